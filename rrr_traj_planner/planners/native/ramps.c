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

static double node(int J, int N, int n, Variables m, int k, int i, int j)
{
    if (i == 0)
        return k == 0 ? 0.0 : m.a[(k - 1) * J + j];
    if (i == n)
        return k == N - 1 ? 0.0 : m.a[k * J + j];
    return m.inner[((size_t)k * (n - 1) + i - 1) * J + j];
}

void motion_samples(int J, int N, int n, double end_q, const double *points, Variables m,
                    const Samples *at, double *z)
{
    const int per = at->per_ramp, first = at->nodes_first;
    const size_t Z = 4 * (size_t)J, step = Z * (first ? 1 : per);  /* from node to node */
    for (int k = 0; k < N; ++k, z += ((size_t)n * per + 1) * Z) {
        const double h = m.T[k] / n;
        for (int j = 0; j < J; ++j) {
            double q = points[k * J + j], v = k == 0 ? 0.0 : m.v[(k - 1) * J + j];
            double a = node(J, N, n, m, k, 0, j);
            for (int i = 0; i <= n; ++i) {
                double *to = z + i * step + j;
                to[0] = q, to[J] = v, to[2 * J] = a, to[3 * J] = 0.0;
                if (i == n)
                    break;
                const double next = node(J, N, n, m, k, i + 1, j), rise = next - a;
                to = z + (first ? n + 1 + (size_t)i * (per - 1) : (size_t)i * per + 1) * Z + j;
                for (int r = 1; r < per; ++r, to += Z) {
                    const double u = (double)r / per, *unit = at->unit[r];
                    to[0] = ramp_q(h, u, q, v, a, rise, unit[0]);
                    to[J] = ramp_qd(h, u, v, a, rise, unit[1]);
                    to[2 * J] = a + unit[2] * rise;
                    to[3 * J] = unit[3] * rise / h;
                }
                q = ramp_q(h, 1.0, q, v, a, rise, end_q);
                v = ramp_qd(h, 1.0, v, a, rise, 0.5);
                a = next;
            }
        }
    }
}

/* For solver/ramps.py. */
EXPORTED void ramps_sample(int32_t J, int32_t N, int32_t n, double end_q, const double *points,
                           double *variables, int32_t per_ramp, int32_t nodes_first,
                           const double (*unit)[4], double *z)
{
    const Samples at = {per_ramp, nodes_first, unit};
    motion_samples(J, N, n, end_q, points, variables_of(J, N, n, variables), &at, z);
}

void motion_states(const Problem *p, Variables m, double *z)
{
    const double unit[2][4] = {{0.0}, {p->ramp.mid_q, p->ramp.mid_qd, 0.5, p->ramp.peak_jerk}};
    const Samples at = {2, 1, unit};
    motion_samples(p->J, p->N, p->n, p->ramp.end_q, p->points, m, &at, z);
}

void meet_points(int J, int N, int n, double end_q, const double *points, const double *shapes,
                 Variables m)
{
    for (int k = 0; k < N; ++k) {
        const double h = m.T[k] / n;
        for (int j = 0; j < J; ++j) {
            const double v0 = k == 0 ? 0.0 : m.v[(k - 1) * J + j];
            const double v1 = k == N - 1 ? 0.0 : m.v[k * J + j];
            double dv = 0.0, dq = 0.0;  /* changes of v / h and of q / h^2; then residuals */
            for (int i = 0; i < n; ++i) {
                const double a = node(J, N, n, m, k, i, j);
                const double rise = node(J, N, n, m, k, i + 1, j) - a;
                dq = ramp_q(1.0, 1.0, dq, dv, a, rise, end_q);
                dv = ramp_qd(1.0, 1.0, dv, a, rise, 0.5);
            }
            dv = (v1 - v0) / h - dv;
            dq = (points[(k + 1) * J + j] - points[k * J + j] - m.T[k] * v0) / (h * h) - dq;
            for (int i = 0; i < n - 1; ++i)
                m.inner[((size_t)k * (n - 1) + i) * J + j] +=
                    shapes[2 * i] * dv + shapes[2 * i + 1] * dq;
        }
    }
}

/* For solver/ramps.py. */
EXPORTED void ramps_meet_points(int32_t J, int32_t N, int32_t n, double end_q,
                                const double *points, const double *shapes, double *variables)
{
    meet_points(J, N, n, end_q, points, shapes, variables_of(J, N, n, variables));
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
    meet_points(J, p->N, n, p->ramp.end_q, p->points, p->restore, moved);
    return 1;
}
