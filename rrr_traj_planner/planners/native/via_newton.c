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

/* The Newton step of weight * objective + barrier of the via-point problem (Boyd & Vandenberghe,
 * Convex Optimization, 11.3): a banded system, whose solution costs time linear in the number of
 * via points. */
#include "band_cholesky.h"
#include "via_problem.h"

#include <string.h>

/* First and (damped) second derivatives of the barrier by a via velocity, and by a duration. */
static void by_velocity(const ViaProblem *p, int i, double *first, double *second)
{
    const double *damping = p->damping, *bound = damping + p->n * JOINTS;
    *first = p->gradient[i][1] + p->gradient[i + JOINTS][0] + p->bound[i][0];
    *second = p->hessian[i][1][1] * (1.0 + damping[i])
        + p->hessian[i + JOINTS][0][0] * (1.0 + damping[i + JOINTS])
        + p->bound[i][1] * (1.0 + bound[i]);
}

static void by_duration(const ViaProblem *p, int k, double *first, double *second)
{
    const int at = (p->n - 1) * JOINTS + k;
    *first = p->bound[at][0];
    *second = p->bound[at][1] * (1.0 + p->damping[p->n * JOINTS + at]);
    for (int i = k * JOINTS; i < (k + 1) * JOINTS; ++i) {
        *first += p->gradient[i][2];
        *second += p->hessian[i][2][2] * (1.0 + p->damping[i]);
    }
}

/* A damped entry of the Hessian of a segment's joint. */
static double entry(const ViaProblem *p, int i, int row, int column)
{
    return p->hessian[i][row][column] * (1.0 + p->damping[i]);
}

enum { OWN = 1 + JOINTS };  /* unknowns of a segment, its duration and the velocities at its end */

/* Subtract from a range's right-hand side what the steps of the velocities at its ends add. */
static void subtract_steps_of_ends(const ViaProblem *p, Range at)
{
    double *right = p->right + OWN * at.begin;
    const int m = OWN * (at.end - at.begin) - JOINTS;
    for (int j = 0; j < JOINTS; ++j) {
        const int first = at.begin * JOINTS + j, last = (at.end - 1) * JOINTS + j;
        if (at.begin > 0) {
            const double before = p->step[first - JOINTS];
            right[0] -= entry(p, first, 0, 2) * before;
            if (m > 1)
                right[1 + j] -= entry(p, first, 0, 1) * before;
        }
        if (at.end < p->n) {
            const double after = p->step[last];
            right[m - 1] -= entry(p, last, 1, 2) * after;
            if (m > 1)
                right[m - 1 - JOINTS + j] -= entry(p, last, 0, 1) * after;
        }
    }
}

int via_range_step(const ViaProblem *p, double weight, Range at)
{
    enum { W = 5 };
    const int m = OWN * (at.end - at.begin) - JOINTS;
    double *band = p->band + (size_t)OWN * at.begin * W, *right = p->right + OWN * at.begin;
    double *dT = p->step + (p->n - 1) * JOINTS;
    memset(band, 0, (size_t)m * W * sizeof(double));
    for (int k = at.begin; k < at.end; ++k) {
        double first, *column = p->band + (size_t)OWN * k * W;
        by_duration(p, k, &first, column);
        p->total_gradient[OWN * k] = -(weight + first);
        for (int j = 0; j < JOINTS && k < at.end - 1; ++j) {
            const int i = k * JOINTS + j;
            double *own = column + (1 + j) * W;
            by_velocity(p, i, &first, own);
            p->total_gradient[OWN * k + 1 + j] = -first;
            column[1 + j] = entry(p, i, 1, 2);
            own[JOINTS - j] = entry(p, i + JOINTS, 0, 2);
            if (k < at.end - 2)
                own[OWN] = entry(p, i + JOINTS, 0, 1);
        }
    }
    memcpy(right, p->total_gradient + OWN * at.begin, m * sizeof(double));
    subtract_steps_of_ends(p, at);
    if (solve_band(band, right, m, W, 1))
        return 1;
    for (int k = at.begin; k < at.end; ++k) {
        dT[k] = p->right[OWN * k];
        for (int j = 0; j < JOINTS && k < at.end - 1; ++j)
            p->step[k * JOINTS + j] = p->right[OWN * k + 1 + j];
    }
    return 0;
}

double via_share(const ViaProblem *p, int k, int end)
{
    const double *total = p->total_gradient + OWN * k;
    double sum = total[0] * p->step[(p->n - 1) * JOINTS + k];
    for (int j = 0; j < JOINTS && k < end - 1; ++j)
        sum += total[1 + j] * p->step[k * JOINTS + j];
    return sum;
}

/* The step with all durations free. Returns the Newton decrement squared, negative where the
 * matrix is not positive definite numerically. */
static double free_step(const ViaProblem *p, double weight)
{
    const Range all = {0, p->n};
    double decrement = 0.0;
    if (via_range_step(p, weight, all))
        return -1.0;
    for (int k = 0; k < p->n; ++k)
        decrement += via_share(p, k, p->n);
    return decrement;
}

/* The step with durations in fixed proportions: a band for the velocities, bordered by the row of
 * their common factor, which is eliminated first. */
static double common_step(const ViaProblem *p, double weight)
{
    enum { W = JOINTS + 1 };
    const int n = p->n, m = (n - 1) * JOINTS;
    const double *in = p->proportions;
    double g = weight, h = 0.0;
    for (int k = 0; k < n; ++k) {
        double first, second;
        by_duration(p, k, &first, &second);
        g += first * in[k];
        h += second * in[k] * in[k];
    }
    memset(p->band, 0, (size_t)m * W * sizeof(double));
    for (int i = 0; i < m; ++i) {
        const int k = i / JOINTS;
        by_velocity(p, i, &p->total_gradient[i], &p->band[(size_t)i * W]);
        if (i + JOINTS < m)
            p->band[(size_t)i * W + JOINTS] = entry(p, i + JOINTS, 0, 1);
        p->border[i] = entry(p, i, 1, 2) * in[k] + entry(p, i + JOINTS, 0, 2) * in[k + 1];
        p->right[2 * i] = p->total_gradient[i];
        p->right[2 * i + 1] = p->border[i];
    }
    if (solve_band(p->band, p->right, m, W, 2))
        return -1.0;
    double border_times_velocity_step = 0.0, by_border = 0.0;
    for (int i = 0; i < m; ++i) {
        border_times_velocity_step += p->border[i] * p->right[2 * i];
        by_border += p->border[i] * p->right[2 * i + 1];
    }
    const double factor = -(g - border_times_velocity_step) / (h - by_border);
    double decrement = -g * factor, *dT = p->step + m;
    for (int i = 0; i < m; ++i) {
        p->step[i] = -(p->right[2 * i] + p->right[2 * i + 1] * factor);
        decrement -= p->total_gradient[i] * p->step[i];
    }
    for (int k = 0; k < n; ++k)
        dT[k] = factor * in[k];
    return decrement;
}

double via_newton(const ViaProblem *p, double weight)
{
    return p->proportions ? common_step(p, weight) : free_step(p, weight);
}
