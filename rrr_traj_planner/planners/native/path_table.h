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

/* A path's table (path_timing/table.py): along s, dq/ds and further derivatives, and the dynamics
 * along the path, torque = M sdd + C sd^2 + G (Bobrow, Dubowsky & Gibson 1985), and viscous friction
 * of the joints, viscous dq/ds sd. */
#ifndef RRR_TRAJ_PLANNER_PATH_TABLE_H
#define RRR_TRAJ_PLANNER_PATH_TABLE_H

#include <stddef.h>

enum { DQ, DDQ, DDDQ, M, C, G, KINDS };  /* columns of the table, of three joints each */
enum { COLUMNS = 3 * KINDS };

/* The cubic coefficients, highest first, of all columns at a part u of a segment: rows of COLUMNS,
 * stride doubles from each other; x receives the distance of u from the start of its interval. */
static inline const double *path_interval(const double *rows, int intervals, double u,
                                          size_t *stride, double *x)
{
    const double scaled = u * intervals;
    /* a trial step may give any value: compare before the conversion to int */
    const int i = !(scaled > 0.0) ? 0 : scaled < intervals - 1 ? (int)scaled : intervals - 1;
    *stride = (size_t)intervals * COLUMNS;
    *x = (scaled - i) / intervals;
    return rows + (size_t)i * COLUMNS;
}

/* The values of all columns there. */
static inline void path_columns(const double *c3, size_t stride, double x, double *value)
{
    const double *c2 = c3 + stride, *c1 = c2 + stride, *c0 = c1 + stride;
    for (int k = 0; k < COLUMNS; ++k)
        value[k] = ((c3[k] * x + c2[k]) * x + c1[k]) * x + c0[k];
}

/* The 12 quantities of the joints: velocity, acceleration, jerk and torque, of three joints each.
 */
static inline void joint_quantities(const double d[KINDS][3], const double *viscous, double v,
                                    double a, double jerk, double *x)
{
    for (int j = 0; j < 3; ++j) {
        x[j] = d[DQ][j] * v;
        x[3 + j] = d[DDQ][j] * v * v + d[DQ][j] * a;
        x[6 + j] = d[DDDQ][j] * v * v * v + 3.0 * d[DDQ][j] * v * a + d[DQ][j] * jerk;
        x[9 + j] = d[M][j] * a + d[C][j] * v * v + d[G][j] + viscous[j] * d[DQ][j] * v;
    }
}

#endif
