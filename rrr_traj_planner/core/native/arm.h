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

/* An arm of three revolute joints as tables of trigonometric coefficients (core/arm/tables.py):
 * kinematics and dynamics, with their derivatives, of any such arm. */
#ifndef RRR_TRAJ_PLANNER_ARM_H
#define RRR_TRAJ_PLANNER_ARM_H

#include <stdint.h>

/* The coefficients that are not zero. Basis functions of a joint's position q are numbered: 1,
 * cos q, sin q, cos 2 q, sin 2 q. */
typedef struct {
    int32_t tip_count, inertia_count, potential_count;
    const int32_t *tip_at;        /* (tip_count, 4): coordinate; functions of q1, q2, q3 */
    const int32_t *inertia_at;    /* (inertia_count, 3): element of M; functions of q2, q3 */
    const int32_t *potential_at;  /* (potential_count, 3): functions of q1, q2, q3 */
    const double *tip, *inertia, *potential;  /* the coefficients [m], [kg m^2], [J] */
    const double *viscous;        /* (3), friction [N m s/rad] */
} Arm;

/* torque.c: the joint torques x (n, 3) of motions at n states z (n, 12: q, qd, qdd, jerk of each
 * joint), viscous friction included; and with their gradients by z (n, 3, 12), and, added to second
 * (n, 12, 12), the second derivatives of each state's sum of torques times weights (n, 3). */
void torques_at(const Arm *arm, int32_t n, const double *z, double *x);
void torque_derivatives_at(const Arm *arm, int32_t n, const double *z, const double *weights,
                           double *x, double *gradient, double *second);

/* tip.c: the tip's positions (n, 3) at n states; at one, with its Jacobian (coordinate, joint). */
void arm_tip(const Arm *arm, int32_t n, const double *q, double *p);
void tip_and_jacobian(const Arm *arm, const double *q, double *p, double (*J)[3]);

#endif
