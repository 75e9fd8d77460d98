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

/* The constraints: their slacks and derivatives, and the barrier problem linearised at an iterate.
 */
#include "timing_problem.h"

#include <math.h>
#include <string.h>

/* Multiplicity of a least duration's logarithm: one for each joint. Only motions of three joints
 * have least durations (joint_timing/constraints.py); those along a path, of one coordinate, have
 * none. */
enum { DURATION_WEIGHT = 3 };

/* For solver/timing_problem.py, which compares them. */
EXPORTED const int64_t size_of_problem = sizeof(Problem), size_of_step = sizeof(Step);

static double *duration_slacks(const Problem *p, double *slack)
{
    return slack + 2 * (size_t)p->N * constraints_of(p);
}

static void general_at(const Problem *p, int k, int i, const double *z, double *x,
                       double *gradient, const double *weights, double *second)
{
    if (p->arm)
        torque_at(p->arm, z, x, gradient, weights, second);
    else
        path_at(p, k, i, z, x, gradient, weights, second);
}

/* Slacks at the states z of a motion, the given part of the shifts included; x receives the values
 * of the general constraints. */
void slacks_at(const Problem *p, const double *T, const double *z, double part, double *x,
               double *slack)
{
    const int Z = 4 * p->J, P = 2 * p->n + 1, E = p->E;
    for (int k = 0; k < p->N; ++k) {
        const double *at = z + (size_t)k * P * Z, *lower = p->lower + (size_t)k * P * Z,
            *upper = p->upper + (size_t)k * P * Z;
        double *to = slack + 2 * (size_t)k * constraints_of(p);
        for (int c = 0; c < p->bounds; ++c, to += 2) {
            const int i = p->bound_at[c];
            to[0] = upper[i] - at[i];
            to[1] = at[i] - lower[i];
        }
        double *xk = x + (size_t)k * P * E;
        for (int i = 0; i < P && p->general; ++i)
            if (p->has_general[i])
                general_at(p, k, i, at + (size_t)i * Z, xk + (size_t)i * E, NULL, NULL, NULL);
        lower = p->general_lower + (size_t)k * P * E;
        upper = p->general_upper + (size_t)k * P * E;
        for (int c = 0; c < p->general; ++c, to += 2) {
            const int i = p->general_at[c];
            to[0] = upper[i] - xk[i];
            to[1] = xk[i] - lower[i];
        }
        double *duration_slack = duration_slacks(p, slack) + 2 * k;
        duration_slack[1] = p->least_T ? T[k] - p->least_T[k] : 1.0;
        duration_slack[0] = p->least_T ? p->longest - duration_slack[1] : 1.0;
    }
    const size_t all = slacks_size(p);
    for (size_t i = 0; i < all && p->shifted; ++i)
        slack[i] += part * p->shift[i];
}

/* The number of constraints, by multiplicity. */
EXPORTED double timing_constraint_count(const Problem *p)
{
    return 2.0 * p->N * (constraints_of(p) + (p->least_T ? DURATION_WEIGHT : 0));
}

/* The sum of the slacks' logarithms; most of them are taken of products, which is faster. */
EXPORTED double timing_log_sum(const Problem *p, const double *slack)
{
    const size_t all = 2 * (size_t)p->N * constraints_of(p);
    double sum = 0.0, product = 1.0;
    size_t i = 0;
    for (; i + 8 <= all; i += 8) {
        product *= (slack[i] * slack[i + 1]) * (slack[i + 2] * slack[i + 3])
            * ((slack[i + 4] * slack[i + 5]) * (slack[i + 6] * slack[i + 7]));
        if (!(product > 1e-100 && product < 1e100)) {
            sum += log(product);
            product = 1.0;
        }
    }
    for (; i < all; ++i)
        sum += log(slack[i]);
    sum += log(product);
    const double *duration_slack = slack + all;
    for (int k = 0; p->least_T && k < 2 * p->N; ++k)
        sum += DURATION_WEIGHT * log(duration_slack[k]);
    return sum;
}

/* The gradient, by states and durations, of the weighted sum of all constrained quantities; the
 * weight of each is that of its upper bound less that of its lower bound. */
void weighted_gradient(const Problem *p, const double *weights, double *r, double *r_T)
{
    const int Z = 4 * p->J, P = 2 * p->n + 1, E = p->E;
    memset(r, 0, (size_t)p->N * P * Z * sizeof(double));
    for (int k = 0; k < p->N; ++k) {
        const double *from = weights + 2 * (size_t)k * constraints_of(p);
        double *rk = r + (size_t)k * P * Z;
        for (int c = 0; c < p->bounds; ++c, from += 2)
            rk[p->bound_at[c]] += from[0] - from[1];
        for (int c = 0; c < p->general; ++c, from += 2) {
            const int i = p->general_at[c];
            const double *g = p->jacobian + ((size_t)k * P * E + i) * Z, f = from[0] - from[1];
            double *to = rk + (size_t)(i / E) * Z;
            for (int a = 0; a < Z; ++a)
                to[a] += f * g[a];
        }
        const double *duration_slack = weights + 2 * (size_t)p->N * constraints_of(p) + 2 * k;
        r_T[k] = p->least_T ? DURATION_WEIGHT * (duration_slack[0] - duration_slack[1]) : 0.0;
    }
}

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
            general_at(p, k, i, p->states + point * Z, x, g, weights, full);
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

/* Linearise the problem at the iterate: slacks, the Jacobian of the general constraints, and
 * gradient and primal-dual Hessian of the barrier by states (Nocedal & Wright, Numerical
 * Optimization, 19.3). The Hessian is computed twice: without the constraints' second derivatives,
 * and with them, weighted by the multipliers. */
EXPORTED void timing_linearise(const Problem *p, double barrier)
{
    const Variables m = variables_at(p, p->variables);
    const double *dual = p->dual;
    const int Z = 4 * p->J, P = 2 * p->n + 1, whole = !bounds_alone(p);
    motion_states(p, m, p->states);
    memset(p->gradient, 0, (size_t)p->N * P * Z * sizeof(double));
    memset(p->hessian, 0, p->N * hessian_size(p) * sizeof(double));
    if (whole)
        memset(p->exact, 0, p->N * hessian_size(p) * sizeof(double));
    for (int k = 0; k < p->N; ++k) {
        const size_t first = 2 * (size_t)k * constraints_of(p), part = (size_t)k * P * Z;
        const double *z = p->states + part, *lower = p->lower + part, *upper = p->upper + part;
        double *r = p->gradient + part, *Q = p->hessian + k * hessian_size(p);
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
        const size_t at = 2 * ((size_t)p->N * constraints_of(p) + k);
        double *duration_slack = p->slack + at, *inverse = p->inverse + at;
        duration_slack[1] = p->least_T ? m.T[k] - p->least_T[k] : 1.0;
        duration_slack[0] = p->least_T ? p->longest - duration_slack[1] : 1.0;
        inverse[0] = 1.0 / duration_slack[0], inverse[1] = 1.0 / duration_slack[1];
        if (p->least_T) {
            p->gradient_T[k] = DURATION_WEIGHT * barrier * (inverse[0] - inverse[1]);
            p->hessian_T[k] = DURATION_WEIGHT
                * (dual[at] * inverse[0] + dual[at + 1] * inverse[1]);
        }
    }
}

/* Directional derivatives of the slacks along a step that changes durations by dT and states by
 * dz. */
void slack_rates(const Problem *p, const double *dT, const double *dz, double *rate)
{
    const int Z = 4 * p->J, P = 2 * p->n + 1, E = p->E;
    for (int k = 0; k < p->N; ++k) {
        const double *at = dz + (size_t)k * P * Z;
        double *to = rate + 2 * (size_t)k * constraints_of(p);
        for (int c = 0; c < p->bounds; ++c, to += 2) {
            to[0] = -at[p->bound_at[c]];
            to[1] = at[p->bound_at[c]];
        }
        for (int c = 0; c < p->general; ++c, to += 2) {
            const int i = p->general_at[c];
            const double *g = p->jacobian + ((size_t)k * P * E + i) * Z,
                *d = at + (size_t)(i / E) * Z;
            double sum = 0.0;
            for (int a = 0; a < Z; ++a)
                sum += g[a] * d[a];
            to[0] = -sum;
            to[1] = sum;
        }
        double *duration_slack = duration_slacks(p, rate) + 2 * k;
        duration_slack[1] = p->least_T ? dT[k] : 0.0;
        duration_slack[0] = -duration_slack[1];
    }
    const size_t all = slacks_size(p);
    for (size_t i = 0; i < all && p->shifted; ++i)
        rate[i] -= p->shift[i];
}
