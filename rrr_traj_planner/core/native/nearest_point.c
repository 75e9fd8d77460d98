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

/* Starts for the nearest point that the tip reaches, of a point that it does not.
 *
 * Joint 1 brings the tip into the half-plane of the point, where the distance depends on q2, q3
 * alone: its local minima on a grid are starts, so that the least of them is not missed. */
#include "inverse.h"

#include <stdbool.h>

enum { STEPS = 24 };  /* of a turn, in q2 and in q3; chosen: local minima are 1 to 4, wide */

static const double TURN = 6.28318530717958647693;

/* Squared distances in the half-plane of a point, at radius from axis 1 and height h above c1. */
static void squared_distances(const CommonNormal *g, double radius, double h,
                              double d[STEPS][STEPS])
{
    for (int j = 0; j < STEPS; ++j) {
        const double q3 = TURN * j / STEPS;
        const double u = at_angle(g->u, q3), v = at_angle(g->v, q3), k = at_angle(g->k, q3);
        for (int i = 0; i < STEPS; ++i) {
            const double cosine = cos(TURN * i / STEPS), sine = sin(TURN * i / STEPS);
            const double v_turned = u * sine + v * cosine;
            const double X = g->a + u * cosine - v * sine, Y = g->c * v_turned - g->s * k;
            const double away = hypot(X, Y) - radius, above = g->s * v_turned + g->c * k - h;
            d[i][j] = away * away + above * above;
        }
    }
}

static bool is_local_minimum(double d[STEPS][STEPS], int i, int j)
{
    for (int k = -1; k <= 1; ++k)
        for (int l = -1; l <= 1; ++l)
            if (d[(i + k + STEPS) % STEPS][(j + l + STEPS) % STEPS] < d[i][j])
                return false;
    return true;
}

double distance_out_of_reach(const Arm *arm, const CommonNormal *g, const double *p,
                             const double *parts, int iterations)
{
    const double azimuth = atan2(parts[1], parts[0]);
    double d[STEPS][STEPS], least = INFINITY;
    squared_distances(g, hypot(parts[0], parts[1]), parts[2], d);
    for (int i = 0; i < STEPS; ++i)
        for (int j = 0; j < STEPS; ++j)
            if (is_local_minimum(d, i, j)) {
                const double q2 = TURN * i / STEPS, q3 = TURN * j / STEPS;
                const double u = at_angle(g->u, q3), v = at_angle(g->v, q3);
                const double X = g->a + u * cos(q2) - v * sin(q2);
                const double Y = g->c * (u * sin(q2) + v * cos(q2)) - g->s * at_angle(g->k, q3);
                double q[3] = {azimuth - atan2(Y, X), q2, q3};
                least = fmin(least, polish(arm, g->size, p, iterations, q));
            }
    return least;
}
