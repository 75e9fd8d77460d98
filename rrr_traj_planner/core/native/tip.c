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

/* The tip's position and its derivatives by joint positions, from an arm's table. */
#include "tip.h"
#include "trigonometric.h"

#include "export.h"

#include <stddef.h>
#include <string.h>

/* By how often each derivative is taken by q1, q2, q3; of one order in sequence. */
static const int8_t order_of[ORDERS][3] = {
    {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
    {2, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 2, 0}, {0, 1, 1}, {0, 0, 2},
    {3, 0, 0}, {2, 1, 0}, {2, 0, 1}, {1, 2, 0}, {1, 1, 1}, {1, 0, 2}, {0, 3, 0}, {0, 2, 1},
    {0, 1, 2}, {0, 0, 3}};

void tip_derivatives(const Arm *arm, const double *q, int order, Vector *x)
{
    static const int counts[] = {1, 4, 10, ORDERS};
    const int count = counts[order];
    Basis by[3];
    bases(q, order, by);
    memset(x, 0, (size_t)count * sizeof *x);
    for (int n = 0; n < arm->tip_count; ++n) {
        const int32_t *at = arm->tip_at + 4 * n;
        for (int k = 0; k < count; ++k)
            x[k][at[0]] += arm->tip[n] * by[0].d[order_of[k][0]][at[1]]
                * by[1].d[order_of[k][1]][at[2]] * by[2].d[order_of[k][2]][at[3]];
    }
}

/* Positions (n, 3). */
EXPORTED void arm_tip(const Arm *arm, int32_t n, const double *q, double *p)
{
    for (int s = 0; s < n; ++s, q += 3, p += 3)
        tip_derivatives(arm, q, 0, (Vector *)p);
}

void tip_and_jacobian(const Arm *arm, const double *q, double *p, double (*J)[3])
{
    Basis by[3];
    bases(q, 1, by);
    memset(p, 0, 3 * sizeof *p), memset(J, 0, 3 * sizeof *J);
    for (int n = 0; n < arm->tip_count; ++n) {
        const int32_t *at = arm->tip_at + 4 * n;
        const double x = arm->tip[n], a = x * by[0].d[0][at[1]], b = by[1].d[0][at[2]];
        const double c = by[2].d[0][at[3]];
        p[at[0]] += a * b * c;
        J[at[0]][0] += x * by[0].d[1][at[1]] * b * c;
        J[at[0]][1] += a * by[1].d[1][at[2]] * c;
        J[at[0]][2] += a * b * by[2].d[1][at[3]];
    }
}

/* Jacobians (n, 3, 3): coordinate, joint. */
EXPORTED void arm_jacobian(const Arm *arm, int32_t n, const double *q, double (*J)[3])
{
    double p[3];
    for (int s = 0; s < n; ++s, q += 3, J += 3)
        tip_and_jacobian(arm, q, p, J);
}

/* Time derivatives of Jacobians (n, 3, 3) at joint velocities. */
EXPORTED void arm_jacobian_rate(const Arm *arm, int32_t n, const double *q, const double *qd,
                                double *rate)
{
    for (int s = 0; s < n; ++s, q += 3, qd += 3, rate += 9) {
        Vector x[10];
        tip_derivatives(arm, q, 2, x);
        for (int c = 0; c < 3; ++c)
            for (int i = 0; i < 3; ++i) {
                rate[3 * c + i] = 0.0;
                for (int j = 0; j < 3; ++j)
                    rate[3 * c + i] += x[second_by[i][j]][c] * qd[j];
            }
    }
}
