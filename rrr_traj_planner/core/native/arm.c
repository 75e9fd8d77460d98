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

/* Dynamics of an arm from its tables. The inertia matrix M depends on q2 and q3 alone; with M_k its
 * partial derivatives (M_1 = 0) and V the potential energy, the torque of joint i is
 *
 *     (M qdd)_i + sum_k qd_k (M_k qd)_i - qd' M_i qd / 2 + dV/dq_i
 *
 * (Lagrange's equations: Lynch & Park, Modern Robotics, 2017, 8.1). */
#include "arm.h"
#include "arm_terms.h"

#include "export.h"

#include <stddef.h>

/* For core/arm/compiled_arm.py, which compares it. */
EXPORTED const int64_t size_of_arm = sizeof(Arm);

/* M (n, 6) and the torques of velocity and gravity (n, 3), at n states. */
EXPORTED void arm_inertia_and_bias(const Arm *arm, int32_t n, const double *q, const double *qd,
                                   double (*M)[ELEMENTS], double *bias)
{
    for (int s = 0; s < n; ++s, q += 3, qd += 3, bias += 3) {
        Basis by[3];
        double all[ORDERS_1][ELEMENTS];
        Gravity g;
        bases(q, 1, by);
        inertia_derivatives(arm, by, 1, all);
        gravity_derivatives(arm, by, 1, &g);
        coriolis((const double (*)[ELEMENTS])all + 1, qd, bias);
        memcpy(M[s], all[0], sizeof all[0]);
        for (int i = 0; i < 3; ++i)
            bias[i] += g.first[i];
    }
}

/* Joint torques (n, 3) of n states of motion, without friction. */
EXPORTED void arm_inverse_dynamics(const Arm *arm, int32_t n, const double *q, const double *qd,
                                   const double *qdd, double *torque)
{
    for (int s = 0; s < n; ++s, q += 3, qd += 3, qdd += 3, torque += 3) {
        double M[ELEMENTS], bias[3];
        arm_inertia_and_bias(arm, 1, q, qd, &M, bias);
        times(M, qdd, torque);
        for (int i = 0; i < 3; ++i)
            torque[i] += bias[i];
    }
}

/* The torques (n, 3) that hold the arm at rest. */
EXPORTED void arm_gravity_torque(const Arm *arm, int32_t n, const double *q, double *torque)
{
    for (int s = 0; s < n; ++s, q += 3, torque += 3) {
        Basis by[3];
        Gravity g;
        bases(q, 1, by);
        gravity_derivatives(arm, by, 1, &g);
        memcpy(torque, g.first, sizeof g.first);
    }
}

/* Potential energies (n). */
EXPORTED void arm_potential_energy(const Arm *arm, int32_t n, const double *q, double *energy)
{
    for (int s = 0; s < n; ++s, q += 3) {
        Basis by[3];
        bases(q, 0, by);
        energy[s] = 0.0;
        for (int k = 0; k < arm->potential_count; ++k) {
            const int32_t *at = arm->potential_at + 3 * k;
            energy[s] += arm->potential[k] * by[0].d[0][at[0]] * by[1].d[0][at[1]]
                * by[2].d[0][at[2]];
        }
    }
}

/* Terms of the torque along a path with joint derivatives dq and ddq by its length, at n points:
 * inertia (n, 3) times tip acceleration, plus centripetal (n, 3) times squared tip speed, plus
 * gravity (n, 3) (Bobrow, Dubowsky & Gibson 1985). */
EXPORTED void arm_path_terms(const Arm *arm, int32_t n, const double *q, const double *dq,
                             const double *ddq, double *inertia, double *centripetal,
                             double *gravity)
{
    for (int s = 0; s < 3 * n; s += 3) {
        Basis by[3];
        double M[ORDERS_1][ELEMENTS], product[3], velocity[3];
        Gravity g;
        bases(q + s, 1, by);
        inertia_derivatives(arm, by, 1, M);
        gravity_derivatives(arm, by, 1, &g);
        coriolis((const double (*)[ELEMENTS])M + 1, dq + s, velocity);
        times(M[0], dq + s, inertia + s);
        times(M[0], ddq + s, product);
        memcpy(gravity + s, g.first, sizeof g.first);
        for (int i = 0; i < 3; ++i)
            centripetal[s + i] = product[i] + velocity[i];
    }
}
