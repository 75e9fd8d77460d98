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

/* 3 x 3 blocks that are made positive definite: eigenvalues by Jacobi's method (Golub & Van Loan,
 * Matrix Computations, 8.5). */
#include "convexify.h"

#include <math.h>

/* For a block scaled to a unit diagonal, without unit: pivots above which it is positive definite
 * as it stands (far above their rounding errors, some 1e-15), the least eigenvalue that it is
 * given, and entries that count as zero (below the rounding of the diagonal). Chosen. */
static const double CLEARLY_CONVEX = 1e-10, LEAST_EIGENVALUE = 1e-12, NOTHING = 1e-17;
static const double TINY = 1e-300;  /* added to diagonal entries, which may be 0: the least that divides; chosen */
enum { SWEEPS = 30 };  /* at most: convergence is quadratic, some five are needed */

static int is_clearly_convex(double a[3][3])
{
    const double l10 = a[1][0] / a[0][0], l20 = a[2][0] / a[0][0];
    const double d1 = a[1][1] - l10 * a[1][0], m21 = a[2][1] - l20 * a[1][0];
    const double d2 = a[2][2] - l20 * a[2][0] - m21 * m21 / d1;
    return a[0][0] > CLEARLY_CONVEX && d1 > CLEARLY_CONVEX && d2 > CLEARLY_CONVEX;
}

/* Cyclic Jacobi: the diagonal of a becomes its eigenvalues, the columns of v its eigenvectors. */
static void diagonalise(double a[3][3], double v[3][3])
{
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            v[i][k] = i == k;
    for (int sweep = 0; sweep < SWEEPS; ++sweep) {
        if (fabs(a[0][1]) + fabs(a[0][2]) + fabs(a[1][2]) < NOTHING)
            return;
        for (int p = 0; p < 2; ++p)
            for (int q = p + 1; q < 3; ++q) {
                if (a[p][q] == 0.0)
                    continue;
                const double theta = 0.5 * (a[q][q] - a[p][p]) / a[p][q];
                const double t = (theta < 0.0 ? -1.0 : 1.0)
                    / (fabs(theta) + sqrt(theta * theta + 1.0));
                const double c = 1.0 / sqrt(t * t + 1.0), s = t * c, shift = t * a[p][q];
                const int r = 3 - p - q;
                const double rp = a[r][p], rq = a[r][q];
                a[p][p] -= shift;
                a[q][q] += shift;
                a[p][q] = a[q][p] = 0.0;
                a[r][p] = a[p][r] = c * rp - s * rq;
                a[r][q] = a[q][r] = s * rp + c * rq;
                for (int i = 0; i < 3; ++i) {
                    const double vp = v[i][p], vq = v[i][q];
                    v[i][p] = c * vp - s * vq;
                    v[i][q] = s * vp + c * vq;
                }
            }
    }
}

void make_convex(double block[3][3])
{
    double scale[3], a[3][3], v[3][3];
    for (int i = 0; i < 3; ++i)
        scale[i] = 1.0 / sqrt(fabs(block[i][i]) + TINY);
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            a[i][k] = block[i][k] * scale[i] * scale[k];
    if (is_clearly_convex(a))
        return;
    diagonalise(a, v);
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k <= i; ++k) {
            double sum = 0.0;
            for (int e = 0; e < 3; ++e)
                sum += v[i][e] * fmax(fabs(a[e][e]), LEAST_EIGENVALUE) * v[k][e];
            block[i][k] = block[k][i] = sum / (scale[i] * scale[k]);
        }
}
