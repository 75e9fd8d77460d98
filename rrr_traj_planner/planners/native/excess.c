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

/* Magnitudes between samples of a motion, and by how much they exceed limits near the points of
 * the problem (solver/excess.py). Samples x are (N, 2 n checks + 1, K), in the order of
 * time, checks of them from one point to the next. */
#include "export.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>

static double second_difference(const double *x, size_t stride, int width, int w)
{
    const double *at = x + (size_t)(w < 1 ? 1 : w < width - 1 ? w : width - 2) * stride;
    return fabs(at[stride] - 2.0 * at[0] + *(at - stride));
}

/* The rise of a smooth quantity between each sample and its neighbours: an eighth of the largest
 * second difference there. x: of one segment and quantity, stride doubles apart, as rise. */
static void rises(const double *x, size_t stride, int width, double *rise, size_t rise_stride)
{
    double before = second_difference(x, stride, width, 0), at = before;
    for (int w = 0; w < width; ++w) {
        const double after = second_difference(x, stride, width, w + 1);
        const double beside = before > after ? before : after;
        rise[w * rise_stride] = (at > beside ? at : beside) / 8.0;
        before = at, at = after;
    }
}

EXPORTED void rise_between_samples(int32_t N, int32_t width, int32_t K, const double *x,
                                   double *rise)
{
    for (int k = 0; k < N; ++k)
        for (int e = 0; e < K; ++e) {
            const size_t first = (size_t)k * width * K + e;
            rises(x + first, K, width, rise + first, K);
        }
}

/* Excess of magnitudes near each point (N, 2 n + 1, K), nodes first: the largest within reach
 * samples on either side. What exceeds a limit also exceeds it less the part rounding of it.
 * scratch: (2 n checks + 1). */
EXPORTED void excess_near_points(int32_t N, int32_t n, int32_t checks, int32_t reach, int32_t K,
                                 const double *x, const double *limit, double rounding,
                                 double *excess, double *scratch)
{
    const int width = 2 * n * checks + 1, P = 2 * n + 1;
    for (size_t i = 0; i < (size_t)N * P * K; ++i)
        excess[i] = 0.0;
    for (int k = 0; k < N; ++k, x += (size_t)width * K, excess += (size_t)P * K)
        for (int e = 0; e < K; ++e) {
            if (!isfinite(limit[e]))
                continue;
            rises(x + e, K, width, scratch, 1);
            for (int w = 0; w < width; ++w) {
                const double peak = fabs(x[(size_t)w * K + e]) + scratch[w];
                if (!(peak > limit[e]))
                    continue;
                const double over = peak - limit[e] * (1.0 - rounding);
                int i = w > reach ? (w - reach + checks - 1) / checks : 0;
                for (; i < P && i * checks <= w + reach; ++i) {
                    double *to = excess + (size_t)(i % 2 ? n + 1 + i / 2 : i / 2) * K + e;
                    *to = fmax(*to, over);
                }
            }
        }
}

static int direction(double velocity, double rest)
{
    return velocity > rest ? 1 : velocity < -rest ? -1 : 0;
}

/* How far positions q (N, width, K) leave the range from low to high (K) in each segment: beyond
 * (2, N, K), upper and lower end; not above 0 within. Where the velocity qd, at rest up to the
 * speed rest, has another sign at the next sample, they rise between. */
EXPORTED void range_excess(int32_t N, int32_t width, int32_t K, const double *q, const double *qd,
                           const double *low, const double *high, double rest, double *beyond,
                           double *scratch)
{
    const size_t size = (size_t)width * K;
    for (int k = 0; k < N; ++k, q += size, qd += size)
        for (int e = 0; e < K; ++e) {
            double most = -INFINITY, least = INFINITY;
            rises(q + e, K, width, scratch, 1);
            for (int w = 0; w < width; ++w) {
                const double x = q[(size_t)w * K + e];
                most = x > most ? x : most, least = x < least ? x : least;
            }
            for (int w = 0; w + 1 < width; ++w) {
                const size_t at = (size_t)w * K + e, next = at + K;
                if (direction(qd[at], rest) * direction(qd[next], rest) >= 0)
                    continue;
                const double rise = fmax(scratch[w], scratch[w + 1]);
                most = fmax(most, fmax(q[at], q[next]) + rise);
                least = fmin(least, fmin(q[at], q[next]) - rise);
            }
            beyond[(size_t)k * K + e] = most - high[e];
            beyond[((size_t)N + k) * K + e] = low[e] - least;
        }
}
