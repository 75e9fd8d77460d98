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

/* The least-time problem over segments between via points, with limits on a motion's states.
 * Python owns all arrays and controls the iteration: solver/timing_problem.py,
 * solver/interior_point.py. Arrays are dense and row-major.
 *
 * At each of the P = 2 n + 1 points of a segment, first the n + 1 nodes, then the middles between
 * them, the state z has position, velocity, acceleration and jerk of all J coordinates: Z = 4 J
 * values, by kind, then by coordinate. Jerk is limited at the nodes, where it peaks. */
#ifndef RRR_TRAJ_PLANNER_TIMING_PROBLEM_H
#define RRR_TRAJ_PLANNER_TIMING_PROBLEM_H

#include "arm.h"
#include "export.h"
#include "spline.h"

#include <stddef.h>
#include <stdint.h>

enum { MOST_JOINTS = 3, MOST_GENERAL = 12 };

/* Multiplicity of a least duration's logarithm: one for each joint. Only motions of three joints
 * have least durations (joint_timing/constraints.py); those along a path, of one coordinate, have
 * none. */
enum { DURATION_WEIGHT = 3 };

/* Bounds on values in a row: the offset of the first into (P, Z), how many there are, and the number
 * of the first among all bounds. */
typedef struct { int32_t at, length, number; } Run;

/* Constraints of a segment are bounds on states, then general ones, each two-sided: slacks,
 * multipliers and shifts are (N, bounds + general, 2), upper and lower, then (N, 2) for least
 * durations. */
typedef struct {
    int32_t J, N, n;        /* coordinates, segments, intervals in a segment */
    int32_t E;              /* greatest number of general constraints at a point */
    int32_t bounds, general;  /* numbers of constraints of a segment */
    int32_t runs;           /* of bounds, see below */
    int32_t bounded_alike;  /* whether the bounds of all segments are those of the first */
    int32_t intervals;      /* of a path's table, in a segment */
    const double *points;   /* (N + 1, J) */
    const double *parts;    /* (N, n), of the intervals in their segment's duration */
    const double *restore;  /* (N, n - 1, 3) */
    const double *lower, *upper;                  /* (N, P, Z), or (1, P, Z) if alike */
    const double *general_lower, *general_upper;  /* (N, P, E) */
    const Run *bound_runs;  /* (runs), of the limited ones */
    const int32_t *general_at;  /* the limited ones: offsets into (P, E) */
    const uint8_t *has_general;            /* (P) */
    const double *least_T;  /* (N), least durations, or NULL */
    double longest;         /* by how much durations may be above the least ones */
    /* A duration is free, or the multiple of a common factor, or fixed (proportion 0) */
    const uint8_t *free;    /* (N) */
    const double *proportions;      /* (N) */
    const double *weights;  /* (N), of the durations in the objective */
    const double *jerk_weights;  /* (N, n + 1, J), of squared jerks in the objective, or NULL */
    const uint8_t *fixed;   /* (N + 1, 3, J), which of v, a and j at via points do not change */
    /* General constraints are limits on torque, or on motion along a path; NULL where not so: */
    const Arm *arm;
    const double *table;    /* (N, 4, intervals, COLUMNS), cubic coefficients */
    const double *overshoot;  /* (N, 2, 3), added to ddq and to c near the segments' ends */
    const double *viscous;  /* (3), friction of the joints along a path [N m s/rad] */

    double *variables;      /* the iterate; see Variables */
    double *states;         /* (N, P, Z) */
    double *values;         /* (N, P, E), of the general constraints */
    double *jacobian;       /* (N, P, E, Z) */
    double *slack, *inverse, *dual;
    double *shift;          /* by which each constraint is relaxed; included in its slack */
    double *hessian, *exact;  /* (N, hessian_size): without and with second derivatives */
    double *gradient;       /* (N, P, Z), by states */
    double *gradient_T, *hessian_T;    /* (N), by durations themselves */

    /* scratch */
    double *trial_variables, *trial_slack, *trial_gradient, *trial_gradient_T;
    double *trial_states, *trial_values;  /* (P, Z) and (P, E), of a segment */
    double *step_states, *newton;
    int32_t shifted;        /* whether any constraint is relaxed */
} Problem;

/* A Newton step of all variables, and the result of the last trial along it. */
typedef struct {
    double *direction;
    double *correction;     /* second-order, times the size squared, or NULL */
    double *rate;           /* derivatives of the slacks by the step's size */
    double *variables, *slack;  /* after the last trial */
    double predicted_decrease;            /* of the merit on the whole step, to first order */
    double max_relative_slack_decrease;   /* over all slacks, on the whole step, to first order */
    double cost, log;       /* after the last trial: objective, sum of the slacks' logarithms */
    double suggested_size;  /* after a trial that violates a constraint, for the next one */
} Step;

/* A range of segments. */
typedef struct { int begin, end; } Range;

static inline size_t points_of(const Problem *p) { return 2 * (size_t)p->n + 1; }

static inline int bounds_alone(const Problem *p) { return !p->arm && !p->table; }

/* The size of a segment's Hessian: (P, Z, Z); with bounds alone it is diagonal, (P, Z). */
static inline size_t hessian_size(const Problem *p)
{
    const size_t Z = 4 * p->J;
    return points_of(p) * Z * (bounds_alone(p) ? 1 : Z);
}

static inline size_t constraints_of(const Problem *p)
{
    return (size_t)p->bounds + p->general;
}

static inline size_t slacks_size(const Problem *p)
{
    return 2 * (size_t)p->N * (constraints_of(p) + 1);
}

static inline size_t variables_size(const Problem *p)
{
    return ((size_t)p->N * (p->n - 1) + ORDERS * (size_t)(p->N + 1)) * p->J + p->N;
}

static inline Variables variables_at(const Problem *p, double *memory)
{
    return variables_of(p->J, p->N, p->n, memory);
}

/* The jerks at a node of a segment, (J). */
static inline const double *jerks_at(const Problem *p, Variables m, int k, int node)
{
    if (node == 0 || node == p->n)
        return m.j + (size_t)(k + (node > 0)) * p->J;
    return m.inner + ((size_t)k * (p->n - 1) + node - 1) * p->J;
}

/* spline.c: a step of a motion's variables after which it meets the via points. */
int step_motion(const Problem *p, Variables m, Variables step, double size, Variables moved);

/* path_table.c: the general constraints at a point of a path. Values x (E), gradients
 * by state (E, Z), and second derivatives (Z, Z) of the weighted sum, which are added; each may be
 * NULL. */
void path_at(const Problem *p, int segment, int point, const double *z, double *x,
             double *gradient, const double *weights, double *second);

/* The same of segment k alone: unknowns that begin with its own; its states; its step, after those
 * of the via points at its ends, of which one is taken by step_via_point. With damping (N), if not
 * NULL, time at a via point is scaled rather as in the segment that is damped more. */
static inline Variables segment_of(const Problem *p, Variables m, int k)
{
    const size_t via = (size_t)k * p->J;
    return (Variables){m.inner + via * (p->n - 1), m.v + via, m.a + via, m.j + via, m.T + k};
}

void segment_states(const Problem *p, Variables m, int k, double *z);
void step_segment(const Problem *p, Variables m, Variables step, double size, int k,
                  Variables moved);
void step_via_point(const Problem *p, Variables m, Variables step, double size,
                    const double *damping, int k, Variables moved);
void meet_segment(const Problem *p, Variables m, int k);

/* search.c: a segment's part of the objective. */
double segment_cost(const Problem *p, Variables m, int k);

/* Of a segment at the iterate: its states, its constraints, and the barrier's derivatives by the
 * states; see Problem. */
typedef struct {
    double *z;
    double *values, *jacobian;
    double *slack, *inverse;
    double *gradient, *hessian, *exact;
} Linearised;

/* The place of segment k in the problem's arrays. */
static inline Linearised linearised_of(const Problem *p, int k)
{
    const size_t first = 2 * k * constraints_of(p), point = k * points_of(p), Z = 4 * p->J;
    const size_t hessian = k * hessian_size(p);
    return (Linearised){
        p->states + point * Z, p->values + point * p->E, p->jacobian + point * p->E * Z,
        p->slack + first, p->inverse + first, p->gradient + point * Z, p->hessian + hessian,
        p->exact + hessian};
}

/* linearise.c: the bounds and general constraints of segment k linearised, with their multipliers
 * (bounds + general, 2). */
void linearise_segment(const Problem *p, int k, double barrier, const double *dual,
                       Linearised at);

/* constraints.c: the slacks of a motion, the given part of the shifts included; of a segment of it,
 * (bounds + general, 2), or from the segment's states z and values x of the general constraints. Rates
 * are directional derivatives along a step. */
void segment_slacks(const Problem *p, Variables m, int k, double part, double *slack);
void slacks_of_values(const Problem *p, int k, const double *z, const double *x, double part,
                      double *slack);
void segment_rates(const Problem *p, int k, const double *jacobian, const double *dz, double part,
                   double *rate);
int points_with_general(const Problem *p, int first, int most);  /* in a row */
void slacks_at(const Problem *p, Variables m, double part, double *slack);
void slack_rates(const Problem *p, const double *dT, const double *dz, double *rate);
void weighted_gradient(const Problem *p, const double *weights, double *gradient,
                       double *gradient_T);
double timing_log_sum(const Problem *p, const double *slack);

/* via_points.c: from the condensed segments S (N, 6 J + 1, 6 J + 1) and right-hand sides r, the
 * steps of velocities, accelerations and jerks at the via points, (N + 1, 3 J), of a range, and,
 * returned, that of the factor common to the durations of fixed proportions. Within the motion, the
 * steps at the range's ends are given. Each segment's S is multiplied by its damping (N), if not
 * NULL. */
double solve_via_points(const Problem *p, Range range, const double *S, const double *r,
                        const double *damping, double common_hessian, double common_gradient,
                        double *via_step, double *band);

/* newton.c: the Newton step and the changes of the states along it, (N, P, Z); the predicted
 * decrease is minus the product of gradient and step. Returns 1 where the system is singular, else
 * 0. */
int newton_step(const Problem *p, const double *hessian, const double *gradient,
                const double *gradient_T, double *direction, double *dz,
                double *predicted_decrease);

/* newton.c: Newton steps of a range of segments, for free durations: each segment condensed, which
 * returns 1 where that fails; the steps at the range's ends set to zero; the steps of its via points
 * and durations; and that of a segment between them, with the changes dz of its states (P, Z):
 * returned is the predicted decrease. The Hessian of each segment is multiplied by its damping (N),
 * at least 1. */
int condense_segment(const Problem *p, int k, Linearised at);
void rest_ends(const Problem *p, Range at);
void damped_via_step(const Problem *p, Range at, const double *damping, double *direction);
double damped_segment_step(const Problem *p, int k, double damping, Linearised at,
                           double *direction, double *dz);

#endif
