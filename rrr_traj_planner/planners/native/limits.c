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

/* Limits of a chain near a motion (ramp_constraints.py, ramp_curvature.py). */
#include "limits.h"

#include <math.h>
#include <string.h>

enum { FLOOR_WEIGHT = 3 };  /* a floor counts as often as there are coordinates */
static const double FAR = 1e6;


size_t limits_size(const Work *w)
{
    return 2 * (size_t)w->p->N * (w->M + 1);
}

static double *floors(const Work *w, double *slack)
{
    return slack + 2 * (size_t)w->p->N * w->M;
}

static void general_at(const Problem *p, int k, int i, const double *z, double *x,
                       double *gradient, const double *weights, double *second)
{
    if (p->kind == TORQUE)
        torque_at(p, z, x, gradient, weights, second);
    else
        path_at(p, k, i, z, x, gradient, weights, second);
}

void room(const Work *w, const double *T, const double *z, double part, double *x, double *slack)
{
    const Problem *p = w->p;
    const int Z = 4 * p->J, P = 2 * p->n + 1, E = p->E;
    for (int k = 0; k < p->N; ++k) {
        const double *at = z + (size_t)k * P * Z, *lower = p->lower + (size_t)k * P * Z,
            *upper = p->upper + (size_t)k * P * Z;
        double *to = slack + 2 * (size_t)k * w->M;
        for (int c = 0; c < w->boxes; ++c, to += 2) {
            const int i = w->box_at[c];
            to[0] = upper[i] - at[i];
            to[1] = at[i] - lower[i];
        }
        double *xk = x + (size_t)k * P * E;
        for (int i = 0; i < P && w->general; ++i)
            if (w->looked[i])
                general_at(p, k, i, at + (size_t)i * Z, xk + (size_t)i * E, NULL, NULL, NULL);
        lower = p->general_lower + (size_t)k * P * E;
        upper = p->general_upper + (size_t)k * P * E;
        for (int c = 0; c < w->general; ++c, to += 2) {
            const int i = w->general_at[c];
            to[0] = upper[i] - xk[i];
            to[1] = xk[i] - lower[i];
        }
        double *spare = floors(w, slack) + 2 * k;
        spare[1] = p->floor ? T[k] - p->floor[k] : 1.0;
        spare[0] = p->floor ? FAR - spare[1] : 1.0;
    }
    const size_t all = limits_size(w);
    for (size_t i = 0; i < all && w->relieved; ++i)
        slack[i] += part * w->relief[i];
}

double log_of(const Work *w, const double *slack)
{
    const size_t all = 2 * (size_t)w->p->N * w->M;
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
    const double *spare = slack + all;
    for (int k = 0; w->p->floor && k < 2 * w->p->N; ++k)
        sum += FLOOR_WEIGHT * log(spare[k]);
    return sum;
}

size_t limits_count(const Work *w)
{
    return 2 * (size_t)w->p->N * (w->M + (w->p->floor ? FLOOR_WEIGHT : 0));
}

/* First derivatives of a sum of limited quantities, pulled below by pull[1], above by pull[0]. */
void pulled(const Work *w, const double *pull, double *r, double *r_T)
{
    const Problem *p = w->p;
    const int Z = 4 * p->J, P = 2 * p->n + 1, E = p->E;
    memset(r, 0, (size_t)p->N * P * Z * sizeof(double));
    for (int k = 0; k < p->N; ++k) {
        const double *from = pull + 2 * (size_t)k * w->M;
        double *rk = r + (size_t)k * P * Z;
        for (int c = 0; c < w->boxes; ++c, from += 2)
            rk[w->box_at[c]] += from[0] - from[1];
        for (int c = 0; c < w->general; ++c, from += 2) {
            const int i = w->general_at[c];
            const double *g = w->gradient + ((size_t)k * P * E + i) * Z, f = from[0] - from[1];
            double *to = rk + (size_t)(i / E) * Z;
            for (int a = 0; a < Z; ++a)
                to[a] += f * g[a];
        }
        const double *spare = pull + 2 * (size_t)p->N * w->M + 2 * k;
        r_T[k] = p->floor ? FLOOR_WEIGHT * (spare[0] - spare[1]) : 0.0;
    }
}

/* Enter a limit of gradient g, zero but for columns from first to end, that pulls with f and has a
 * weight: r += f g, and the lower half of Q += weight g g'. */
static inline void entered(const double *g, int first, int end, int Z, double f, double weight,
                           double *r, double *Q)
{
    for (int a = first; a < end; ++a) {
        const double scaled = weight * g[a];
        r[a] += f * g[a];
        for (int b = first; b <= a; ++b)
            Q[a * Z + b] += scaled * g[b];
    }
}

/* The same for general limit e. */
static inline void general_entered(const Problem *p, int e, const double *g, double f,
                                   double weight, double *r, double *Q)
{
    if (p->kind == TORQUE)
        entered(g, 1, 9, 12, f, weight, r, Q);  /* of two positions, velocities, accelerations */
    else if (e < 3)
        entered(g, 0, 2, 4, f, weight, r, Q);
    else if (e < 6 || e >= 9)
        entered(g, 0, 3, 4, f, weight, r, Q);
    else
        entered(g, 0, 4, 4, f, weight, r, Q);
}

/* Room on both sides of a value: slacks and their inverses; what both pull with, and weigh. */
static inline void sides(double lower, double upper, double value, const double *dual,
                         const double *relief, double barrier, double *slack, double *inverse,
                         double *f, double *weight)
{
    slack[0] = upper - value + relief[0], slack[1] = value - lower + relief[1];
    inverse[0] = 1.0 / slack[0], inverse[1] = 1.0 / slack[1];
    *f = (barrier + dual[0] * relief[0]) * inverse[0]
        - (barrier + dual[1] * relief[1]) * inverse[1];
    *weight = dual[0] * inverse[0] + dual[1] * inverse[1];
}

/* The general limits of a segment, from an offset on, at its states; see localised. */
static void general_localised(Work *w, int k, size_t offset, const double *dual, double barrier)
{
    const Problem *p = w->p;
    const int Z = 4 * p->J, P = 2 * p->n + 1, E = p->E;
    const double *lower = p->general_lower + (size_t)k * P * E,
        *upper = p->general_upper + (size_t)k * P * E;
    const int *at = w->general_at, *end = at + w->general;
    size_t c = offset;
    for (int i = 0; i < P; ++i) {
        const size_t point = (size_t)k * P + i, block = point * Z * Z;
        double *x = w->x + point * E, *g = w->gradient + point * E * Z, *r = w->r + point * Z,
            *Q = w->Q + block, *full = w->Q_full + block;
        if (w->looked[i]) {
            double weights[MOST_GENERAL] = {0.0};
            const int *first = at;
            for (size_t d = c; at < end && *at < (i + 1) * E; ++at, d += 2)
                weights[*at - i * E] = dual[d] - dual[d + 1];
            general_at(p, k, i, w->z + point * Z, x, g, weights, full);
            for (; first < at; ++first, c += 2) {
                const int e = *first - i * E;
                double f, weight;
                sides(lower[*first], upper[*first], x[e], dual + c, w->relief + c, barrier,
                      w->slack + c, w->inverse + c, &f, &weight);
                general_entered(p, e, g + (size_t)e * Z, f, weight, r, Q);
            }
        }
        for (int a = 0; a < Z; ++a)
            for (int b = 0; b < a; ++b)
                Q[b * Z + a] = Q[a * Z + b];
        for (int q = 0; q < Z * Z; ++q)
            full[q] += Q[q];
    }
}

/* The problem near a motion: room, derivatives, and the Hessian of the barrier: of Gauss and Newton,
 * and with the general limits' own curvature. */
void localised(Work *w, Motion m, const double *dual, double barrier)
{
    const Problem *p = w->p;
    const int Z = 4 * p->J, P = 2 * p->n + 1, whole = p->kind != BOXES_ALONE;
    motion_states(p, m, w->z);
    memset(w->r, 0, (size_t)p->N * P * Z * sizeof(double));
    memset(w->Q, 0, p->N * hessian_size(p) * sizeof(double));
    if (whole)
        memset(w->Q_full, 0, p->N * hessian_size(p) * sizeof(double));
    for (int k = 0; k < p->N; ++k) {
        const size_t first = 2 * (size_t)k * w->M, part = (size_t)k * P * Z;
        const double *z = w->z + part, *lower = p->lower + part, *upper = p->upper + part;
        double *r = w->r + part, *Q = w->Q + k * hessian_size(p);
        for (int c = 0; c < w->boxes; ++c) {
            const int i = w->box_at[c];
            const size_t at = first + 2 * c;
            double f, weight;
            sides(lower[i], upper[i], z[i], dual + at, w->relief + at, barrier, w->slack + at,
                  w->inverse + at, &f, &weight);
            r[i] += f;
            Q[whole ? i * Z + i % Z : i] += weight;
        }
        if (whole)
            general_localised(w, k, first + 2 * (size_t)w->boxes, dual, barrier);
        w->r_T[k] = w->Q_T[k] = 0.0;
        const size_t at = 2 * ((size_t)p->N * w->M + k);
        double *spare = w->slack + at, *inverse = w->inverse + at;
        spare[1] = p->floor ? m.T[k] - p->floor[k] : 1.0;
        spare[0] = p->floor ? FAR - spare[1] : 1.0;
        inverse[0] = 1.0 / spare[0], inverse[1] = 1.0 / spare[1];
        if (p->floor) {
            w->r_T[k] = FLOOR_WEIGHT * barrier * (inverse[0] - inverse[1]);
            w->Q_T[k] = FLOOR_WEIGHT * (dual[at] * inverse[0] + dual[at + 1] * inverse[1]);
        }
    }
}

/* How slacks change along a step. */
void rates_of(const Work *w, Motion step, const double *dz, double *rate)
{
    const Problem *p = w->p;
    const int Z = 4 * p->J, P = 2 * p->n + 1, E = p->E;
    for (int k = 0; k < p->N; ++k) {
        const double *at = dz + (size_t)k * P * Z;
        double *to = rate + 2 * (size_t)k * w->M;
        for (int c = 0; c < w->boxes; ++c, to += 2) {
            to[0] = -at[w->box_at[c]];
            to[1] = at[w->box_at[c]];
        }
        for (int c = 0; c < w->general; ++c, to += 2) {
            const int i = w->general_at[c];
            const double *g = w->gradient + ((size_t)k * P * E + i) * Z,
                *d = at + (size_t)(i / E) * Z;
            double sum = 0.0;
            for (int a = 0; a < Z; ++a)
                sum += g[a] * d[a];
            to[0] = -sum;
            to[1] = sum;
        }
        double *spare = floors(w, rate) + 2 * k;
        spare[1] = p->floor ? step.T[k] : 0.0;
        spare[0] = -spare[1];
    }
    const size_t all = limits_size(w);
    for (size_t i = 0; i < all && w->relieved; ++i)
        rate[i] -= w->relief[i];
}
