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

/* Sequences of ramps: states of a motion, and steps after which it meets the via points again. */
#include "timing_problem.h"

static double node(const Problem *p, Variables m, int k, int i, int j)
{
    if (i == 0)
        return k == 0 ? 0.0 : m.a[(k - 1) * p->J + j];
    if (i == p->n)
        return k == p->N - 1 ? 0.0 : m.a[k * p->J + j];
    return m.inner[((size_t)k * (p->n - 1) + i - 1) * p->J + j];
}

void motion_states(const Problem *p, Variables m, double *z)
{
    const int J = p->J, n = p->n, P = 2 * n + 1;
    for (int k = 0; k < p->N; ++k) {
        const double h = m.T[k] / n;
        for (int j = 0; j < J; ++j) {
            double q = p->points[k * J + j], v = k == 0 ? 0.0 : m.v[(k - 1) * J + j];
            for (int i = 0; i <= n; ++i) {
                double *at = z + ((size_t)k * P + i) * 4 * J + j;
                const double a = node(p, m, k, i, j);
                at[0] = q, at[J] = v, at[2 * J] = a, at[3 * J] = 0.0;
                if (i == n)
                    break;
                const double rise = node(p, m, k, i + 1, j) - a;
                at += (size_t)(n + 1) * 4 * J;
                at[0] = q + h * (0.5 * v + h * (0.125 * a + p->ramp.mid_q * rise));
                at[J] = v + h * (0.5 * a + p->ramp.mid_qd * rise);
                at[2 * J] = a + 0.5 * rise;
                at[3 * J] = p->ramp.peak_jerk * rise / h;
                q += h * (v + h * (0.5 * a + p->ramp.end_q * rise));
                v += h * (a + 0.5 * rise);
            }
        }
    }
}

/* Change inner accelerations smoothly so that the motion meets the via points exactly. */
static void restore(const Problem *p, Variables m)
{
    const int J = p->J, n = p->n;
    for (int k = 0; k < p->N; ++k) {
        const double h = m.T[k] / n;
        for (int j = 0; j < J; ++j) {
            const double v0 = k == 0 ? 0.0 : m.v[(k - 1) * J + j];
            const double v1 = k == p->N - 1 ? 0.0 : m.v[k * J + j];
            double dv = 0.0, dq = 0.0;  /* changes of v / h and of q / h^2; then residuals */
            for (int i = 0; i < n; ++i) {
                const double a = node(p, m, k, i, j), rise = node(p, m, k, i + 1, j) - a;
                dq += dv + 0.5 * a + p->ramp.end_q * rise;
                dv += a + 0.5 * rise;
            }
            dv = (v1 - v0) / h - dv;
            dq = (p->points[(k + 1) * J + j] - p->points[k * J + j] - m.T[k] * v0) / (h * h)
                - dq;
            for (int i = 0; i < n - 1; ++i)
                m.inner[((size_t)k * (n - 1) + i) * J + j] +=
                    p->restore[2 * i] * dv + p->restore[2 * i + 1] * dq;
        }
    }
}

/* Take a step of the variables in normalised time: velocities times T and accelerations times T^2
 * change linearly with its size. Returns 0 where a duration would not be positive. */
int step_motion(const Problem *p, Variables m, Variables step, double size, Variables moved)
{
    const int J = p->J, n = p->n;
    for (int k = 0; k < p->N; ++k) {
        moved.T[k] = m.T[k] + size * step.T[k];
        if (!(moved.T[k] > 0.0))
            return 0;
    }
    for (int k = 0; k < p->N; ++k) {
        const double rate = step.T[k] / m.T[k], slower = 1.0 + size * rate;
        for (size_t i = (size_t)k * (n - 1) * J; i < (size_t)(k + 1) * (n - 1) * J; ++i)
            moved.inner[i] = (m.inner[i] + size * (step.inner[i] + 2.0 * rate * m.inner[i]))
                / (slower * slower);
    }
    for (int k = 0; k < p->N - 1; ++k) {
        /* time scale at a via point: mean of both segments', the shorter one's counting more */
        const double before = m.T[k] * m.T[k] * m.T[k];
        const double after = m.T[k + 1] * m.T[k + 1] * m.T[k + 1];
        const double beside = (step.T[k] / m.T[k] * after + step.T[k + 1] / m.T[k + 1] * before)
            / (before + after);
        const double slower = 1.0 + size * beside;
        for (int i = k * J; i < (k + 1) * J; ++i) {
            moved.v[i] = (m.v[i] + size * (step.v[i] + beside * m.v[i])) / slower;
            moved.a[i] = (m.a[i] + size * (step.a[i] + 2.0 * beside * m.a[i]))
                / (slower * slower);
        }
    }
    restore(p, moved);
    return 1;
}
