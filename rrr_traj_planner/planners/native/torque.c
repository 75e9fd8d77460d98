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

/* Torques of the arm, their derivatives by state and their own bends (ramp_constraints.py). */
#include "timing_problem.h"

#include <math.h>

static const double DIFFERENCE = 1e-7;  /* rad, over which the terms change by q2 and q3 */

typedef struct {
    double H11, H22, H23, H33, D2, D3, bc3, g2, g3;
} Terms;

enum { A2, L3, M3, BASE, UPPER, FORE, SHOULDER, ELBOW, COUPLING, UPPER_WEIGHT, FORE_WEIGHT };

static Terms terms(const double *k, double q2, double q3)
{
    const double s2 = sin(q2), c2 = cos(q2), s3 = sin(q3), c3 = cos(q3);
    const double s23 = s2 * c3 + c2 * s3, c23 = c2 * c3 - s2 * s3;
    const double r = k[L3] * s23 + k[A2] * c2, m3r = k[M3] * r, fore = k[FORE] * s23;
    const double half_D3 = (fore + m3r * k[L3]) * c23, bs3 = k[COUPLING] * s3;
    Terms t;
    t.H11 = k[BASE] + k[UPPER] * c2 * c2 + fore * s23 + m3r * r;
    t.H22 = k[SHOULDER] + 2.0 * bs3;
    t.H23 = k[ELBOW] + bs3;
    t.H33 = k[ELBOW];
    t.D2 = 2.0 * (half_D3 - (k[UPPER] * c2 + m3r * k[A2]) * s2);
    t.D3 = 2.0 * half_D3;
    t.bc3 = k[COUPLING] * c3;
    t.g3 = k[FORE_WEIGHT] * s23;
    t.g2 = k[UPPER_WEIGHT] * c2 + t.g3;
    return t;
}

static Terms change(Terms a, Terms b, double difference)
{
    Terms d = {(b.H11 - a.H11) / difference, (b.H22 - a.H22) / difference,
               (b.H23 - a.H23) / difference, (b.H33 - a.H33) / difference,
               (b.D2 - a.D2) / difference, (b.D3 - a.D3) / difference,
               (b.bc3 - a.bc3) / difference, (b.g2 - a.g2) / difference,
               (b.g3 - a.g3) / difference};
    return d;
}

static void torques(const Terms *t, const double *w, const double *a, double *tau)
{
    const double half = 0.5 * w[0] * w[0];
    tau[0] = t->H11 * a[0] + (t->D2 * w[1] + t->D3 * w[2]) * w[0];
    tau[1] = t->H22 * a[1] + t->H23 * a[2] + t->bc3 * w[2] * (w[2] + 2.0 * w[1]) - t->D2 * half
        + t->g2;
    tau[2] = t->H23 * a[1] + t->H33 * a[2] - t->D3 * half - t->bc3 * w[1] * w[1] + t->g3;
}

void torque_at(const double *arm, const double *z, double *x, double *gradient,
               const double *weights, double *second)
{
    const double *q = z, *w = z + 3, *a = z + 6;
    const Terms t = terms(arm, q[1], q[2]);
    if (x)
        torques(&t, w, a, x);
    if (!gradient && !second)
        return;
    const Terms by[2] = {change(t, terms(arm, q[1] + DIFFERENCE, q[2]), DIFFERENCE),
                         change(t, terms(arm, q[1], q[2] + DIFFERENCE), DIFFERENCE)};
    if (gradient) {
        double (*g)[12] = (double (*)[12])gradient;
        for (int e = 0; e < 3; ++e)
            for (int c = 0; c < 12; ++c)
                g[e][c] = 0.0;
        for (int c = 0; c < 2; ++c) {
            double tau[3];
            torques(&by[c], w, a, tau);
            for (int e = 0; e < 3; ++e)
                g[e][1 + c] = tau[e];
        }
        g[0][3] = t.D2 * w[1] + t.D3 * w[2], g[0][4] = t.D2 * w[0], g[0][5] = t.D3 * w[0];
        g[1][3] = -t.D2 * w[0], g[1][4] = 2.0 * t.bc3 * w[2];
        g[1][5] = 2.0 * t.bc3 * (w[1] + w[2]);
        g[2][3] = -t.D3 * w[0], g[2][4] = -2.0 * t.bc3 * w[1];
        g[0][6] = t.H11, g[1][7] = t.H22, g[1][8] = g[2][7] = t.H23, g[2][8] = t.H33;
    }
    if (second) {
        double H[9][9] = {{0.0}};
        const double s1 = weights[0], s2 = weights[1], s3 = weights[2];
        for (int c = 0; c < 2; ++c) {
            const Terms *d = &by[c];
            double *row = H[1 + c];
            row[3] = s1 * (d->D2 * w[1] + d->D3 * w[2]) - (s2 * d->D2 + s3 * d->D3) * w[0];
            row[4] = s1 * d->D2 * w[0] + 2.0 * d->bc3 * (s2 * w[2] - s3 * w[1]);
            row[5] = s1 * d->D3 * w[0] + 2.0 * s2 * d->bc3 * (w[1] + w[2]);
            row[6] = s1 * d->H11, row[7] = s2 * d->H22 + s3 * d->H23, row[8] = s2 * d->H23;
        }
        H[3][4] = s1 * t.D2, H[3][5] = s1 * t.D3, H[4][5] = 2.0 * s2 * t.bc3;
        H[1][2] = -(s2 + s3) * t.g3;
        for (int i = 0; i < 9; ++i)
            for (int k = i + 1; k < 9; ++k)
                H[k][i] = H[i][k];
        H[1][1] = -(s2 * t.g2 + s3 * t.g3), H[2][2] = -(s2 + s3) * t.g3;
        H[3][3] = -(s2 * t.D2 + s3 * t.D3);
        H[4][4] = -2.0 * s3 * t.bc3, H[5][5] = 2.0 * s2 * t.bc3;
        for (int i = 0; i < 9; ++i)
            for (int k = 0; k < 9; ++k)
                second[i * 12 + k] += H[i][k];
    }
}
