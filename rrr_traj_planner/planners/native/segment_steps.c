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

/* The steps of segment_steps.h: Newton's, shortened where it has to be, and accepted. */
#include "segment_steps.h"

#include <math.h>

/* Segments on either side of one that changes, whose steps then change too;
 * and beside one that is not centred, which take a step with it. Chosen. */
enum { HALO = 2, BESIDE = 1 };

/* For solver/segment_steps.py, which compares them. */
EXPORTED const int64_t size_of_segment_rules = sizeof(SegmentRules);
EXPORTED const int64_t size_of_segments = sizeof(Segments);

double decrement_of(const Problem *p, int k, const double *rates)
{
    const double *dual = p->dual + k * count_of(p), *inverse = p->inverse + k * count_of(p);
    double sums[2] = {0.0};  /* of both sides of the bounds */
    for (size_t i = 0; i < count_of(p); i += 2)
        for (size_t side = i; side < i + 2; ++side)
            sums[side - i] += dual[side] * inverse[side] * rates[side] * rates[side];
    return sums[0] + sums[1];
}

/* The step of segment k, that of its via points known, and the derivatives of its slacks. */
static void step_within(const Problem *p, const Step *s, const Segments *l, int k)
{
    double *rates = rates_of(p, s, l, k), worst = 0.0;
    const double *inverse = p->inverse + k * count_of(p);
    double *dz = p->step_states;
    l->decrease[k] = damped_segment_step(p, k, l->damping[k], s->direction, dz);
    segment_rates(p, k, dz, 1.0 / l->damping[k], rates);
    for (size_t i = 0; i < count_of(p); ++i) {
        const double fall = -rates[i] * inverse[i];
        worst = fall > worst ? fall : worst;
    }
    l->fall[k] = worst;
}

/* Linearise and condense the active segments, and compute their Newton step. Returns 1 where that
 * fails. */
static int newton(const Problem *p, const Step *s, Segments *l, double barrier)
{
    l->predicted_decrease = 0.0;
    memset(l->again, 0, p->N);
    FOR_SEGMENTS(k, p, l->active) {
        linearise_segment(p, k, barrier);
        l->damping[k] = 1.0;
        if (condense_segment(p, k))
            return 1;
    }
    FOR_RANGES(at, p, l->active) {
        rest_ends(p, at);
        damped_via_step(p, at, l->damping, s->direction);
    }
    for (int k = 0; k < p->N; ++k) {
        if (l->active[k]) {
            step_within(p, s, l, k);
            l->decrement[k] = decrement_of(p, k, rates_of(p, s, l, k));
        }
        l->predicted_decrease += l->active[k] ? l->decrease[k] : l->decrement[k];
    }
    return !isfinite(l->predicted_decrease);
}

/* Compute the step again around changed segments. */
static void step_again(const Problem *p, const Step *s, Segments *l)
{
    mark_around(p, l->changed, l->active, HALO, l->marked);
    FOR_RANGES(at, p, l->marked)
        damped_via_step(p, at, l->damping, s->direction);
    FOR_SEGMENTS(k, p, l->marked) {
        l->again[k] = l->untried[k] = 1;
        step_within(p, s, l, k);
    }
}

/* Accept a segment's slacks, and update its multipliers as timing_accept does those of all. */
static void accept_segment(const Problem *p, const SegmentRules *rules, const Step *s, int k,
                           double barrier)
{
    const size_t begin = k * count_of(p), count = count_of(p);
    const double *moved = s->slack + begin, *rates = s->rate + begin;
    const double *inverse = p->inverse + begin;
    double *change = p->trial_slack, *duals = p->dual + begin, worst = 0.0;
    for (size_t i = 0; i < count; ++i) {
        change[i] = (barrier - duals[i] * rates[i]) * inverse[i] - duals[i];
        if (-change[i] > worst * duals[i])
            worst = -change[i] / duals[i];
    }
    const double size = worst > rules->to_boundary ? rules->to_boundary / worst : 1.0;
    const double part = 1.0 / rules->corridor;
    for (size_t i = 0; i < count; ++i) {
        const double central = barrier / moved[i], least = central * part;
        const double most = central * rules->corridor, dual = duals[i] + size * change[i];
        duals[i] = dual < least ? least : dual > most ? most : dual;
    }
    for (size_t i = 0; i < count && p->shifted; ++i)
        p->slack[begin + i] = moved[i];
}

/* Reduce a segment's shifts by its part of the step; returns whether any is left. */
static int reduce_shifts(const Problem *p, const SegmentRules *rules, const Segments *l, int k)
{
    int left = 0;
    for (size_t i = k * count_of(p); i < (k + 1) * count_of(p) && p->shifted; ++i) {
        if (!(p->shift[i] > 0.0))
            continue;
        p->shift[i] *= 1.0 - 1.0 / l->damping[k];
        if (p->shift[i] > rules->small_shift * p->slack[i]) {
            left = 1;
        } else {
            p->slack[i] -= p->shift[i];
            p->shift[i] = 0.0;
        }
    }
    return left;
}

/* Accept the step, and choose the segments that take the next one: all, if none needs it. */
static void accept(Problem *p, const SegmentRules *rules, const Step *s, Segments *l,
                   double barrier)
{
    int shifted = 0;
    const double least = rules->centred * barrier * count_of(p);
    memset(l->changed, 0, p->N);
    FOR_SEGMENTS(k, p, l->active) {
        accept_segment(p, rules, s, k, barrier);
        const int left = reduce_shifts(p, rules, l, k);
        l->log[k] = p->shifted ? log_sum(p->slack + k * count_of(p), count_of(p))
            : l->moved_log[k];
        l->changed[k] = left || l->decrement[k] > least;
        shifted |= left;
    }
    p->shifted = shifted;
    memcpy(p->variables, s->variables, variables_size(p) * sizeof(double));
    mark_around(p, l->changed, NULL, BESIDE, l->active);
    if (!any(p, l->active))
        memset(l->active, 1, p->N);
    l->total_log = 0.0;
    l->cost = 0.0;
    for (int k = 0; k < p->N; ++k) {
        l->total_log += l->log[k];
        l->cost += segment_cost(p, variables_at(p, p->variables), k);
    }
}

/* The sums of the logarithms of the slacks at the iterate, of which that of all is returned. */
EXPORTED double segments_log_sum(const Problem *p, Segments *l)
{
    const Variables m = variables_at(p, p->variables);
    l->total_log = 0.0;
    for (int k = 0; k < p->N; ++k) {
        double *slack = p->slack + k * count_of(p);
        segment_states(p, m, k, p->trial_states);
        segment_slacks(p, k, p->trial_states, 1.0, NULL, slack);
        l->total_log += l->log[k] = log_sum(slack, count_of(p));
    }
    return l->total_log;
}

/* Shorten the step until it is acceptable; returns whether that succeeds. */
static int shorten(const Problem *p, const SegmentRules *rules, const Step *s, Segments *l,
                   double barrier)
{
    memcpy(l->marked, l->active, p->N);
    memcpy(l->untried, l->active, p->N);
    for (int round = 0; round < rules->rounds; ++round) {
        if (!fall_too_fast(p, rules, l) && !are_too_short(p, s, l)
            && !fall_too_far(p, rules, s, l) && !decreases_too_little(p, rules, s, l, barrier))
            return 1;
        step_again(p, s, l);
    }
    return 0;
}

/* Take a step. Returns 0 where none is acceptable. */
EXPORTED int32_t segments_step(Problem *p, const Step *s, Segments *l, const SegmentRules *rules,
                               double barrier)
{
    if (newton(p, s, l, barrier))
        return 0;
    memcpy(s->variables, p->variables, variables_size(p) * sizeof(double));
    if (!shorten(p, rules, s, l, barrier))
        return 0;
    accept(p, rules, s, l, barrier);
    return 1;
}
