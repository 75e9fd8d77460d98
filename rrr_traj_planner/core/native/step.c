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

/* Integration step of the simulated arm between events (core/simulation/time_step.py): Nystrom's
 * method of fourth order for second-order equations, whose two inner stages share one position
 * (Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I, II.14). */
#include "arm.h"
#include "arm_terms.h"

#include "export.h"

#include <math.h>

/* Torques and constraints on the joints until the next event. */
typedef struct {
    double torque[3];       /* constant over the step [N m] */
    double viscous[3];      /* [N m s/rad] */
    double edges[3];        /* where the bumpers begin that joints are in [rad] */
    double stiffness, damping;  /* of the bumpers [N m/rad], [s/rad] */
    int32_t lock[3];        /* not 0 for each joint held at rest; its velocity must be 0 */
    int32_t sides[3];       /* 1 for each joint in its lower bumper, -1 in its upper one */
} Load;

/* For core/simulation/time_step.py, which compares it. */
EXPORTED const int64_t size_of_load = sizeof(Load);

/* The reaction of a bumper compressed by depth, outwards; dissipated receives the power lost (Hunt
 * & Crossley, ASME J. Applied Mechanics 42, 1975). */
EXPORTED double bumper_torque(double stiffness, double damping, double depth, double rate,
                              double *dissipated)
{
    const double spring = stiffness * depth, torque = spring * fmax(1.0 + damping * rate, 0.0);
    *dissipated = (torque - spring) * rate;
    return torque;
}

/* Accelerations a (3) at a state (q, qd), and the power lost (2): in friction, and in bumpers. */
EXPORTED void arm_rates(const Arm *arm, const Load *load, const double *state, double *a,
                        double *lost)
{
    const double *qd = state + 3;
    double elements[ELEMENTS], n[3];
    lost[0] = lost[1] = 0.0;
    arm_inertia_and_bias(arm, 1, state, qd, &elements, n);
    for (int i = 0; i < 3; ++i) {
        n[i] = load->torque[i] - load->viscous[i] * qd[i] - n[i];
        lost[0] += load->viscous[i] * qd[i] * qd[i];
        if (load->sides[i]) {
            double heat;
            n[i] += load->sides[i] * bumper_torque(
                load->stiffness, load->damping, load->sides[i] * (load->edges[i] - state[i]),
                -load->sides[i] * qd[i], &heat);
            lost[1] += heat;
        }
    }
    for (int i = 0; i < 3; ++i)
        if (load->lock[i]) {  /* its row and column are those of the identity */
            for (int j = 0; j < 3; ++j)
                elements[element[i][j]] = i == j;
            n[i] = 0.0;
        }
    solve_symmetric(elements, n, a);
}

/* The state after a time h; adds the energy lost (2) [J]. */
static void nystrom(const Arm *arm, const Load *load, double h, const double *before,
                    double *after, double *lost)
{
    const double half = 0.5 * h, sixth = h / 6.0;
    double a[4][3], power[4][2], stage[6];
    arm_rates(arm, load, before, a[0], power[0]);
    for (int k = 1; k < 4; ++k) {
        const double step = k < 3 ? half : h;
        const double *by = a[k < 3 ? 0 : 2];
        for (int i = 0; i < 3; ++i) {
            stage[i] = before[i] + step * (before[3 + i] + (k < 3 ? 0.5 * half : half) * by[i]);
            stage[3 + i] = before[3 + i] + step * a[k - 1][i];
        }
        arm_rates(arm, load, stage, a[k], power[k]);
    }
    for (int i = 0; i < 3; ++i) {
        const double inner = a[1][i] + a[2][i];
        after[i] = before[i] + h * (before[3 + i] + sixth * (a[0][i] + inner));
        after[3 + i] = before[3 + i] + sixth * (a[0][i] + 2.0 * inner + a[3][i]);
    }
    for (int k = 0; k < 2; ++k)
        lost[k] += sixth * (power[0][k] + 2.0 * (power[1][k] + power[2][k]) + power[3][k]);
}

/* The state after a time h, in equal steps no longer than the longest, and the energy lost (2) [J].
 */
EXPORTED void arm_step(const Arm *arm, const Load *load, double h, double longest,
                       const double *before, double *after, double *lost)
{
    const int steps = h > longest ? (int)ceil(h / longest) : 1;
    double state[6];
    memcpy(after, before, sizeof state);
    lost[0] = lost[1] = 0.0;
    if (load->lock[0] && load->lock[1] && load->lock[2])
        return;
    for (int k = 0; k < steps; ++k) {
        memcpy(state, after, sizeof state);
        nystrom(arm, load, h / steps, state, after, lost);
    }
}
