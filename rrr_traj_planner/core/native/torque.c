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

/* The joint torques of states of motion with their first and second derivatives, from an arm's
 * tables; see arm.c. As many states are computed at once as a processor's vectors have numbers. */
#include "processor.h"

#define STATES VECTOR
#include "arm.h"
#include "arm_terms.h"

/* Columns of a state: q, qd, qdd, jerk of the joints. Torques depend on all but jerk. */
enum { Q, QD = 3, QDD = 6, JERK = 9, STATE = 12 };

/* Row of the derivative of M by the joints i and j (and k) of 1 and 2 (joints 2 and 3). */
static int second_row(int i, int j) { return 3 + (i == 2) + (j == 2); }

static int third_row(int i, int j, int k) { return 6 + (i == 2) + (j == 2) + (k == 2); }

/* Copy columns of up to STATES rows; rows that are missing are taken to be the last. */
INLINE void load(const double *from, int rows, int stride, int columns, Real *to)
{
    for (int k = 0; k < STATES; ++k)
        for (int c = 0; c < columns; ++c)
            ((double *)(to + c))[k] = from[(k < rows ? k : rows - 1) * stride + c];
}

INLINE void store(const Real *from, int rows, int stride, int columns, double *to)
{
    for (int k = 0; k < rows; ++k)
        for (int c = 0; c < columns; ++c)
            to[k * stride + c] = ((const double *)(from + c))[k];
}

INLINE void torques(const Arm *arm, const Real (*M)[ELEMENTS], const Real *gravity,
                    const Real *z, Real *x)
{
    Real product[3];
    times(M[0], z + QDD, product);
    coriolis(M + 1, z + QD, x);
    for (int i = 0; i < 3; ++i)
        x[i] += product[i] + gravity[i] + arm->viscous[i] * z[QD + i];
}

INLINE void torque_gradients(const Real (*M)[ELEMENTS], const Gravity *g, const double *viscous,
                             const Real *qd, const Real *qdd, Real (*to)[JERK])
{
    Real product[3][3], column[3];  /* M_k qd */
    memset(product, 0, sizeof product);
    for (int k = 1; k < 3; ++k)
        times(M[k], qd, product[k]);
    for (int i = 0; i < 3; ++i)
        for (int m = 0; m < 3; ++m)
            to[i][Q + m] = i < m ? g->second[i][m] : g->second[m][i];
    for (int m = 1; m < 3; ++m) {
        Real by[2][3];
        times(M[m], qdd, column);
        for (int k = 1; k < 3; ++k)
            times(M[second_row(k, m)], qd, by[k - 1]);
        for (int i = 0; i < 3; ++i)
            to[i][Q + m] += column[i] + qd[1] * by[0][i] + qd[2] * by[1][i];
        for (int i = 1; i < 3; ++i)
            to[i][Q + m] -= 0.5 * dot(qd, by[i - 1]);
    }
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            const int e = element[i][j];
            to[i][QD + j] = qd[1] * M[1][e] + qd[2] * M[2][e] + product[j][i] - product[i][j];
            to[i][QDD + j] = M[0][e];
        }
        to[i][QD + i] += viscous[i];
    }
}

/* The second derivatives of the sum of torques weighted by w: on and above the diagonal, of those
 * that may differ from zero. */
INLINE void torque_hessian(const Real (*M)[ELEMENTS], const Gravity *g, const Real *w,
                           const Real *qd, const Real *qdd, Real (*to)[JERK])
{
    Real by_w[3][3];  /* M_k w */
    const Real (*const V)[3][3] = g->third;
    memset(by_w, 0, sizeof by_w);
    for (int k = 1; k < 3; ++k)
        times(M[k], w, by_w[k]);
    to[Q][Q] = w[0] * V[0][0][0] + w[1] * V[0][0][1] + w[2] * V[0][0][2];
    to[Q][Q + 1] = w[0] * V[0][0][1] + w[1] * V[0][1][1] + w[2] * V[0][1][2];
    to[Q][Q + 2] = w[0] * V[0][0][2] + w[1] * V[0][1][2] + w[2] * V[0][2][2];
    to[Q + 1][Q + 1] = w[0] * V[0][1][1] + w[1] * V[1][1][1] + w[2] * V[1][1][2];
    to[Q + 1][Q + 2] = w[0] * V[0][1][2] + w[1] * V[1][1][2] + w[2] * V[1][2][2];
    to[Q + 2][Q + 2] = w[0] * V[0][2][2] + w[1] * V[1][2][2] + w[2] * V[2][2][2];
    for (int m = 1; m < 3; ++m) {
        Real of_w[2][3], of_qd[2][3];  /* M_km w and M_km qd */
        for (int k = 1; k < 3; ++k) {
            times(M[second_row(k, m)], w, of_w[k - 1]);
            times(M[second_row(k, m)], qd, of_qd[k - 1]);
        }
        for (int n = m; n < 3; ++n) {
            Real sum = dot(of_w[n - 1], qdd), third[3];
            for (int k = 1; k < 3; ++k) {
                times(M[third_row(k, m, n)], qd, third);
                sum += qd[k] * dot(w, third) - 0.5 * w[k] * dot(qd, third);
            }
            to[Q + m][Q + n] += sum;
        }
        for (int j = 0; j < 3; ++j) {
            to[Q + m][QD + j] = qd[1] * of_w[0][j] + qd[2] * of_w[1][j]
                - w[1] * of_qd[0][j] - w[2] * of_qd[1][j];
            to[Q + m][QDD + j] = by_w[m][j];
        }
        for (int j = 1; j < 3; ++j)
            to[Q + m][QD + j] += dot(w, of_qd[j - 1]);
    }
    for (int j = 0; j < 3; ++j)
        for (int l = j; l < 3; ++l) {
            const int e = element[j][l];
            to[QD + j][QD + l] = by_w[l][j] + by_w[j][l] - w[1] * M[1][e] - w[2] * M[2][e];
        }
}

/* Add second derivatives of up to STATES states to symmetric matrices (STATE, STATE). */
INLINE void add_hessian(const Real (*from)[JERK], int rows, double *second)
{
    for (int k = 0; k < rows; ++k, second += STATE * STATE)
        for (int i = 0; i < QDD; ++i)
            for (int j = i; j < (i < QD ? JERK : QDD); ++j) {
                const double x = ((const double *)&from[i][j])[k];
                second[i * STATE + j] += x;
                if (j > i)
                    second[j * STATE + i] += x;
            }
}

BY_PROCESSOR void torques_at(const Arm *arm, int32_t n, const double *z, double *x)
{
    for (; n > 0; n -= STATES, z += STATES * STATE, x += STATES * 3) {
        const int rows = n < STATES ? n : STATES;
        Real state[JERK], M[ORDERS_1][ELEMENTS], torque[3];
        Basis by[3];
        Gravity g;
        load(z, rows, STATE, JERK, state);
        bases(state, 1, by);
        inertia_derivatives(arm, by, 1, M);
        gravity_derivatives(arm, by, 1, &g);
        torques(arm, (const Real (*)[ELEMENTS])M, g.first, state, torque);
        store(torque, rows, 3, 3, x);
    }
}

BY_PROCESSOR void torque_derivatives_at(const Arm *arm, int32_t n, const double *z,
                                        const double *weights, double *x, double *gradient,
                                        double *second)
{
    for (; n > 0; n -= STATES, z += STATES * STATE, x += STATES * 3, weights += STATES * 3,
             gradient += STATES * 3 * STATE) {
        const int rows = n < STATES ? n : STATES;
        Real state[JERK], w[3], M[ORDERS_3][ELEMENTS], torque[3], by_z[3][JERK];
        Real hessian[QDD][JERK];
        Basis by[3];
        Gravity g;
        load(z, rows, STATE, JERK, state);
        load(weights, rows, 3, 3, w);
        bases(state, 3, by);
        inertia_derivatives(arm, by, 3, M);
        gravity_derivatives(arm, by, 3, &g);
        const Real (*const at)[ELEMENTS] = (const Real (*)[ELEMENTS])M;
        torques(arm, at, g.first, state, torque);
        torque_gradients(at, &g, arm->viscous, state + QD, state + QDD, by_z);
        store(torque, rows, 3, 3, x);
        for (int i = 0; i < 3; ++i) {
            store(by_z[i], rows, 3 * STATE, JERK, gradient + i * STATE);
            for (int k = 0; k < rows; ++k)
                memset(gradient + (3 * k + i) * STATE + JERK, 0, 3 * sizeof *gradient);
        }
        if (!second)
            continue;
        memset(hessian, 0, sizeof hessian);
        torque_hessian(at, &g, w, state + QD, state + QDD, hessian);
        add_hessian((const Real (*)[JERK])hessian, rows, second);
        second += STATES * STATE * STATE;
    }
}
