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

/* The part of a Newton step that couples the segments: the steps of velocities, accelerations and
 * jerks at the via points, from a banded system. */
#include "band_cholesky.h"
#include "timing_problem.h"

#include <math.h>
#include <string.h>

/* Diagonal entry of a value that does not change: the step that it gives is below the rounding of
 * any, and the products of several such entries are still finite. */
static const double FIXED_PIVOT = 1e60;
/* Multiples of the diagonal added in turn until the band is positive definite (inertia correction:
 * Waechter & Biegler 2006, 3.1); chosen: from a slight change to twice the diagonal. */
static const double REGULARISATION[] = {0.0, 1e-9, 1e-6, 1e-3, 1.0};

/* The banded system of the via points of a range, with two right-hand sides: the gradient, and the
 * coupling to the common factor. Steps at the range's ends are given, unless the motion ends there.
 */
static void assemble_via_points(const Problem *p, Range range, const double *S, const double *r,
                                const double *damping, const double *via_step, double *band,
                                double *right)
{
    const int half = ORDERS * p->J, B = 2 * half, W = B + 1, w = 2 * half;
    const size_t m = (size_t)(range.end - range.begin + 1) * half;
    memset(band, 0, m * w * sizeof(double));
    memset(right, 0, 2 * m * sizeof(double));
    for (int k = range.begin; k < range.end; ++k) {
        const double *own = S + (size_t)k * W * W, *own_r = r + (size_t)k * W;
        const double *given = via_step + (size_t)k * half;
        const double factor = damping ? damping[k] : 1.0;
        const int from = k == range.begin && k > 0 ? 0 : half;
        const int until = k == range.end - 1 && k < p->N - 1 ? B : half;
        for (int i = 0; i < B; ++i) {
            const size_t at = (size_t)(k - range.begin) * half + i;
            for (int c = i; c < B; ++c)
                band[at * w + c - i] += factor * own[c * W + i];
            right[2 * at] += own_r[i];
            for (int c = from; c < until; ++c)
                right[2 * at] += factor * own[i * W + c] * given[c];
            right[2 * at + 1] += p->proportions[k] * own[i * W + B];
        }
    }
    for (size_t at = 0; at < m; ++at) {
        const int k = range.begin + (int)(at / half);
        const int given = (k == range.begin && k > 0) || (k == range.end && k < p->N);
        if (given || p->fixed[(size_t)range.begin * half + at])
            band[at * w] = FIXED_PIVOT;
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

double solve_via_points(const Problem *p, Range range, const double *S, const double *r,
                        const double *damping, double common_hessian, double common_gradient,
                        double *via_step, double *band)
{
    const int half = ORDERS * p->J, m = (range.end - range.begin + 1) * half, w = 2 * half;
    double *right = band + (size_t)m * w, *solved = right + 2 * m;
    assemble_via_points(p, range, S, r, damping, via_step, band, right);
    solve_regularised(band, solved, m, w);
    const double *x = solved + (size_t)m * w;
    double by_r = 0.0, by_common = 0.0, common = 0.0;
    for (int c = 0; c < m; ++c) {
        by_r += right[2 * c + 1] * x[2 * c];
        by_common += right[2 * c + 1] * x[2 * c + 1];
    }
    if (common_hessian != 0.0)
        common = -(common_gradient - by_r) / (common_hessian - by_common);
    const int first = range.begin > 0 ? half : 0, end = range.end < p->N ? m - half : m;
    for (int c = first; c < end; ++c)
        via_step[(size_t)range.begin * half + c] = -(x[2 * c] + x[2 * c + 1] * common);
    return common;
}
