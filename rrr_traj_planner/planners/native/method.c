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

/* The interior-point method: every iterate strictly within the limits (interior_point.py and
 * interior_step.py, whose names are used). */
#include "limits.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    Motion motion;
    double *slack;
} Point;

typedef struct {
    Motion step;
    double *rate;
    double size, gain, log;  /* log: log_of its slacks, where there is no relief */
    Point to;                /* valid where size > 0 */
    int known;
} Tried;

/* A shorter size for a step on which some slacks fell too far; see _shorter. */
static double shorter(const Work *w, const Tried *t, double size)
{
    const size_t all = limits_size(w);
    double best = w->set->longest_retry * size;
    for (size_t i = 0; i < all; ++i) {
        const double slack = w->slack[i], moved = t->to.slack[i], rate = t->rate[i];
        const double fall = (1.0 - w->set->room_aimed_at) * slack;
        if (moved >= slack - fall)
            continue;
        if (!isfinite(moved))
            return 0.5 * size;
        const double bend = (moved - slack - size * rate) / (size * size);
        const double root = sqrt(rate * rate - 4.0 * bend * fall);
        best = fmin(best, 2.0 * fall / (root - rate));
    }
    return fmax(best, 0.5 * size);
}

/* Find a step's size and what it leads to; see _line_search. */
static void searched(Work *w, Motion m, Tried *t, const Motion *bend, double barrier, double *z,
                     double *x, Motion towards)
{
    const Problem *p = w->p;
    const Settings *set = w->set;
    const size_t all = limits_size(w), unknowns = motion_size(p);
    const double merit = motion_cost(p, m) - barrier * w->log;
    double worst = 0.0;
    for (size_t i = 0; i < all; ++i) {
        const double towards_limit = -t->rate[i] * w->inverse[i];
        if (towards_limit > worst)
            worst = towards_limit;
    }
    double size = worst > set->to_boundary ? set->to_boundary / worst : 1.0;
    t->known = 0;
    for (int trial = 0; trial < set->backtracks; ++trial) {
        for (size_t i = 0; i < unknowns; ++i)
            towards.inner[i] = t->step.inner[i] + (bend ? size * bend->inner[i] : 0.0);
        if (!motion_stepped(p, m, towards, size, t->to.motion)) {
            size *= 0.5;
            continue;
        }
        motion_states(p, t->to.motion, z);
        room(w, t->to.motion.T, z, 1.0 - size, x, t->to.slack);
        int kept = 1;
        for (size_t i = 0; i < all && kept; ++i)
            kept = t->to.slack[i] >= set->least_room_kept * w->slack[i];
        t->log = kept && !w->relieved ? log_of(w, t->to.slack) : 0.0;
        /* relief is taken away whatever that costs */
        if (kept && (w->relieved || motion_cost(p, t->to.motion) - barrier * t->log
                     <= merit - set->sufficient_gain * size * t->gain)) {
            t->size = size;
            t->known = 1;
            return;
        }
        size = kept ? 0.5 * size : shorter(w, t, size);
    }
    t->size = 0.0;
}

/* The change, by size squared, that mends what slacks do beside their rates; 0 where unknown. */
static int bent(Work *w, Motion m, const Tried *t, Motion bend, Motion moved, double *z, double *x,
                double *pull, double *dz)
{
    const Problem *p = w->p;
    const double size = t->size > w->set->least_bend ? t->size : w->set->least_bend;
    double gain;
    if (!motion_stepped(p, m, t->step, size, moved))
        return 0;
    motion_states(p, moved, z);
    room(w, moved.T, z, 1.0 - size, x, pull);
    const size_t all = limits_size(w);
    for (size_t i = 0; i < all; ++i)
        pull[i] = -w->dual[i] * w->inverse[i] * (pull[i] - w->slack[i] - size * t->rate[i])
            / (size * size);
    double *r = w->second, *r_T = r + (size_t)p->N * (2 * p->n + 1) * 4 * p->J;
    pulled(w, pull, r, r_T);
    for (int k = 0; k < p->N; ++k)
        r_T[k] -= p->weights[k];  /* the step adds them */
    return newton_step(p, m, w->z, w->Q, r, w->Q_T, r_T, bend, dz, &gain, w->newton) == 0;
}

typedef struct {
    Work w;
    double *memory;
    Tried tried[4];
    Motion bend, towards, best;
    double *dz, *z, *x, *pull;
} Run;

static double *taken(double **next, size_t size)
{
    double *found = *next;
    *next += (size + 3) / 4 * 4;
    return found;
}

static int prepared(Run *run, const Problem *p, const Settings *set)
{
    Work *w = &run->w;
    const size_t P = 2 * p->n + 1, Z = 4 * p->J, N = p->N, E = p->E;
    memset(run, 0, sizeof *run);
    w->p = p, w->set = set;
    w->box_at = malloc((P * Z + P * E + 1) * sizeof(int) + P);
    if (!w->box_at)
        return 1;
    w->general_at = w->box_at + P * Z;
    w->looked = (uint8_t *)(w->general_at + P * E + 1);
    for (size_t i = 0; i < P * Z; ++i)
        if (p->boxed[i])
            w->box_at[w->boxes++] = (int)i;
    memset(w->looked, 0, P);
    for (size_t i = 0; i < P * E; ++i)
        if (p->kept[i]) {
            w->general_at[w->general++] = (int)i;
            w->looked[i / E] = 1;
        }
    w->M = w->boxes + w->general;
    const size_t limits = limits_size(w) + 4, motion = motion_size(p) + 4;
    const size_t states = N * P * Z + 4, values = N * P * E + 4;
    const size_t size = 15 * limits + 11 * motion + 8 * states + 3 * values
        + values * Z + 2 * (N * hessian_size(p) + 4) + 4 * (N + 4) + newton_size(p) + 64;
    double *next = run->memory = malloc(size * sizeof(double));
    if (!next)
        return 1;
    w->z = taken(&next, states - 4), w->x = taken(&next, values - 4);
    w->gradient = taken(&next, (values - 4) * Z);
    w->inverse = taken(&next, limits - 4);
    w->slack = taken(&next, limits - 4), w->dual = taken(&next, limits - 4);
    w->aside = taken(&next, limits - 4), w->relief = taken(&next, limits - 4);
    w->Q = taken(&next, N * hessian_size(p)), w->Q_full = taken(&next, N * hessian_size(p));
    w->r = taken(&next, states - 4), w->r_T = taken(&next, N), w->Q_T = taken(&next, N);
    w->second = taken(&next, states - 4 + N);
    for (int i = 0; i < 4; ++i) {
        Tried *t = &run->tried[i];
        t->step = motion_at(p, taken(&next, motion - 4));
        t->rate = taken(&next, limits - 4);
        t->to.motion = motion_at(p, taken(&next, motion - 4));
        t->to.slack = taken(&next, limits - 4);
    }
    run->bend = motion_at(p, taken(&next, motion - 4));
    run->towards = motion_at(p, taken(&next, motion - 4));
    run->best = motion_at(p, taken(&next, motion - 4));
    run->dz = taken(&next, states - 4), run->z = taken(&next, states - 4);
    run->x = taken(&next, values - 4), run->pull = taken(&next, limits - 4);
    w->newton = taken(&next, newton_size(p));
    return 0;
}

/* A Newton step with or without the general limits' own curvature; 0 where there is none. */
static int suggested(Run *run, Motion m, int full, Tried *t)
{
    Work *w = &run->w;
    if (newton_step(w->p, m, w->z, full ? w->Q_full : w->Q, w->r, w->Q_T, w->r_T, t->step,
                    run->dz, &t->gain, w->newton) || !isfinite(t->gain))
        return 0;
    if (full && !(t->gain > 0.0))
        return 0;
    rates_of(w, t->step, run->dz, t->rate);
    return 1;
}

/* The first of the suggested steps that gets far, else the one that gets furthest. */
static Tried *best_step(Run *run, Motion m, double barrier)
{
    Work *w = &run->w;
    Tried *best = NULL;
    int count = 0;
    for (int full = w->p->kind != BOXES_ALONE; full >= 0; --full) {
        Tried *t = &run->tried[count];
        if (!suggested(run, m, full, t))
            continue;
        ++count;
        searched(w, m, t, NULL, barrier, run->z, run->x, run->towards);
        if (!best || t->size > best->size)
            best = t;
        if (t->size <= w->set->narrow) {
            Tried *again = &run->tried[count];
            if (bent(w, m, t, run->bend, again->to.motion, run->z, run->x, run->pull, run->dz)) {
                ++count;
                memcpy(again->rate, t->rate, limits_size(w) * sizeof(double));
                motion_copy(w->p, again->step, t->step);
                again->gain = t->gain;
                searched(w, m, again, &run->bend, barrier, run->z, run->x, run->towards);
                if (again->size > best->size)
                    best = again;
                t = again;
            }
        }
        if (t->size > w->set->narrow)
            break;
    }
    return best;
}

/* Multipliers after a step that keeps them positive, in sight of barrier / slack. */
static void duals_moved(Work *w, const double *rate, const double *slack, double barrier,
                        double *change)
{
    const size_t all = limits_size(w);
    double worst = 0.0;
    for (size_t i = 0; i < all; ++i) {
        change[i] = (barrier - w->dual[i] * rate[i]) * w->inverse[i] - w->dual[i];
        if (-change[i] > worst * w->dual[i])  /* divided seldom */
            worst = -change[i] / w->dual[i];
    }
    const double size = worst > w->set->to_boundary ? w->set->to_boundary / worst : 1.0;
    const double corridor = w->set->dual_corridor, part = 1.0 / corridor;
    for (size_t i = 0; i < all; ++i) {
        const double central = barrier / slack[i];
        double d = w->dual[i] + size * change[i];
        d = d < central * part ? central * part : d;
        w->dual[i] = d > central * corridor ? central * corridor : d;
    }
}

/* Take a step's part of all relief away, and what is small beside the room; see relief.py. */
static void less_relieved(Work *w, double size, double *slack)
{
    const size_t all = limits_size(w);
    w->relieved = 0;
    for (size_t i = 0; i < all; ++i) {
        if (!(w->relief[i] > 0.0))
            continue;
        w->relief[i] *= 1.0 - size;
        if (w->relief[i] > w->set->small_relief * slack[i]) {
            w->relieved = 1;
        } else {
            slack[i] -= w->relief[i];
            w->relief[i] = 0.0;
        }
    }
}

static int cancelled(int32_t (*should_stop)(void))
{
    return should_stop && should_stop();
}

/* See Compiled.minimised in compiled.py. Returns the number of centres, or -1 without memory. */
EXPORTED int chain_minimised(const Problem *p, const Settings *set, double *motion,
                             double known, double least_barrier, const double *relief,
                             int32_t (*should_stop)(void), double *gap, double *centres,
                             double *barriers, int32_t *iterations, int32_t *within)
{
    Run run;
    if (prepared(&run, p, set)) {
        free(run.w.box_at);
        return -1;
    }
    Work *w = &run.w;
    Motion m = motion_at(p, motion);
    const size_t all = limits_size(w), unknowns = motion_size(p);
    const double count = (double)limits_count(w);
    double barrier = known > 0.0 ? known : set->start * motion_cost(p, m) / count;
    int found = 0, merits = 0, known_log = 0;
    double *merit = malloc((set->iterations + 1) * sizeof(double));
    if (!merit) {
        free(run.w.box_at);
        free(run.memory);
        return -1;
    }
    motion_states(p, m, w->z);
    w->relieved = relief != NULL;
    if (relief)
        memcpy(w->relief, relief, all * sizeof(double));
    else
        memset(w->relief, 0, all * sizeof(double));
    room(w, m.T, w->z, 1.0, w->x, w->slack);
    for (size_t c = 0; c < all; ++c)
        w->dual[c] = barrier / w->slack[c];
    for (int i = 0; i < set->raises && !relief; ++i) {
        localised(w, m, w->dual, barrier);
        Tried *t = &run.tried[0];
        if (!(p->kind != BOXES_ALONE && suggested(&run, m, 1, t)) && !suggested(&run, m, 0, t))
            break;
        if (t->gain < set->far_from_centre * barrier)
            break;
        barrier /= set->barrier_reduction;
        for (size_t c = 0; c < all; ++c)
            w->dual[c] = barrier / w->slack[c];
    }
    motion_copy(p, run.best, m);
    *gap = INFINITY;
    *iterations = 0;
    for (int i = 0; i < set->iterations; ++i) {
        if (cancelled(should_stop))
            break;
        ++*iterations;
        localised(w, m, w->dual, barrier);
        if (!w->relieved && !known_log)
            w->log = log_of(w, w->slack);
        Tried *t = best_step(&run, m, barrier);
        if (!t)
            break;
        const int closing = w->relieved;
        double *slack = t->known ? t->to.slack : w->slack;
        if (closing && t->known)
            less_relieved(w, t->size, slack);
        duals_moved(w, t->rate, slack, barrier, w->aside);
        if (t->known) {
            motion_copy(p, m, t->to.motion);
            if (!w->relieved && (closing || motion_cost(p, m) < motion_cost(p, run.best)))
                motion_copy(p, run.best, m);
        }
        if (closing && t->known)
            continue;
        if (closing)
            break;
        const double cost = motion_cost(p, m);
        w->log = t->known ? t->log : w->log;
        known_log = 1;
        merit[merits++] = cost - barrier * w->log;
        const double left = t->gain * (1.0 - 0.5 * t->size) + count * barrier;
        if (left < *gap)
            *gap = left;
        const int stalled = !t->known || (merits > set->patience
            && merit[merits - 1 - set->patience] - merit[merits - 1] < set->stall * cost);
        if (stalled || t->gain < set->centred * count * barrier) {
            if (found < CENTRES) {
                memcpy(centres + found * unknowns, m.inner, unknowns * sizeof(double));
                barriers[found++] = barrier;
            }
            if (barrier <= least_barrier || count * barrier < set->relative_gap * cost)
                break;
            barrier *= set->barrier_reduction;
            merits = 0;
        }
    }
    *within = !w->relieved;
    motion_copy(p, m, run.best);
    free(merit);
    free(run.w.box_at);
    free(run.memory);
    return found;
}
