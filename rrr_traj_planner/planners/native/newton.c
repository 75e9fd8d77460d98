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
#include "processor.h"
#include "timing_problem.h"

#include <math.h>
#include <string.h>

#define J 1
#define REAL double
#define FRONT(name) one_##name
#include "riccati.inc"
#undef REAL
#undef FRONT
/* A number of each coordinate, which need not be aligned in memory. */
typedef Lanes Coordinates;
#define REAL Coordinates
#define FRONT(name) each_##name
#include "riccati.inc"
#undef J
#undef REAL
#undef FRONT
#define J 3
#define REAL double
#define FRONT(name) three_##name
#include "riccati.inc"
#undef J
#undef REAL
#undef FRONT

/* With bounds alone the coordinates are coupled through the durations only: `each`. */
static size_t rows_size(const Problem *p)
{
    return bounds_alone(p) ? each_rows_size(p->n)
        : p->J == 1 ? one_rows_size(p->n) : three_rows_size(p->n);
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
        + VECTOR * (P * (4 + 16 + 4 + 4) + (size_t)p->n) + (p->N + 1) * ORDERS * p->J;
}

/* Copy a number of each coordinate, the last one's again where there are fewer. */
INLINE void copy_each(const double *from, int J, Coordinates *to)
{
    double *of = (double *)to;
    for (int k = 0; k < VECTOR; ++k)
        of[k] = from[k < J ? k : J - 1];
}

/* Copy numbers of each coordinate. */
INLINE void copy_back(const Coordinates *from, int count, int J, double *to)
{
    for (int i = 0; i < count; ++i, to += J)
        for (int k = 0; k < MOST_JOINTS; ++k)
            if (k < J)
                to[k] = from[i][k];
}

/* Scratch memory of a step; W = 6 J + 1 unknowns of a condensed segment. */
typedef struct {
    double *S, *right;               /* (N, W, W) and (N, W): the condensed segments */
    double *rows;                    /* of their eliminations */
    Coordinates *z, *Q, *r, *dz, *inner;  /* of a segment whose coordinates are decoupled */
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
    s.z = (Coordinates *)(s.rows + N * rows_size(p));
    s.Q = s.z + 4 * P;
    s.r = s.Q + 16 * P;
    s.dz = s.r + 4 * P;
    s.inner = s.dz + 4 * P;
    s.via_step = (double *)(s.inner + p->n);
    s.band = s.via_step + (N + 1) * ORDERS * p->J;
    return s;
}

/* Condense a segment whose coordinates are coupled through its duration only. */
static int condense_each(const Problem *p, const Scratch *s, int k, double T, const double *z,
                         const double *Q, const double *r, double *S, double *right,
                         double *rows)
{
    enum { BORDER = 2 * ORDERS + 1 };
    const int J = p->J, B = 2 * ORDERS * J, W = B + 1, states = 4 * (2 * p->n + 1);
    Coordinates each[BORDER][BORDER], each_right[BORDER];
    memset(s->Q, 0, 4 * states * sizeof *s->Q);
    for (int i = 0; i < states; ++i) {
        copy_each(z + i * J, J, s->z + i);
        copy_each(r + i * J, J, s->r + i);
        copy_each(Q + i * J, J, s->Q + 4 * i + i % 4);
    }
    if (each_condense(p, k, T, s->z, s->Q, s->r, each[0], each_right, (each_Rows *)rows))
        return 1;
    memset(S, 0, (size_t)W * W * sizeof(double));
    right[B] = 0.0;
    for (int j = 0; j < J; ++j)
        for (int a = 0; a < BORDER; ++a) {
            const int row = a < BORDER - 1 ? a * J + j : B;
            right[row] = (row == B ? right[row] : 0.0) + each_right[a][j];
            for (int b = 0; b < BORDER; ++b)
                S[row * W + (b < BORDER - 1 ? b * J + j : B)] += each[a][b][j];
        }
    return 0;
}

/* Condense segment k to the states at its ends and its duration. Returns 1 where that fails. */
static int condense(const Problem *p, const Scratch *s, int k, const double *z, const double *Q,
                    const double *r, double r_T)
{
    const double T = variables_at(p, p->variables).T[k];
    const int B = 2 * ORDERS * p->J, W = B + 1;
    double *S = s->S + (size_t)k * W * W, *right = s->right + (size_t)k * W;
    double *rows = s->rows + k * rows_size(p);
    const int singular = bounds_alone(p)
        ? condense_each(p, s, k, T, z, Q, r, S, right, rows) : p->J == 1
        ? one_condense(p, k, T, z, Q, r, S, right, (one_Rows *)rows)
        : three_condense(p, k, T, z, Q, r, S, right, (three_Rows *)rows);
    S[B * W + B] += p->hessian_T[k];
    right[B] += r_T + p->weights[k];
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
static void expand_each(const Problem *p, const Scratch *s, int k, double T, const double *z,
                        const double *border, double dT, double part, const double *rows,
                        double *inner, double *dz)
{
    const int J = p->J, n = p->n, states = 4 * (2 * n + 1);
    Coordinates own[2 * ORDERS];
    for (int i = 0; i < 2 * ORDERS; ++i)
        copy_each(border + i * J, J, own + i);
    for (int i = 0; i < states; ++i)
        copy_each(z + i * J, J, s->z + i);
    each_expand(p, k, T, s->z, own, dT, part, (const each_Rows *)rows, s->inner, s->dz);
    copy_back(s->inner, n - 1, J, inner);
    copy_back(s->dz, states, J, dz);
}

/* The steps of a segment's inner jerks and states (P, Z), from those of the via points and of the
 * duration, and the part that is taken of the step with these fixed; returns the predicted
 * decrease. */
static double expand(const Problem *p, const Scratch *s, int k, const double *z, const double *r,
                     double r_T, double dT, double part, Variables step, double *to)
{
    const double T = variables_at(p, p->variables).T[k];
    const int J = p->J;
    const size_t states = points_of(p) * 4 * J;
    const double *border = s->via_step + (size_t)k * ORDERS * J;  /* of both ends in a row */
    const double *rows = s->rows + k * rows_size(p);
    double *inner = step.inner + (size_t)k * (p->n - 1) * J;
    double decrease = -(r_T + p->weights[k]) * dT;
    if (bounds_alone(p))
        expand_each(p, s, k, T, z, border, dT, part, rows, inner, to);
    else if (p->J == 1)
        one_expand(p, k, T, z, border, dT, part, (const one_Rows *)rows, inner, to);
    else
        three_expand(p, k, T, z, border, dT, part, (const three_Rows *)rows, inner, to);
    double sums[VECTOR] = {0.0};  /* states are a multiple */
    for (size_t i = 0; i < states; i += VECTOR)
        for (int c = 0; c < VECTOR; ++c)
            sums[c] += r[i + c] * to[i + c];
    for (int c = 0; c < VECTOR; ++c)
        decrease -= sums[c];
    return decrease;
}

/* The steps of a range's via points and durations, with the common factor's step. */
static void put_steps(const Problem *p, const Scratch *s, Range at, const double *damping,
                      double common, Variables step)
{
    const int J = p->J;
    for (int k = at.begin; k < at.end; ++k)
        step.T[k] = duration_step(p, s, k, s->via_step + (size_t)k * ORDERS * J, common,
                                  damping ? 1.0 / damping[k] : 1.0);
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
    const size_t states = points_of(p) * 4 * p->J;
    double common_hessian = 0.0, common_gradient = 0.0, decrease = 0.0;
    for (int k = 0; k < p->N; ++k) {
        if (condense(p, &s, k, p->states + k * states, Q + k * hessian_size(p), r + k * states,
                     r_T[k]))
            return 1;
        eliminate_duration(p, &s, k, &common_hessian, &common_gradient);
    }
    const double common = solve_via_points(p, all, s.S, s.right, NULL, common_hessian,
                                           common_gradient, s.via_step, s.band);
    put_steps(p, &s, all, NULL, common, step);
    for (int k = 0; k < p->N; ++k)
        decrease += expand(p, &s, k, p->states + k * states, r + k * states, r_T[k], step.T[k],
                           1.0, step, dz + k * states);
    *predicted_decrease = decrease;
    return 0;
}

int condense_segment(const Problem *p, int k, Linearised at)
{
    const Scratch s = scratch_of(p);
    double hessian = 0.0, gradient = 0.0;
    if (condense(p, &s, k, at.z, at.hessian, at.gradient, p->gradient_T[k]))
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

void damped_via_step(const Problem *p, Range at, const double *damping, double *direction)
{
    const Scratch s = scratch_of(p);
    solve_via_points(p, at, s.S, s.right, damping, 0.0, 0.0, s.via_step, s.band);
    put_steps(p, &s, at, damping, 0.0, variables_at(p, direction));
}

double damped_segment_step(const Problem *p, int k, double damping, Linearised at,
                           double *direction, double *dz)
{
    const Scratch s = scratch_of(p);
    const Variables step = variables_at(p, direction);
    return expand(p, &s, k, at.z, at.gradient, p->gradient_T[k], step.T[k], 1.0 / damping, step,
                  dz);
}
