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

/* What a step does to one segment. The arrays of a few segments fill a processor's nearest cache: what
 * is cheap to compute is computed again where it is needed, in the place of the first segment's, and
 * multipliers alone are kept. */
#include "segment_steps.h"
#include "slacks.h"

#include <math.h>

double *duals_of(const Problem *p, const Segments *l, int k, int moved)
{
    return (l->flipped[k] == moved ? p->dual : p->trial_slack) + k * count_of(p);
}

void linearise_confined(const Problem *p, const SegmentRules *rules, const Segments *l, int k,
                        Linearised at)
{
    double *dual = duals_of(p, l, k, 0);
    linearise_segment(p, k, rules->barrier, dual, at);
    if (are_confined(dual, at.slack, count_of(p), rules->barrier, rules->corridor))
        return;
    confine_duals(dual, at.slack, count_of(p), rules->barrier, rules->corridor);
    linearise_segment(p, k, rules->barrier, dual, at);
}

void find_step(const Problem *p, const SegmentRules *rules, const Step *s, Segments *l, int k)
{
    Linearised at = linearised_of(p, 0);
    at.hessian = at.exact = NULL;
    linearise_segment(p, k, rules->barrier, duals_of(p, l, k, 0), at);
    l->decrease[k] = damped_segment_step(p, k, l->damping[k], at, s->direction, p->step_states);
    segment_rates(p, k, at.jacobian, p->step_states, 1.0 / l->damping[k], s->rate);
    l->fall[k] = largest_fall(s->rate, at.inverse, count_of(p));
    l->untried[k] = 1;
}

double decrement_of(const Problem *p, const Step *s, const Segments *l, int k)
{
    const double *dual = duals_of(p, l, k, 0), *inverse = p->inverse, *rates = s->rate;
    double sums[2] = {0.0};  /* of both sides of the bounds */
    for (size_t i = 0; i < count_of(p); i += 2)
        for (size_t side = i; side < i + 2; ++side)
            sums[side - i] += dual[side] * inverse[side] * rates[side] * rates[side];
    return sums[0] + sums[1];
}

void move_duals(const Problem *p, const SegmentRules *rules, const Step *s, const Segments *l,
                int k)
{
    step_duals(duals_of(p, l, k, 0), s->rate, p->inverse, count_of(p), rules->barrier,
               rules->to_boundary, duals_of(p, l, k, 1));
}

/* The slacks of a segment that has moved. They are kept where shifts depend on them. */
static double *moved_slacks(const Problem *p, const Step *s, const Segments *l, int k)
{
    double *slack = s->slack + (p->shifted ? k * count_of(p) : 0);
    segment_slacks(p, variables_at(p, s->variables), k, 1.0 - 1.0 / l->damping[k], slack);
    return slack;
}

/* The part of a segment's step at which the parabola of every slack, through its value, its
 * derivative and its value after the step, retains the target: 1 if none retains too little. */
static double retaining_part(const Problem *p, const SegmentRules *rules, const double *rates,
                             const double *moved)
{
    double least = INFINITY;
    int too_far = 0;
    if (all_retain(p->slack, moved, count_of(p), rules->target))
        return 1.0;
    for (size_t i = 0; i < count_of(p); ++i) {
        const double slack = p->slack[i], rate = rates[i], fall = (1.0 - rules->target) * slack;
        too_far |= !(moved[i] >= rules->retained * slack);
        if (moved[i] >= slack - fall)
            continue;
        const double curvature = moved[i] - slack - rate;
        const double part = 2.0 * fall / (sqrt(rate * rate - 4.0 * curvature * fall) - rate);
        least = fmin(least, part);
    }
    return too_far ? least : 1.0;
}

void move_segment(const Problem *p, const SegmentRules *rules, const Step *s, Segments *l, int k)
{
    const Variables moved = variables_at(p, s->variables);
    step_segment(p, variables_at(p, p->variables), variables_at(p, s->direction), 1.0, k, moved);
    meet_segment(p, moved, k);
    const double *slack = moved_slacks(p, s, l, k);
    l->untried[k] = 0;
    l->part[k] = retaining_part(p, rules, s->rate, slack);
    if (l->part[k] == 1.0)
        l->moved_log[k] = log_sum(slack, count_of(p));
}
