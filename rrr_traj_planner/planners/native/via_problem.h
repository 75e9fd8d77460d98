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

/* The least time through via points by transitions and cruises, as a barrier problem. Python owns
 * all arrays and controls the iteration: solver/via_barrier.py, solver/barrier_method.py. */
#ifndef RRR_TRAJ_PLANNER_VIA_PROBLEM_H
#define RRR_TRAJ_PLANNER_VIA_PROBLEM_H

#include "export.h"

#include <stdint.h>

enum { JOINTS = 3 };

/* A point is via velocities (n - 1, 3), then durations (n). The barrier is a sum of parts: for
 * each segment and joint (n, 3), for the bounds of each via velocity (n - 1, 3), and for each
 * duration's least value (n). Arrays over parts have this order. */
typedef struct {
    int32_t n;                         /* segments */
    const double *displacements;       /* (n, 3) */
    const double *slope, *root;        /* (3), of the transitions' law */
    const double *max_velocity;        /* (3) */
    const double *lowest, *highest;    /* (n - 1, 3) */
    const double *least_T;             /* (n), least durations, or NULL */
    const double *proportions;         /* (n), whose common factor is sought, or NULL */
    double *point, *step, *next;       /* the iterate, a step, and the point after it */
    double *before, *after, *damping;  /* over parts: barrier before and after the step, damping */
    double (*gradient)[3];             /* (n, 3), of a segment and joint by v0, v1 and T */
    double (*hessian)[3][3];           /* (n, 3), made positive definite */
    double (*bound)[2];                /* first and second derivatives of the other parts */
    double *band, *right;              /* scratch of the Newton step: (unknowns, 5) and (.., 2), */
    double *total_gradient, *border;   /* (unknowns) both */
    double objective;                  /* at the iterate */
    double decrement;                  /* the Newton decrement of the last step, squared */
} ViaProblem;

static inline int unknowns_of(const ViaProblem *p) { return 4 * p->n - 3; }
static inline int parts_of(const ViaProblem *p) { return 7 * p->n - 3; }

/* The damped Newton step of weight * objective + barrier at the iterate. Returns its Newton
 * decrement squared, negative where the matrix is not positive definite numerically. */
double via_newton(const ViaProblem *p, double weight);

/* Consecutive segments: their durations, and the velocities at the via points between them. */
typedef struct {
    int begin, end;
} Range;

/* The damped Newton step of a range with durations free, where the velocities at its ends have the
 * steps that they have already. Returns 1 where the matrix is not positive definite, else 0. */
int via_range_step(const ViaProblem *p, double weight, Range at);

/* What a segment, of a range that ends at a segment, adds to the decrement of the last step. */
double via_share(const ViaProblem *p, int k, int end);

/* The barrier's parts in a range at a point; its derivatives there, at the iterate. */
void via_part_values(const ViaProblem *p, const double *point, double *values, Range at);
void via_differentiate(const ViaProblem *p, Range at);

double via_objective(const ViaProblem *p, const double *point);

/* When a part counts as badly predicted by its derivatives, g and H damped, on a step s: where it
 * rises by more than g's + tolerated * s'Hs + slack; its damping is then raised. */
typedef struct {
    double tolerated, more_damping, slack;
} DampingRule;

/* Raise the damping of the badly predicted parts of a segment, and of the velocities at its end
 * unless its range ends there. Returns of how many. */
int via_damp_segment(const ViaProblem *p, DampingRule rule, int k, int end);

#endif
