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

/* Damp a segment, whose step is computed again then. */
static void damp(Segments *l, int k, double factor)
{
    l->damping[k] *= factor;
    l->changed[k] = 1;
}

int damp_fast(const SegmentRules *rules, Segments *l, Range at)
{
    memset(l->changed + at.begin, 0, at.end - at.begin);
    FOR_SEGMENTS(k, at, l->active)
        if (falls_too_fast(rules, l, k))
            damp(l, k, l->fall[k] / (rules->shorter * rules->to_boundary));
    return any(at, l->changed);
}

int damp_short(const Problem *p, const Step *s, Segments *l, Range at)
{
    const Variables moved = variables_at(p, s->variables);
    memset(l->changed + at.begin, 0, at.end - at.begin);
    FOR_SEGMENTS(k, at, l->active)
        if (!(moved.T[k] > 0.0))
            damp(l, k, 2.0);
    return any(at, l->changed);
}

int damp_far(const Problem *p, const SegmentRules *rules, const Step *s, Segments *l, Range at)
{
    FOR_SEGMENTS(k, at, l->active)
        if (l->untried[k]) {
            find_step(p, rules, s, l, k);
            if (!falls_too_fast(rules, l, k))
                move_segment(p, rules, s, l, k);
        }
    if (damp_fast(rules, l, at))
        return 1;
    FOR_SEGMENTS(k, at, l->active)
        if (l->part[k] != 1.0)
            damp(l, k, 1.0 / fmax(rules->shorter * fmin(l->part[k], 1.0), SHORTEST));
    return any(at, l->changed);
}

int damp_rising(const Problem *p, const SegmentRules *rules, const Step *s, Segments *l)
{
    const Variables m = variables_at(p, p->variables), moved = variables_at(p, s->variables);
    const Range all = all_segments(p);
    double change = 0.0;
    l->damped_decrease = 0.0;
    FOR_SEGMENTS(k, all, l->active) {
        l->change[k] = segment_cost(p, moved, k) - segment_cost(p, m, k)
            - rules->barrier * (l->moved_log[k] - l->log[k]);
        change += l->change[k];
        l->damped_decrease += l->decrease[k];
    }
    if (p->shifted || change <= -rules->sufficient_decrease * l->damped_decrease)
        return 0;
    memset(l->changed, 0, p->N);
    FOR_SEGMENTS(k, all, l->active) {
        find_step(p, rules, s, l, k);
        if (l->change[k] + l->decrease[k] > rules->bad * decrement_of(p, s, l, k))
            damp(l, k, 2.0);
    }
    const int nowhere = !any(all, l->changed);
    FOR_SEGMENTS(k, all, l->active)
        if (nowhere)
            damp(l, k, 2.0);
    return 1;
}
