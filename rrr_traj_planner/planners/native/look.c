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
#include "chain.h"
#include "path.h"

#include <math.h>
#include <stdlib.h>

enum { LIMITED = 12, SPEED = LIMITED, LOOKED };
static const double ROUNDING = 1e-7;  /* as in ramp_look.py */

typedef struct {
    int32_t N, n, intervals, looks;  /* looks: between two points */
    double whole;           /* of a ramp, at its end: see RampShape */
    const double *ramp;     /* (2 looks, 4): way, speed, part and jerk of a ramp at each look */
    const double *ends;     /* (N + 1) */
    const double *table;    /* (N, 4, intervals, COLUMNS) */
    const double *bounds;   /* (LOOKED), infinite where there is none */
} Look;

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

/* Look at a segment that begins with speed v and has these accelerations at its n + 1 nodes;
 * magnitudes (LOOKED, 2 n looks + 1). */
static void looked(const Look *p, int k, double v, const double *nodes, double T,
                   double *magnitudes, Seen *seen)
{
    const int steps = 2 * p->looks, width = p->n * steps + 1;
    const double begin = p->ends[k], end = p->ends[k + 1], h = T / p->n;
    const double *rows = p->table + (size_t)k * 4 * p->intervals * COLUMNS;
    double s = begin;
    for (int w = 0; w < width; ++w) {
        const int i = w / steps < p->n ? w / steps : p->n - 1, step = w - i * steps;
        const double a = nodes[i], rise = nodes[i + 1] - a;
        double at[4] = {s, v, nodes[p->n], 0.0};
        if (step < steps) {
            const double *r = p->ramp + 4 * step, u = (double)step / steps;
            at[0] = s + h * (v * u + h * (0.5 * a * u * u + rise * r[0]));
            at[1] = v + h * (a * u + rise * r[1]);
            at[2] = a + rise * r[2];
            at[3] = rise * r[3] / h;
        }
        if (step == steps - 1) {
            s += h * (v + h * (0.5 * a + p->whole * rise));
            v += h * (a + 0.5 * rise);
        }
        const double place = fmin(fmax(at[0], begin), end);
        double d[KINDS][3], x[LOOKED], part;
        size_t apart;
        const double *c = path_interval(rows, p->intervals, (place - begin) / (end - begin),
                                        &apart, &part);
        path_columns(c, apart, part, &d[0][0]);
        path_limited((const double (*)[3])d, at[1], at[2], at[3], x);
        x[SPEED] = at[1];
        weighed(x, d[G], p->bounds, seen);
        for (int e = 0; e < LOOKED; ++e)
            magnitudes[(size_t)e * width + w] = fabs(x[e]);
    }
}

/* Of magnitudes x of one quantity, by how much they exceed a limit near each of 2 n + 1 points, a
 * step apart in near; see near_points. */
static void exceeded(const Look *p, const double *x, double limit, double *excess, double *near,
                     int apart)
{
    const int looks = p->looks, width = 2 * p->n * looks + 1;
    for (int w = 0; w < width; ++w) {
        double bend = 0.0;  /* what it rises by between two looks: an eighth */
        for (int m = w - 1; m <= w + 1; ++m) {
            const int i = m < 1 ? 1 : m < width - 1 ? m : width - 2;
            raised(&bend, fabs(x[i + 1] - 2.0 * x[i] + x[i - 1]) / 8.0);
        }
        const double peak = x[w] + bend;
        excess[w] = peak > limit ? peak - limit * (1.0 - ROUNDING) : 0.0;
    }
    for (int point = 0; point <= 2 * p->n; ++point) {
        double *to = near + (size_t)apart * (point % 2 ? p->n + 1 + point / 2 : point / 2);
        for (int w = (point - 1) * looks; w <= (point + 1) * looks; ++w)
            if (w >= 0 && w < width)
                raised(to, excess[w]);
    }
}

/* See path_look.py. A motion's unknowns are as motion_at has them; excess (N, 2 n + 1, apart) is
 * zero, and speeds and accelerations have none. Not 0 without memory. */
EXPORTED int path_looked(const Look *p, const double *inner, const double *v, const double *a,
                         const double *T, double *excess, int32_t apart, double *found)
{
    const int N = p->N, n = p->n, width = 2 * n * p->looks + 1;
    double *memory = malloc(((size_t)(LOOKED + 1) * width + n + 1) * sizeof(double));
    if (!memory)
        return 1;
    double *x = memory, *scratch = x + (size_t)LOOKED * width, *nodes = scratch + width;
    Seen seen = {0.0, 0.0, 0.0, INFINITY, 0.0};
    for (int k = 0; k < N; ++k) {
        nodes[0] = k ? a[k - 1] : 0.0, nodes[n] = k < N - 1 ? a[k] : 0.0;
        for (int i = 1; i < n; ++i)
            nodes[i] = inner[(size_t)k * (n - 1) + i - 1];
        looked(p, k, k ? v[k - 1] : 0.0, nodes, T[k], x, &seen);
        for (int e = 0; e < LOOKED; ++e)
            if (isfinite(p->bounds[e]))
                exceeded(p, x + (size_t)e * width, p->bounds[e], scratch,
                         excess + (size_t)k * (2 * n + 1) * apart + e, apart);
    }
    free(memory);
    found[0] = fmax(seen.rate, fmax(sqrt(seen.squared), cbrt(seen.cubed)));
    found[1] = seen.slowest, found[2] = seen.fastest;
    return 0;
}
