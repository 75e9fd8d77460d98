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

/* The least time through via points by transitions and cruises, as a barrier problem. Python holds
 * all arrays and decides on every step: solver/via_barrier.py, solver/barrier_method.py. */
#ifndef RRR_TRAJ_PLANNER_VIA_PROBLEM_H
#define RRR_TRAJ_PLANNER_VIA_PROBLEM_H

#include "export.h"

#include <stdint.h>

enum { JOINTS = 3 };

/* A point is via velocities (n - 1, 3), then durations (n). The barrier is a sum of parts: of a
 * segment's joint (n, 3), of a via velocity's bounds (n - 1, 3), of a duration's least value (n);
 * arrays "of the parts" have these in order. */
typedef struct {
    int32_t n;                         /* segments */
    const double *displacements;       /* (n, 3) */
    const double *slope, *root;        /* (3), of the transitions' law */
    const double *max_velocity;        /* (3) */
    const double *lowest, *highest;    /* (n - 1, 3) */
    const double *floor;               /* (n), least durations, or NULL */
    const double *proportions;         /* (n), whose common factor is sought, or NULL */
    double *point, *step, *next;       /* points: the iterate, a step, and where it leads */
    double *before, *after, *damping;  /* of the parts: barrier at both, and damping */
    double (*gradient)[3];             /* (n, 3), of a segment's joint by v0, v1 and T */
    double (*hessian)[3][3];           /* (n, 3), made positive definite */
    double (*bound)[2];                /* first and second derivative of the other parts */
    double *band, *right, *pull, *border;  /* scratch of the Newton step: 5, 2, 1, 1 unknowns */
    double objective;                  /* at the iterate */
    double decrement;                  /* of the last step, squared */
} ViaProblem;

static inline int unknowns_of(const ViaProblem *p) { return 4 * p->n - 3; }
static inline int parts_of(const ViaProblem *p) { return 7 * p->n - 3; }

/* The damped Newton step of weight * objective + barrier at the iterate, and its decrement squared;
 * negative where rounding leaves no step. */
double via_newton(const ViaProblem *p, double weight);

#endif
