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

/* The log barrier of a chain: value, gradient and Hessian. */
#include "barrier.h"

#include "blocks.h"
#include "reach.h"

#include <math.h>
#include <string.h>

static Law law_of(const Chain *chain, int j)
{
    const Law law = {chain->slope[j], chain->root[j], chain->max_velocity[j]};
    return law;
}

static void ends(const Chain *chain, const double *v, int k, int j, double *v0, double *v1)
{
    *v0 = k > 0 ? v[(k - 1) * JOINTS + j] : 0.0;
    *v1 = k < chain->n - 1 ? v[k * JOINTS + j] : 0.0;
}

int parts_of(const Chain *chain)
{
    return chain->n * JOINTS + (chain->n - 1) * JOINTS + chain->n;
}

static double barrier(double product, double least)
{
    return least > 0.0 ? -log(product) : INFINITY;
}

void barrier_values(const Chain *chain, const double *v, const double *T, double *values)
{
    const int n = chain->n;
    for (int j = 0; j < JOINTS; ++j) {
        const Law law = law_of(chain, j);
        for (int k = 0; k < n; ++k) {
            double v0, v1, *value = &values[k * JOINTS + j];
            *value = INFINITY;
            if (!(T[k] > 0.0))
                continue;
            ends(chain, v, k, j, &v0, &v1);
            const double D = chain->displacements[k * JOINTS + j];
            const double change = largest_change(&law, T[k]);
            const double up = change - (v1 - v0), down = change + (v1 - v0);
            if (!(up > 0.0 && down > 0.0))
                continue;
            const double forth = reach(&law, v0, v1, T[k]) - D;
            const double back = reach(&law, -v0, -v1, T[k]) + D;
            *value = barrier(up * down * forth * back, fmin(forth, back));
        }
    }
    values += n * JOINTS;
    for (int i = 0; i < (n - 1) * JOINTS; ++i) {
        const double low = v[i] - chain->lowest[i], high = chain->highest[i] - v[i];
        values[i] = barrier(low * high, fmin(low, high));
    }
    values += (n - 1) * JOINTS;
    for (int k = 0; k < n; ++k) {
        const double spare = chain->floor ? T[k] - chain->floor[k] : 1.0;
        values[k] = barrier(spare, spare);
    }
}

/* Add -log of a slack to the derivatives. */
static void pushed(double slack, const double gradient[3], double slope[3], double block[3][3])
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

/* The reach forth (sign 1) or back (-1), and its own second derivatives. */
static void reach_pushed(const Law *law, double sign, double v0, double v1, double T, double D,
                         double slope[3], double block[3][3])
{
    const double by[3] = {sign, sign, 1.0};
    ReachDerivatives at = reach_derivatives(law, sign * v0, sign * v1, T);
    const double slack = at.distance - sign * D, inverse = 1.0 / slack;
    for (int i = 0; i < 3; ++i) {
        at.gradient[i] *= by[i];
        for (int c = 0; c < 3; ++c)
            block[i][c] -= by[i] * by[c] * inverse * at.hessian[i][c];
    }
    pushed(slack, at.gradient, slope, block);
}

void barrier_derivatives(const Chain *chain, const double *v, const double *T, Derivatives d)
{
    memset(d.slope, 0, chain->n * JOINTS * sizeof *d.slope);
    memset(d.block, 0, chain->n * JOINTS * sizeof *d.block);
    for (int j = 0; j < JOINTS; ++j) {
        const Law law = law_of(chain, j);
        for (int k = 0; k < chain->n; ++k) {
            const int at = k * JOINTS + j;
            double v0, v1;
            ends(chain, v, k, j, &v0, &v1);
            const double D = chain->displacements[at];
            const double change = largest_change(&law, T[k]), rate = change_rate(&law, T[k]);
            const double up[3] = {1.0, -1.0, rate}, down[3] = {-1.0, 1.0, rate};
            reach_pushed(&law, 1.0, v0, v1, T[k], D, d.slope[at], d.block[at]);
            reach_pushed(&law, -1.0, v0, v1, T[k], D, d.slope[at], d.block[at]);
            pushed(change - (v1 - v0), up, d.slope[at], d.block[at]);
            pushed(change + (v1 - v0), down, d.slope[at], d.block[at]);
            made_convex(d.block[at], chain->least_eigenvalue);
        }
    }
    for (int i = 0; i < (chain->n - 1) * JOINTS; ++i) {
        const double low = 1.0 / (v[i] - chain->lowest[i]);
        const double high = 1.0 / (chain->highest[i] - v[i]);
        d.bound[i][0] = high - low;
        d.bound[i][1] = low * low + high * high;
    }
    d.bound += (chain->n - 1) * JOINTS;
    for (int k = 0; k < chain->n; ++k) {
        const double spare = chain->floor ? 1.0 / (T[k] - chain->floor[k]) : 0.0;
        d.bound[k][0] = -spare;
        d.bound[k][1] = spare * spare;
    }
}

static int is_misjudged(double change, double first, double second, double tolerated)
{
    return !(change - first <= tolerated * second);
}

void misjudged(const Chain *chain, const double *dv, const double *dT, Derivatives d,
               const double *before, const double *after, double more_damping, double *damping)
{
    const int segments = chain->n * JOINTS, bounds = segments - JOINTS, all = parts_of(chain);
    int found = 0;
    for (int i = 0; i < all; ++i) {
        const double own = 1.0 + damping[i];
        double first, second;
        if (i < segments) {
            double step[3] = {0.0, 0.0, dT[i / JOINTS]};
            ends(chain, dv, i / JOINTS, i % JOINTS, &step[0], &step[1]);
            first = second = 0.0;
            for (int a = 0; a < 3; ++a) {
                first += d.slope[i][a] * step[a];
                for (int b = 0; b < 3; ++b)
                    second += step[a] * d.block[i][a][b] * step[b];
            }
        } else {
            const int at = i - segments;
            const double step = at < bounds ? dv[at] : dT[at - bounds];
            first = d.bound[at][0] * step;
            second = d.bound[at][1] * step * step;
        }
        if (is_misjudged(after[i] - before[i], first, own * second, chain->tolerated)) {
            damping[i] = damping[i] * more_damping + 1.0;
            found = 1;
        }
    }
    for (int i = 0; !found && i < all; ++i)
        damping[i] = damping[i] * more_damping + 1.0;
}
