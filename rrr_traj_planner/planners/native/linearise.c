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

/* The barrier problem linearised at an iterate. */
#include "processor.h"
#include "slacks.h"
#include "timing_problem.h"

#include <string.h>

/* Add the barrier terms of a constraint with gradient g, zero outside columns first to end - 1:
 * r += f g, and to the lower triangle Q += weight g g'. */
static inline void add_constraint(const double *g, int first, int end, int Z, double f,
                                  double weight, double *r, double *Q)
{
    for (int a = first; a < end; ++a) {
        const double scaled = weight * g[a];
        r[a] += f * g[a];
        for (int b = first; b <= a && Q; ++b)
            Q[a * Z + b] += scaled * g[b];
    }
}

/* The same for general constraint e. */
static inline void add_general_constraint(const Problem *p, int e, const double *g, double f,
                                          double weight, double *r, double *Q)
{
    if (p->arm)
        add_constraint(g, 0, 9, 12, f, weight, r, Q);  /* by position, velocity, acceleration */
    else if (e < 3)
        add_constraint(g, 0, 2, 4, f, weight, r, Q);
    else if (e < 6 || e >= 9)
        add_constraint(g, 0, 3, 4, f, weight, r, Q);
    else
        add_constraint(g, 0, 4, 4, f, weight, r, Q);
}

/* The values of the general constraints of segment k, their gradients, and their second derivatives
 * weighted by the multipliers. */
static void linearise_general(const Problem *p, int k, const double *dual, Linearised at)
{
    const int Z = 4 * p->J, P = 2 * p->n + 1, E = p->E;
    const double *own = dual + 2 * p->bounds;
    if (at.exact)
        memset(at.exact, 0, hessian_size(p) * sizeof(double));
    for (int i = 0, count, c = 0; i < P; i += count ? count : 1) {
        double weights[VECTOR * MOST_GENERAL] = {0.0};
        double *z = at.z + i * Z, *x = at.values + i * E, *g = at.jacobian + i * E * Z;
        double *exact = at.exact ? at.exact + i * Z * Z : NULL;
        count = points_with_general(p, i, VECTOR);
        for (; c < p->general && p->general_at[c] < (i + count) * E; ++c)
            weights[p->general_at[c] - i * E] = own[2 * c] - own[2 * c + 1];
        if (p->arm)
            torque_derivatives_at(p->arm, count, z, weights, x, g, exact);
        for (int m = 0; m < count && !p->arm; ++m)
            path_at(p, k, i + m, z + m * Z, x + m * E, g + m * E * Z, weights + m * E,
                    exact ? exact + m * Z * Z : NULL);
    }
}

enum { BLOCK = 64 };  /* constraints at once, at most */

/* The barrier's derivatives by a few constraints' values, from number c of segment k. */
static void derivatives(const Problem *p, int k, int c, int count, double barrier,
                        const double *dual, Linearised at, double *f, double *weight)
{
    const double *shift = p->shifted ? p->shift + 2 * (k * constraints_of(p) + c) : NULL;
    barrier_derivatives(dual + 2 * c, shift, at.inverse + 2 * c, count, barrier, f,
                        at.hessian ? weight : NULL);
}

/* Add the barrier terms of a segment's bounds to gradient and Hessian. */
static void add_bounds(const Problem *p, int k, double barrier, const double *dual, Linearised at)
{
    const int Z = 4 * p->J, whole = !bounds_alone(p);
    double f[BLOCK], weight[BLOCK];
    for (const Run *run = p->bound_runs; run < p->bound_runs + p->runs; ++run)
        for (int done = 0; done < run->length; done += BLOCK) {
            const int first = run->at + done;
            const int count = run->length - done < BLOCK ? run->length - done : BLOCK;
            derivatives(p, k, run->number + done, count, barrier, dual, at, f, weight);
            for (int i = 0; i < count; ++i)
                at.gradient[first + i] += f[i];
            for (int i = 0; i < count && at.hessian && !whole; ++i)
                at.hessian[first + i] += weight[i];
            for (int i = first; i < first + count && at.hessian && whole; ++i)
                at.hessian[i * Z + i % Z] += weight[i - first];
        }
}

/* The same of its general constraints. */
static void add_general(const Problem *p, int k, double barrier, const double *dual, Linearised at)
{
    const int Z = 4 * p->J, E = p->E;
    double f[BLOCK], weight[BLOCK];
    for (int done = 0; done < p->general; done += BLOCK) {
        const int count = p->general - done < BLOCK ? p->general - done : BLOCK;
        derivatives(p, k, p->bounds + done, count, barrier, dual, at, f, weight);
        for (int c = 0; c < count; ++c) {
            const int e = p->general_at[done + c], i = e / E;
            double *Q = at.hessian ? at.hessian + i * Z * Z : NULL;
            add_general_constraint(p, e % E, at.jacobian + e * Z, f[c], weight[c],
                                   at.gradient + i * Z, Q);
        }
    }
}

void linearise_segment(const Problem *p, int k, double barrier, const double *dual,
                       Linearised at)
{
    const int Z = 4 * p->J, P = 2 * p->n + 1;
    double *r = at.gradient, *Q = at.hessian, *exact = at.exact;
    segment_states(p, variables_at(p, p->variables), k, at.z);
    memset(r, 0, (size_t)P * Z * sizeof(double));
    if (Q)
        memset(Q, 0, hessian_size(p) * sizeof(double));
    if (!bounds_alone(p))
        linearise_general(p, k, dual, at);
    slacks_of_values(p, k, at.z, at.values, 1.0, at.slack);
    invert(at.slack, 2 * constraints_of(p), at.inverse);
    add_bounds(p, k, barrier, dual, at);
    const int size = p->jerk_weights ? (p->n + 1) * p->J : 0;
    for (int c = 0; c < size; ++c) {
        const int i = c / p->J * Z + 3 * p->J + c % p->J;
        const double weight = 2.0 * p->jerk_weights[(size_t)k * size + c];
        r[i] += weight * at.z[i];
        if (Q)
            Q[bounds_alone(p) ? i : i * Z + i % Z] += weight;
    }
    add_general(p, k, barrier, dual, at);
    for (int i = 0; i < P && !bounds_alone(p) && Q; ++i, Q += Z * Z, exact += Z * Z) {
        for (int a = 0; a < Z; ++a)
            for (int b = 0; b < a; ++b)
                Q[b * Z + a] = Q[a * Z + b];
        for (int q = 0; q < Z * Z; ++q)
            exact[q] += Q[q];
    }
    p->gradient_T[k] = p->hessian_T[k] = 0.0;
}

/* The same for a segment's least duration. */
static void linearise_duration(const Problem *p, int k, double barrier)
{
    const size_t at = 2 * ((size_t)p->N * constraints_of(p) + k);
    const double T = variables_at(p, p->variables).T[k];
    double *slack = p->slack + at, *inverse = p->inverse + at;
    slack[1] = p->least_T ? T - p->least_T[k] : 1.0;
    slack[0] = p->least_T ? p->longest - slack[1] : 1.0;
    inverse[0] = 1.0 / slack[0], inverse[1] = 1.0 / slack[1];
    if (p->least_T) {
        p->gradient_T[k] = DURATION_WEIGHT * barrier * (inverse[0] - inverse[1]);
        p->hessian_T[k] = DURATION_WEIGHT
            * (p->dual[at] * inverse[0] + p->dual[at + 1] * inverse[1]);
    }
}

/* Linearise the problem at the iterate: slacks, the Jacobian of the general constraints, and
 * gradient and primal-dual Hessian of the barrier by states (Nocedal & Wright, Numerical
 * Optimization, 19.3). The Hessian is computed twice: without the constraints' second derivatives,
 * and with them, weighted by the multipliers. */
EXPORTED void timing_linearise(const Problem *p, double barrier)
{
    for (int k = 0; k < p->N; ++k) {
        linearise_segment(p, k, barrier, p->dual + 2 * k * constraints_of(p),
                          linearised_of(p, k));
        linearise_duration(p, k, barrier);
    }
}
