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

/* Dynamics of an arm from its tables. The inertia matrix M depends on q2 and q3 alone; with M_k its
 * partial derivatives (M_1 = 0) and V the potential energy, the torque of joint i is
 *
 *     (M qdd)_i + sum_k qd_k (M_k qd)_i - qd' M_i qd / 2 + dV/dq_i
 *
 * (Lagrange's equations: Lynch & Park, Modern Robotics, 2017, 8.1). */
#include "arm.h"
#include "trigonometric.h"

#include "export.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

enum { ELEMENTS = 6 };  /* of M: 11, 12, 13, 22, 23, 33 */

/* For core/arm/compiled_arm.py, which compares it. */
EXPORTED const int64_t size_of_arm = sizeof(Arm);

/* M and its derivatives by q2 (count a) and q3 (count b), by a + b, then by b: number
 * (a + b) (a + b + 1) / 2 + b. */
enum { ORDERS_1 = 3, ORDERS_2 = 6, ORDERS_3 = 10 };

/* order: a constant at every call, so that the loops unroll. */
static inline void add_inertia(const Arm *arm, const Basis *by, const int order,
                               double (*M)[ELEMENTS])
{
    for (int n = 0; n < arm->inertia_count; ++n) {
        const int32_t *at = arm->inertia_at + 3 * n;
        const double x = arm->inertia[n];
        double second[MOST_ORDER + 1], third[MOST_ORDER + 1];
        for (int d = 0; d <= order; ++d) {
            second[d] = x * by[1].d[d][at[1]];
            third[d] = by[2].d[d][at[2]];
        }
        for (int total = 0, row = 0; total <= order; ++total)
            for (int b = 0; b <= total; ++b, ++row)
                M[row][at[0]] += second[total - b] * third[b];
    }
}

static void inertia_derivatives(const Arm *arm, const Basis *by, int order,
                                double (*M)[ELEMENTS])
{
    memset(M, 0, (order == 1 ? ORDERS_1 : order == 2 ? ORDERS_2 : ORDERS_3) * sizeof *M);
    if (order == 1)
        add_inertia(arm, by, 1, M);
    else if (order == 2)
        add_inertia(arm, by, 2, M);
    else
        add_inertia(arm, by, 3, M);
}

/* Derivatives of the potential energy: first (3), second (3, 3) and third (3, 3, 3), of these those
 * with indices in ascending order, up to an order. */
typedef struct {
    double first[3], second[3][3], third[3][3][3];
} Gravity;

static void gravity_derivatives(const Arm *arm, const Basis *by, int order, Gravity *g)
{
    memset(g, 0, sizeof *g);
    for (int n = 0; n < arm->potential_count; ++n) {
        const int32_t *at = arm->potential_at + 3 * n;
        double a[MOST_ORDER + 1], b[MOST_ORDER + 1], c[MOST_ORDER + 1];
        for (int d = 0; d <= order; ++d) {
            a[d] = arm->potential[n] * by[0].d[d][at[0]];
            b[d] = by[1].d[d][at[1]], c[d] = by[2].d[d][at[2]];
        }
        g->first[0] += a[1] * b[0] * c[0];
        g->first[1] += a[0] * b[1] * c[0];
        g->first[2] += a[0] * b[0] * c[1];
        if (order < 2)
            continue;
        g->second[0][0] += a[2] * b[0] * c[0];
        g->second[0][1] += a[1] * b[1] * c[0];
        g->second[0][2] += a[1] * b[0] * c[1];
        g->second[1][1] += a[0] * b[2] * c[0];
        g->second[1][2] += a[0] * b[1] * c[1];
        g->second[2][2] += a[0] * b[0] * c[2];
        if (order < 3)
            continue;
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
static void times(const double *M, const double *v, double *product)
{
    product[0] = M[0] * v[0] + M[1] * v[1] + M[2] * v[2];
    product[1] = M[1] * v[0] + M[3] * v[1] + M[4] * v[2];
    product[2] = M[2] * v[0] + M[4] * v[1] + M[5] * v[2];
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Coriolis and centrifugal torques; by: derivatives of M by q2 and q3. */
static void coriolis(const double (*by)[ELEMENTS], const double *qd, double *torque)
{
    double p2[3], p3[3];
    times(by[0], qd, p2), times(by[1], qd, p3);
    for (int i = 0; i < 3; ++i)
        torque[i] = qd[1] * p2[i] + qd[2] * p3[i];
    torque[1] -= 0.5 * dot(qd, p2), torque[2] -= 0.5 * dot(qd, p3);
}

/* M (n, 6) and the torques of velocity and gravity (n, 3), at n states. */
EXPORTED void arm_inertia_and_bias(const Arm *arm, int32_t n, const double *q, const double *qd,
                                   double (*M)[ELEMENTS], double *bias)
{
    for (int s = 0; s < n; ++s, q += 3, qd += 3, bias += 3) {
        Basis by[3];
        double all[ORDERS_1][ELEMENTS];
        Gravity g;
        bases(q, 1, by);
        inertia_derivatives(arm, by, 1, all);
        gravity_derivatives(arm, by, 1, &g);
        coriolis((const double (*)[ELEMENTS])all + 1, qd, bias);
        memcpy(M[s], all[0], sizeof all[0]);
        for (int i = 0; i < 3; ++i)
            bias[i] += g.first[i];
    }
}

/* Joint torques (n, 3) of n states of motion, without friction. */
EXPORTED void arm_inverse_dynamics(const Arm *arm, int32_t n, const double *q, const double *qd,
                                   const double *qdd, double *torque)
{
    for (int s = 0; s < n; ++s, q += 3, qd += 3, qdd += 3, torque += 3) {
        double M[ELEMENTS], bias[3];
        arm_inertia_and_bias(arm, 1, q, qd, &M, bias);
        times(M, qdd, torque);
        for (int i = 0; i < 3; ++i)
            torque[i] += bias[i];
    }
}

/* The torques (n, 3) that hold the arm at rest. */
EXPORTED void arm_gravity_torque(const Arm *arm, int32_t n, const double *q, double *torque)
{
    for (int s = 0; s < n; ++s, q += 3, torque += 3) {
        Basis by[3];
        Gravity g;
        bases(q, 1, by);
        gravity_derivatives(arm, by, 1, &g);
        memcpy(torque, g.first, sizeof g.first);
    }
}

/* Potential energies (n). */
EXPORTED void arm_potential_energy(const Arm *arm, int32_t n, const double *q, double *energy)
{
    for (int s = 0; s < n; ++s, q += 3) {
        Basis by[3];
        bases(q, 0, by);
        energy[s] = 0.0;
        for (int k = 0; k < arm->potential_count; ++k) {
            const int32_t *at = arm->potential_at + 3 * k;
            energy[s] += arm->potential[k] * by[0].d[0][at[0]] * by[1].d[0][at[1]]
                * by[2].d[0][at[2]];
        }
    }
}

/* Row of the derivative of M by the joints i and j (and k) of 1 and 2 (joints 2 and 3). */
static int second_row(int i, int j) { return 3 + (i == 2) + (j == 2); }

static int third_row(int i, int j, int k) { return 6 + (i == 2) + (j == 2) + (k == 2); }

static const int element[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};  /* of M, by row and column */

/* Columns of the state: q, qd, qdd, jerk of the joints. */
enum { Q, QD = 3, QDD = 6, STATE = 12 };

static void torque_gradients(const double (*M)[ELEMENTS], const Gravity *g, const double *viscous,
                             const double *qd, const double *qdd, double (*to)[STATE])
{
    double product[3][3] = {{0.0}}, column[3];  /* M_k qd */
    memset(to, 0, 3 * sizeof *to);
    for (int k = 1; k < 3; ++k)
        times(M[k], qd, product[k]);
    for (int m = 1; m < 3; ++m) {
        double by[2][3];
        times(M[m], qdd, column);
        for (int k = 1; k < 3; ++k)
            times(M[second_row(k, m)], qd, by[k - 1]);
        for (int i = 0; i < 3; ++i)
            to[i][Q + m] = column[i] + qd[1] * by[0][i] + qd[2] * by[1][i]
                - (i ? 0.5 * dot(qd, by[i - 1]) : 0.0);
    }
    for (int i = 0; i < 3; ++i)
        for (int m = 0; m < 3; ++m)
            to[i][Q + m] += i < m ? g->second[i][m] : g->second[m][i];
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            const int e = element[i][j];
            to[i][QD + j] = qd[1] * M[1][e] + qd[2] * M[2][e] + product[j][i] - product[i][j];
            to[i][QDD + j] = M[0][e];
        }
        to[i][QD + i] += viscous[i];
    }
}

/* Add the second derivatives of the sum of torques weighted by w. */
static void add_torque_hessian(const double (*M)[ELEMENTS], const Gravity *g, const double *w,
                               const double *qd, const double *qdd, double (*to)[STATE])
{
    double by_w[3][3] = {{0.0}};  /* M_k w */
    for (int k = 1; k < 3; ++k)
        times(M[k], w, by_w[k]);
    const double (*const V)[3][3] = g->third;
    const double h00 = w[0] * V[0][0][0] + w[1] * V[0][0][1] + w[2] * V[0][0][2];
    const double h01 = w[0] * V[0][0][1] + w[1] * V[0][1][1] + w[2] * V[0][1][2];
    const double h02 = w[0] * V[0][0][2] + w[1] * V[0][1][2] + w[2] * V[0][2][2];
    to[Q][Q] += h00, to[Q][Q + 1] += h01, to[Q + 1][Q] += h01;
    to[Q][Q + 2] += h02, to[Q + 2][Q] += h02;
    to[Q + 1][Q + 1] += w[0] * V[0][1][1] + w[1] * V[1][1][1] + w[2] * V[1][1][2];
    to[Q + 2][Q + 2] += w[0] * V[0][2][2] + w[1] * V[1][2][2] + w[2] * V[2][2][2];
    const double h12 = w[0] * V[0][1][2] + w[1] * V[1][1][2] + w[2] * V[1][2][2];
    to[Q + 1][Q + 2] += h12, to[Q + 2][Q + 1] += h12;
    for (int m = 1; m < 3; ++m) {
        double of_w[2][3], of_qd[2][3];  /* M_km w and M_km qd */
        for (int k = 1; k < 3; ++k) {
            times(M[second_row(k, m)], w, of_w[k - 1]);
            times(M[second_row(k, m)], qd, of_qd[k - 1]);
        }
        for (int n = m; n < 3; ++n) {
            double sum = dot(of_w[n - 1], qdd), third[3];
            for (int k = 1; k < 3; ++k) {
                times(M[third_row(k, m, n)], qd, third);
                sum += qd[k] * dot(w, third) - 0.5 * w[k] * dot(qd, third);
            }
            to[Q + m][Q + n] += sum;
            if (n > m)
                to[Q + n][Q + m] += sum;
        }
        for (int j = 0; j < 3; ++j) {
            const double sum = qd[1] * of_w[0][j] + qd[2] * of_w[1][j]
                + (j ? dot(w, of_qd[j - 1]) : 0.0)
                - w[1] * of_qd[0][j] - w[2] * of_qd[1][j];
            to[Q + m][QD + j] += sum, to[QD + j][Q + m] += sum;
            to[Q + m][QDD + j] += by_w[m][j], to[QDD + j][Q + m] += by_w[m][j];
        }
    }
    for (int j = 0; j < 3; ++j)
        for (int l = 0; l < 3; ++l) {
            const int e = element[j][l];
            const double sum = by_w[l][j] + by_w[j][l] - w[1] * M[1][e] - w[2] * M[2][e];
            to[QD + j][QD + l] += sum;
        }
}

void torque_at(const Arm *arm, const double *z, double *x, double *gradient,
               const double *weights, double *second)
{
    const double *qd = z + QD, *qdd = z + QDD;
    const int order = second ? 3 : gradient ? 2 : 1;
    Basis by[3];
    double M[ORDERS_3][ELEMENTS];
    Gravity g;
    bases(z, order, by);
    inertia_derivatives(arm, by, order, M);
    gravity_derivatives(arm, by, order, &g);
    const double (*const at)[ELEMENTS] = (const double (*)[ELEMENTS])M;
    if (x) {
        double product[3];
        times(M[0], qdd, product);
        coriolis(at + 1, qd, x);
        for (int i = 0; i < 3; ++i)
            x[i] += product[i] + g.first[i] + arm->viscous[i] * qd[i];
    }
    if (gradient)
        torque_gradients(at, &g, arm->viscous, qd, qdd, (double (*)[STATE])gradient);
    if (second)
        add_torque_hessian(at, &g, weights, qd, qdd, (double (*)[STATE])second);
}
