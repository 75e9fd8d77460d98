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

/* The family of motions: accelerations that change from node to node in ramps of one shape. J
 * coordinates pass N segments of n ramps each, from point to point of (N + 1, J). */
#ifndef RRR_TRAJ_PLANNER_RAMPS_H
#define RRR_TRAJ_PLANNER_RAMPS_H

#include <stddef.h>

/* A ramp of unit duration and unit rise of acceleration (core/motion_laws/ramps.py): the
 * displacement at its end and half-way, the velocity half-way, and the peak of jerk, half-way. */
typedef struct {
    double end_q, mid_q, mid_qd, peak_jerk;
} Ramp;

/* Position and velocity at the part u of a ramp of duration h that begins at q, v and a; unit_q
 * and unit_qd are those of the unit ramp there. */
static inline double ramp_q(double h, double u, double q, double v, double a, double rise,
                            double unit_q)
{
    return q + h * (u * v + h * (0.5 * u * u * a + unit_q * rise));
}

static inline double ramp_qd(double h, double u, double v, double a, double rise, double unit_qd)
{
    return v + h * (u * a + unit_qd * rise);
}

/* The unknowns of a motion, contiguous in memory. */
typedef struct {
    double *inner;          /* (N, n - 1, J), accelerations at a segment's inner nodes */
    double *v, *a;          /* (N - 1, J), velocities and accelerations at via points */
    double *T;              /* (N), durations */
} Variables;

static inline Variables variables_of(int J, int N, int n, double *memory)
{
    Variables m;
    m.inner = memory;
    m.v = m.inner + (size_t)N * (n - 1) * J;
    m.a = m.v + (size_t)(N - 1) * J;
    m.T = m.a + (size_t)(N - 1) * J;
    return m;
}

/* Samples of every ramp: per_ramp of them from its start on, and the segment's end. */
typedef struct {
    int per_ramp;
    int nodes_first;        /* whether the nodes come before the samples between them */
    const double (*unit)[4];  /* (per_ramp): the unit ramp's q, qd, qdd and jerk at each */
} Samples;

/* The states z (N, n per_ramp + 1, 4, J) of a motion at samples; each segment is integrated from
 * its own point. */
void motion_samples(int J, int N, int n, double end_q, const double *points, Variables m,
                    const Samples *at, double *z);

/* Change inner accelerations along the shapes (n - 1, 2), which change velocity by h and
 * displacement by h^2, so that the motion meets its points. */
void meet_points(int J, int N, int n, double end_q, const double *points, const double *shapes,
                 Variables m);

#endif
