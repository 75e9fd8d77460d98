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

/* All joint positions that bring the tip of any arm of three revolute joints to a point (Pieper,
 * The kinematics of manipulators under computer control, 1968).
 *
 * Of the tip x turned about axis 3 alone, u, v, k are the components along n, z2 x n and z2 from
 * c2, and Q = u^2 + v^2 + k^2; of the point p, h is the height along axis 1 above c1 and R the
 * distance from c1. Joint 2 turns u, v into u', v', and joint 1 turns X = a + u', Y = c v' - s k
 * into the point's components along n and m; so
 *
 *     v' = (h - c k) / s,   2 a u' = R^2 - Q - a^2 = D,   u'^2 + v'^2 = Q - k^2
 *
 * and without u', v' a condition on q3: s^2 D^2 + 4 a^2 (h - c k)^2 = 4 a^2 s^2 (Q - k^2), of
 * degree 2 in cos q3, sin q3. Where the axes meet (a = 0) it is D = 0, and both signs of u' are
 * right. */
#include "inverse.h"

#include "export.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

/* For core/kinematics/common_normal.py, which compares it. */
EXPORTED const int64_t size_of_common_normal = sizeof(CommonNormal);

enum { MOST = 4, ITERATIONS = 60, MORE_ITERATIONS = 300 };

static const double PI = 3.14159265358979323846;
static const double MEETING = 1e-10;  /* a in sizes, up to which the axes meet */
static const double ALMOST_MEETING = 1e-4; /* and for a first attempt */
static const double NEAR = 1e-3;      /* and up to which D / (2 a) does not tell the sign of u' */
static const double OFF_CIRCLE = 0.05; /* |r - 1| of roots that may be real but for rounding */
static const double OUTSIDE = 0.01;   /* squared, in sizes: by which Y may exceed the radius */
static const double ROUNDING = 1e-14; /* of a position, in sizes */
static const double ON_AXIS_2 = 5e-8; /* distance in sizes, up to which q2 is arbitrary: that of a
                                         double root, which is known to half the digits */
static const double SAME = 1e-9;      /* rad, of solutions that are one */
static const double SAME_ORDER = 1e-7; /* rad, of positions that do not decide on the order */

/* A point, relative to c1. */
typedef struct {
    double along_n, along_m, h, radius2, R2;  /* radius: distance from axis 1 */
    bool on_axis;
} Point;

/* The solutions found of one point. */
typedef struct {
    const double *p;
    double (*q)[3], error[MOST], tolerance, miss;
    int count;
} Found;

static double wrapped(double angle)
{
    return angle - 2.0 * PI * ceil((angle - PI) / (2.0 * PI));
}

static Point relative(const CommonNormal *g, const double *p)
{
    double d[3], parts[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < 3; ++i) {
        d[i] = p[i] - g->c1[i];
        parts[0] += d[i] * g->n[i], parts[1] += d[i] * g->m[i], parts[2] += d[i] * g->z[i];
    }
    const double radius2 = parts[0] * parts[0] + parts[1] * parts[1];
    return (Point){parts[0], parts[1], parts[2], radius2, radius2 + parts[2] * parts[2], false};
}

/* The condition on q3, by coefficients of 1, cos, sin, cos 2, sin 2; all in sizes. */
static void condition(const CommonNormal *g, const Point *t, double *f)
{
    const double l = 1.0 / g->size, a2 = 4.0 * g->a * g->a * l * l, s2 = g->s * g->s;
    double D[3], w[3], k[3];
    for (int i = 0; i < 3; ++i) {
        D[i] = -g->Q[i] * l * l, w[i] = -g->c * g->k[i] * l, k[i] = g->k[i] * l;
        f[i] = -a2 * s2 * g->Q[i] * l * l;
    }
    D[0] += t->R2 * l * l - 0.25 * a2, w[0] += t->h * l;
    f[3] = f[4] = 0.0;
    const double *squares[3] = {D, w, k}, factor[3] = {s2, a2, a2 * s2};
    for (int i = 0; i < 3; ++i) {
        const double *x = squares[i], y = factor[i];
        f[0] += y * (x[0] * x[0] + 0.5 * (x[1] * x[1] + x[2] * x[2]));
        f[1] += 2.0 * y * x[0] * x[1], f[2] += 2.0 * y * x[0] * x[2];
        f[3] += 0.5 * y * (x[1] * x[1] - x[2] * x[2]), f[4] += y * x[1] * x[2];
    }
}

/* Joint positions for q3; sign: of X, or 0 where D decides. Angles that are arbitrary are those of
 * the positions before. Returns whether they may bring the tip to the point. */
static bool start_at(const CommonNormal *g, const Point *t, double q3, int sign,
                     const double *before, double *q)
{
    const double u = at_angle(g->u, q3), v = at_angle(g->v, q3), k = at_angle(g->k, q3);
    const double v_turned = (t->h - g->c * k) / g->s, Y = g->c * v_turned - g->s * k;
    const double X = sign ? sign * sqrt(fmax(0.0, t->radius2 - Y * Y))
        : g->a + (t->R2 - at_angle(g->Q, q3) - g->a * g->a) / (2.0 * g->a);
    q[0] = t->on_axis ? before[0] : atan2(t->along_m, t->along_n) - atan2(Y, X);
    q[1] = hypot(u, v) <= ON_AXIS_2 * g->size ? before[1]
        : atan2(v_turned, X - g->a) - atan2(v, u);
    q[2] = q3;
    return Y * Y <= t->radius2 + OUTSIDE * g->size * g->size;
}

/* Whether two solutions are one: equal, or so near to each other at a singularity that between
 * them the tip stays at the point within their errors and rounding. */
static bool same(const Arm *arm, double size, const Found *found, int i, const double *q,
                 double error)
{
    double middle[3], tip[3], largest = 0.0, away = 0.0;
    for (int j = 0; j < 3; ++j) {
        const double difference = wrapped(q[j] - found->q[i][j]);
        middle[j] = found->q[i][j] + 0.5 * difference;
        largest = fmax(largest, fabs(difference));
    }
    if (largest <= SAME)
        return true;
    arm_tip(arm, 1, middle, tip);
    for (int j = 0; j < 3; ++j)
        away = fmax(away, fabs(tip[j] - found->p[j]));
    return away <= ROUNDING * size + 2.0 * fmax(error, found->error[i]);
}

static bool before_in_order(const double *a, const double *b)
{
    for (int j = 0; j < 3; ++j)
        if (fabs(a[j] - b[j]) > SAME_ORDER)
            return a[j] < b[j];
    return false;
}

static void put(Found *found, int at, const double *q, double error)
{
    memcpy(found->q[at], q, sizeof *found->q);
    found->error[at] = error;
}

/* Add what a start leads to, in order, unless it misses the point. Of solutions that are one, that
 * with the smaller error remains. */
static void add(const Arm *arm, const CommonNormal *g, int iterations, double *q, Found *found)
{
    const double error = polish(arm, g->size, found->p, iterations, q);
    int other = 0, at;
    found->miss = fmin(found->miss, error);
    if (!(error <= found->tolerance))  /* nor where a huge point makes it NaN */
        return;
    for (int j = 0; j < 3; ++j)
        q[j] = wrapped(q[j]);
    while (other < found->count && !same(arm, g->size, found, other, q, error))
        ++other;
    if (other == MOST || (other < found->count && found->error[other] <= error))
        return;
    found->count += other == found->count;
    for (at = other; at + 1 < found->count; ++at)  /* close the gap of the other */
        put(found, at, found->q[at + 1], found->error[at + 1]);
    for (; at > 0 && before_in_order(q, found->q[at - 1]); --at)
        put(found, at, found->q[at - 1], found->error[at - 1]);
    put(found, at, q, error);
}

/* Try roots of a condition on q3: those that may be real, or the others. */
static void try_roots(const Arm *arm, const CommonNormal *g, const Point *t, const double *before,
                      const double *f, bool real, Found *found)
{
    double q3[MOST] = {before[2]}, off[MOST] = {0.0}, q[3];
    const int roots = circle_roots(f, q3, off), both = fabs(g->a) <= NEAR * g->size;
    for (int i = 0; i < (roots ? roots : 1); ++i)  /* without roots, q3 is arbitrary */
        for (int sign = both ? -1 : 0; sign <= both; sign += 2) {
            const bool may_reach = start_at(g, t, q3[i], sign, before, q);
            if ((may_reach && off[i] <= OFF_CIRCLE) == real && found->count < MOST)
                add(arm, g, real ? ITERATIONS : MORE_ITERATIONS, q, found);
        }
}

/* All solutions for one point. Axes that meet but for rounding are first taken to meet. */
static void solve(const Arm *arm, const CommonNormal *g, const Point *t, const double *before,
                  Found *found)
{
    double f[5] = {t->R2 - g->Q[0], -g->Q[1], -g->Q[2], 0.0, 0.0};
    const double a = fabs(g->a) / g->size;
    if (a <= ALMOST_MEETING)
        try_roots(arm, g, t, before, f, true, found);
    if (a > MEETING && found->count < MOST) {
        condition(g, t, f);
        try_roots(arm, g, t, before, f, true, found);
    }
    if (found->count % 2 || found->count == 0)  /* solutions come in pairs, or one is double */
        try_roots(arm, g, t, before, f, false, found);
}

/* Joint positions q (n, 4, 3), each in (-pi, pi], that bring the tip within tolerance [m] of the
 * points p (n, 3), count (n) of each; of the others miss (n): the tip's least distance [m].
 * A point within on_axis [m] of axis 1 is taken as on it. before (3): for arbitrary angles. */
EXPORTED void arm_inverse(const Arm *arm, const CommonNormal *g, int32_t n, const double *p,
                          const double *before, double tolerance, double on_axis,
                          double (*q)[MOST][3], int32_t *count, double *miss)
{
    for (int i = 0; i < n; ++i, p += 3) {
        double target[3];
        Point t = relative(g, p);
        memcpy(target, p, sizeof target);
        if (sqrt(t.radius2) <= on_axis) {
            for (int j = 0; j < 3; ++j)
                target[j] = g->c1[j] + t.h * g->z[j];
            t = (Point){0.0, 0.0, t.h, 0.0, t.h * t.h, true};
        }
        Found found = {target, q[i], {0.0}, tolerance, INFINITY, 0};
        solve(arm, g, &t, before, &found);
        const double parts[3] = {t.along_n, t.along_m, t.h};
        count[i] = found.count;
        miss[i] = found.count ? 0.0 : fmin(
            found.miss, distance_out_of_reach(arm, g, target, parts, MORE_ITERATIONS));
    }
}
