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
#include "arm.h"
#include "trigonometric.h"

#include "export.h"

#include <stddef.h>
#include <string.h>

/* Add a derivative, a, b and c times by the joints, of all coordinates; out: stride doubles from
 * one to the next. */
static void add_derivative(const Arm *arm, const Basis *by, int a, int b, int c, double *out,
                           size_t stride)
{
    for (int n = 0; n < arm->tip_count; ++n) {
        const int32_t *at = arm->tip_at + 4 * n;
        out[at[0] * stride] += arm->tip[n] * by[0].d[a][at[1]] * by[1].d[b][at[2]]
            * by[2].d[c][at[3]];
    }
}

/* Positions (n, 3). */
EXPORTED void arm_tip(const Arm *arm, int32_t n, const double *q, double *p)
{
    memset(p, 0, 3 * (size_t)n * sizeof *p);
    for (int s = 0; s < n; ++s, q += 3, p += 3) {
        Basis by[3];
        bases(q, 0, by);
        add_derivative(arm, by, 0, 0, 0, p, 1);
    }
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
        Basis by[3];
        double second[3][3][3] = {{{0.0}}};  /* joint, joint, coordinate */
        bases(q, 2, by);
        for (int i = 0; i < 3; ++i)
            for (int j = i; j < 3; ++j)
                add_derivative(arm, by, (i == 0) + (j == 0), (i == 1) + (j == 1),
                               (i == 2) + (j == 2), second[i][j], 1);
        for (int x = 0; x < 3; ++x)
            for (int i = 0; i < 3; ++i) {
                rate[3 * x + i] = 0.0;
                for (int j = 0; j < 3; ++j)
                    rate[3 * x + i] += second[i < j ? i : j][i < j ? j : i][x] * qd[j];
            }
    }
}
