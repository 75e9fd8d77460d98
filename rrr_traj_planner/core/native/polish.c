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

/* Newton's method on the tip's position, damped (Levenberg & Marquardt): also where the Jacobian is
 * singular, and where no joint positions reach the point. */
#include "arm_terms.h"
#include "inverse.h"

#include <float.h>
#include <stdbool.h>

static const double LEAST_DAMPING = 1e-15; /* of the squared size: rounding of J'J */
static const double NOISE = 1e-14;         /* of the size, in the tip's position */
static const double LEAST_STEP = 1e-13;    /* rad, that a search for a minimum ends with */

/* The point less the tip's position; returns its length. */
static double error_at(const Arm *arm, const double *p, const double *q, double *error)
{
    arm_tip(arm, 1, q, error);
    for (int i = 0; i < 3; ++i)
        error[i] = p[i] - error[i];
    return sqrt(dot(error, error));
}

/* The step d of (J'J + damping) d = J' error. */
static void damped_step(const Arm *arm, const double *q, const double *error, double damping,
                        double *d)
{
    double J[9], JJ[ELEMENTS], b[3];
    arm_jacobian(arm, 1, q, J);
    for (int i = 0; i < 3; ++i) {
        b[i] = J[i] * error[0] + J[3 + i] * error[1] + J[6 + i] * error[2];
        for (int j = i; j < 3; ++j)
            JJ[element[i][j]] = J[i] * J[j] + J[3 + i] * J[3 + j] + J[6 + i] * J[6 + j]
                + (i == j ? damping : 0.0);
    }
    solve_symmetric(JJ, b, d);
}

/* damping: in parts of the squared error, so that the iteration converges as Newton's. */
double polish(const Arm *arm, double size, const double *p, int iterations, double *q)
{
    double error[3], relative = 1e-3, length = error_at(arm, p, q, error);
    for (int n = 0; n < iterations && length > 2.0 * DBL_EPSILON * size; ++n) {
        double d[3], next[3], next_error[3];
        damped_step(arm, q, error, relative * length * length + LEAST_DAMPING * size * size, d);
        for (int i = 0; i < 3; ++i)
            next[i] = q[i] + d[i];
        const double next_length = error_at(arm, p, next, next_error);
        const bool small = fmax(fabs(d[0]), fmax(fabs(d[1]), fabs(d[2]))) <= LEAST_STEP;
        if (next_length < length) {
            memcpy(q, next, sizeof next), memcpy(error, next_error, sizeof next_error);
            length = next_length, relative = fmax(0.1 * relative, 1e-6);
        } else if (length <= NOISE * size) {
            break;
        } else {
            relative = fmax(8.0 * relative, 1e-3);
        }
        if (small)
            break;
    }
    return length;
}
