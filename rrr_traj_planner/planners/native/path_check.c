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

/* Dense check of a motion along a path: by how much it exceeds its limits between the points of
 * the problem (path_timing/dense_check.py). */
#include "timing_problem.h"
#include "path_table.h"

#include <math.h>

enum { LIMITED = 12, SPEED = LIMITED, CHECKED };

typedef struct {
    int32_t checks;         /* samples between two points of a segment */
    int32_t stride;         /* from point to point in excess */
    double rounding;        /* part of a limit that is added to what exceeds it */
    const double *ramp;     /* (2 checks, 4): q, qd, qdd and jerk of a unit ramp at each sample */
    const double *bounds;   /* (CHECKED), infinite where there is none */
    double *excess;         /* (N, P, stride), zero at first */
    double *scratch;        /* (CHECKED + 1, 2 n checks + 1) and n + 1 */
    double time_scale, slowest, fastest;  /* found: see path_timing's dense check */
} PathCheck;

/* For solver/library.py, which compares it. */
EXPORTED const int64_t size_of_path_check = sizeof(PathCheck);

typedef struct {            /* over the motion */
    double rate, squared, cubed;  /* time scaling that limits require, to the power 1, 2, 3 */
    double slowest, fastest;      /* of the tip [m/s] */
} Peaks;

static void raise_to(double *most, double value)
{
    if (value > *most)
        *most = value;
}

/* Update the peaks with the limited quantities x at one time. Scaling time by z divides velocities
 * by z, accelerations and the torque beside gravity's by z^2, jerk by z^3. */
static void update_peaks(const double *x, const double *gravity, const double *bounds,
                         Peaks *peaks)
{
    raise_to(&peaks->rate, fabs(x[SPEED]) / bounds[SPEED]);
    raise_to(&peaks->fastest, x[SPEED]);
    peaks->slowest = fmin(peaks->slowest, x[SPEED]);
    for (int j = 0; j < 3; ++j) {
        raise_to(&peaks->rate, fabs(x[j]) / bounds[j]);
        raise_to(&peaks->squared, fabs(x[3 + j]) / bounds[3 + j]);
        raise_to(&peaks->cubed, fabs(x[6 + j]) / bounds[6 + j]);
        const double motion = x[9 + j] - gravity[j];
        const double margin = bounds[9 + j] - (motion > 0.0 ? gravity[j] : -gravity[j]);
        if (motion != 0.0)
            raise_to(&peaks->squared, margin > 0.0 ? fabs(motion) / margin : INFINITY);
    }
}

/* Sample a segment that begins with speed v, with accelerations at its n + 1 nodes; receives the
 * magnitudes (CHECKED, 2 n checks + 1). */
static void check_segment(const Problem *p, const PathCheck *check, int k, double v,
                            const double *nodes, double T, double *magnitudes, Peaks *peaks)
{
    const int steps = 2 * check->checks, width = p->n * steps + 1;
    const double begin = p->points[k], end = p->points[k + 1], h = T / p->n;
    const double *rows = p->table + (size_t)k * 4 * p->intervals * COLUMNS;
    double s = begin;
    for (int w = 0; w < width; ++w) {
        const int i = w / steps < p->n ? w / steps : p->n - 1, step = w - i * steps;
        const double a = nodes[i], rise = nodes[i + 1] - a;
        double at[4] = {s, v, nodes[p->n], 0.0};
        if (step < steps) {
            const double *r = check->ramp + 4 * step, u = (double)step / steps;
            at[0] = s + h * (v * u + h * (0.5 * a * u * u + rise * r[0]));
            at[1] = v + h * (a * u + rise * r[1]);
            at[2] = a + rise * r[2];
            at[3] = rise * r[3] / h;
        }
        if (step == steps - 1) {
            s += h * (v + h * (0.5 * a + p->ramp.end_q * rise));
            v += h * (a + 0.5 * rise);
        }
        const double place = fmin(fmax(at[0], begin), end);
        double d[KINDS][3], x[CHECKED], part;
        size_t stride;
        const double *c = path_interval(rows, p->intervals, (place - begin) / (end - begin),
                                        &stride, &part);
        path_columns(c, stride, part, &d[0][0]);
        limited_quantities((const double (*)[3])d, at[1], at[2], at[3], x);
        x[SPEED] = at[1];
        update_peaks(x, d[G], check->bounds, peaks);
        for (int e = 0; e < CHECKED; ++e)
            magnitudes[(size_t)e * width + w] = fabs(x[e]);
    }
}

/* By how much the sampled magnitudes x of one quantity exceed a limit near each point of a
 * segment. */
static void excess_near_points(int n, int checks, const double *x, double limit, double rounding,
                     double *excess, double *excess_at, int stride)
{
    const int width = 2 * n * checks + 1;
    for (int w = 0; w < width; ++w) {
        double curvature = 0.0;  /* an eighth of the second difference: the rise between samples */
        for (int m = w - 1; m <= w + 1; ++m) {
            const int i = m < 1 ? 1 : m < width - 1 ? m : width - 2;
            raise_to(&curvature, fabs(x[i + 1] - 2.0 * x[i] + x[i - 1]) / 8.0);
        }
        const double peak = x[w] + curvature;
        excess[w] = peak > limit ? peak - limit * (1.0 - rounding) : 0.0;
    }
    for (int point = 0; point <= 2 * n; ++point) {
        double *to = excess_at + (size_t)stride * (point % 2 ? n + 1 + point / 2 : point / 2);
        for (int w = (point - 1) * checks; w <= (point + 1) * checks; ++w)
            if (w >= 0 && w < width)
                raise_to(to, excess[w]);
    }
}

/* Check a motion along a path at many times: by how much each quantity exceeds its bound near each
 * point, the time scaling with which all bounds hold, and the tip's least and largest speed. */
EXPORTED void check_path(const Problem *p, PathCheck *check, double *variables)
{
    const int n = p->n, width = 2 * n * check->checks + 1;
    const Variables m = variables_at(p, variables);
    double *x = check->scratch, *own = x + (size_t)CHECKED * width, *nodes = own + width;
    Peaks peaks = {0.0, 0.0, 0.0, INFINITY, 0.0};
    for (int k = 0; k < p->N; ++k) {
        nodes[0] = k ? m.a[k - 1] : 0.0, nodes[n] = k < p->N - 1 ? m.a[k] : 0.0;
        for (int i = 1; i < n; ++i)
            nodes[i] = m.inner[(size_t)k * (n - 1) + i - 1];
        check_segment(p, check, k, k ? m.v[k - 1] : 0.0, nodes, m.T[k], x, &peaks);
        for (int e = 0; e < CHECKED; ++e)
            if (isfinite(check->bounds[e]))
                excess_near_points(n, check->checks, x + (size_t)e * width, check->bounds[e],
                         check->rounding, own,
                         check->excess + (size_t)k * points_of(p) * check->stride + e,
                         check->stride);
    }
    check->time_scale = fmax(peaks.rate, fmax(sqrt(peaks.squared), cbrt(peaks.cubed)));
    check->slowest = peaks.slowest, check->fastest = peaks.fastest;
}
