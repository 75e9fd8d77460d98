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

/* A motion along a path at many times between its points: what it exceeds there (path_look.py). */
#include "timing_problem.h"
#include "path_table.h"

#include <math.h>

enum { LIMITED = 12, SPEED = LIMITED, CHECKED };

typedef struct {
    int32_t checks;         /* between two points of a segment */
    int32_t apart;          /* from point to point in excess */
    double rounding;        /* part of a limit by which it is kept a little more */
    const double *ramp;     /* (2 checks, 4): way, speed, part and jerk of a unit ramp at each */
    const double *bounds;   /* (CHECKED), infinite where there is none */
    double *excess;         /* (N, P, apart), zero at first */
    double *scratch;        /* (CHECKED + 1, 2 n checks + 1) and n + 1 */
    double stretch, slowest, fastest;  /* found: see path_timing's dense check */
} PathCheck;

typedef struct {            /* over the motion */
    double rate, squared, cubed;  /* by how much it must be slowed, to these powers */
    double slowest, fastest;      /* the tip [m/s] */
} Seen;

static void raised(double *most, double value)
{
    if (value > *most)
        *most = value;
}

/* Enter the limited quantities x at one time. */
static void weighed(const double *x, const double *gravity, const double *bounds, Seen *seen)
{
    raised(&seen->rate, fabs(x[SPEED]) / bounds[SPEED]);
    raised(&seen->fastest, x[SPEED]);
    seen->slowest = fmin(seen->slowest, x[SPEED]);
    for (int j = 0; j < 3; ++j) {
        raised(&seen->rate, fabs(x[j]) / bounds[j]);
        raised(&seen->squared, fabs(x[3 + j]) / bounds[3 + j]);
        raised(&seen->cubed, fabs(x[6 + j]) / bounds[6 + j]);
        const double moving = x[9 + j] - gravity[j];
        const double spare = bounds[9 + j] - (moving > 0.0 ? gravity[j] : -gravity[j]);
        if (moving != 0.0)
            raised(&seen->squared, spare > 0.0 ? fabs(moving) / spare : INFINITY);
    }
}

/* Check a segment that begins with speed v and has these accelerations at its n + 1 nodes;
 * magnitudes (CHECKED, 2 n checks + 1). */
static void segment_checked(const Problem *p, const PathCheck *check, int k, double v,
                            const double *nodes, double T, double *magnitudes, Seen *seen)
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
            s += h * (v + h * (0.5 * a + p->ramp.whole * rise));
            v += h * (a + 0.5 * rise);
        }
        const double place = fmin(fmax(at[0], begin), end);
        double d[KINDS][3], x[CHECKED], part;
        size_t apart;
        const double *c = path_interval(rows, p->intervals, (place - begin) / (end - begin),
                                        &apart, &part);
        path_columns(c, apart, part, &d[0][0]);
        path_limited((const double (*)[3])d, at[1], at[2], at[3], x);
        x[SPEED] = at[1];
        weighed(x, d[G], check->bounds, seen);
        for (int e = 0; e < CHECKED; ++e)
            magnitudes[(size_t)e * width + w] = fabs(x[e]);
    }
}

/* Of magnitudes x of one quantity at the checks of a segment, by how much they exceed a limit near each
 * of its points, which are apart in near. */
static void exceeded(int n, int checks, const double *x, double limit, double rounding,
                     double *excess, double *near, int apart)
{
    const int width = 2 * n * checks + 1;
    for (int w = 0; w < width; ++w) {
        double bend = 0.0;  /* what it rises by between two checks: an eighth */
        for (int m = w - 1; m <= w + 1; ++m) {
            const int i = m < 1 ? 1 : m < width - 1 ? m : width - 2;
            raised(&bend, fabs(x[i + 1] - 2.0 * x[i] + x[i - 1]) / 8.0);
        }
        const double peak = x[w] + bend;
        excess[w] = peak > limit ? peak - limit * (1.0 - rounding) : 0.0;
    }
    for (int point = 0; point <= 2 * n; ++point) {
        double *to = near + (size_t)apart * (point % 2 ? n + 1 + point / 2 : point / 2);
        for (int w = (point - 1) * checks; w <= (point + 1) * checks; ++w)
            if (w >= 0 && w < width)
                raised(to, excess[w]);
    }
}

/* Check a motion along a path at many times between its points: by how much each quantity exceeds its
 * bound near each point, how much slower all would be kept, and the speeds of the tip. */
EXPORTED void path_checked(const Problem *p, PathCheck *check, double *variables)
{
    const int n = p->n, width = 2 * n * check->checks + 1;
    const Variables m = variables_at(p, variables);
    double *x = check->scratch, *own = x + (size_t)CHECKED * width, *nodes = own + width;
    Seen seen = {0.0, 0.0, 0.0, INFINITY, 0.0};
    for (int k = 0; k < p->N; ++k) {
        nodes[0] = k ? m.a[k - 1] : 0.0, nodes[n] = k < p->N - 1 ? m.a[k] : 0.0;
        for (int i = 1; i < n; ++i)
            nodes[i] = m.inner[(size_t)k * (n - 1) + i - 1];
        segment_checked(p, check, k, k ? m.v[k - 1] : 0.0, nodes, m.T[k], x, &seen);
        for (int e = 0; e < CHECKED; ++e)
            if (isfinite(check->bounds[e]))
                exceeded(n, check->checks, x + (size_t)e * width, check->bounds[e],
                         check->rounding, own,
                         check->excess + (size_t)k * points_of(p) * check->apart + e,
                         check->apart);
    }
    check->stretch = fmax(seen.rate, fmax(sqrt(seen.squared), cbrt(seen.cubed)));
    check->slowest = seen.slowest, check->fastest = seen.fastest;
}
