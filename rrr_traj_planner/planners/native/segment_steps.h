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

/* Steps of the interior-point method that each segment shortens for itself
 * (solver/segment_steps.py). Where a slack would fall too far the Hessian of its segment alone is
 * damped, which shortens the step there, and the step is computed again around it, with the steps
 * beside as they are: their influence decays within a few segments. Segments that are centred rest
 * while the others take more steps. For bounds alone and durations that are free, without least
 * ones. */
#ifndef RRR_TRAJ_PLANNER_SEGMENT_STEPS_H
#define RRR_TRAJ_PLANNER_SEGMENT_STEPS_H

#include "timing_problem.h"

#include <string.h>

/* What Python asks of a step; see solver/segment_steps.py. */
typedef struct {
    double to_boundary;         /* part by which slacks may fall, to first order */
    double retained, target;    /* parts that they retain; that a shorter step aims at */
    double shorter;             /* by which a damped step is shorter than first order asks */
    double sufficient_decrease; /* part of the predicted decrease */
    double bad;                 /* rise over the prediction of segments damped, over decrement */
    double centred;             /* decrement squared up to which a segment rests, over its count */
    double corridor, small_shift;
    int32_t rounds;             /* of damping, at most */
} SegmentRules;

/* The segments' arrays, (N) each, and what a step has brought. */
typedef struct {
    double *damping;            /* of the last step, at least 1 */
    double *decrease;           /* that it predicts */
    double *decrement;          /* squared, of each segment's last Newton step */
    double *fall;               /* largest relative one of a slack, to first order */
    double *log, *moved_log;    /* sums of the slacks' logarithms; those after the step */
    double *change;             /* of the merit */
    uint8_t *active;            /* 1: takes the next step */
    uint8_t *again;             /* 1: its step is not Newton's */
    uint8_t *changed, *marked, *untried;  /* scratch */
    double predicted_decrease;  /* of the Newton step, and of the segments that rest */
    double damped_decrease;     /* predicted of the step that is taken */
    double cost, total_log;
} Segments;

static inline Range next_range(const Problem *p, const uint8_t *in, int from)
{
    Range at = {from, from};
    while (at.begin < p->N && !in[at.begin])
        ++at.begin;
    for (at.end = at.begin; at.end < p->N && in[at.end];)
        ++at.end;
    return at;
}

/* Run what follows for every range of segments in an array. */
#define FOR_RANGES(at, p, in) \
    for (Range at = next_range(p, in, 0); at.begin < (p)->N; at = next_range(p, in, at.end))

/* Run what follows for every segment in an array. */
#define FOR_SEGMENTS(k, p, in) for (int k = 0; k < (p)->N; ++k) if (in[k])

/* Mark what is in an array, and halo segments on either side of it that are active. */
static inline void mark_around(const Problem *p, const uint8_t *in, const uint8_t *active,
                               int halo,
                        uint8_t *marked)
{
    memset(marked, 0, p->N);
    FOR_SEGMENTS(k, p, in)
        for (int i = k - halo; i <= k + halo; ++i)
            if (i >= 0 && i < p->N && (!active || active[i]))
                marked[i] = 1;
}

static inline int any(const Problem *p, const uint8_t *in)
{
    FOR_SEGMENTS(k, p, in)
        return 1;
    return 0;
}

static inline size_t count_of(const Problem *p) { return 2 * constraints_of(p); }

/* The derivatives of a segment's slacks along its step. */
static inline double *rates_of(const Problem *p, const Step *s, const Segments *l, int k)
{
    return (l->again[k] ? p->trial_slack : s->rate) + k * count_of(p);
}

/* The second-order part of a segment's decrease along a step with these derivatives of its slacks,
 * twice: of the constraints. */
double decrement_of(const Problem *p, int k, const double *rates);

/* segment_trials.c: whether a step is not acceptable, by the derivatives of the marked segments'
 * slacks; by the durations, and by the slacks, of the segments that have not been tried; by the
 * merit. Where it is not, segments are damped, and marked as changed. */
int fall_too_fast(const Problem *p, const SegmentRules *rules, Segments *l);
int are_too_short(const Problem *p, const Step *s, Segments *l);
int fall_too_far(const Problem *p, const SegmentRules *rules, const Step *s, Segments *l);
int decreases_too_little(const Problem *p, const SegmentRules *rules, const Step *s, Segments *l,
                         double barrier);

#endif
