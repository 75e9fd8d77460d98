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

/* The constraints: their slacks, and derivatives along a step. */
#include "processor.h"
#include "slacks.h"
#include "timing_problem.h"

#include <math.h>
#include <string.h>

/* For solver/timing_problem.py, which compares them. */
EXPORTED const int64_t size_of_problem = sizeof(Problem), size_of_step = sizeof(Step);

static double *duration_slacks(const Problem *p, double *slack)
{
    return slack + 2 * (size_t)p->N * constraints_of(p);
}

int points_with_general(const Problem *p, int first, int most)
{
    int count = 0;
    while (count < most && first + count <= 2 * p->n && p->has_general[first + count])
        ++count;
    return count;
}

/* The values x (P, E) of the general constraints of segment k at its states z (P, Z). */
static void general_values(const Problem *p, int k, const double *z, double *x)
{
    const int Z = 4 * p->J, P = 2 * p->n + 1;
    for (int i = 0, count; i < P; i += count + 1) {
        count = points_with_general(p, i, P);
        if (p->arm)
            torques_at(p->arm, count, z + i * Z, x + i * p->E);
        for (int m = i; m < i + count && !p->arm; ++m)
            path_at(p, k, m, z + m * Z, x + m * p->E, NULL, NULL, NULL);
    }
}

BY_PROCESSOR static void bound_slacks(const Problem *p, int k, const double *z, double *slack)
{
    const size_t own = p->bounded_alike ? 0 : k * points_of(p) * 4 * p->J;
    for (const Run *run = p->bound_runs; run < p->bound_runs + p->runs; ++run) {
        const double *restrict lower = p->lower + own + run->at, *restrict value = z + run->at;
        const double *restrict upper = p->upper + own + run->at;
        double *restrict to = slack + 2 * run->number;
        for (int i = 0; i < run->length; ++i) {
            to[2 * i] = upper[i] - value[i];
            to[2 * i + 1] = value[i] - lower[i];
        }
    }
}

void slacks_of_values(const Problem *p, int k, const double *z, const double *x, double part,
                      double *slack)
{
    const int P = 2 * p->n + 1, E = p->E;
    const double *lower = p->general_lower + (size_t)k * P * E;
    const double *upper = p->general_upper + (size_t)k * P * E;
    double *to = slack + 2 * p->bounds;
    bound_slacks(p, k, z, slack);
    for (int c = 0; c < p->general; ++c, to += 2) {
        const int i = p->general_at[c];
        to[0] = upper[i] - x[i];
        to[1] = x[i] - lower[i];
    }
    const size_t all = 2 * constraints_of(p);
    const double *shift = p->shift + k * all;
    for (size_t i = 0; i < all && p->shifted; ++i)
        slack[i] += part * shift[i];
}

void segment_slacks(const Problem *p, Variables m, int k, double part, double *slack)
{
    segment_states(p, m, k, p->trial_states);
    if (p->general)
        general_values(p, k, p->trial_states, p->trial_values);
    slacks_of_values(p, k, p->trial_states, p->trial_values, part, slack);
}

void slacks_at(const Problem *p, Variables m, double part, double *slack)
{
    for (int k = 0; k < p->N; ++k) {
        segment_slacks(p, m, k, part, slack + 2 * k * constraints_of(p));
        double *duration_slack = duration_slacks(p, slack) + 2 * k;
        duration_slack[1] = p->least_T ? m.T[k] - p->least_T[k] : 1.0;
        duration_slack[0] = p->least_T ? p->longest - duration_slack[1] : 1.0;
    }
}

/* The number of constraints, by multiplicity. */
EXPORTED double timing_constraint_count(const Problem *p)
{
    return 2.0 * p->N * (constraints_of(p) + (p->least_T ? DURATION_WEIGHT : 0));
}

/* The sum of the slacks' logarithms. */
EXPORTED double timing_log_sum(const Problem *p, const double *slack)
{
    const size_t all = 2 * (size_t)p->N * constraints_of(p);
    double sum = log_sum(slack, all);
    const double *duration_slack = slack + all;
    for (int k = 0; p->least_T && k < 2 * p->N; ++k)
        sum += DURATION_WEIGHT * log(duration_slack[k]);
    return sum;
}

/* The gradient, by states and durations, of the weighted sum of all constrained quantities; the
 * weight of each is that of its upper bound less that of its lower bound. */
void weighted_gradient(const Problem *p, const double *weights, double *r, double *r_T)
{
    const int Z = 4 * p->J, P = 2 * p->n + 1, E = p->E;
    memset(r, 0, (size_t)p->N * P * Z * sizeof(double));
    for (int k = 0; k < p->N; ++k) {
        const double *from = weights + 2 * (size_t)k * constraints_of(p);
        double *rk = r + (size_t)k * P * Z;
        for (const Run *run = p->bound_runs; run < p->bound_runs + p->runs; ++run)
            for (int i = 0; i < run->length; ++i, from += 2)
                rk[run->at + i] += from[0] - from[1];
        for (int c = 0; c < p->general; ++c, from += 2) {
            const int i = p->general_at[c];
            const double *g = p->jacobian + ((size_t)k * P * E + i) * Z, f = from[0] - from[1];
            double *to = rk + (size_t)(i / E) * Z;
            for (int a = 0; a < Z; ++a)
                to[a] += f * g[a];
        }
        const double *duration_slack = weights + 2 * (size_t)p->N * constraints_of(p) + 2 * k;
        r_T[k] = p->least_T ? DURATION_WEIGHT * (duration_slack[0] - duration_slack[1]) : 0.0;
    }
}

BY_PROCESSOR static void bound_rates(const Problem *p, const double *dz, double *rate)
{
    for (const Run *run = p->bound_runs; run < p->bound_runs + p->runs; ++run) {
        const double *restrict by = dz + run->at;
        double *restrict to = rate + 2 * run->number;
        for (int i = 0; i < run->length; ++i) {
            to[2 * i] = -by[i];
            to[2 * i + 1] = by[i];
        }
    }
}

/* Directional derivatives of a segment's slacks along a step that changes its states by dz and takes
 * the given part of the shifts. */
void segment_rates(const Problem *p, int k, const double *jacobian, const double *dz, double part,
                   double *rate)
{
    const int Z = 4 * p->J, E = p->E;
    double *to = rate + 2 * p->bounds;
    bound_rates(p, dz, rate);
    for (int c = 0; c < p->general; ++c, to += 2) {
        const int i = p->general_at[c];
        const double *g = jacobian + (size_t)i * Z,
            *d = dz + (size_t)(i / E) * Z;
        double sum = 0.0;
        for (int a = 0; a < Z; ++a)
            sum += g[a] * d[a];
        to[0] = -sum;
        to[1] = sum;
    }
    const size_t all = 2 * constraints_of(p);
    const double *shift = p->shift + k * all;
    for (size_t i = 0; i < all && p->shifted; ++i)
        rate[i] -= part * shift[i];
}

/* Directional derivatives of the slacks along a step that changes durations by dT and states by
 * dz. */
void slack_rates(const Problem *p, const double *dT, const double *dz, double *rate)
{
    for (int k = 0; k < p->N; ++k) {
        segment_rates(p, k, linearised_of(p, k).jacobian, dz + k * points_of(p) * 4 * p->J, 1.0,
                      rate + 2 * k * constraints_of(p));
        double *duration_slack = duration_slacks(p, rate) + 2 * k;
        duration_slack[1] = p->least_T ? dT[k] : 0.0;
        duration_slack[0] = -duration_slack[1];
    }
}
