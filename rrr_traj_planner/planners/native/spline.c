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

/* Motions of piecewise linear jerk: their states, and steps after which they meet the via points
 * again. */
#include "timing_problem.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

/* The jerk at node i of segment k. */
static double node(int J, int n, Variables m, int k, int i, int j)
{
    return i == 0 ? m.j[k * J + j] : i == n ? m.j[(k + 1) * J + j]
        : m.inner[((size_t)k * (n - 1) + i - 1) * J + j];
}

static State via_state(int J, const double *points, Variables m, int k, int j)
{
    const int at = k * J + j;
    return (State){points[at], m.v[at], m.a[at], m.j[at]};
}

static void put(double *to, int J, State s)
{
    to[0] = s.q, to[J] = s.v, to[2 * J] = s.a, to[3 * J] = s.j;
}

void motion_samples(int J, int N, int n, const double *parts, const double *points, Variables m,
                    Samples at, double *z)
{
    const int per = at.per_interval, first = at.nodes_first;
    const size_t Z = 4 * (size_t)J, step = Z * (first ? 1 : per);  /* from node to node */
    for (int k = 0; k < N; ++k, parts += n, z += ((size_t)n * per + 1) * Z) {
        State s[MOST_JOINTS];
        for (int j = 0; j < J; ++j)
            put(z + j, J, s[j] = via_state(J, points, m, k, j));
        for (int i = 0; i < n; ++i) {
            const double h = parts[i] * m.T[k];
            double *to = z + (first ? n + 1 + (size_t)i * (per - 1) : (size_t)i * per + 1) * Z;
            for (int r = 1; r < per; ++r, to += Z) {
                const double x = (double)r / per;
                const Advance w = advance_of(h, x);
                for (int j = 0; j < J; ++j)
                    put(to + j, J, advanced(s[j], node(J, n, m, k, i + 1, j), &w, x));
            }
            const Advance whole = advance_of(h, 1.0);
            for (int j = 0; j < J; ++j) {
                s[j] = advanced(s[j], node(J, n, m, k, i + 1, j), &whole, 1.0);
                put(z + (i + 1) * step + j, J, s[j]);
            }
        }
    }
}

/* For solver/splines.py. */
EXPORTED void spline_sample(int32_t J, int32_t N, int32_t n, const double *parts,
                            const double *points, double *variables, int32_t per_interval,
                            int32_t nodes_first, double *z)
{
    motion_samples(J, N, n, parts, points, variables_of(J, N, n, variables),
                   (Samples){per_interval, nodes_first}, z);
}

void segment_states(const Problem *p, Variables m, int k, double *z)
{
    motion_samples(p->J, 1, p->n, p->parts + (size_t)k * p->n, p->points + (size_t)k * p->J,
                   segment_of(p, m, k), (Samples){2, 1}, z);
}

void meet_points(int J, int N, int n, const double *parts, const double *points,
                 const double *shapes, Variables m)
{
    for (int k = 0; k < N; ++k, parts += n, shapes += (size_t)(n - 1) * ORDERS) {
        const double T = m.T[k], to_v = T * T, to_q = to_v * T;
        double by[MOST_JOINTS][ORDERS], *inner = m.inner + (size_t)k * (n - 1) * J;
        State s[MOST_JOINTS];
        for (int j = 0; j < J; ++j)
            s[j] = via_state(J, points, m, k, j);
        for (int i = 0; i < n; ++i) {
            const Advance whole = advance_of(parts[i] * T, 1.0);
            for (int j = 0; j < J; ++j)
                s[j] = advanced(s[j], node(J, n, m, k, i + 1, j), &whole, 1.0);
        }
        for (int j = 0; j < J; ++j) {
            const State end = via_state(J, points, m, k + 1, j);
            by[j][0] = (end.a - s[j].a) / T, by[j][1] = (end.v - s[j].v) / to_v;
            by[j][2] = (end.q - s[j].q) / to_q;
        }
        for (int i = 0; i < n - 1; ++i)
            for (int j = 0; j < J; ++j)
                for (int o = 0; o < ORDERS; ++o)
                    inner[i * J + j] += shapes[ORDERS * i + o] * by[j][o];
    }
}

/* Three shapes of jerk at the inner nodes of a segment of unit duration, (n - 1, 3), and what each
 * changes of acceleration, velocity and position at its end (change, shape). */
static void sines(int n, const double *parts, double *shapes, double (*end)[ORDERS])
{
    State at[ORDERS];
    double s = 0.0;
    memset(at, 0, sizeof at);
    for (int i = 0; i < n; ++i) {
        const Advance whole = advance_of(parts[i], 1.0);
        s += parts[i];
        for (int o = 0; o < ORDERS; ++o) {
            const double jerk = i < n - 1 ? sin(PI * (o + 1) * s) : 0.0;
            if (i < n - 1)
                shapes[ORDERS * i + o] = jerk;
            at[o] = advanced(at[o], jerk, &whole, 1.0);
        }
    }
    for (int o = 0; o < ORDERS; ++o)
        end[0][o] = at[o].a, end[1][o] = at[o].v, end[2][o] = at[o].q;
}

/* The shapes (N, n - 1, 3) of meet_points, for solver/splines.py: sines, combined. */
EXPORTED void spline_restoring_shapes(int32_t N, int32_t n, const double *parts, double *shapes)
{
    for (int k = 0; k < N; ++k, parts += n, shapes += (size_t)(n - 1) * ORDERS) {
        double M[ORDERS][ORDERS], cofactor[ORDERS][ORDERS], determinant = 0.0;
        sines(n, parts, shapes, M);
        for (int r = 0; r < ORDERS; ++r)
            for (int c = 0; c < ORDERS; ++c) {
                const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
                cofactor[r][c] = M[r1][c1] * M[r2][c2] - M[r1][c2] * M[r2][c1];
            }
        for (int c = 0; c < ORDERS; ++c)
            determinant += M[0][c] * cofactor[0][c];
        for (int i = 0; i < n - 1; ++i) {
            double *own = shapes + ORDERS * i;
            const double from[ORDERS] = {own[0], own[1], own[2]};
            for (int r = 0; r < ORDERS; ++r)
                own[r] = (from[0] * cofactor[r][0] + from[1] * cofactor[r][1]
                          + from[2] * cofactor[r][2]) / determinant;
        }
    }
}

/* For solver/splines.py. */
EXPORTED void spline_meet_points(int32_t J, int32_t N, int32_t n, const double *parts,
                                 const double *points, const double *shapes, double *variables)
{
    meet_points(J, N, n, parts, points, shapes, variables_of(J, N, n, variables));
}

/* Take a step of the values of order o (1: velocities, ...) at a via point, where time is scaled
 * at a rate: fixed ones do not change. */
static void step_via(const Problem *p, int k, int o, const double *from, const double *step,
                     double size, double rate, double *to)
{
    const uint8_t *fixed = p->fixed + ((size_t)k * ORDERS + o - 1) * p->J;
    double slower = 1.0;
    for (int i = 0; i < o; ++i)
        slower *= 1.0 + size * rate;
    for (int j = 0; j < p->J; ++j) {
        const int i = k * p->J + j;
        to[i] = fixed[j] ? from[i] : (from[i] + size * (step[i] + o * rate * from[i])) / slower;
    }
}

void step_segment(const Problem *p, Variables m, Variables step, double size, int k,
                  Variables moved)
{
    const double rate = step.T[k] / m.T[k], slower = 1.0 + size * rate;
    const size_t inner = (size_t)(p->n - 1) * p->J;
    for (size_t i = k * inner; i < (k + 1) * inner; ++i)
        moved.inner[i] = (m.inner[i] + size * (step.inner[i] + 3.0 * rate * m.inner[i]))
            / (slower * slower * slower);
}

void step_via_point(const Problem *p, Variables m, Variables step, double size,
                    const double *damping, int k, Variables moved)
{
    /* time scale at a via point: mean of both segments', the shorter one's counting more */
    const int before = k > 0 ? k - 1 : 0, after = k < p->N ? k : p->N - 1;
    double one = m.T[before] * m.T[before] * m.T[before];
    double other = m.T[after] * m.T[after] * m.T[after];
    if (damping) {
        one *= damping[after];
        other *= damping[before];
    }
    const double rate = (step.T[before] / m.T[before] * other
                         + step.T[after] / m.T[after] * one) / (one + other);
    step_via(p, k, 1, m.v, step.v, size, rate, moved.v);
    step_via(p, k, 2, m.a, step.a, size, rate, moved.a);
    step_via(p, k, 3, m.j, step.j, size, rate, moved.j);
}

void meet_segment(const Problem *p, Variables m, int k)
{
    meet_points(p->J, 1, p->n, p->parts + (size_t)k * p->n, p->points + (size_t)k * p->J,
                p->restore + (size_t)k * (p->n - 1) * ORDERS, segment_of(p, m, k));
}

/* Take a step of the variables in normalised time: velocities times T, accelerations times T^2 and
 * jerks times T^3 change linearly with its size. Returns 0 where a duration would not be positive.
 */
int step_motion(const Problem *p, Variables m, Variables step, double size, Variables moved)
{
    const int N = p->N;
    for (int k = 0; k < N; ++k) {
        moved.T[k] = m.T[k] + size * step.T[k];
        if (!(moved.T[k] > 0.0))
            return 0;
    }
    for (int k = 0; k < N; ++k)
        step_segment(p, m, step, size, k, moved);
    for (int k = 0; k <= N; ++k)
        step_via_point(p, m, step, size, NULL, k, moved);
    meet_points(p->J, N, p->n, p->parts, p->points, p->restore, moved);
    return 1;
}
