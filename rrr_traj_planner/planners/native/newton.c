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

/* One Newton step on a motion of piecewise linear jerk. Each segment is condensed to the states at
 * its ends and its duration (Schur complement), free durations are eliminated, and the velocities,
 * accelerations and jerks at the via points follow from a banded system. The cost is linear in
 * intervals and segments. */
#include "timing_problem.h"

#include <math.h>
#include <string.h>

enum { VECTOR = 4 };  /* doubles that a processor adds at once; loops are over multiples of it */

/* Functions that are compiled for processors with AVX2 too, of which one is chosen when the
 * library is loaded; they round alike. What they call is compiled with them. */
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__)
#define BY_PROCESSOR __attribute__((target_clones("avx2", "default")))
#else
#define BY_PROCESSOR
#endif
#define INLINE static inline __attribute__((always_inline))

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

/* With bounds alone the coordinates are coupled through the durations only. */
static int is_decoupled(const Problem *p)
{
    return p->J == 1 || bounds_alone(p);
}

static size_t rows_size(const Problem *p)
{
    return is_decoupled(p) ? p->J * one_rows_size(p->n) : three_rows_size(p->n);
}

static size_t band_size(const Problem *p)
{
    return (size_t)(p->N + 1) * ORDERS * p->J * (2 * ORDERS * p->J + 3);
}

/* The size of the scratch memory of newton_step, in doubles. */
EXPORTED int64_t timing_newton_size(const Problem *p)
{
    const size_t B = 2 * ORDERS * p->J, P = 2 * p->n + 1;
    return p->N * ((B + 1) * (B + 2) + rows_size(p)) + 2 * band_size(p)
        + P * (4 + 16 + 4 + 4) + (size_t)p->n + (p->N + 1) * ORDERS * p->J;
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
                own_Q[16 * i + 4 * a + b] = !bounds_alone(p)
                    ? Q[((size_t)i * Z + a * J + j) * Z + b * J + j]
                    : a == b ? Q[(size_t)i * Z + a * J + j] : 0.0;
        }
}

/* Scratch memory of a step; W = 6 J + 1 unknowns of a condensed segment. */
typedef struct {
    double *S, *right;               /* (N, W, W) and (N, W): the condensed segments */
    double *rows;                    /* of their eliminations */
    double *z, *Q, *r, *dz, *inner;  /* of one coordinate */
    double *via_step;                /* (N + 1, 3 J) */
    double *band;                    /* the system of the via points, twice */
} Scratch;

static Scratch scratch_of(const Problem *p)
{
    const size_t N = p->N, P = points_of(p), W = 2 * ORDERS * (size_t)p->J + 1;
    Scratch s;
    s.S = p->newton;
    s.right = s.S + N * W * W;
    s.rows = s.right + N * W;
    s.z = s.rows + N * rows_size(p);
    s.Q = s.z + 4 * P;
    s.r = s.Q + 16 * P;
    s.dz = s.r + 4 * P;
    s.inner = s.dz + 4 * P;
    s.via_step = s.inner + p->n;
    s.band = s.via_step + (N + 1) * ORDERS * p->J;
    return s;
}

/* Condense a segment whose coordinates are coupled through its duration only. */
static int condense_decoupled(const Problem *p, const Scratch *s, int k, double T,
                              const double *z, const double *Q, const double *r, double *S,
                              double *right, double *rows)
{
    enum { BORDER = 2 * ORDERS + 1 };
    const int J = p->J, B = 2 * ORDERS * J, W = B + 1;
    memset(S, 0, (size_t)W * W * sizeof(double));
    memset(right, 0, (size_t)W * sizeof(double));
    for (int j = 0; j < J; ++j) {
        double one[BORDER * BORDER], one_r[BORDER];
        int at[BORDER] = {0};
        for (int i = 0; i < BORDER; ++i)
            at[i] = i < BORDER - 1 ? i * J + j : B;
        extract_coordinate(p, j, z, Q, r, s->z, s->Q, s->r);
        if (one_condense(p, k, T, s->z, s->Q, s->r, one, one_r,
                         (one_Rows *)(rows + j * one_rows_size(p->n))))
            return 1;
        for (int a = 0; a < BORDER; ++a) {
            right[at[a]] += one_r[a];
            for (int b = 0; b < BORDER; ++b)
                S[at[a] * W + at[b]] += one[BORDER * a + b];
        }
    }
    return 0;
}

/* Condense segment k to the states at its ends and its duration. Returns 1 where that fails. */
static int condense(const Problem *p, const Scratch *s, int k, const double *Q, const double *r,
                    const double *r_T)
{
    const double T = variables_at(p, p->variables).T[k];
    const int B = 2 * ORDERS * p->J, W = B + 1;
    const size_t states = points_of(p) * 4 * p->J;
    double *S = s->S + (size_t)k * W * W, *right = s->right + (size_t)k * W;
    double *rows = s->rows + k * rows_size(p);
    const double *z = p->states + k * states, *Qk = Q + k * hessian_size(p);
    const int singular = is_decoupled(p)
        ? condense_decoupled(p, s, k, T, z, Qk, r + k * states, S, right, rows)
        : three_condense(p, k, T, z, Qk, r + k * states, S, right, (three_Rows *)rows);
    S[B * W + B] += p->hessian_T[k];
    right[B] += r_T[k] + p->weights[k];
    return singular;
}

/* Eliminate a duration that is free; adds derivatives by the factor common to the others. */
static void eliminate_duration(const Problem *p, const Scratch *s, int k, double *common_hessian,
                               double *common_gradient)
{
    const int B = 2 * ORDERS * p->J, W = B + 1;
    double *S = s->S + (size_t)k * W * W, *right = s->right + (size_t)k * W;
    *common_hessian += p->proportions[k] * p->proportions[k] * S[B * W + B];
    *common_gradient += p->proportions[k] * right[B];
    if (!p->free[k] || S[B * W + B] == 0.0)
        return;
    for (int i = 0; i < B; ++i) {
        const double factor = S[i * W + B] / S[B * W + B];
        for (int c = 0; c < B; ++c)
            S[i * W + c] -= factor * S[B * W + c];
        right[i] -= factor * right[B];
    }
}

/* The step of a segment's duration, from those of its border v0, a0, j0, v1, a1, j1, and the part
 * that is taken of the step with these fixed. */
static double duration_step(const Problem *p, const Scratch *s, int k, const double *border,
                            double common, double part)
{
    const int B = 2 * ORDERS * p->J, W = B + 1;
    const double *S = s->S + (size_t)k * W * W, *right = s->right + (size_t)k * W;
    if (!p->free[k])
        return p->proportions[k] * common;
    if (S[B * W + B] == 0.0)
        return 0.0;
    double sum = part * right[B];
    for (int i = 0; i < B; ++i)
        sum += S[B * W + i] * border[i];
    return -sum / S[B * W + B];
}

/* Back substitution in a segment whose coordinates are coupled through its duration only. */
static void expand_decoupled(const Problem *p, const Scratch *s, int k, double T, const double *z,
                             const double *border, double dT, double part, const double *rows,
                             double *inner, double *dz)
{
    const int J = p->J, Z = 4 * J, n = p->n, P = 2 * n + 1;
    for (int j = 0; j < J; ++j) {
        double own[2 * ORDERS];
        for (int i = 0; i < 2 * ORDERS; ++i)
            own[i] = border[i * J + j];
        for (int i = 0; i < P; ++i)
            for (int a = 0; a < 4; ++a)
                s->z[4 * i + a] = z[i * Z + a * J + j];
        one_expand(p, k, T, s->z, own, dT, part, (const one_Rows *)(rows + j * one_rows_size(n)),
                   s->inner, s->dz);
        for (int i = 0; i < n - 1; ++i)
            inner[i * J + j] = s->inner[i];
        for (int i = 0; i < P; ++i)
            for (int a = 0; a < 4; ++a)
                dz[i * Z + a * J + j] = s->dz[4 * i + a];
    }
}

/* The steps of a segment's duration, inner jerks and states, from those of the via points and the
 * part that is taken of the step with these fixed; returns the predicted decrease. */
static double expand(const Problem *p, const Scratch *s, int k, const double *r,
                     const double *r_T, double common, double part, Variables step, double *dz)
{
    const double T = variables_at(p, p->variables).T[k];
    const int J = p->J;
    const size_t states = points_of(p) * 4 * J;
    const double *border = s->via_step + (size_t)k * ORDERS * J;  /* of both ends in a row */
    const double *z = p->states + k * states, *rows = s->rows + k * rows_size(p);
    const double *gradient = r + k * states;
    double *to = dz + k * states, *inner = step.inner + (size_t)k * (p->n - 1) * J;
    const double dT = step.T[k] = duration_step(p, s, k, border, common, part);
    double decrease = -(r_T[k] + p->weights[k]) * dT;
    if (is_decoupled(p))
        expand_decoupled(p, s, k, T, z, border, dT, part, rows, inner, to);
    else
        three_expand(p, k, T, z, border, dT, part, (const three_Rows *)rows, inner, to);
    for (size_t i = 0; i < states; ++i)
        decrease -= gradient[i] * to[i];
    return decrease;
}

/* Copy the steps at via points begin to end. */
static void put_via_steps(const Problem *p, const Scratch *s, Range at, Variables step)
{
    const int J = p->J;
    for (int k = at.begin; k <= at.end; ++k)
        for (int j = 0; j < J; ++j) {
            const double *own = s->via_step + (size_t)k * ORDERS * J + j;
            step.v[k * J + j] = own[0];
            step.a[k * J + j] = own[J];
            step.j[k * J + j] = own[2 * J];
        }
}

int newton_step(const Problem *p, const double *Q, const double *r, const double *r_T,
                double *direction, double *dz, double *predicted_decrease)
{
    const Variables step = variables_at(p, direction);
    const Scratch s = scratch_of(p);
    const Range all = {0, p->N};
    double common_hessian = 0.0, common_gradient = 0.0, decrease = 0.0;
    for (int k = 0; k < p->N; ++k) {
        if (condense(p, &s, k, Q, r, r_T))
            return 1;
        eliminate_duration(p, &s, k, &common_hessian, &common_gradient);
    }
    const double common = solve_via_points(p, all, s.S, s.right, NULL, common_hessian,
                                           common_gradient, s.via_step, s.band);
    for (int k = 0; k < p->N; ++k)
        decrease += expand(p, &s, k, r, r_T, common, 1.0, step, dz);
    put_via_steps(p, &s, all, step);
    *predicted_decrease = decrease;
    return 0;
}

int condense_segment(const Problem *p, int k)
{
    const Scratch s = scratch_of(p);
    double hessian = 0.0, gradient = 0.0;
    if (condense(p, &s, k, p->hessian, p->gradient, p->gradient_T))
        return 1;
    eliminate_duration(p, &s, k, &hessian, &gradient);
    return 0;
}

void rest_ends(const Problem *p, Range at)
{
    const Scratch s = scratch_of(p);
    const size_t half = ORDERS * p->J;
    memset(s.via_step + at.begin * half, 0, half * sizeof(double));
    memset(s.via_step + at.end * half, 0, half * sizeof(double));
}

void damped_step(const Problem *p, Range at, const double *damping, double *direction,
                 double *decrease)
{
    const Variables step = variables_at(p, direction);
    const Scratch s = scratch_of(p);
    solve_via_points(p, at, s.S, s.right, damping, 0.0, 0.0, s.via_step, s.band);
    for (int k = at.begin; k < at.end; ++k)
        decrease[k] = expand(p, &s, k, p->gradient, p->gradient_T, 0.0, 1.0 / damping[k], step,
                             p->step_states);
    put_via_steps(p, &s, at, step);
}
