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

/* Newton steps of the via-point problem that touch only the segments that need them: a repair of a
 * step changes it around the parts that it predicted badly, and segments that are centred take no
 * further steps (transitions/local_steps.py). For durations that are free. */
#include "via_problem.h"

#include <math.h>
#include <string.h>

/* Segments on either side of one that changes, which may then change too. Chosen: with 3 or 6 the
 * steps through 1,000 via points take up to a fifth longer. */
enum { HALO = 2 };

enum { PARTS = 2 * JOINTS + 1 };  /* of a segment, with the bounds of the velocities at its end */

/* Part of the decrement squared that badly predicted parts may add together and still be left
 * alone: where a step is short they are so by rounding. Chosen: a sufficient decrease has room
 * for 0.15. */
static const double NEGLIGIBLE = 0.01;

/* What a caller asks of a step; see solver/barrier_method.py. */
typedef struct {
    double sufficient_decrease, tolerated_rise, more_damping, less_damping;
    double left_out;  /* part of the decrement squared that segments without a step may have */
} LocalRules;

/* For transitions/local_steps.py, which compares it. */
EXPORTED const int64_t size_of_local_rules = sizeof(LocalRules);

/* The first range of marked segments from a place on; begins at n where there is none. */
static Range next_range(const ViaProblem *p, const double *marked, int from)
{
    Range at = {from, from};
    while (at.begin < p->n && marked[at.begin] == 0.0)
        ++at.begin;
    for (at.end = at.begin; at.end < p->n && marked[at.end] != 0.0;)
        ++at.end;
    return at;
}

/* Run what follows for every range of marked segments. */
#define FOR_RANGES(at, p, marked) \
    for (Range at = next_range(p, marked, 0); at.begin < (p)->n; \
         at = next_range(p, marked, at.end))

static void mark_around(double *marked, int k, Range within)
{
    for (int i = k - HALO; i <= k + HALO; ++i)
        if (i >= within.begin && i < within.end)
            marked[i] = 1.0;
}

/* Compute the step, and the parts after it, of the marked segments. Returns 1 where that fails. */
static int try_step(const ViaProblem *p, double weight, const double *marked)
{
    const int bounds = (p->n - 1) * JOINTS;
    FOR_RANGES(at, p, marked) {
        if (via_range_step(p, weight, at))
            return 1;
        for (int k = at.begin; k < at.end; ++k) {
            p->next[bounds + k] = p->point[bounds + k] + p->step[bounds + k];
            for (int i = k * JOINTS; i < (k + 1) * JOINTS && k < at.end - 1; ++i)
                p->next[i] = p->point[i] + p->step[i];
        }
        via_part_values(p, p->next, p->after, at);
    }
    return 0;
}

/* The numbers of a segment's parts, with those of the bounds of the velocities at its end unless
 * its range ends there; returns how many they are. */
static int parts_of_segment(const ViaProblem *p, int k, int end, int parts[PARTS])
{
    const int segments = p->n * JOINTS, bounds = segments - JOINTS;
    int count = 0;
    parts[count++] = segments + bounds + k;
    for (int i = k * JOINTS; i < (k + 1) * JOINTS; ++i) {
        parts[count++] = i;
        if (k < end - 1)
            parts[count++] = segments + i;
    }
    return count;
}

/* The change of weight * objective + barrier along the step; its decrement squared goes to p. */
static double change_of(ViaProblem *p, double weight, const double *active)
{
    const double *dT = p->step + (p->n - 1) * JOINTS;
    double change = 0.0;
    p->decrement = 0.0;
    FOR_RANGES(at, p, active)
        for (int k = at.begin; k < at.end; ++k) {
            int parts[PARTS];
            const int count = parts_of_segment(p, k, at.end, parts);
            for (int i = 0; i < count; ++i)
                change += p->after[parts[i]] - p->before[parts[i]];
            change += weight * dT[k];
            p->decrement += via_share(p, k, at.end);
        }
    return change;
}

/* Damp the parts that the step predicted badly and mark what is around them; all, if there is
 * none. */
static void damp(const ViaProblem *p, const LocalRules *rules, const double *active,
                 double *marked)
{
    const DampingRule rule = {rules->tolerated_rise, rules->more_damping,
                              NEGLIGIBLE * p->decrement / parts_of(p)};
    int found = 0;
    memset(marked, 0, p->n * sizeof *marked);
    FOR_RANGES(at, p, active)
        for (int k = at.begin; k < at.end; ++k)
            if (via_damp_segment(p, rule, k, at.end)) {
                mark_around(marked, k, at);
                found = 1;
            }
    if (found)
        return;
    memcpy(marked, active, p->n * sizeof *marked);
    for (int i = 0; i < parts_of(p); ++i)
        p->damping[i] = p->damping[i] * rules->more_damping + 1.0;
}

/* Take the step of a range. */
static void take(const ViaProblem *p, double less_damping, Range at)
{
    const int bounds = (p->n - 1) * JOINTS, first = at.begin * JOINTS;
    memcpy(p->point + bounds + at.begin, p->next + bounds + at.begin,
           (at.end - at.begin) * sizeof(double));
    memcpy(p->point + first, p->next + first, ((at.end - 1) * JOINTS - first) * sizeof(double));
    for (int k = at.begin; k < at.end; ++k) {
        int parts[PARTS];
        const int count = parts_of_segment(p, k, at.end, parts);
        for (int i = 0; i < count; ++i) {
            p->before[parts[i]] = p->after[parts[i]];
            p->damping[parts[i]] *= less_damping;
        }
    }
    via_differentiate(p, at);
}

static double sum_up_to(const double *values, int n, double bound)
{
    double sum = 0.0;
    for (int k = 0; k < n; ++k)
        sum += values[k] <= bound ? values[k] : 0.0;
    return sum;
}

/* Leave out of further steps the segments that add little to the decrement of this one, together
 * at most so much. Returns what they add. */
static double leave_out(const ViaProblem *p, double most, double *active, double *shares)
{
    const Range all = {0, p->n};
    double bound = p->decrement, left = 0.0;
    memset(shares, 0, p->n * sizeof *shares);
    FOR_RANGES(at, p, active)
        for (int k = at.begin; k < at.end; ++k)
            shares[k] = fabs(via_share(p, k, at.end));
    while (most > 0.0 && sum_up_to(shares, p->n, bound) > most)
        bound *= 0.5;
    if (!(most > 0.0))
        bound = 0.0;
    memset(active, 0, p->n * sizeof *active);
    for (int k = 0; k < p->n; ++k)
        if (shares[k] > bound)
            mark_around(active, k, all);
    for (int k = 0; k < p->n; ++k)
        left += active[k] == 0.0 ? shares[k] : 0.0;
    return left;
}

/* Take a damped Newton step of the active segments, repaired where it must be. Returns its
 * decrement squared with that of the segments left out before; negative where rounding allows no
 * decrease. Then active are the segments that need another, and left_out is what the others have
 * added. */
EXPORTED double via_local_step(ViaProblem *p, double weight, const LocalRules *rules,
                               double *active, double *scratch, double *left_out)
{
    memset(p->step, 0, unknowns_of(p) * sizeof(double));
    memcpy(p->next, p->point, unknowns_of(p) * sizeof(double));
    memcpy(scratch, active, p->n * sizeof *scratch);
    for (int repair = 0; repair < 30; ++repair) {  /* at most, as whole steps */
        if (try_step(p, weight, scratch))
            return -1.0;
        const double change = change_of(p, weight, active);
        if (!(p->decrement >= 0.0)) {  /* a step that was repaired too near to where it was bad */
            if (!repair)
                return -1.0;
            memcpy(scratch, active, p->n * sizeof *scratch);
            continue;
        }
        if (change <= -rules->sufficient_decrease * p->decrement) {
            const double all = p->decrement + *left_out;
            FOR_RANGES(at, p, active)
                take(p, rules->less_damping, at);
            p->objective = via_objective(p, p->point);
            *left_out += leave_out(p, rules->left_out * all - *left_out, active, scratch);
            return all;
        }
        damp(p, rules, active, scratch);
    }
    return -1.0;
}
