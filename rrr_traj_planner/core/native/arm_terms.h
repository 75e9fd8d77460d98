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

/* The inertia matrix and the potential energy of an arm with their derivatives, from its tables. */
#ifndef RRR_TRAJ_PLANNER_ARM_TERMS_H
#define RRR_TRAJ_PLANNER_ARM_TERMS_H

#include "arm.h"
#include "trigonometric.h"

#include <string.h>

enum { ELEMENTS = 6 };  /* of M: 11, 12, 13, 22, 23, 33 */
static const int element[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};  /* by row and column */

/* M and its derivatives by q2 (count a) and q3 (count b), by a + b, then by b: number
 * (a + b) (a + b + 1) / 2 + b. */
enum { ORDERS_1 = 3, ORDERS_3 = 10 };

INLINE void inertia_derivatives(const Arm *arm, const Basis *by, const int order,
                                Real (*M)[ELEMENTS])
{
    memset(M, 0, (order == 1 ? ORDERS_1 : ORDERS_3) * sizeof *M);
    for (int n = 0; n < arm->inertia_count; ++n) {
        const int32_t *at = arm->inertia_at + 3 * n;
        Real second[MOST_ORDER + 1], third[MOST_ORDER + 1];
        for (int d = 0; d <= order; ++d) {
            second[d] = arm->inertia[n] * by[1].d[d][at[1]];
            third[d] = by[2].d[d][at[2]];
        }
        for (int total = 0, row = 0; total <= order; ++total)
            for (int b = 0; b <= total; ++b, ++row)
                M[row][at[0]] += second[total - b] * third[b];
    }
}

/* Derivatives of the potential energy: first (3), second (3, 3) and third (3, 3, 3), of these those
 * with indices in ascending order, up to an order. */
typedef struct {
    Real first[3], second[3][3], third[3][3][3];
} Gravity;

INLINE void gravity_derivatives(const Arm *arm, const Basis *by, const int order, Gravity *g)
{
    memset(g, 0, order == 1 ? sizeof g->first : sizeof *g);
    for (int n = 0; n < arm->potential_count; ++n) {
        const int32_t *at = arm->potential_at + 3 * n;
        Real a[MOST_ORDER + 1], b[MOST_ORDER + 1], c[MOST_ORDER + 1];
        for (int d = 0; d <= order; ++d) {
            a[d] = arm->potential[n] * by[0].d[d][at[0]];
            b[d] = by[1].d[d][at[1]], c[d] = by[2].d[d][at[2]];
        }
        g->first[0] += a[1] * b[0] * c[0];
        g->first[1] += a[0] * b[1] * c[0];
        g->first[2] += a[0] * b[0] * c[1];
        if (order < 3)
            continue;
        g->second[0][0] += a[2] * b[0] * c[0];
        g->second[0][1] += a[1] * b[1] * c[0];
        g->second[0][2] += a[1] * b[0] * c[1];
        g->second[1][1] += a[0] * b[2] * c[0];
        g->second[1][2] += a[0] * b[1] * c[1];
        g->second[2][2] += a[0] * b[0] * c[2];
        g->third[0][0][0] += a[3] * b[0] * c[0];
        g->third[0][0][1] += a[2] * b[1] * c[0];
        g->third[0][0][2] += a[2] * b[0] * c[1];
        g->third[0][1][1] += a[1] * b[2] * c[0];
        g->third[0][1][2] += a[1] * b[1] * c[1];
        g->third[0][2][2] += a[1] * b[0] * c[2];
        g->third[1][1][1] += a[0] * b[3] * c[0];
        g->third[1][1][2] += a[0] * b[2] * c[1];
        g->third[1][2][2] += a[0] * b[1] * c[2];
        g->third[2][2][2] += a[0] * b[0] * c[3];
    }
}

/* M v for M by its elements. */
INLINE void times(const Real *M, const Real *v, Real *product)
{
    product[0] = M[0] * v[0] + M[1] * v[1] + M[2] * v[2];
    product[1] = M[1] * v[0] + M[3] * v[1] + M[4] * v[2];
    product[2] = M[2] * v[0] + M[4] * v[1] + M[5] * v[2];
}

INLINE Real dot(const Real *a, const Real *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Coriolis and centrifugal torques; by: derivatives of M by q2 and q3. */
INLINE void coriolis(const Real (*by)[ELEMENTS], const Real *qd, Real *torque)
{
    Real p2[3], p3[3];
    times(by[0], qd, p2), times(by[1], qd, p3);
    for (int i = 0; i < 3; ++i)
        torque[i] = qd[1] * p2[i] + qd[2] * p3[i];
    torque[1] -= 0.5 * dot(qd, p2), torque[2] -= 0.5 * dot(qd, p3);
}

/* M x = b, for M by its elements, symmetric and positive definite. */
INLINE void solve_symmetric(const Real *M, const Real *b, Real *x)
{
    const Real C00 = M[3] * M[5] - M[4] * M[4], C01 = M[2] * M[4] - M[1] * M[5];
    const Real C02 = M[1] * M[4] - M[2] * M[3], C11 = M[0] * M[5] - M[2] * M[2];
    const Real C12 = M[1] * M[2] - M[0] * M[4], C22 = M[0] * M[3] - M[1] * M[1];
    const Real det = M[0] * C00 + M[1] * C01 + M[2] * C02;
    x[0] = (C00 * b[0] + C01 * b[1] + C02 * b[2]) / det;
    x[1] = (C01 * b[0] + C11 * b[1] + C12 * b[2]) / det;
    x[2] = (C02 * b[0] + C12 * b[1] + C22 * b[2]) / det;
}

/* arm.c: M (n, 6) and the torques of velocity and gravity (n, 3), at n states. */
void arm_inertia_and_bias(const Arm *arm, int32_t n, const double *q, const double *qd,
                          double (*M)[ELEMENTS], double *bias);

#endif
