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
#include "slacks.h"

#include <math.h>

/* Segments on either side of one that changes, whose steps then change too;
 * beside one that is not centred, which take a step with it;
 * and those of a window, whose memory is in the cache while they are damped. Chosen. */
enum { HALO = 2, BESIDE = 1, WINDOW = 32 };

/* For solver/segment_steps.py, which compares them. */
EXPORTED const int64_t size_of_segment_rules = sizeof(SegmentRules);
EXPORTED const int64_t size_of_segments = sizeof(Segments);

/* Move the durations of marked segments in a range, and the via points between them. */
static void move_between(const Problem *p, const Step *s, const Segments *l, Range at)
{
    const Variables m = variables_at(p, p->variables), step = variables_at(p, s->direction),
        moved = variables_at(p, s->variables);
    FOR_RANGES(marked, at, l->marked) {
        for (int k = marked.begin; k < marked.end; ++k)
            moved.T[k] = m.T[k] + step.T[k];
        for (int k = marked.begin; k <= marked.end; ++k)
            if (k == 0 || k == p->N || (k > marked.begin && k < marked.end))
                step_via_point(p, m, step, 1.0, l->damping, k, moved);
    }
}

/* Linearise and condense the active segments, compute their Newton step, and move those that have
 * none beside them that falls too fast. Returns 1 where that fails. */
static int newton(const Problem *p, const SegmentRules *rules, const Step *s, Segments *l)
{
    const Range all = all_segments(p);
    const Linearised at = linearised_of(p, 0);
    FOR_SEGMENTS(k, all, l->active) {
        linearise_confined(p, rules, l, k, at);
        l->damping[k] = 1.0;
        if (condense_segment(p, k, at))
            return 1;
    }
    FOR_RANGES(active, all, l->active) {
        rest_ends(p, active);
        damped_via_step(p, active, l->damping, s->direction);
    }
    memcpy(s->variables, p->variables, variables_size(p) * sizeof(double));
    memcpy(l->marked, l->active, p->N);
    move_between(p, s, l, all);
    int fast = p->N + HALO;
    for (int k = p->N - 1; k >= 0; --k) {  /* first those that are still in the cache */
        if (!l->active[k])
            continue;
        find_step(p, rules, s, l, k);
        l->decrement[k] = decrement_of(p, s, l, k);
        move_duals(p, rules, s, l, k);
        if (falls_too_fast(rules, l, k) || !(variables_at(p, s->variables).T[k] > 0.0))
            fast = k;
        else if (k + HALO < fast)
            move_segment(p, rules, s, l, k);
    }
    l->predicted_decrease = 0.0;
    for (int k = 0; k < p->N; ++k)
        l->predicted_decrease += l->active[k] ? l->decrease[k] : l->decrement[k];
    return !isfinite(l->predicted_decrease);
}

/* Compute the step again around the changed segments of a range. */
static void step_again(const Problem *p, const Step *s, Segments *l, Range changed)
{
    const Range at = around(p, changed, HALO);
    mark_around(p, changed, l->changed, l->active, HALO, l->marked);
    FOR_RANGES(marked, at, l->marked)
        damped_via_step(p, marked, l->damping, s->direction);
    move_between(p, s, l, at);
    FOR_SEGMENTS(k, at, l->marked)
        l->untried[k] = 1;
}

/* Reduce a segment's shifts by its part of the step; returns whether any is left. */
static int reduce_shifts(const Problem *p, const SegmentRules *rules, const Step *s,
                         const Segments *l, int k)
{
    int left = 0;
    for (size_t i = k * count_of(p); i < (k + 1) * count_of(p) && p->shifted; ++i) {
        if (!(p->shift[i] > 0.0))
            continue;
        p->shift[i] *= 1.0 - 1.0 / l->damping[k];
        if (p->shift[i] > rules->small_shift * s->slack[i]) {
            left = 1;
        } else {
            s->slack[i] -= p->shift[i];
            p->shift[i] = 0.0;
        }
    }
    return left;
}

/* Accept the step, and choose the segments that take the next one: all, if none needs it. */
static void accept(Problem *p, const SegmentRules *rules, const Step *s, Segments *l)
{
    int shifted = 0;
    const double least = rules->centred * rules->barrier * count_of(p);
    const Range all = all_segments(p);
    memset(l->changed, 0, p->N);
    FOR_SEGMENTS(k, all, l->active) {
        l->flipped[k] ^= 1;
        const int left = reduce_shifts(p, rules, s, l, k);
        l->log[k] = p->shifted ? log_sum(s->slack + k * count_of(p), count_of(p))
            : l->moved_log[k];
        l->changed[k] = left || l->decrement[k] > least;
        shifted |= left;
    }
    p->shifted = shifted;
    memcpy(p->variables, s->variables, variables_size(p) * sizeof(double));
    mark_around(p, all, l->changed, NULL, BESIDE, l->active);
    if (!any(all, l->active))
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
        segment_slacks(p, m, k, 1.0, p->slack);
        l->total_log += l->log[k] = log_sum(p->slack, count_of(p));
    }
    return l->total_log;
}

/* Shorten the step until no segment violates anything, a window after the other; returns whether
 * that succeeds. */
static int shorten(const Problem *p, const SegmentRules *rules, const Step *s, Segments *l)
{
    const Range all = all_segments(p);
    if (damp_fast(rules, l, all))
        step_again(p, s, l, all);
    for (int round = 0; damp_short(p, s, l, all); ++round) {
        if (round == rules->rounds)
            return 0;
        step_again(p, s, l, all);
    }
    for (Range at = {0}; at.end < p->N;) {
        at = (Range){at.end, at.end + WINDOW < p->N ? at.end + WINDOW : p->N};
        for (int round = 0; damp_short(p, s, l, at) || damp_far(p, rules, s, l, at); ++round) {
            if (round == rules->rounds)
                return 0;
            const int first = next_range(at, l->changed).begin;
            step_again(p, s, l, at);
            const int beside = around(p, (Range){first, at.end}, HALO).begin;
            at.begin = beside < at.begin ? beside : at.begin;
        }
    }
    return 1;
}

/* The same until the merit decreases too. */
static int make_acceptable(const Problem *p, const SegmentRules *rules, const Step *s, Segments *l)
{
    for (int round = 0; round < rules->rounds && shorten(p, rules, s, l); ++round) {
        if (!damp_rising(p, rules, s, l))
            return 1;
        step_again(p, s, l, all_segments(p));
    }
    return 0;
}

/* Compute the Newton step; returns the decrease that it predicts, NaN where there is none. */
EXPORTED double segments_newton(const Problem *p, const Step *s, Segments *l,
                                const SegmentRules *rules)
{
    const int failed = newton(p, rules, s, l);
    l->newton_barrier = failed ? 0.0 : rules->barrier;
    return failed ? NAN : l->predicted_decrease;
}

/* Take a step. Returns 0 where none is acceptable; then nothing has changed. */
EXPORTED int32_t segments_step(Problem *p, const Step *s, Segments *l, const SegmentRules *rules)
{
    const int known = l->newton_barrier == rules->barrier;
    const int found = (known || !newton(p, rules, s, l)) && make_acceptable(p, rules, s, l);
    l->newton_barrier = 0.0;
    if (found) {
        accept(p, rules, s, l);
        return 1;
    }
    FOR_SEGMENTS(k, all_segments(p), l->flipped)
        memcpy(duals_of(p, l, k, 1), duals_of(p, l, k, 0), count_of(p) * sizeof(double));
    memset(l->flipped, 0, p->N);
    return 0;
}
