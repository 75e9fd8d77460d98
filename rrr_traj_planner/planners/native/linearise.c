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

/* timing_linearise for the general constraints of a segment, whose slacks begin at an offset. */
static void linearise_general(const Problem *p, int k, size_t offset, double barrier)
{
    const double *dual = p->dual;
    const int Z = 4 * p->J, P = 2 * p->n + 1, E = p->E;
    const double *lower = p->general_lower + (size_t)k * P * E,
        *upper = p->general_upper + (size_t)k * P * E;
    const int32_t *at = p->general_at, *end = at + p->general;
    size_t c = offset;
    for (int i = 0; i < P; ++i) {
        const size_t point = (size_t)k * P + i, block = point * Z * Z;
        double *x = p->values + point * E, *g = p->jacobian + point * E * Z,
            *r = p->gradient + point * Z, *Q = p->hessian + block, *full = p->exact + block;
        if (p->has_general[i]) {
            double weights[MOST_GENERAL] = {0.0};
            const int32_t *first = at;
            for (size_t d = c; at < end && *at < (i + 1) * E; ++at, d += 2)
                weights[*at - i * E] = dual[d] - dual[d + 1];
            general_constraints(p, k, i, p->states + point * Z, x, g, weights, full);
            for (; first < at; ++first, c += 2) {
                const int e = *first - i * E;
                double f, weight;
                barrier_derivatives(lower[*first], upper[*first], x[e], dual + c, p->shift + c,
                                    barrier, p->slack + c, p->inverse + c, &f, &weight);
                add_general_constraint(p, e, g + (size_t)e * Z, f, weight, r, Q);
            }
        }
        for (int a = 0; a < Z; ++a)
            for (int b = 0; b < a; ++b)
                Q[b * Z + a] = Q[a * Z + b];
        for (int q = 0; q < Z * Z; ++q)
            full[q] += Q[q];
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
        barrier_derivatives(lower[i], upper[i], z[i], dual + at, p->shift + at, barrier,
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
        linearise_general(p, k, first + 2 * (size_t)p->bounds, barrier);
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
