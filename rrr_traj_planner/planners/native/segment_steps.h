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
 * while the others take more steps. For durations that are free, without least ones. */
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
    double barrier;             /* parameter */
    int32_t rounds;             /* of damping, at most */
} SegmentRules;

/* The segments' arrays, (N) each, and what a step has brought. */
typedef struct {
    double *damping;            /* of the last step, at least 1 */
    double *decrease;           /* that it predicts */
    double *decrement;          /* squared, of each segment's last Newton step */
    double *fall;               /* largest relative one of a slack, to first order */
    double *part;               /* of the step, at which all slacks retain enough */
    double *log, *moved_log;    /* sums of the slacks' logarithms; those after the step */
    double *change;             /* of the merit */
    uint8_t *active;            /* 1: takes the next step */
    uint8_t *flipped;           /* 1: its multipliers are where others' next ones are */
    uint8_t *untried;           /* 1: not moved since it has another step */
    uint8_t *changed, *marked;  /* scratch */
    double predicted_decrease;  /* of the Newton step, and of the segments that rest */
    double damped_decrease;     /* predicted of the step that is taken */
    double cost, total_log;
    double newton_barrier;      /* parameter for which the Newton step is known; 0: it is not */
} Segments;

static inline Range all_segments(const Problem *p) { return (Range){0, p->N}; }

/* A range, and so many segments on either side. */
static inline Range around(const Problem *p, Range at, int halo)
{
    return (Range){at.begin > halo ? at.begin - halo : 0,
                   at.end + halo < p->N ? at.end + halo : p->N};
}

/* Run what follows for every marked segment of a range. */
#define FOR_SEGMENTS(k, at, marked) for (int k = (at).begin; k < (at).end; ++k) if (marked[k])

/* The first marked segments in a row; begin is end if there are none. */
static inline Range next_range(Range in, const uint8_t *marked)
{
    Range at = in;
    while (at.begin < in.end && !marked[at.begin])
        ++at.begin;
    for (at.end = at.begin; at.end < in.end && marked[at.end];)
        ++at.end;
    return at;
}

/* Run what follows for all marked segments in a row of a range. */
#define FOR_RANGES(at, in, marked) \
    for (Range at = next_range(in, marked); at.begin < (in).end; \
         at = next_range((Range){at.end, (in).end}, marked))

/* Mark what is marked already in a range, and halo active segments on either side of it. */
static inline void mark_around(const Problem *p, Range at, const uint8_t *from,
                               const uint8_t *active, int halo, uint8_t *marked)
{
    const Range wide = around(p, at, halo);
    memset(marked + wide.begin, 0, wide.end - wide.begin);
    FOR_SEGMENTS(k, at, from)
        for (int i = k - halo; i <= k + halo; ++i)
            if (i >= wide.begin && i < wide.end && (!active || active[i]))
                marked[i] = 1;
}

static inline int any(Range at, const uint8_t *marked)
{
    return next_range(at, marked).begin < at.end;
}

static inline size_t count_of(const Problem *p) { return 2 * constraints_of(p); }

/* Factor by which the fall of slacks may exceed its part before a segment is damped. */
static const double TOLERANCE = 1.05;

static inline int falls_too_fast(const SegmentRules *rules, const Segments *l, int k)
{
    return !(l->fall[k] <= TOLERANCE * rules->to_boundary);
}

/* segment_attempts.c: a segment's multipliers, now or after the step. */
double *duals_of(const Problem *p, const Segments *l, int k, int moved);

/* Linearise a segment, its multipliers confined to the corridor around barrier / slack. */
void linearise_confined(const Problem *p, const SegmentRules *rules, const Segments *l, int k,
                        Linearised at);

/* The step of an active segment, those of its ends and its duration known; then, of that segment,
 * the second-order part of the decrease, twice, of the constraints; and the multipliers after a
 * Newton step. */
void find_step(const Problem *p, const SegmentRules *rules, const Step *s, Segments *l, int k);
double decrement_of(const Problem *p, const Step *s, const Segments *l, int k);
void move_duals(const Problem *p, const SegmentRules *rules, const Step *s, const Segments *l,
                int k);

/* Move the segment whose step was found last, its ends and its duration moved already. */
void move_segment(const Problem *p, const SegmentRules *rules, const Step *s, Segments *l, int k);

/* segment_trials.c: damp, and mark as changed, the segments whose slacks fall too fast, to first
 * order; whose duration would not be positive; whose slacks fall too fast or, after they are moved,
 * too far; where the merit rises over what the step predicts, all if there are none, if it decreases
 * too little. Returned is whether there are any. */
int damp_fast(const SegmentRules *rules, Segments *l, Range at);
int damp_short(const Problem *p, const Step *s, Segments *l, Range at);
int damp_far(const Problem *p, const SegmentRules *rules, const Step *s, Segments *l, Range at);
int damp_rising(const Problem *p, const SegmentRules *rules, const Step *s, Segments *l);

#endif
