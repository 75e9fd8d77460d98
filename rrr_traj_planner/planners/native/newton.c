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

/* One Newton step on a sequence of ramps. Each segment is condensed to the states at its ends and
 * its duration (Schur complement), free durations are eliminated, and the velocities and
 * accelerations at the via points follow from a banded system. The cost is linear in ramps and
 * segments. */
#include "blocks.h"
#include "timing_problem.h"

#include <math.h>
#include <string.h>

#define J 1
#define FRONT(name) one_##name
#include "riccati.inc"
#undef J
#undef FRONT
#define J 3
#define FRONT(name) three_##name
#include "riccati.inc"
#undef J
#undef FRONT

static const double FIXED_PIVOT = 1e60;  /* diagonal entry of a velocity that does not change */
/* Multiples of the diagonal added in turn until the band is positive definite (inertia correction:
 * Waechter & Biegler 2006, 3.1). */
static const double REGULARISATION[] = {0.0, 1e-9, 1e-6, 1e-3, 1.0};

/* With bounds alone the coordinates are coupled through the durations only. */
static int is_decoupled(const Problem *p)
{
    return p->J == 1 || p->kind == BOUNDS_ALONE;
}

static size_t rows_size(const Problem *p)
{
    return is_decoupled(p) ? p->J * one_rows_size(p->n) : three_rows_size(p->n);
}

static size_t band_size(const Problem *p)
{
    return (size_t)p->N * 2 * p->J * (4 * p->J + 3);
}

/* The size of the scratch memory of newton_step, in doubles. */
EXPORTED int64_t timing_newton_size(const Problem *p)
{
    const size_t B = 4 * p->J, P = 2 * p->n + 1;
    return p->N * ((B + 1) * (B + 2) + rows_size(p)) + 2 * band_size(p)
        + P * (4 + 16 + 4 + 4) + (size_t)p->n + (p->N + 1) * 2 * p->J;
}

/* Copy one coordinate's states and its first and second derivatives. */
static void extract_coordinate(const Problem *p, int j, const double *z, const double *Q,
                               const double *r, double *own_z, double *own_Q, double *own_r)
{
    const int J = p->J, Z = 4 * J;
    for (int i = 0; i < 2 * p->n + 1; ++i)
        for (int a = 0; a < 4; ++a) {
            own_z[4 * i + a] = z[i * Z + a * J + j];
            own_r[4 * i + a] = r[i * Z + a * J + j];
            for (int b = 0; b < 4; ++b)
                own_Q[16 * i + 4 * a + b] = p->kind != BOUNDS_ALONE
                    ? Q[((size_t)i * Z + a * J + j) * Z + b * J + j]
                    : a == b ? Q[(size_t)i * Z + a * J + j] : 0.0;
        }
}

/* Solve for the steps of velocities and accelerations at the via points (N + 1, 2 J); returns the
 * step of the factor common to the durations of fixed proportions. */
static double solve_via_points(const Problem *p, const double *S, const double *r,
                               double common_hessian, double common_gradient, double *via_step,
                               double *memory)
{
    const int N = p->N, half = 2 * p->J, B = 2 * half, W = B + 1, m = (N - 1) * half, w = 2 * half;
    double *band = memory, *right = band + (size_t)m * w;
    double *solved = right + 2 * m;  /* band and right again: to solve in */
    memset(via_step, 0, (size_t)(N + 1) * half * sizeof(double));
    if (m == 0)
        return common_hessian != 0.0 ? -common_gradient / common_hessian : 0.0;
    memset(band, 0, (size_t)m * w * sizeof(double));
    for (int k = 0; k < N - 1; ++k) {
        const double *one = S + (size_t)k * W * W, *next = one + (size_t)W * W;
        for (int i = 0; i < half; ++i) {
            double *column = band + ((size_t)k * half + i) * w;
            for (int c = i; c < half; ++c)
                column[c - i] = one[(half + c) * W + half + i] + next[c * W + i];
            if (k < N - 2)
                for (int c = 0; c < half; ++c)
                    column[half + c - i] = next[(half + c) * W + i];
            right[2 * (k * half + i)] = r[(size_t)k * W + half + i] + r[(size_t)(k + 1) * W + i];
            right[2 * (k * half + i) + 1] = p->proportions[k] * one[(half + i) * W + B]
                + p->proportions[k + 1] * next[i * W + B];
            if (i < p->J && p->fixed_velocity[k * p->J + i])
                column[0] = FIXED_PIVOT;
        }
    }
    const size_t all = (size_t)m * (w + 2);
    for (size_t trial = 0; trial <= sizeof REGULARISATION / sizeof *REGULARISATION; ++trial) {
        memcpy(solved, band, all * sizeof(double));
        if (trial == sizeof REGULARISATION / sizeof *REGULARISATION) {
            for (int c = 0; c < m; ++c)
                for (int s = 0; s < 2; ++s)
                    solved[(size_t)m * w + 2 * c + s] /= fabs(band[(size_t)c * w]);
            break;
        }
        for (int c = 0; c < m; ++c)
            solved[(size_t)c * w] += REGULARISATION[trial] * fabs(band[(size_t)c * w]);
        if (!solve_band(solved, solved + (size_t)m * w, m, w, 2))
            break;
    }
    const double *x = solved + (size_t)m * w;
    double by_r = 0.0, by_common = 0.0, common = 0.0;
    for (int c = 0; c < m; ++c) {
        by_r += right[2 * c + 1] * x[2 * c];
        by_common += right[2 * c + 1] * x[2 * c + 1];
    }
    if (common_hessian != 0.0)
        common = -(common_gradient - by_r) / (common_hessian - by_common);
    for (int c = 0; c < m; ++c)
        via_step[half + c] = -(x[2 * c] + x[2 * c + 1] * common);
    return common;
}

int newton_step(const Problem *p, const double *Q, const double *r, const double *r_T,
                double *direction, double *dz, double *predicted_decrease)
{
    const Variables m = variables_at(p, p->variables), step = variables_at(p, direction);
    const double *z = p->states, *Q_T = p->hessian_T;
    double *memory = p->newton;
    const int J = p->J, N = p->N, n = p->n, Z = 4 * J, B = 4 * J, W = B + 1, P = 2 * n + 1;
    double *S = memory, *right = S + (size_t)N * W * W;
    double *rows = right + (size_t)N * W;
    double *own_z = rows + N * rows_size(p), *own_Q = own_z + 4 * P, *own_r = own_Q + 16 * P;
    double *own_dz = own_r + 4 * P, *own_inner = own_dz + 4 * P, *via_step = own_inner + n;
    double *band = via_step + (size_t)(N + 1) * 2 * J;
    for (int k = 0; k < N; ++k) {
        double *Sk = S + (size_t)k * W * W, *rk = right + (size_t)k * W;
        const double *zk = z + (size_t)k * P * Z, *Qk = Q + k * hessian_size(p);
        const double *gradient = r + (size_t)k * P * Z;
        double *condensed_rows = rows + k * rows_size(p);
        if (!is_decoupled(p)) {
            if (three_condense(p, m.T[k], zk, Qk, gradient, Sk, rk, (three_Rows *)condensed_rows))
                return 1;
        } else {
            memset(Sk, 0, (size_t)W * W * sizeof(double));
            memset(rk, 0, (size_t)W * sizeof(double));
            for (int j = 0; j < J; ++j) {
                double one[25], one_r[5];
                const int at[5] = {j, J + j, 2 * J + j, 3 * J + j, B};
                extract_coordinate(p, j, zk, Qk, gradient, own_z, own_Q, own_r);
                if (one_condense(p, m.T[k], own_z, own_Q, own_r, one, one_r,
                                  (one_Rows *)(condensed_rows + j * one_rows_size(n))))
                    return 1;
                for (int a = 0; a < 5; ++a) {
                    rk[at[a]] += one_r[a];
                    for (int b = 0; b < 5; ++b)
                        Sk[at[a] * W + at[b]] += one[5 * a + b];
                }
            }
        }
        Sk[B * W + B] += Q_T[k];
        rk[B] += r_T[k] + p->weights[k];
    }
    double common_hessian = 0.0, common_gradient = 0.0;
    for (int k = 0; k < N; ++k) {  /* free durations are eliminated */
        double *Sk = S + (size_t)k * W * W, *rk = right + (size_t)k * W;
        common_hessian += p->proportions[k] * p->proportions[k] * Sk[B * W + B];
        common_gradient += p->proportions[k] * rk[B];
        if (!p->free[k] || Sk[B * W + B] == 0.0)
            continue;
        for (int i = 0; i < B; ++i) {
            const double factor = Sk[i * W + B] / Sk[B * W + B];
            for (int c = 0; c < B; ++c)
                Sk[i * W + c] -= factor * Sk[B * W + c];
            rk[i] -= factor * rk[B];
        }
    }
    const double common = solve_via_points(p, S, right, common_hessian, common_gradient, via_step,
                                           band);
    *predicted_decrease = 0.0;
    for (int k = 0; k < N; ++k) {
        const double *Sk = S + (size_t)k * W * W, *rk = right + (size_t)k * W;
        const double *border = via_step + (size_t)k * 2 * J;  /* v0, a0, v1, a1 in a row */
        double dT = p->proportions[k] * common;
        if (p->free[k]) {
            dT = 0.0;
            if (Sk[B * W + B] != 0.0) {
                double sum = rk[B];
                for (int i = 0; i < B; ++i)
                    sum += Sk[B * W + i] * border[i];
                dT = -sum / Sk[B * W + B];
            }
        }
        step.T[k] = dT;
        const double *zk = z + (size_t)k * P * Z;
        double *to = dz + (size_t)k * P * Z, *inner = step.inner + (size_t)k * (n - 1) * J;
        const double *condensed_rows = rows + k * rows_size(p);
        if (!is_decoupled(p))
            three_expand(p, m.T[k], zk, border, dT, (const three_Rows *)condensed_rows, inner, to);
        else
            for (int j = 0; j < J; ++j) {
                const double own[4] = {border[j], border[J + j], border[2 * J + j],
                                       border[3 * J + j]};
                for (int i = 0; i < P; ++i)
                    for (int a = 0; a < 4; ++a)
                        own_z[4 * i + a] = zk[i * Z + a * J + j];
                one_expand(p, m.T[k], own_z, own, dT,
                             (const one_Rows *)(condensed_rows + j * one_rows_size(n)), own_inner,
                             own_dz);
                for (int i = 0; i < n - 1; ++i)
                    inner[i * J + j] = own_inner[i];
                for (int i = 0; i < P; ++i)
                    for (int a = 0; a < 4; ++a)
                        to[i * Z + a * J + j] = own_dz[4 * i + a];
            }
        const double *gradient = r + (size_t)k * P * Z;
        for (int i = 0; i < P * Z; ++i)
            *predicted_decrease -= gradient[i] * to[i];
        *predicted_decrease -= (r_T[k] + p->weights[k]) * dT;
    }
    for (int k = 0; k < N - 1; ++k)
        for (int j = 0; j < J; ++j) {
            step.v[k * J + j] = via_step[(size_t)(k + 1) * 2 * J + j];
            step.a[k * J + j] = via_step[(size_t)(k + 1) * 2 * J + J + j];
        }
    return 0;
}
