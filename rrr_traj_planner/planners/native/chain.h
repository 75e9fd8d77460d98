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

/* The least-time problem of a chain of ramps, and what its parts offer each other.
 *
 * The method is that of interior_point.py, interior_step.py, ramp_newton.py and their kin, written
 * once more for speed; names and conventions are theirs. Arrays are dense and row-major.
 *
 * At each of the P = 2 n + 1 points of a segment, first the n + 1 nodes, then the middles between
 * them, the state z has position, velocity, acceleration and jerk of all J coordinates: 4 J values,
 * by kind, then by coordinate. Jerk counts in the middles only: at the nodes it is zero.
 */
#ifndef RRR_TRAJ_PLANNER_CHAIN_H
#define RRR_TRAJ_PLANNER_CHAIN_H

#include <stddef.h>
#include <stdint.h>

#define EXPORTED __attribute__((visibility("default")))

enum { MOST_JOINTS = 3, MOST_STATES = 12, MOST_GENERAL = 12, CENTRES = 40 };
enum { BOXES_ALONE, TORQUE, PATH };

typedef struct {            /* of interior_point.py and interior_step.py */
    double relative_gap, barrier_reduction, centred, stall, start, far_from_centre, dual_corridor,
        sufficient_gain, narrow, least_bend, to_boundary, least_room_kept,
        room_aimed_at, longest_retry, small_relief;
    int32_t patience, raises, iterations, backtracks;
} Settings;

typedef struct {
    int32_t J, N, n;        /* coordinates, segments, ramps in a segment */
    int32_t kind;           /* what the general limits are: BOXES_ALONE, TORQUE or PATH */
    int32_t E;              /* general limits at a point */
    int32_t intervals;      /* of a path's table, in a segment */
    double whole, way, speed, peak;  /* of a ramp: at its end, and half-way; see RampShape */
    const double *points;   /* (N + 1, J) */
    const double *restore;  /* (n - 1, 2) */
    const double *lower, *upper;      /* (N, P, 4 J) */
    const uint8_t *boxed;             /* (P, 4 J), which of these count */
    const double *general_lower, *general_upper;  /* (N, P, E) */
    const uint8_t *kept;              /* (P, E) */
    const double *floor;    /* (N), or NULL */
    const uint8_t *free;    /* (N), and so on: see Freedom */
    const double *tie, *weights;
    const uint8_t *still;   /* (N - 1, J) */
    const double *arm;      /* 11 constants of equations.py, where kind is TORQUE */
    const double *table;    /* (N, 4, intervals, 18), cubic coefficients, where it is PATH */
    const double *overshoot;  /* (N, 2, 3), of ddq and of c at the segments' ends */
    double difference;
} Problem;

/* Size of a segment's Hessian by its states: (P, 4 J, 4 J), of boxes alone the diagonals (P, 4 J). */
static inline size_t hessian_size(const Problem *p)
{
    const size_t Z = 4 * p->J;
    return (2 * (size_t)p->n + 1) * Z * (p->kind == BOXES_ALONE ? 1 : Z);
}

typedef struct {
    double *inner;          /* (N, n - 1, J) */
    double *v, *a;          /* (N - 1, J) */
    double *T;              /* (N) */
} Motion;

/* motion.c: motions as wholes. */
size_t motion_size(const Problem *p);
Motion motion_at(const Problem *p, double *memory);
void motion_copy(const Problem *p, Motion to, Motion from);
double motion_cost(const Problem *p, Motion m);
void motion_states(const Problem *p, Motion m, double *z);
int motion_stepped(const Problem *p, Motion m, Motion step, double size, Motion moved);

/* torque.c and path.c: the general limits. Values x (E), gradients by state (E, 4 J), and the
 * weighted sum's second derivatives (4 J, 4 J), added to what is there; NULL: not wanted. */
void torque_at(const Problem *p, const double *z, double *x, double *gradient,
               const double *weights, double *second);
void path_at(const Problem *p, int segment, int point, const double *z, double *x,
             double *gradient, const double *weights, double *second);

/* newton.c: one Newton step. Q (N, hessian_size) and r (N, P, 4 J) are second and first derivatives
 * by the states; r_T, Q_T (N) by the durations themselves. Gives the step, how the states change
 * along it (N, P, 4 J), and what it promises to gain; not 0 where the system is singular. */
size_t newton_size(const Problem *p);
int newton_step(const Problem *p, Motion m, const double *z, const double *Q, const double *r,
                const double *Q_T, const double *r_T, Motion step, double *dz, double *gain,
                double *memory);

#endif
