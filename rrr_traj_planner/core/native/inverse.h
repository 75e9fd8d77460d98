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

/* All joint positions that bring an arm's tip to a point: what its parts share. */
#ifndef RRR_TRAJ_PLANNER_INVERSE_H
#define RRR_TRAJ_PLANNER_INVERSE_H

#include "arm.h"

#include <math.h>

/* Joint axes 1 and 2 with their common normal from c1 on axis 1 to c2 on axis 2, and the tip x as
 * joint 3 turns, the others at zero, by coefficients of 1, cos q3, sin q3. Lengths in m. */
typedef struct {
    double size;             /* no tip is further from axis 1 [m] */
    double a, c, s;          /* c2 - c1 = a n; cosine and sine (> 0) of the angle of the axes */
    double c1[3];            /* [m] */
    double n[3], m[3], z[3]; /* unit vectors: z along axis 1, n = z x z2 / s, m = z x n */
    double u[3], v[3], k[3]; /* components of x - c2 along n, z2 x n and z2 */
    double Q[3];             /* |x - c2|^2 [m^2] */
} CommonNormal;

/* A trigonometric polynomial of degree 1 at an angle. */
static inline double at_angle(const double *f, double angle)
{
    return f[0] + f[1] * cos(angle) + f[2] * sin(angle);
}

/* circle_roots.c: of a real trigonometric polynomial f of degree 2 (coefficients of 1, cos, sin,
 * cos 2, sin 2) the complex roots z = r exp(i angle): their number, angles (4) and off = |r - 1|
 * (4), 0 for real roots. Others come in pairs r, 1 / r of one angle: those with r > 1 are given. */
int circle_roots(const double *f, double *angle, double *off);

/* polish.c: moves joint positions q to where the tip is nearest to p, a local minimum; returns its
 * distance [m]. size: of the arm [m]. */
double polish(const Arm *arm, double size, const double *p, int iterations, double *q);

/* nearest_point.c: the distance from a point p to the nearest one that the tip reaches [m]. parts:
 * the point's components from c1 along n, m and z [m]. */
double distance_out_of_reach(const Arm *arm, const CommonNormal *g, const double *p,
                             const double *parts, int iterations);

#endif
