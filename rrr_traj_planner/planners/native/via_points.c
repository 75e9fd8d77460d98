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

/* The part of a Newton step that couples the segments: the steps of velocities and accelerations
 * at the via points, from a banded system. */
#include "band_cholesky.h"
#include "timing_problem.h"

#include <math.h>
#include <string.h>

/* Diagonal entry of a velocity that does not change: the step that it gives is below the rounding
 * of any velocity, and the products of several such entries are still finite. */
static const double FIXED_PIVOT = 1e60;
/* Multiples of the diagonal added in turn until the band is positive definite (inertia correction:
 * Waechter & Biegler 2006, 3.1); chosen: from a slight change to twice the diagonal. */
static const double REGULARISATION[] = {0.0, 1e-9, 1e-6, 1e-3, 1.0};

/* The banded system of velocities and accelerations at the via points, with two right-hand sides:
 * the gradient, and the coupling to the common factor. */
static void assemble_via_points(const Problem *p, const double *S, const double *r, double *band,
                                double *right)
{
    const int N = p->N, half = 2 * p->J, B = 2 * half, W = B + 1, w = 2 * half;
    memset(band, 0, (size_t)(N - 1) * half * w * sizeof(double));
    for (int k = 0; k < N - 1; ++k) {
        const double *one = S + (size_t)k * W * W, *next = one + (size_t)W * W;
        for (int i = 0; i < half; ++i) {
            double *column = band + ((size_t)k * half + i) * w;
            for (int c = i; c < half; ++c)
                column[c - i] = one[(half + c) * W + half + i] + next[c * W + i];
            if (k < N - 2)
                for (int c = 0; c < half; ++c)
                    column[half + c - i] = next[(half + c) * W + i];
            right[2 * (k * half + i)] = r[(size_t)k * W + half + i] + r[(size_t)(k + 1) * W + i];
            right[2 * (k * half + i) + 1] = p->proportions[k] * one[(half + i) * W + B]
                + p->proportions[k + 1] * next[i * W + B];
            if (i < p->J && p->fixed_velocity[k * p->J + i])
                column[0] = FIXED_PIVOT;
        }
    }
}

/* Solve a system of m unknowns, band and right-hand sides in a row, regularised as far as
 * necessary: by its diagonal alone where nothing else helps. */
static void solve_regularised(const double *band, double *solved, int m, int w)
{
    const size_t trials = sizeof REGULARISATION / sizeof *REGULARISATION;
    const size_t all = (size_t)m * (w + 2);
    double *right = solved + (size_t)m * w;
    for (size_t trial = 0; trial < trials; ++trial) {
        memcpy(solved, band, all * sizeof(double));
        for (int c = 0; c < m; ++c)
            solved[(size_t)c * w] += REGULARISATION[trial] * fabs(band[(size_t)c * w]);
        if (!solve_band(solved, right, m, w, 2))
            return;
    }
    memcpy(solved, band, all * sizeof(double));
    for (int c = 0; c < m; ++c)
        for (int s = 0; s < 2; ++s)
            right[2 * c + s] /= fabs(band[(size_t)c * w]);
}

/* Solve for the steps of velocities and accelerations at the via points (N + 1, 2 J); returns the
 * step of the factor common to the durations of fixed proportions. */
double solve_via_points(const Problem *p, const double *S, const double *r,
                        double common_hessian, double common_gradient, double *via_step,
                        double *band)
{
    const int N = p->N, half = 2 * p->J, m = (N - 1) * half, w = 2 * half;
    double *right = band + (size_t)m * w, *solved = right + 2 * m;
    memset(via_step, 0, (size_t)(N + 1) * half * sizeof(double));
    if (m == 0)
        return common_hessian != 0.0 ? -common_gradient / common_hessian : 0.0;
    assemble_via_points(p, S, r, band, right);
    solve_regularised(band, solved, m, w);
    const double *x = solved + (size_t)m * w;
    double by_r = 0.0, by_common = 0.0, common = 0.0;
    for (int c = 0; c < m; ++c) {
        by_r += right[2 * c + 1] * x[2 * c];
        by_common += right[2 * c + 1] * x[2 * c + 1];
    }
    if (common_hessian != 0.0)
        common = -(common_gradient - by_r) / (common_hessian - by_common);
    for (int c = 0; c < m; ++c)
        via_step[half + c] = -(x[2 * c] + x[2 * c + 1] * common);
    return common;
}
