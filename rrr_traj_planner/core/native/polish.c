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
static const double LEAST_STEP = 1e-9;     /* rad, the last: errors are of its square */

/* A state, and the point less the tip's position there. */
typedef struct {
    double q[3], error[3], length, J[3][3];
} State;

static void evaluate(const Arm *arm, const double *p, State *state)
{
    double tip[3];
    tip_and_jacobian(arm, state->q, tip, state->J);
    for (int i = 0; i < 3; ++i)
        state->error[i] = p[i] - tip[i];
    state->length = sqrt(dot(state->error, state->error));
}

/* The step d of (J'J + damping) d = J' error; returns the largest of its parts. */
static double damped_step(const State *state, double damping, double *d)
{
    const double (*J)[3] = state->J, *e = state->error;
    double JJ[ELEMENTS], b[3];
    for (int i = 0; i < 3; ++i) {
        b[i] = J[0][i] * e[0] + J[1][i] * e[1] + J[2][i] * e[2];
        for (int j = i; j < 3; ++j)
            JJ[element[i][j]] = J[0][i] * J[0][j] + J[1][i] * J[1][j] + J[2][i] * J[2][j]
                + (i == j ? damping : 0.0);
    }
    solve_symmetric(JJ, b, d);
    return fmax(fabs(d[0]), fmax(fabs(d[1]), fabs(d[2])));
}

/* damping: in parts of the squared error, so that the iteration converges as Newton's. */
double polish(const Arm *arm, double size, const double *p, int iterations, double *q)
{
    State now, next;
    double damping = 1e-3, d[3];
    memcpy(now.q, q, sizeof now.q);
    evaluate(arm, p, &now);
    for (int n = 0; n < iterations && now.length > 2.0 * DBL_EPSILON * size; ++n) {
        const double step = damped_step(
            &now, damping * now.length * now.length + LEAST_DAMPING * size * size, d);
        for (int i = 0; i < 3; ++i)
            next.q[i] = now.q[i] + d[i];
        evaluate(arm, p, &next);
        const bool nearer = next.length < now.length;
        if (nearer)
            now = next;
        damping = nearer ? fmax(0.1 * damping, 1e-6) : fmax(8.0 * damping, 1e-3);
        if (step <= LEAST_STEP || (!nearer && now.length <= NOISE * size))
            break;
    }
    memcpy(q, now.q, sizeof now.q);
    return now.length;
}
