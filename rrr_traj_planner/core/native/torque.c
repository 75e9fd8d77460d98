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

/* The joint torques of a state of motion with their first and second derivatives, from an arm's
 * tables; see arm.c. */
#include "arm.h"
#include "arm_terms.h"

/* Row of the derivative of M by the joints i and j (and k) of 1 and 2 (joints 2 and 3). */
static int second_row(int i, int j) { return 3 + (i == 2) + (j == 2); }

static int third_row(int i, int j, int k) { return 6 + (i == 2) + (j == 2) + (k == 2); }

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
