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

/* The log barrier of a chain of segments of three joints; see barrier.py. */
#ifndef RRR_TRAJ_PLANNER_BARRIER_H
#define RRR_TRAJ_PLANNER_BARRIER_H

#include <stdint.h>

enum { JOINTS = 3 };

typedef struct {
    int32_t n;                         /* segments */
    const double *displacements;       /* (n, 3) */
    const double *slope, *root;        /* (3), of the transitions' law */
    const double *max_velocity;        /* (3) */
    const double *lowest, *highest;    /* (n - 1, 3) */
    const double *floor;               /* (n), or NULL */
    const double *proportions;         /* (n), whose common stretch is sought, or NULL */
    double least_eigenvalue, tolerated;
} Chain;

/* First and second derivatives of the barrier's parts: of a segment's joint by v0, v1 and T, of a
 * via velocity's bounds, of a duration's floor. Arrays of something for each part have these in
 * order: (n, 3), (n - 1, 3), (n). */
typedef struct {
    double (*slope)[3];                /* (n, 3) */
    double (*block)[3][3];             /* (n, 3) */
    double (*bound)[2];                /* (n - 1, 3), then (n) */
} Derivatives;

int parts_of(const Chain *chain);
/* -sum log(slack) of each part; infinite where a constraint is not strictly kept. */
void barrier_values(const Chain *chain, const double *v, const double *T, double *values);
/* The curvature of each segment is made convex. */
void barrier_derivatives(const Chain *chain, const double *v, const double *T, Derivatives d);
/* Damp the parts that rise more along a step than their derivatives foretell; all, if none does. */
void misjudged(const Chain *chain, const double *dv, const double *dT, Derivatives d,
               const double *before, const double *after, double more_damping, double *damping);

#endif
