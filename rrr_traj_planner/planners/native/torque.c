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

/* Joint torques by the equations of motion (thesis (5.39) to (5.54), corrected), with their first
 * and second derivatives by the state (joint_timing/constraints.py). */
#include "timing_problem.h"

#include <math.h>

static const double DIFFERENCE = 1e-7;  /* rad, step of the difference quotients by q2 and q3 */

/* Terms of the inertia matrix M, its partial derivatives (M11_q2 = dM11/dq2), and gravity's
 * torque. */
typedef struct {
    double M11, M22, M23, M33, M11_q2, M11_q3, M23_q3, g2, g3;
} Terms;

/* The arm's constants: the fields of core/dynamics/equations.Constants, in their order. */
enum {
    A2, L3, M3, BASE_INERTIA, UPPER_INERTIA, FORE_INERTIA, SHOULDER_INERTIA, ELBOW_INERTIA,
    COUPLING, UPPER_WEIGHT, FORE_WEIGHT
};

static Terms terms(const double *k, double q2, double q3)
{
    const double s2 = sin(q2), c2 = cos(q2), s3 = sin(q3), c3 = cos(q3);
    const double s23 = s2 * c3 + c2 * s3, c23 = c2 * c3 - s2 * s3;
    const double r = k[L3] * s23 + k[A2] * c2, m3r = k[M3] * r, fore = k[FORE_INERTIA] * s23;
    const double half_M11_q3 = (fore + m3r * k[L3]) * c23, M23_part = k[COUPLING] * s3;
    Terms t;
    t.M11 = k[BASE_INERTIA] + k[UPPER_INERTIA] * c2 * c2 + fore * s23 + m3r * r;
    t.M22 = k[SHOULDER_INERTIA] + 2.0 * M23_part;
    t.M23 = k[ELBOW_INERTIA] + M23_part;
    t.M33 = k[ELBOW_INERTIA];
    t.M11_q2 = 2.0 * (half_M11_q3 - (k[UPPER_INERTIA] * c2 + m3r * k[A2]) * s2);
    t.M11_q3 = 2.0 * half_M11_q3;
    t.M23_q3 = k[COUPLING] * c3;
    t.g3 = k[FORE_WEIGHT] * s23;
    t.g2 = k[UPPER_WEIGHT] * c2 + t.g3;
    return t;
}

static Terms difference_quotient(Terms from, Terms to, double step)
{
    Terms d = {(to.M11 - from.M11) / step, (to.M22 - from.M22) / step,
               (to.M23 - from.M23) / step, (to.M33 - from.M33) / step,
               (to.M11_q2 - from.M11_q2) / step, (to.M11_q3 - from.M11_q3) / step,
               (to.M23_q3 - from.M23_q3) / step, (to.g2 - from.g2) / step,
               (to.g3 - from.g3) / step};
    return d;
}

static void torques(const Terms *t, const double *qd, const double *qdd, double *tau)
{
    const double half = 0.5 * qd[0] * qd[0];
    tau[0] = t->M11 * qdd[0] + (t->M11_q2 * qd[1] + t->M11_q3 * qd[2]) * qd[0];
    tau[1] = t->M22 * qdd[1] + t->M23 * qdd[2] + t->M23_q3 * qd[2] * (qd[2] + 2.0 * qd[1])
        - t->M11_q2 * half + t->g2;
    tau[2] = t->M23 * qdd[1] + t->M33 * qdd[2] - t->M11_q3 * half - t->M23_q3 * qd[1] * qd[1]
        + t->g3;
}

/* Gradients of the torques by the state (3, 12); by: the terms' derivatives by q2 and q3. */
static void torque_gradients(const Terms *t, const Terms by[2], const double *qd,
                             const double *qdd, double g[3][12])
{
    for (int e = 0; e < 3; ++e)
        for (int c = 0; c < 12; ++c)
            g[e][c] = 0.0;
    for (int c = 0; c < 2; ++c) {
        double tau[3];
        torques(&by[c], qd, qdd, tau);
        for (int e = 0; e < 3; ++e)
            g[e][1 + c] = tau[e];
    }
    g[0][3] = t->M11_q2 * qd[1] + t->M11_q3 * qd[2];
    g[0][4] = t->M11_q2 * qd[0], g[0][5] = t->M11_q3 * qd[0];
    g[1][3] = -t->M11_q2 * qd[0], g[1][4] = 2.0 * t->M23_q3 * qd[2];
    g[1][5] = 2.0 * t->M23_q3 * (qd[1] + qd[2]);
    g[2][3] = -t->M11_q3 * qd[0], g[2][4] = -2.0 * t->M23_q3 * qd[1];
    g[0][6] = t->M11, g[1][7] = t->M22, g[1][8] = g[2][7] = t->M23, g[2][8] = t->M33;
}

/* Add the Hessian of the weighted sum of torques to the upper left of second (12, 12). */
static void add_torque_hessian(const Terms *t, const Terms by[2], const double *qd,
                               const double *weights, double *second)
{
    double hessian[9][9] = {{0.0}};
    const double l1 = weights[0], l2 = weights[1], l3 = weights[2];
    for (int c = 0; c < 2; ++c) {
        const Terms *d = &by[c];
        double *row = hessian[1 + c];
        row[3] = l1 * (d->M11_q2 * qd[1] + d->M11_q3 * qd[2])
            - (l2 * d->M11_q2 + l3 * d->M11_q3) * qd[0];
        row[4] = l1 * d->M11_q2 * qd[0] + 2.0 * d->M23_q3 * (l2 * qd[2] - l3 * qd[1]);
        row[5] = l1 * d->M11_q3 * qd[0] + 2.0 * l2 * d->M23_q3 * (qd[1] + qd[2]);
        row[6] = l1 * d->M11, row[7] = l2 * d->M22 + l3 * d->M23, row[8] = l2 * d->M23;
    }
    hessian[3][4] = l1 * t->M11_q2, hessian[3][5] = l1 * t->M11_q3;
    hessian[4][5] = 2.0 * l2 * t->M23_q3;
    hessian[1][2] = -(l2 + l3) * t->g3;
    for (int i = 0; i < 9; ++i)
        for (int k = i + 1; k < 9; ++k)
            hessian[k][i] = hessian[i][k];
    hessian[1][1] = -(l2 * t->g2 + l3 * t->g3), hessian[2][2] = -(l2 + l3) * t->g3;
    hessian[3][3] = -(l2 * t->M11_q2 + l3 * t->M11_q3);
    hessian[4][4] = -2.0 * l3 * t->M23_q3, hessian[5][5] = 2.0 * l2 * t->M23_q3;
    for (int i = 0; i < 9; ++i)
        for (int k = 0; k < 9; ++k)
            second[i * 12 + k] += hessian[i][k];
}

void torque_at(const double *arm, const double *z, double *x, double *gradient,
               const double *weights, double *second)
{
    const double *q = z, *qd = z + 3, *qdd = z + 6;
    const Terms t = terms(arm, q[1], q[2]);
    if (x)
        torques(&t, qd, qdd, x);
    if (!gradient && !second)
        return;
    const Terms by[2] = {difference_quotient(t, terms(arm, q[1] + DIFFERENCE, q[2]), DIFFERENCE),
                         difference_quotient(t, terms(arm, q[1], q[2] + DIFFERENCE), DIFFERENCE)};
    if (gradient)
        torque_gradients(&t, by, qd, qdd, (double (*)[12])gradient);
    if (second)
        add_torque_hessian(&t, by, qd, weights, second);
}
