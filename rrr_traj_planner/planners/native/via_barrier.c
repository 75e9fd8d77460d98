// Copyright 2026 rrr_traj_planner developers
//
// Licensed under the Apache License, Version 2.0 (the "License");
// you may not use this file except in compliance with the License.
// You may obtain a copy of the License at
//
//     http://www.apache.org/licenses/LICENSE-2.0
//
// Unless required by applicable law or agreed to in writing, software
// distributed under the License is distributed on an "AS IS" BASIS,
// WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
// See the License for the specific language governing permissions and
// limitations under the License.

/* The logarithmic barrier of the via-point problem: values, gradients, Hessians and damping of its
 * parts (solver/via_barrier.py; Boyd & Vandenberghe, Convex Optimization, 11.2 and 11.3). */
#include "via_problem.h"

#include "convexify.h"
#include "largest_displacement.h"

#include <math.h>
#include <string.h>

static Law law_of(const ViaProblem *p, int j)
{
    const Law law = {p->slope[j], p->root[j], p->max_velocity[j]};
    return law;
}

static void ends(const ViaProblem *p, const double *v, int k, int j, double *v0, double *v1)
{
    *v0 = k > 0 ? v[(k - 1) * JOINTS + j] : 0.0;
    *v1 = k < p->n - 1 ? v[k * JOINTS + j] : 0.0;
}

static double barrier(double product, double least)
{
    return least > 0.0 ? -log(product) : INFINITY;
}

/* -sum log(slack) of the parts at a point; infinite where a constraint does not hold strictly. */
void via_part_values(const ViaProblem *p, const double *point, double *values, Range at)
{
    const int n = p->n;
    const double *v = point, *T = point + (n - 1) * JOINTS;
    for (int j = 0; j < JOINTS; ++j) {
        const Law law = law_of(p, j);
        for (int k = at.begin; k < at.end; ++k) {
            double v0, v1, *value = &values[k * JOINTS + j];
            *value = INFINITY;
            if (!(T[k] > 0.0))
                continue;
            ends(p, v, k, j, &v0, &v1);
            const double D = p->displacements[k * JOINTS + j];
            const double change = largest_change(&law, T[k]);
            const double up = change - (v1 - v0), down = change + (v1 - v0);
            if (!(up > 0.0 && down > 0.0))
                continue;
            const double forth = largest_displacement(&law, v0, v1, T[k]) - D;
            const double back = largest_displacement(&law, -v0, -v1, T[k]) + D;
            *value = barrier(up * down * forth * back, fmin(forth, back));
        }
    }
    values += n * JOINTS;
    for (int i = at.begin * JOINTS; i < (at.end - 1) * JOINTS; ++i) {
        const double low = v[i] - p->lowest[i], high = p->highest[i] - v[i];
        values[i] = barrier(low * high, fmin(low, high));
    }
    values += (n - 1) * JOINTS;
    for (int k = at.begin; k < at.end; ++k) {
        const double slack = p->least_T ? T[k] - p->least_T[k] : 1.0;
        values[k] = barrier(slack, slack);
    }
}

double via_objective(const ViaProblem *p, const double *point)
{
    const double *T = point + (p->n - 1) * JOINTS;
    double sum = 0.0;
    for (int k = 0; k < p->n; ++k)
        sum += T[k];
    return p->proportions ? T[0] / p->proportions[0] : sum;
}

/* Add the derivatives of -log(slack): gradient, and Hessian but for the slack's own second
 * derivative. */
static void add_log_derivatives(double slack, const double gradient[3], double slope[3],
                                double block[3][3])
{
    const double inverse = 1.0 / slack;
    double relative[3];
    for (int i = 0; i < 3; ++i) {
        relative[i] = gradient[i] * inverse;
        slope[i] -= relative[i];
    }
    for (int i = 0; i < 3; ++i)
        for (int c = 0; c < 3; ++c)
            block[i][c] += relative[i] * relative[c];
}

/* Add the derivatives of -log(largest displacement - D), forward (sign 1) or backward (sign -1).
 */
static void add_displacement_derivatives(const Law *law, double sign, double v0, double v1,
                                         double T, double D, double slope[3],
                                         double block[3][3])
{
    const double by[3] = {sign, sign, 1.0};
    DisplacementDerivatives at = displacement_derivatives(law, sign * v0, sign * v1, T);
    const double slack = at.distance - sign * D, inverse = 1.0 / slack;
    for (int i = 0; i < 3; ++i) {
        at.gradient[i] *= by[i];
        for (int c = 0; c < 3; ++c)
            block[i][c] -= by[i] * by[c] * inverse * at.hessian[i][c];
    }
    add_log_derivatives(slack, at.gradient, slope, block);
}

void via_differentiate(const ViaProblem *p, Range at)
{
    const int n = p->n;
    const double *v = p->point, *T = p->point + (n - 1) * JOINTS;
    const size_t first = at.begin * JOINTS, count = (at.end - at.begin) * JOINTS;
    memset(p->gradient + first, 0, count * sizeof *p->gradient);
    memset(p->hessian + first, 0, count * sizeof *p->hessian);
    for (int j = 0; j < JOINTS; ++j) {
        const Law law = law_of(p, j);
        for (int k = at.begin; k < at.end; ++k) {
            const int i = k * JOINTS + j;
            double v0, v1, *slope = p->gradient[i];
            double (*block)[3] = p->hessian[i];
            ends(p, v, k, j, &v0, &v1);
            const double D = p->displacements[i];
            const double change = largest_change(&law, T[k]), rate = change_rate(&law, T[k]);
            const double up[3] = {1.0, -1.0, rate}, down[3] = {-1.0, 1.0, rate};
            add_displacement_derivatives(&law, 1.0, v0, v1, T[k], D, slope, block);
            add_displacement_derivatives(&law, -1.0, v0, v1, T[k], D, slope, block);
            add_log_derivatives(change - (v1 - v0), up, slope, block);
            add_log_derivatives(change + (v1 - v0), down, slope, block);
            make_convex(block);
        }
    }
    double (*bound)[2] = p->bound;
    for (int i = at.begin * JOINTS; i < (at.end - 1) * JOINTS; ++i) {
        const double low = 1.0 / (v[i] - p->lowest[i]), high = 1.0 / (p->highest[i] - v[i]);
        bound[i][0] = high - low;
        bound[i][1] = low * low + high * high;
    }
    bound += (n - 1) * JOINTS;
    for (int k = at.begin; k < at.end; ++k) {
        const double slack = p->least_T ? 1.0 / (T[k] - p->least_T[k]) : 0.0;
        bound[k][0] = -slack;
        bound[k][1] = slack * slack;
    }
}

/* For solver/via_barrier.py, which compares it. */
EXPORTED const int64_t size_of_via_problem = sizeof(ViaProblem);

/* Evaluate the barrier and its derivatives at the first iterate. */
EXPORTED void via_begin(ViaProblem *p)
{
    const Range all = {0, p->n};
    p->objective = via_objective(p, p->point);
    via_part_values(p, p->point, p->before, all);
    via_differentiate(p, all);
}

/* Try the damped Newton step; returns the change of weight * objective + barrier along it,
 * infinite where a constraint is violated. */
EXPORTED double via_attempt(ViaProblem *p, double weight)
{
    p->decrement = via_newton(p, weight);
    if (!(p->decrement >= 0.0))
        return INFINITY;
    for (int u = 0; u < unknowns_of(p); ++u)
        p->next[u] = p->point[u] + p->step[u];
    via_part_values(p, p->next, p->after, (Range){0, p->n});
    double change = weight * via_objective(p, p->next) - weight * p->objective;
    for (int i = 0; i < parts_of(p); ++i)
        change += p->after[i] - p->before[i];
    return change;
}

/* Accept the last attempt; the damping of every part is multiplied by a factor. */
EXPORTED void via_accept(ViaProblem *p, double less_damping)
{
    memcpy(p->point, p->next, unknowns_of(p) * sizeof(double));
    memcpy(p->before, p->after, parts_of(p) * sizeof(double));
    p->objective = via_objective(p, p->point);
    for (int i = 0; i < parts_of(p); ++i)
        p->damping[i] *= less_damping;
    via_differentiate(p, (Range){0, p->n});
}

/* Raise the damping of a part if it was badly predicted; returns whether it was. */
static int damp_part(const ViaProblem *p, DampingRule rule, int i)
{
    const int segments = p->n * JOINTS, bounds = segments - JOINTS;
    const double *dv = p->step, *dT = p->step + bounds;
    double first = 0.0, second = 0.0;
    if (i < segments) {
        double step[3] = {0.0, 0.0, dT[i / JOINTS]};
        ends(p, dv, i / JOINTS, i % JOINTS, &step[0], &step[1]);
        for (int a = 0; a < 3; ++a) {
            first += p->gradient[i][a] * step[a];
            for (int b = 0; b < 3; ++b)
                second += step[a] * p->hessian[i][a][b] * step[b];
        }
    } else {
        const int at = i - segments;
        const double step = at < bounds ? dv[at] : dT[at - bounds];
        first = p->bound[at][0] * step;
        second = p->bound[at][1] * step * step;
    }
    const double rise = p->after[i] - p->before[i];
    if (rise - first <= rule.tolerated * (1.0 + p->damping[i]) * second + rule.slack)
        return 0;
    p->damping[i] = p->damping[i] * rule.more_damping + 1.0;
    return 1;
}

int via_damp_segment(const ViaProblem *p, DampingRule rule, int k, int end)
{
    const int segments = p->n * JOINTS, bounds = segments - JOINTS;
    int found = damp_part(p, rule, segments + bounds + k);
    for (int i = k * JOINTS; i < (k + 1) * JOINTS; ++i) {
        found += damp_part(p, rule, i);
        if (k < end - 1)
            found += damp_part(p, rule, segments + i);
    }
    return found;
}

/* Raise the damping of the parts that were badly predicted on the last attempt. Raises all if
 * there is none. */
EXPORTED void via_damp(const ViaProblem *p, double tolerated, double more_damping)
{
    const DampingRule rule = {tolerated, more_damping, 0.0};
    int found = 0;
    for (int k = 0; k < p->n; ++k)
        found += via_damp_segment(p, rule, k, p->n);
    for (int i = 0; !found && i < parts_of(p); ++i)
        p->damping[i] = p->damping[i] * more_damping + 1.0;
}
