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

/* The least-time problem over segments between via points, with limits on a motion's states; Python
 * holds all arrays and decides on every step: solver/timing_problem.py, solver/interior_point.py.
 * Arrays are dense and row-major.
 *
 * At each of the P = 2 n + 1 points of a segment, first the n + 1 nodes, then the middles between
 * them, the state z has position, velocity, acceleration and jerk of all J coordinates: Z = 4 J
 * values, by kind, then by coordinate. Jerk counts in the middles only: at the nodes it is zero. */
#ifndef RRR_TRAJ_PLANNER_TIMING_PROBLEM_H
#define RRR_TRAJ_PLANNER_TIMING_PROBLEM_H

#include "export.h"
#include "ramps.h"

#include <stddef.h>
#include <stdint.h>

enum { MOST_JOINTS = 3, MOST_GENERAL = 12 };
enum { BOUNDS_ALONE, TORQUE, PATH };  /* what the general constraints are */

/* Constraints of a segment are bounds on states, then general ones, each two-sided: slacks of them,
 * and multipliers and so on, are (N, bounds + general, 2), above and below, then (N, 2) of floors. */
typedef struct {
    int32_t J, N, n;        /* coordinates, segments, ramps in a segment */
    int32_t kind, E;        /* of the general constraints, and how many there can be at a point */
    int32_t bounds, general;  /* constraints of a segment */
    int32_t intervals;      /* of a path's table, in a segment */
    Ramp ramp;
    const double *points;   /* (N + 1, J) */
    const double *restore;  /* (n - 1, 2) */
    const double *lower, *upper;                  /* (N, P, Z) */
    const double *general_lower, *general_upper;  /* (N, P, E) */
    const int32_t *bound_at, *general_at;  /* which there are: offsets into (P, Z) and (P, E) */
    const uint8_t *has_general;            /* (P) */
    const double *floor;    /* (N), least durations, or NULL */
    /* Durations: free; or multiples of a common unknown, or fixed (multiples of 0) */
    const uint8_t *free;    /* (N) */
    const double *tie;      /* (N) */
    const double *weights;  /* (N), of the durations in the objective */
    const uint8_t *still;   /* (N - 1, J), whose velocity at a via point stays as it is */
    const double *arm;      /* coefficients of the equations of motion, where kind is TORQUE */
    const double *table;    /* (N, 4, intervals, COLUMNS), cubic coefficients, where it is PATH */
    const double *overshoot;  /* (N, 2, 3), added to ddq and to c at the segments' ends */

    double *variables;      /* the iterate; see Variables */
    double *states;         /* (N, P, Z) */
    double *values;         /* (N, P, E), of the general constraints */
    double *jacobian;       /* (N, P, E, Z) */
    double *slack, *inverse, *dual;
    double *shift;          /* how far beyond each constraint a value may still be, in its slack */
    double *hessian, *exact;  /* (N, hessian_size): by states, without and with curvature */
    double *gradient;       /* (N, P, Z), by states */
    double *gradient_T, *hessian_T;    /* (N), by durations themselves */

    /* scratch */
    double *trial_variables, *trial_states, *trial_values, *trial_slack;
    double *trial_gradient, *trial_gradient_T, *step_states, *newton;
    int32_t shifted;        /* whether there are shifts */
} Problem;

/* A Newton step of all variables, and where a part of it leads. */
typedef struct {
    double *direction;
    double *correction;     /* by the step's size squared, or NULL */
    double *rate;           /* how slacks change with the step's size */
    double *variables, *slack;  /* where the last trial led */
    double gain;            /* that the whole step promises, to first order */
    double steepest;        /* the largest part of a slack by which it falls on the whole step */
    double cost, log;       /* where the last trial led: objective, sum of the slacks' logarithms */
    double shorter;         /* the size that the last trial suggests instead */
} Step;

static inline size_t points_of(const Problem *p) { return 2 * (size_t)p->n + 1; }

/* Of a segment's Hessian: (P, Z, Z), where there are bounds alone its diagonals (P, Z). */
static inline size_t hessian_size(const Problem *p)
{
    const size_t Z = 4 * p->J;
    return points_of(p) * Z * (p->kind == BOUNDS_ALONE ? 1 : Z);
}

static inline size_t constraints_of(const Problem *p)
{
    return (size_t)p->bounds + p->general;
}

static inline size_t slacks_size(const Problem *p)
{
    return 2 * (size_t)p->N * (constraints_of(p) + 1);
}

/* The unknowns of a motion, one behind the other. */
typedef struct {
    double *inner;          /* (N, n - 1, J), accelerations at a segment's inner nodes */
    double *v, *a;          /* (N - 1, J), velocities and accelerations at via points */
    double *T;              /* (N), durations */
} Variables;

static inline size_t variables_size(const Problem *p)
{
    return ((size_t)p->N * (p->n - 1) + 2 * (size_t)(p->N - 1)) * p->J + p->N;
}

static inline Variables variables_at(const Problem *p, double *memory)
{
    Variables m;
    m.inner = memory;
    m.v = m.inner + (size_t)p->N * (p->n - 1) * p->J;
    m.a = m.v + (size_t)(p->N - 1) * p->J;
    m.T = m.a + (size_t)(p->N - 1) * p->J;
    return m;
}

/* ramps.c: the states of a motion, and a step of its variables that keeps the via points; 0 where a
 * duration would not be positive. */
void motion_states(const Problem *p, Variables m, double *z);
int motion_stepped(const Problem *p, Variables m, Variables step, double size, Variables moved);

/* torque.c and path_table.c: the general constraints at a point. Values x (E), gradients by state
 * (E, Z), and the weighted sum's second derivatives (Z, Z), added to what is there; NULL: not
 * wanted. */
void torque_at(const double *arm, const double *z, double *x, double *gradient,
               const double *weights, double *second);
void path_at(const Problem *p, int segment, int point, const double *z, double *x,
             double *gradient, const double *weights, double *second);

/* constraints.c */
void slacks_at(const Problem *p, const double *T, const double *z, double part, double *x,
               double *slack);
void slack_rates(const Problem *p, const double *dT, const double *dz, double *rate);
void pulled(const Problem *p, const double *pull, double *gradient, double *gradient_T);
double timing_log(const Problem *p, const double *slack);

/* newton.c: solves for a step, and for how states change on it, (N, P, Z); the gain is minus the
 * gradient's product with it. Not 0 where the system is singular. */
int newton_solved(const Problem *p, const double *hessian, const double *gradient,
                  const double *gradient_T, double *direction, double *dz, double *gain);

#endif
