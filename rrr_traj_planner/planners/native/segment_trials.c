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

/* Whether a step of segments is acceptable, and which of them are damped where it is not. */
#include "segment_steps.h"

#include <math.h>

/* Least factor on the size of a step that is tried again. */
static const double SHORTEST = 0.25;

/* Factor by which the fall of slacks may exceed its part before a segment is damped again. */
static const double TOLERANCE = 1.05;

/* Find the marked segments whose slacks fall too fast, to first order, and damp them; returns
 * whether there are any. */
int fall_too_fast(const Problem *p, const SegmentRules *rules, Segments *l)
{
    memset(l->changed, 0, p->N);
    FOR_SEGMENTS(k, p, l->marked)
        if (!(l->fall[k] <= TOLERANCE * rules->to_boundary)) {
            l->damping[k] *= l->fall[k] / (rules->shorter * rules->to_boundary);
            l->changed[k] = 1;
        }
    memset(l->marked, 0, p->N);
    return any(p, l->changed);
}

/* The part of a segment's step at which the parabola of every slack, through its value, its
 * derivative and its value after the step, retains the target: 1 if none retains too little. */
static double retaining_part(const Problem *p, const SegmentRules *rules, int k,
                             const double *rates, const double *moved)
{
    const double *slacks = p->slack + k * count_of(p);
    double least = INFINITY;
    int too_far = 0;
    for (size_t i = 0; i < count_of(p); ++i) {
        const double slack = slacks[i], rate = rates[i], fall = (1.0 - rules->target) * slack;
        too_far |= !(moved[i] >= rules->retained * slack);
        if (moved[i] >= slack - fall)
            continue;
        const double curvature = moved[i] - slack - rate;
        const double part = 2.0 * fall / (sqrt(rate * rate - 4.0 * curvature * fall) - rate);
        least = fmin(least, part);
    }
    return too_far ? least : 1.0;
}

/* Move the durations of untried segments; damp those that would not be positive. Returns whether
 * there are any. */
int are_too_short(const Problem *p, const Step *s, Segments *l)
{
    const Variables m = variables_at(p, p->variables), step = variables_at(p, s->direction),
        moved = variables_at(p, s->variables);
    memset(l->changed, 0, p->N);
    FOR_SEGMENTS(k, p, l->untried) {
        moved.T[k] = m.T[k] + step.T[k];
        if (!(moved.T[k] > 0.0)) {
            l->damping[k] *= 2.0;
            l->changed[k] = 1;
        }
    }
    return any(p, l->changed);
}

/* Move a segment, its ends moved already; returns the part of the step that it retains. */
static double move_segment(const Problem *p, const SegmentRules *rules, const Step *s,
                           const Segments *l, int k)
{
    const Variables moved = variables_at(p, s->variables);
    double *z = p->trial_states;
    double *slack = s->slack + k * count_of(p);
    step_segment(p, variables_at(p, p->variables), variables_at(p, s->direction), 1.0, k, moved);
    meet_segment(p, moved, k);
    segment_states(p, moved, k, z);
    segment_slacks(p, k, z, 1.0 - 1.0 / l->damping[k], NULL, slack);
    return retaining_part(p, rules, k, rates_of(p, s, l, k), slack);
}

/* Move the untried segments and those beside; damp those whose slacks fall too far, and return
 * whether there are any. Via points at the ends of active ranges do not move. */
int fall_too_far(const Problem *p, const SegmentRules *rules, const Step *s, Segments *l)
{
    const Variables m = variables_at(p, p->variables), step = variables_at(p, s->direction),
        moved = variables_at(p, s->variables);
    const int N = p->N;
    memcpy(l->marked, l->untried, N);
    mark_around(p, l->marked, l->active, 1, l->untried);
    for (int k = 0; k <= N; ++k)
        if ((k == 0 || l->active[k - 1]) && (k == N || l->active[k])
            && ((k > 0 && l->untried[k - 1]) || (k < N && l->untried[k])))
            step_via_point(p, m, step, 1.0, l->damping, k, moved);
    memset(l->changed, 0, N);
    FOR_SEGMENTS(k, p, l->untried) {
        const double part = move_segment(p, rules, s, l, k);
        if (part == 1.0) {
            l->moved_log[k] = log_sum(s->slack + k * count_of(p), count_of(p));
            continue;
        }
        l->damping[k] /= fmax(rules->shorter * fmin(part, 1.0), SHORTEST);
        l->changed[k] = 1;
    }
    memset(l->untried, 0, N);
    return any(p, l->changed);
}

/* Whether the merit decreases too little; then damp the segments where it rises over what the step
 * predicts, all if there are none. */
int decreases_too_little(const Problem *p, const SegmentRules *rules, const Step *s, Segments *l,
                         double barrier)
{
    const Variables m = variables_at(p, p->variables), moved = variables_at(p, s->variables);
    double change = 0.0;
    l->damped_decrease = 0.0;
    FOR_SEGMENTS(k, p, l->active) {
        l->change[k] = segment_cost(p, moved, k) - segment_cost(p, m, k)
            - barrier * (l->moved_log[k] - l->log[k]);
        change += l->change[k];
        l->damped_decrease += l->decrease[k];
    }
    if (p->shifted || change <= -rules->sufficient_decrease * l->damped_decrease)
        return 0;
    memset(l->changed, 0, p->N);
    FOR_SEGMENTS(k, p, l->active)
        l->changed[k] = l->change[k] + l->decrease[k]
            > rules->bad * decrement_of(p, k, rates_of(p, s, l, k));
    if (!any(p, l->changed))
        memcpy(l->changed, l->active, p->N);
    FOR_SEGMENTS(k, p, l->changed)
        l->damping[k] *= 2.0;
    return 1;
}
