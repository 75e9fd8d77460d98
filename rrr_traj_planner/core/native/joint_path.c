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

/* Joint positions along a path of the tip, by Newton's method from near ones, with their
 * derivatives by arc length.
 *
 * With J the tip's Jacobian and p its position, differentiating p(s) = tip(q(s)) gives J q' = p',
 * J q'' = p'' - H(q', q') and J q''' = p''' - 3 H(q', q'') - T(q', q', q'), with H and T the second
 * and third derivatives of the tip. Where the path is in a plane through joint axis 1, joint 1
 * stands still: its column of J is the plane's normal instead, which is regular on the axis too. */
#include "arm.h"
#include "tip.h"
#include "export.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

enum { STEPS = 30 };  /* of Newton's method */

/* After a step this short the next one is rounding: convergence is quadratic [rad]. */
#define SHORT_STEP 1e-8

/* A solution nearer than this is that of the same branch; a longer way is another one [rad]. */
#define FARTHEST 0.7

static void cross(const double *a, const double *b, double *c)
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Distance of the tip from a plane through joint axis 1 up to which it is in it: rounding [m]. */
#define OFF_PLANE 1e-8

/* The equations J x = b by the columns of J (Cramer's rule). */
typedef struct {
    Vector column[3], cofactor[3];
    double determinant;
} Linear;

static void set_linear(Linear *J, const double (*columns)[3], const double *normal)
{
    memcpy(J->column, columns, sizeof J->column);
    if (normal)
        memcpy(J->column[0], normal, sizeof *J->column);
    for (int i = 0; i < 3; ++i)
        cross(J->column[(i + 1) % 3], J->column[(i + 2) % 3], J->cofactor[i]);
    J->determinant = dot(J->column[0], J->cofactor[0]);
}

static void solve_linear(const Linear *J, const double *b, double *x, int fixed)
{
    for (int i = 0; i < 3; ++i)
        x[i] = dot(J->cofactor[i], b) / J->determinant;
    if (fixed)
        x[0] = 0.0;
}

/* The plane's normal at a point; NULL where it is in none. */
static const double *plane_at(const Vector *normals, int n)
{
    return normals && isfinite(normals[n][0]) ? normals[n] : NULL;
}

/* Newton's method from q; whether it converges, near where it began. */
static int newton(const Arm *arm, const double *p, const double *normal, double *q)
{
    Vector tip, rows[3], step, began;
    Linear J;
    memcpy(began, q, sizeof began);
    for (int k = 0; k < STEPS; ++k) {
        tip_and_jacobian(arm, q, tip, rows);
        const Vector columns[3] = {{rows[0][0], rows[1][0], rows[2][0]},
                                   {rows[0][1], rows[1][1], rows[2][1]},
                                   {rows[0][2], rows[1][2], rows[2][2]}};
        set_linear(&J, columns, normal);
        const Vector gap = {p[0] - tip[0], p[1] - tip[1], p[2] - tip[2]};
        if (normal && fabs(dot(gap, normal)) > OFF_PLANE)
            return 0;
        solve_linear(&J, gap, step, normal != NULL);
        double longest = 0.0, farthest = 0.0;
        for (int j = 0; j < 3; ++j) {
            q[j] += step[j];
            longest = fmax(longest, fabs(step[j]));
            farthest = fmax(farthest, fabs(q[j] - began[j]));
        }
        if (!(farthest <= FARTHEST))  /* or not a number */
            return 0;
        if (longest <= SHORT_STEP)
            return 1;
    }
    return 0;
}

/* H(u, v), and T(u, u, u). */
static void second_along(const Vector *x, const double *u, const double *v, double *h)
{
    memset(h, 0, sizeof(Vector));
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int c = 0; c < 3; ++c)
                h[c] += x[second_by[i][j]][c] * u[i] * v[j];
}

/* Columns of the derivatives of J along the path: first and second. */
static void column_rates(const Vector *x, const double *u, const double *v, Vector *first,
                         Vector *second)
{
    memset(first, 0, 3 * sizeof *first), memset(second, 0, 3 * sizeof *second);
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i)
            for (int c = 0; c < 3; ++c) {
                first[k][c] += x[second_by[k][i]][c] * u[i];
                second[k][c] += x[second_by[k][i]][c] * v[i];
                for (int j = 0; j < 3; ++j)
                    second[k][c] += x[third_by[k][i][j]][c] * u[i] * u[j];
            }
}

static double volume(const double *a, const double *b, const double *c)
{
    Vector n;
    cross(b, c, n);
    return dot(a, n);
}

/* How far from singular: det J with two derivatives by arc length, and 1 / |J^-1| (Frobenius's
 * norm), a lower bound on the least singular value. */
enum { DETERMINANT, FIRST, SECOND, SINGULAR_VALUE, REGULARITY };

static void regularity(const Linear *J, const Vector *x, const double *u, const double *v,
                       int fixed, double *to)
{
    Vector a[3], b[3];
    column_rates(x, u, v, a, b);
    if (fixed)
        memset(a[0], 0, sizeof *a), memset(b[0], 0, sizeof *b);
    const Vector *c = J->column;
    to[DETERMINANT] = J->determinant;
    to[FIRST] = volume(a[0], c[1], c[2]) + volume(c[0], a[1], c[2]) + volume(c[0], c[1], a[2]);
    to[SECOND] = volume(b[0], c[1], c[2]) + volume(c[0], b[1], c[2]) + volume(c[0], c[1], b[2])
        + 2.0 * (volume(a[0], a[1], c[2]) + volume(a[0], c[1], a[2]) + volume(c[0], a[1], a[2]));
    double squares = 0.0;
    for (int i = 0; i < 3; ++i)
        squares += dot(J->cofactor[i], J->cofactor[i]);
    to[SINGULAR_VALUE] = fabs(J->determinant) / sqrt(squares);
}

/* Of the path: position and three derivatives by arc length, each (n, 3). */
typedef struct {
    const Vector *p, *dp, *ddp, *dddp, *normals;
} Path;

/* Joint derivatives d (3) by arc length at q, and how far from singular it is, which may be NULL. */
static void derivatives(const Arm *arm, const Path *path, int n, const double *q, Vector *d,
                        double *regular)
{
    const double *normal = plane_at(path->normals, n);
    const int fixed = normal != NULL;
    Vector x[ORDERS], h, right;
    Linear J;
    tip_derivatives(arm, q, 3, x);
    set_linear(&J, (const Vector *)x + 1, normal);
    solve_linear(&J, path->dp[n], d[0], fixed);
    second_along((const Vector *)x, d[0], d[0], h);
    for (int c = 0; c < 3; ++c)
        right[c] = path->ddp[n][c] - h[c];
    solve_linear(&J, right, d[1], fixed);
    second_along((const Vector *)x, d[0], d[1], h);
    for (int c = 0; c < 3; ++c) {
        right[c] = path->dddp[n][c] - 3.0 * h[c];
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                for (int k = 0; k < 3; ++k)
                    right[c] -= x[third_by[i][j][k]][c] * d[0][i] * d[0][j] * d[0][k];
    }
    solve_linear(&J, right, d[2], fixed);
    if (regular)
        regularity(&J, (const Vector *)x, d[0], d[1], fixed, regular);
}

/* Joint positions q (n, 3), given near, at n points of a path (4, n, 3); their derivatives d
 * (n, 3, 3): order, joint; how far from singular they are (n, 4). normals (n, 3): of the plane
 * through joint axis 1 in which the path is, NaN where it is in none; may be NULL. Returns the
 * number of points up to the first without solution. */
EXPORTED int32_t arm_joint_path(const Arm *arm, int32_t n, const double *points,
                                const double *normals, double *q, double *d, double *regular)
{
    const Vector *p = (const Vector *)points;
    const Path path = {p, p + n, p + 2 * n, p + 3 * n, (const Vector *)normals};
    for (int k = 0; k < n; ++k) {
        if (!newton(arm, path.p[k], plane_at(path.normals, k), q + 3 * k))
            return k;
        derivatives(arm, &path, k, q + 3 * k, (Vector *)(d + 9 * k), regular + REGULARITY * k);
    }
    return n;
}

/* Follow a path from q at its first point through n points at arc lengths s: from each, a Taylor
 * polynomial predicts the next. after and before: the path (4, n, 3) and normals (n, 3) as it
 * leaves and as it reaches each point; d: derivatives (2, n, 3, 3) and regular (2, n, 4) likewise;
 * error (n - 1): of the predictions [rad]. Returns the number of points up to the first that is
 * not reached, or at which det J has changed its sign. */
EXPORTED int32_t arm_follow_path(const Arm *arm, int32_t n, const double *s, const double *after,
                                 const double *after_normals, const double *before,
                                 const double *before_normals, double *q, double *d,
                                 double *regular, double *error)
{
    const Vector *a = (const Vector *)after, *b = (const Vector *)before;
    const Path leaving = {a, a + n, a + 2 * n, a + 3 * n, (const Vector *)after_normals};
    const Path reaching = {b, b + n, b + 2 * n, b + 3 * n, (const Vector *)before_normals};
    double *to = q, *d_before = d + 9 * n, *regular_before = regular + REGULARITY * n;
    if (!newton(arm, leaving.p[0], plane_at(leaving.normals, 0), q))
        return 0;
    derivatives(arm, &leaving, 0, q, (Vector *)d, regular);
    memcpy(d_before, d, 9 * sizeof *d), memcpy(regular_before, regular, REGULARITY * sizeof *d);
    for (int k = 0; k + 1 < n; ++k, to += 3) {
        const double h = s[k + 1] - s[k];
        const double *rate = d + 9 * k;
        Vector guess;
        for (int j = 0; j < 3; ++j)
            guess[j] = to[j] + h * (rate[j] + h * (0.5 * rate[3 + j] + h * rate[6 + j] / 6.0));
        memcpy(to + 3, guess, sizeof guess);
        if (!newton(arm, reaching.p[k + 1], plane_at(reaching.normals, k + 1), to + 3))
            return k + 1;
        error[k] = 0.0;
        for (int j = 0; j < 3; ++j)
            error[k] = fmax(error[k], fabs(to[3 + j] - guess[j]));
        derivatives(arm, &reaching, k + 1, to + 3, (Vector *)(d_before + 9 * (k + 1)),
                    regular_before + REGULARITY * (k + 1));
        derivatives(arm, &leaving, k + 1, to + 3, (Vector *)(d + 9 * (k + 1)),
                    regular + REGULARITY * (k + 1));
        if (regular_before[REGULARITY * (k + 1)] * regular[REGULARITY * k] <= 0.0)
            return k + 1;
    }
    return n;
}
