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

/* The family of motions: jerk that is linear in each interval and continuous everywhere, so that
 * position is a quartic spline. J coordinates pass N segments of n intervals each, from point to
 * point of (N + 1, J); parts (N, n) are the intervals' durations over their segment's. */
#ifndef RRR_TRAJ_PLANNER_SPLINE_H
#define RRR_TRAJ_PLANNER_SPLINE_H

#include <stddef.h>

/* The unknowns of a motion, contiguous in memory. */
typedef struct {
    double *inner;          /* (N, n - 1, J), jerks at a segment's inner nodes */
    double *v, *a, *j;      /* (N + 1, J), velocities, accelerations and jerks at via points */
    double *T;              /* (N), durations */
} Variables;

enum { ORDERS = 3 };        /* v, a and j */

static inline Variables variables_of(int J, int N, int n, double *memory)
{
    Variables m;
    m.inner = memory;
    m.v = m.inner + (size_t)N * (n - 1) * J;
    m.a = m.v + (size_t)(N + 1) * J;
    m.j = m.a + (size_t)(N + 1) * J;
    m.T = m.j + (size_t)(N + 1) * J;
    return m;
}

/* A state: position, velocity, acceleration and jerk. */
typedef struct { double q, v, a, j; } State;

/* The coefficients of a, j and u in the changes of q, v and a over the part x of an interval of
 * duration h in which jerk goes from j to u. */
typedef struct { double hv, qa, qj, qu, vj, vu, aj, au; } Advance;

static inline Advance advance_of(double h, double x)
{
    const double t = h * x, tt = t * t, ttt = tt * t;
    return (Advance){t, 0.5 * tt, ttt * (4.0 - x) * (1.0 / 24.0), ttt * x * (1.0 / 24.0),
                     tt * (3.0 - x) * (1.0 / 6.0), tt * x * (1.0 / 6.0), t * (2.0 - x) * 0.5,
                     t * x * 0.5};
}

/* The state q, v, a, j after the part x of the interval, as an initialiser: of numbers or vectors. */
#define ADVANCED(w, q, v, a, j, u, x) { \
    q + (w).hv * v + (w).qa * a + (w).qj * j + (w).qu * u, \
    v + (w).hv * a + (w).vj * j + (w).vu * u, a + (w).aj * j + (w).au * u, j + (x) * (u - j)}

static inline State advanced(State s, double u, const Advance *w, double x)
{
    return (State)ADVANCED(*w, s.q, s.v, s.a, s.j, u, x);
}

/* Samples of every interval: per_interval of them from its start on, and the segment's end. */
typedef struct {
    int per_interval;
    int nodes_first;        /* whether the nodes come before the samples between them */
} Samples;

/* The states z (N, n per_interval + 1, 4, J) of a motion at samples; each segment is integrated
 * from its own point. */
void motion_samples(int J, int N, int n, const double *parts, const double *points, Variables m,
                    Samples at, double *z);

/* Change inner jerks along the shapes (N, n - 1, 3), which in a segment of unit duration change
 * acceleration, velocity and position at its end by 1, so that the motion meets its points. */
void meet_points(int J, int N, int n, const double *parts, const double *points,
                 const double *shapes, Variables m);

#endif
