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

/* Room to the limits at a motion's states. */
void room(const Work *w, const double *T, const double *z, double *x, double *gradient,
          double *slack)
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
                general_at(p, k, i, at + (size_t)i * Z, xk + (size_t)i * E, gradient
                           ? gradient + ((size_t)k * P + i) * E * Z : NULL, NULL, NULL);
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
}

double log_of(const Work *w, const double *slack)
{
    const size_t all = 2 * (size_t)w->p->N * w->M;
    double sum = 0.0;
    size_t i = 0;
    for (; i + 8 <= all; i += 8)
        sum += log(slack[i] * slack[i + 1] * slack[i + 2] * slack[i + 3]
                   * slack[i + 4] * slack[i + 5] * slack[i + 6] * slack[i + 7]);
    for (; i < all; ++i)
        sum += log(slack[i]);
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

/* The problem near a motion: room, derivatives, and the Gauss-Newton Hessian of the barrier. */
void localised(Work *w, Motion m, const double *dual, double barrier, double *scratch)
{
    const Problem *p = w->p;
    const int Z = 4 * p->J, P = 2 * p->n + 1, E = p->E;
    motion_states(p, m, w->z);
    room(w, m.T, w->z, w->x, w->gradient, w->slack);
    const size_t all = limits_size(w);
    for (size_t i = 0; i < all; ++i) {
        w->inverse[i] = 1.0 / w->slack[i];
        scratch[i] = barrier * w->inverse[i];
    }
    pulled(w, scratch, w->r, w->r_T);
    memset(w->Q, 0, p->N * hessian_size(p) * sizeof(double));
    for (int k = 0; k < p->N; ++k) {
        const double *s = w->inverse + 2 * (size_t)k * w->M, *d = dual + 2 * (size_t)k * w->M;
        double *Qk = w->Q + k * hessian_size(p);
        for (int c = 0; c < w->boxes; ++c, s += 2, d += 2) {
            const int i = w->box_at[c];
            Qk[p->kind == BOXES_ALONE ? i : i * Z + i % Z] += d[0] * s[0] + d[1] * s[1];
        }
        for (int c = 0; c < w->general; ++c, s += 2, d += 2) {
            const int i = w->general_at[c];
            const double *g = w->gradient + ((size_t)k * P * E + i) * Z;
            const double weight = d[0] * s[0] + d[1] * s[1];
            double *to = Qk + (size_t)(i / E) * Z * Z;
            for (int a = 0; a < Z; ++a) {
                const double f = weight * g[a];
                if (f != 0.0)
                    for (int b = 0; b < Z; ++b)
                        to[a * Z + b] += f * g[b];
            }
        }
        const double *sf = floors(w, w->slack) + 2 * k;
        const double *df = dual + 2 * (size_t)p->N * w->M + 2 * k;
        w->Q_T[k] = p->floor ? FLOOR_WEIGHT * (df[0] / sf[0] + df[1] / sf[1]) : 0.0;
    }
}

/* Add the general limits' own curvature to the Hessian. */
void bend_added(Work *w, const double *dual)
{
    const Problem *p = w->p;
    const int Z = 4 * p->J, P = 2 * p->n + 1, E = p->E;
    double weights[MOST_GENERAL];
    memcpy(w->Q_full, w->Q, p->N * hessian_size(p) * sizeof(double));
    for (int k = 0; k < p->N; ++k) {
        const double *d = dual + 2 * ((size_t)k * w->M + w->boxes);
        int c = 0;
        for (int i = 0; i < P; ++i) {
            if (!w->looked[i])
                continue;
            memset(weights, 0, sizeof weights);
            for (; c < w->general && w->general_at[c] < (i + 1) * E; ++c)
                weights[w->general_at[c] - i * E] = d[2 * c] - d[2 * c + 1];
            general_at(p, k, i, w->z + ((size_t)k * P + i) * Z, NULL, NULL, weights,
                       w->Q_full + ((size_t)k * P + i) * Z * Z);
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
}
