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
        for (int b = first; b <= a; ++b)
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

/* The shifts of a constraint: zero where none is shifted, which is not read then. */
static inline const double *shifts_at(const Problem *p, size_t at)
{
    static const double none[2] = {0.0};
    return p->shifted ? p->shift + at : none;
}

/* Slacks of a two-sided bound and their inverses; f: the barrier's first derivative by the value,
 * with shifts reduced along the step; weight: its primal-dual second derivative. */
static inline void barrier_derivatives(double lower, double upper, double value,
                                       const double *dual, const double *shift, double barrier,
                                       double *slack, double *inverse, double *f, double *weight)
{
    slack[0] = upper - value + shift[0], slack[1] = value - lower + shift[1];
    inverse[0] = 1.0 / slack[0], inverse[1] = 1.0 / slack[1];
    *f = (barrier + dual[0] * shift[0]) * inverse[0]
        - (barrier + dual[1] * shift[1]) * inverse[1];
    *weight = dual[0] * inverse[0] + dual[1] * inverse[1];
}

/* timing_linearise for the general constraints at points of segment k, the first of them number c
 * of its general ones; returns the number of that after the last. */
static int linearise_points(const Problem *p, int k, int first, int count, int c, double barrier)
{
    const int Z = 4 * p->J, P = 2 * p->n + 1, E = p->E, begin = c;
    const size_t point = (size_t)k * P + first;
    const size_t offset = 2 * (k * constraints_of(p) + p->bounds);
    const double *lower = p->general_lower + point * E, *upper = p->general_upper + point * E;
    const double *z = p->states + point * Z, *dual = p->dual + offset;
    double *x = p->values + point * E, *g = p->jacobian + point * E * Z;
    double *r = p->gradient + point * Z, *Q = p->hessian + point * Z * Z;
    double *exact = p->exact + point * Z * Z, weights[VECTOR * MOST_GENERAL] = {0.0};
    for (; c < p->general && p->general_at[c] < (first + count) * E; ++c)
        weights[p->general_at[c] - first * E] = dual[2 * c] - dual[2 * c + 1];
    if (p->arm)
        torque_derivatives_at(p->arm, count, z, weights, x, g, exact);
    for (int m = 0; m < count && !p->arm; ++m)
        path_at(p, k, first + m, z + m * Z, x + m * E, g + m * E * Z, weights + m * E,
                exact + m * Z * Z);
    for (int d = begin; d < c; ++d) {
        const int e = p->general_at[d] - first * E, m = e / E;
        const size_t at = offset + 2 * d;
        double f, weight;
        barrier_derivatives(lower[e], upper[e], x[e], p->dual + at, shifts_at(p, at), barrier,
                            p->slack + at, p->inverse + at, &f, &weight);
        add_general_constraint(p, e % E, g + e * Z, f, weight, r + m * Z, Q + m * Z * Z);
    }
    return c;
}

/* timing_linearise for the general constraints of a segment. */
static void linearise_general(const Problem *p, int k, double barrier)
{
    const int Z = 4 * p->J, P = 2 * p->n + 1;
    double *Q = p->hessian + (size_t)k * P * Z * Z, *exact = p->exact + (size_t)k * P * Z * Z;
    for (int i = 0, count, c = 0; i < P; i += count ? count : 1) {
        count = points_with_general(p, i, VECTOR);
        c = linearise_points(p, k, i, count, c, barrier);
    }
    for (int i = 0; i < P; ++i, Q += Z * Z, exact += Z * Z) {
        for (int a = 0; a < Z; ++a)
            for (int b = 0; b < a; ++b)
                Q[b * Z + a] = Q[a * Z + b];
        for (int q = 0; q < Z * Z; ++q)
            exact[q] += Q[q];
    }
}

void linearise_segment(const Problem *p, int k, double barrier)
{
    const double *dual = p->dual;
    const int Z = 4 * p->J, P = 2 * p->n + 1, whole = !bounds_alone(p);
    const size_t first = 2 * (size_t)k * constraints_of(p), part = (size_t)k * P * Z;
    double *z = p->states + part, *r = p->gradient + part, *Q = p->hessian + k * hessian_size(p);
    const double *lower = p->lower + part, *upper = p->upper + part;
    segment_states(p, variables_at(p, p->variables), k, z);
    memset(r, 0, (size_t)P * Z * sizeof(double));
    memset(Q, 0, hessian_size(p) * sizeof(double));
    if (whole)
        memset(p->exact + k * hessian_size(p), 0, hessian_size(p) * sizeof(double));
    for (int c = 0; c < p->bounds; ++c) {
        const int i = p->bound_at[c];
        const size_t at = first + 2 * c;
        double f, weight;
        barrier_derivatives(lower[i], upper[i], z[i], dual + at, shifts_at(p, at), barrier,
                            p->slack + at, p->inverse + at, &f, &weight);
        r[i] += f;
        Q[whole ? i * Z + i % Z : i] += weight;
    }
    const int size = p->jerk_weights ? (p->n + 1) * p->J : 0;
    for (int c = 0; c < size; ++c) {
        const int i = c / p->J * Z + 3 * p->J + c % p->J;
        const double weight = 2.0 * p->jerk_weights[(size_t)k * size + c];
        r[i] += weight * z[i];
        Q[whole ? i * Z + i % Z : i] += weight;
    }
    if (whole)
        linearise_general(p, k, barrier);
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
        linearise_segment(p, k, barrier);
        linearise_duration(p, k, barrier);
    }
}
