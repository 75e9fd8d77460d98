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

/* Trial steps, second-order corrections and multipliers of the interior-point method
 * (solver/interior_point.py, solver/line_search.py). */
#include "slacks.h"
#include "timing_problem.h"

#include <math.h>
#include <string.h>

double segment_cost(const Problem *p, Variables m, int k)
{
    const size_t size = (size_t)(p->n + 1) * p->J;
    const double *weight = p->jerk_weights ? p->jerk_weights + k * size : NULL;
    double sum = p->weights[k] * m.T[k];
    for (int i = 0; i <= p->n && weight; ++i)
        for (int j = 0; j < p->J; ++j, ++weight) {
            const double jerk = jerks_at(p, m, k, i)[j];
            sum += *weight * jerk * jerk;
        }
    return sum;
}

/* The objective: the weighted sum of durations and of squared jerks. */
EXPORTED double timing_cost(const Problem *p, double *variables)
{
    double sum = 0.0;
    for (int k = 0; k < p->N; ++k)
        sum += segment_cost(p, variables_at(p, variables), k);
    return sum;
}

/* Slacks at given variables, shifts included; returns the least of them. */
EXPORTED double timing_slacks(const Problem *p, double *variables, double *slack)
{
    const Variables m = variables_at(p, variables);
    const size_t all = slacks_size(p);
    double least = INFINITY;
    slacks_at(p, m, 1.0, slack);
    for (size_t i = 0; i < all; ++i)
        if (!(slack[i] >= least))
            least = slack[i];
    return least;
}

/* Set every multiplier to its value on the central path: barrier / slack. */
EXPORTED void timing_central_duals(const Problem *p, double barrier)
{
    const size_t all = slacks_size(p);
    for (size_t i = 0; i < all; ++i)
        p->dual[i] = barrier / p->slack[i];
}

/* The Newton step of the linearised problem, with the constraints' second derivatives if exact is
 * not 0. Returns 0 where there is none. */
EXPORTED int32_t timing_newton(const Problem *p, int32_t exact, Step *s)
{
    if (newton_step(p, exact ? p->exact : p->hessian, p->gradient, p->gradient_T, s->direction,
                    p->step_states, &s->predicted_decrease) || !isfinite(s->predicted_decrease))
        return 0;
    slack_rates(p, variables_at(p, s->direction).T, p->step_states, s->rate);
    s->max_relative_slack_decrease = largest_fall(s->rate, p->inverse, slacks_size(p));
    return 1;
}

/* The step size at which a slack, modelled by the parabola through its value, its derivative and
 * its value after a trial, is reduced to the given part of itself: the least over all slacks that
 * were reduced further; NaN where one is not finite. */
static double parabola(const Problem *p, const Step *s, double size, double retained)
{
    const size_t all = slacks_size(p);
    double least = INFINITY;
    for (size_t i = 0; i < all; ++i) {
        const double slack = p->slack[i], moved = s->slack[i], rate = s->rate[i];
        const double fall = (1.0 - retained) * slack;
        if (moved >= slack - fall)
            continue;
        if (!isfinite(moved))
            return NAN;
        const double curvature = (moved - slack - size * rate) / (size * size);
        const double root = sqrt(rate * rate - 4.0 * curvature * fall);
        least = fmin(least, 2.0 * fall / (root - rate));
    }
    return least;
}

/* Try a step of the given size. Returns 1 if every slack retains the given part of itself; else 0,
 * and `suggested_size` is the size at which parabolas predict that the target part is retained, 0
 * if none does. */
EXPORTED int32_t timing_trial(const Problem *p, Step *s, double size, double retained,
                              double target)
{
    const size_t unknowns = variables_size(p);
    const Variables moved = variables_at(p, s->variables);
    double *direction = s->direction;
    s->suggested_size = 0.0;
    if (s->correction) {
        direction = p->trial_variables;
        for (size_t i = 0; i < unknowns; ++i)
            direction[i] = s->direction[i] + size * s->correction[i];
    }
    if (!step_motion(p, variables_at(p, p->variables), variables_at(p, direction), size, moved))
        return 0;
    slacks_at(p, moved, 1.0 - size, s->slack);
    if (!all_retain(p->slack, s->slack, slacks_size(p), retained)) {
        const double root = parabola(p, s, size, target);
        s->suggested_size = root > 0.0 ? root : 0.0;
        return 0;
    }
    s->cost = timing_cost(p, s->variables);
    s->log = p->shifted ? 0.0 : timing_log_sum(p, s->slack);
    return 1;
}

/* The second-order correction of a step, from the differences of the slacks after a trial of the
 * given size and their linear prediction. Returns 0 where there is none. */
EXPORTED int32_t timing_correct(const Problem *p, const Step *s, double size, Step *corrected)
{
    const size_t all = slacks_size(p);
    const Variables moved = variables_at(p, p->trial_variables);
    double *weights = p->trial_slack, predicted_decrease;
    if (!step_motion(p, variables_at(p, p->variables), variables_at(p, s->direction), size,
                        moved))
        return 0;
    slacks_at(p, moved, 1.0 - size, weights);
    for (size_t i = 0; i < all; ++i)
        weights[i] = -p->dual[i] * p->inverse[i] * (weights[i] - p->slack[i] - size * s->rate[i])
            / (size * size);
    weighted_gradient(p, weights, p->trial_gradient, p->trial_gradient_T);
    for (int k = 0; k < p->N; ++k)
        p->trial_gradient_T[k] -= p->weights[k];  /* the solution adds them */
    if (newton_step(p, p->hessian, p->trial_gradient, p->trial_gradient_T, corrected->correction,
                    p->step_states, &predicted_decrease))
        return 0;
    memcpy(corrected->direction, s->direction, variables_size(p) * sizeof(double));
    memcpy(corrected->rate, s->rate, all * sizeof(double));
    corrected->predicted_decrease = s->predicted_decrease;
    corrected->max_relative_slack_decrease = s->max_relative_slack_decrease;
    return 1;
}

/* Accept the last trial, if move is not 0, and update the multipliers, which step and are confined
 * then. */
EXPORTED void timing_accept(const Problem *p, const Step *s, int32_t move, double barrier,
                            double to_boundary, double corridor)
{
    const size_t all = slacks_size(p);
    step_duals(p->dual, s->rate, p->inverse, all, barrier, to_boundary, p->trial_slack);
    memcpy(p->dual, p->trial_slack, all * sizeof(double));
    confine_duals(p->dual, move ? s->slack : p->slack, all, barrier, corridor);
    if (move)
        memcpy(p->variables, s->variables, variables_size(p) * sizeof(double));
}

/* Reduce all shifts by the size of the last step, and remove those that are then a small part of
 * their slack. */
EXPORTED void timing_reduce_shifts(Problem *p, const Step *s, double size, double small)
{
    double *slack = s->slack;
    const size_t all = slacks_size(p);
    p->shifted = 0;
    for (size_t i = 0; i < all; ++i) {
        if (!(p->shift[i] > 0.0))
            continue;
        p->shift[i] *= 1.0 - size;
        if (p->shift[i] > small * slack[i]) {
            p->shifted = 1;
        } else {
            slack[i] -= p->shift[i];
            p->shift[i] = 0.0;
        }
    }
}
