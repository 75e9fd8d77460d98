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

/* Joint velocity, acceleration, jerk and torque as functions of position, speed, acceleration and
 * jerk along a path (path_timing/constraints.py), with first and second derivatives. */
#include "timing_problem.h"
#include "path_table.h"

/* Those limited: 12 of the joints (joint_quantities), then the tip's speed and acceleration. */
enum { SPEED = 12, ALONG, QUANTITIES };

/* Last intervals of a segment in which a controller's quintic may overshoot a step at its end. */
enum { OVERSHOOTING = 2 };

static int is_near_end(int point, int n)
{
    const int last = point <= n ? n : 2 * n;  /* node, or middle between two */
    return point > last - OVERSHOOTING;
}

/* Columns of the table at position s of a segment, and their derivatives by s up to an order. */
static void table_at(const Problem *p, int segment, int point, double s, int order,
                     double found[3][KINDS][3])
{
    const double begin = p->points[segment], length = p->points[segment + 1] - begin;
    double x;
    size_t stride;
    const double *c3 = path_interval(p->table + (size_t)segment * 4 * p->intervals * COLUMNS,
                                     p->intervals, (s - begin) / length, &stride, &x);
    const double *c2 = c3 + stride, *c1 = c2 + stride;
    const double per = 1.0 / length;
    double *first = &found[1][0][0], *second = &found[2][0][0];
    path_columns(c3, stride, x, &found[0][0][0]);
    if (order > 0)
        for (int k = 0; k < COLUMNS; ++k)
            first[k] = ((3.0 * c3[k] * x + 2.0 * c2[k]) * x + c1[k]) * per;
    if (order > 1)
        for (int k = 0; k < COLUMNS; ++k)
            second[k] = (6.0 * c3[k] * x + 2.0 * c2[k]) * per * per;
    if (is_near_end(point, p->n)) {
        const double *more = p->overshoot + 6 * (size_t)segment;
        for (int j = 0; j < 3; ++j)
            found[0][DDQ][j] += more[j], found[0][C][j] += more[3 + j];
    }
}

/* Gradients of a joint's velocity, acceleration, jerk and torque by the state, each 12 apart. */
static void joint_gradients(const double (*d)[3], const double (*s)[3], int j, double viscous,
                            const double *z, double *g)
{
    const double v = z[1], a = z[2], jerk = z[3];
    g[0] = s[DQ][j] * v, g[1] = d[DQ][j], g[2] = 0.0, g[3] = 0.0;
    g += 12;
    g[0] = s[DDQ][j] * v * v + s[DQ][j] * a, g[1] = 2.0 * d[DDQ][j] * v, g[2] = d[DQ][j];
    g[3] = 0.0;
    g += 12;
    g[0] = s[DDDQ][j] * v * v * v + 3.0 * s[DDQ][j] * v * a + s[DQ][j] * jerk;
    g[1] = 3.0 * d[DDDQ][j] * v * v + 3.0 * d[DDQ][j] * a, g[2] = 3.0 * d[DDQ][j] * v;
    g[3] = d[DQ][j];
    g += 12;
    g[0] = s[M][j] * a + s[C][j] * v * v + s[G][j] + viscous * s[DQ][j] * v;
    g[1] = 2.0 * d[C][j] * v + viscous * d[DQ][j];
    g[2] = d[M][j], g[3] = 0.0;
}

/* Add the Hessian (4, 4) of the weighted sum of a joint's four quantities. */
static void add_joint_hessian(const double (*d)[3], const double (*s)[3], const double (*ss)[3],
                              int j, double viscous, const double *z, const double *weights,
                              double *second)
{
    const double v = z[1], a = z[2], jerk = z[3];
    const double lv = weights[j], la = weights[3 + j], lj = weights[6 + j], lt = weights[9 + j];
    const double H00 = lv * ss[DQ][j] * v + la * (ss[DDQ][j] * v * v + ss[DQ][j] * a)
        + lj * (ss[DDDQ][j] * v * v * v + 3.0 * ss[DDQ][j] * v * a + ss[DQ][j] * jerk)
        + lt * (ss[M][j] * a + ss[C][j] * v * v + ss[G][j] + viscous * ss[DQ][j] * v);
    const double H01 = (lv + lt * viscous) * s[DQ][j] + 2.0 * v * (la * s[DDQ][j] + lt * s[C][j])
        + 3.0 * lj * (s[DDDQ][j] * v * v + s[DDQ][j] * a);
    const double H02 = la * s[DQ][j] + 3.0 * lj * s[DDQ][j] * v + lt * s[M][j];
    const double H03 = lj * s[DQ][j];
    const double H11 = 2.0 * la * d[DDQ][j] + 6.0 * lj * d[DDDQ][j] * v + 2.0 * lt * d[C][j];
    const double H12 = 3.0 * lj * d[DDQ][j];
    second[0] += H00, second[5] += H11;
    second[1] += H01, second[4] += H01;
    second[2] += H02, second[8] += H02;
    second[3] += H03, second[12] += H03;
    second[6] += H12, second[9] += H12;
}

void path_at(const Problem *p, int segment, int point, const double *z, double *x,
             double *gradient, const double *weights, double *second)
{
    double found[3][KINDS][3];
    table_at(p, segment, point, z[0], second ? 2 : gradient ? 1 : 0, found);
    const double (*d)[3] = (const double (*)[3])found[0], (*s)[3] = (const double (*)[3])found[1],
        (*ss)[3] = (const double (*)[3])found[2];
    if (x)
        joint_quantities(d, p->viscous, z[1], z[2], z[3], x);
    for (int j = 0; gradient && j < 3; ++j)
        joint_gradients(d, s, j, p->viscous[j], z, gradient + 4 * j);
    for (int j = 0; second && j < 3; ++j)
        add_joint_hessian(d, s, ss, j, p->viscous[j], z, weights, second);
}

/* The limited quantities x (N, samples, QUANTITIES), and gravity's torque (N, samples, 3), at
 * states z (N, samples, 4); at_points: whether the samples are the problem's points
 * (path_timing/constraints.py). */
EXPORTED void path_quantities(const Problem *p, int32_t samples, int32_t at_points,
                              const double *z, double *x, double *gravity)
{
    for (int k = 0; k < p->N; ++k)
        for (int i = 0; i < samples; ++i, z += 4, x += QUANTITIES, gravity += 3) {
            double found[3][KINDS][3];
            const double (*d)[3] = (const double (*)[3])found[0];
            table_at(p, k, at_points ? i : -1, z[0], 0, found);
            joint_quantities(d, p->viscous, z[1], z[2], z[3], x);
            x[SPEED] = z[1], x[ALONG] = z[2];
            for (int j = 0; j < 3; ++j)
                gravity[j] = d[G][j];
        }
}
