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

/* Via velocities and durations of least total time, or least common stretch (via_velocities.py). */
#include "barrier.h"
#include "blocks.h"
#include "chain.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    double relative_gap, barrier_reduction, centred, polished, sufficient_decrease, more_damping,
        less_damping, rounding;
    int32_t steps_to_centre, tries;
} VelocitySettings;

typedef struct {
    double *v, *T;                     /* (n - 1, 3), (n); one behind the other */
} Place;

typedef struct {
    const Chain *chain;
    const VelocitySettings *set;
    int32_t (*should_stop)(void);
    int stopped;
    Place here, step, there;
    Derivatives near;
    double *before, *after, *damping;  /* of the barrier's parts */
    double *band, *right, *pull, *border;
} Search;

static double objective(const Chain *chain, const double *T)
{
    if (chain->proportions)
        return T[0] / chain->proportions[0];
    double sum = 0.0;
    for (int k = 0; k < chain->n; ++k)
        sum += T[k];
    return sum;
}

/* First and second derivatives by a via velocity, and by a duration. */
static void by_velocity(const Search *s, int i, double *first, double *second)
{
    const Derivatives *d = &s->near;
    const double *damping = s->damping, *bound = damping + s->chain->n * JOINTS;
    *first = d->slope[i][1] + d->slope[i + JOINTS][0] + d->bound[i][0];
    *second = d->block[i][1][1] * (1.0 + damping[i])
        + d->block[i + JOINTS][0][0] * (1.0 + damping[i + JOINTS])
        + d->bound[i][1] * (1.0 + bound[i]);
}

static void by_duration(const Search *s, int k, double *first, double *second)
{
    const Derivatives *d = &s->near;
    const int floor = (s->chain->n - 1) * JOINTS + k;
    *first = d->bound[floor][0];
    *second = d->bound[floor][1] * (1.0 + s->damping[s->chain->n * JOINTS + floor]);
    for (int i = k * JOINTS; i < (k + 1) * JOINTS; ++i) {
        *first += d->slope[i][2];
        *second += d->block[i][2][2] * (1.0 + s->damping[i]);
    }
}

/* A damped entry of a segment's block. */
static double entry(const Search *s, int i, int row, int column)
{
    return s->near.block[i][row][column] * (1.0 + s->damping[i]);
}

/* Every duration is free: unknowns T0, v0 of three joints, T1, v1, ... Gives the decrement squared;
 * negative where rounding leaves no step. */
static double free_step(Search *s, double weight)
{
    enum { W = 5, OWN = 1 + JOINTS };
    const int n = s->chain->n, m = OWN * n - JOINTS;
    memset(s->band, 0, (size_t)m * W * sizeof(double));
    for (int k = 0; k < n; ++k) {
        double first, *column = s->band + (size_t)OWN * k * W;
        by_duration(s, k, &first, column);
        s->pull[OWN * k] = -(weight + first);
        for (int j = 0; j < JOINTS && k < n - 1; ++j) {
            const int i = k * JOINTS + j;
            double *own = column + (1 + j) * W;
            by_velocity(s, i, &first, own);
            s->pull[OWN * k + 1 + j] = -first;
            column[1 + j] = entry(s, i, 1, 2);
            own[JOINTS - j] = entry(s, i + JOINTS, 0, 2);
            if (k < n - 2)
                own[OWN] = entry(s, i + JOINTS, 0, 1);
        }
    }
    memcpy(s->right, s->pull, m * sizeof(double));
    if (band_solved(s->band, s->right, m, W, 1))
        return -1.0;
    double decrement = 0.0;
    for (int i = 0; i < m; ++i)
        decrement += s->pull[i] * s->right[i];
    for (int k = 0; k < n; ++k) {
        s->step.T[k] = s->right[OWN * k];
        for (int j = 0; j < JOINTS && k < n - 1; ++j)
            s->step.v[k * JOINTS + j] = s->right[OWN * k + 1 + j];
    }
    return decrement;
}

/* A common stretch: a band for the velocities, bordered by the stretch. */
static double common_step(Search *s, double weight)
{
    enum { W = JOINTS + 1 };
    const int n = s->chain->n, m = (n - 1) * JOINTS;
    const double *in = s->chain->proportions;
    double g = weight, h = 0.0;
    for (int k = 0; k < n; ++k) {
        double first, second;
        by_duration(s, k, &first, &second);
        g += first * in[k];
        h += second * in[k] * in[k];
    }
    memset(s->band, 0, (size_t)m * W * sizeof(double));
    for (int i = 0; i < m; ++i) {
        const int k = i / JOINTS;
        by_velocity(s, i, &s->pull[i], &s->band[(size_t)i * W]);
        if (i + JOINTS < m)
            s->band[(size_t)i * W + JOINTS] = entry(s, i + JOINTS, 0, 1);
        s->border[i] = entry(s, i, 1, 2) * in[k] + entry(s, i + JOINTS, 0, 2) * in[k + 1];
        s->right[2 * i] = s->pull[i];
        s->right[2 * i + 1] = s->border[i];
    }
    if (band_solved(s->band, s->right, m, W, 2))
        return -1.0;
    double by_pull = 0.0, by_border = 0.0;
    for (int i = 0; i < m; ++i) {
        by_pull += s->border[i] * s->right[2 * i];
        by_border += s->border[i] * s->right[2 * i + 1];
    }
    const double stretch = -(g - by_pull) / (h - by_border);
    double decrement = -g * stretch;
    for (int i = 0; i < m; ++i) {
        s->step.v[i] = -(s->right[2 * i] + s->right[2 * i + 1] * stretch);
        decrement -= s->pull[i] * s->step.v[i];
    }
    for (int k = 0; k < n; ++k)
        s->step.T[k] = stretch * in[k];
    return decrement;
}

/* Try steps until one gains enough; not 0 where rounding leaves none. */
static int stepped(Search *s, double weight, double *decrement)
{
    const Chain *chain = s->chain;
    const int unknowns = chain->n + (chain->n - 1) * JOINTS, parts = parts_of(chain);
    const double cost = weight * objective(chain, s->here.T);
    for (int tries = 0; tries < s->set->tries; ++tries) {
        *decrement = chain->proportions ? common_step(s, weight) : free_step(s, weight);
        if (!(*decrement >= 0.0))
            return 1;
        for (int u = 0; u < unknowns; ++u)
            s->there.v[u] = s->here.v[u] + s->step.v[u];
        barrier_values(chain, s->there.v, s->there.T, s->after);
        double change = weight * objective(chain, s->there.T) - cost;
        for (int i = 0; i < parts; ++i)
            change += s->after[i] - s->before[i];
        if (change <= -s->set->sufficient_decrease * *decrement) {
            double *before = s->before;
            s->before = s->after;
            s->after = before;
            memcpy(s->here.v, s->there.v, unknowns * sizeof(double));
            return 0;
        }
        misjudged(chain, s->step.v, s->step.T, s->near, s->before, s->after,
                  s->set->more_damping, s->damping);
    }
    return 1;
}

/* Go to a place near the minimum of weight * objective + barrier. */
static void centre(Search *s, double weight, double centred)
{
    const Chain *chain = s->chain;
    const int parts = parts_of(chain);
    barrier_values(chain, s->here.v, s->here.T, s->before);
    for (int i = 0; i < s->set->steps_to_centre; ++i) {
        const double rounding = s->set->rounding * weight * objective(chain, s->here.T);
        double decrement;
        if ((s->stopped = s->should_stop()))
            return;
        barrier_derivatives(chain, s->here.v, s->here.T, s->near);
        if (stepped(s, weight, &decrement))
            return;
        for (int k = 0; k < parts; ++k)
            s->damping[k] *= s->set->less_damping;
        if (decrement < fmax(centred, rounding))
            return;
    }
}

static double *prepared(Search *s, double *place)
{
    const size_t n = s->chain->n, vias = (n - 1) * JOINTS, unknowns = n + vias;
    const size_t parts = n * JOINTS;
    const size_t all = parts_of(s->chain);
    double *memory = malloc((2 * unknowns + 12 * parts + 2 * unknowns + 3 * all + 9 * unknowns)
                            * sizeof(double));
    if (!memory)
        return NULL;
    double *next = memory;
    s->here.v = place, s->here.T = place + vias;
    s->step.v = next, s->step.T = next + vias, next += unknowns;
    s->there.v = next, s->there.T = next + vias, next += unknowns;
    s->near.slope = (double (*)[3])next, next += 3 * parts;
    s->near.block = (double (*)[3][3])next, next += 9 * parts;
    s->near.bound = (double (*)[2])next, next += 2 * unknowns;
    s->before = next, s->after = next + all, s->damping = next + 2 * all, next += 3 * all;
    for (size_t i = 0; i < all; ++i)
        s->damping[i] = 0.0;
    s->band = next, s->right = next + 5 * unknowns;
    s->pull = next + 7 * unknowns, s->border = next + 8 * unknowns;
    return memory;
}

/* See `followed` in compiled_segments.py. Not 0 without memory. */
EXPORTED int velocities_minimised(const Chain *chain, const VelocitySettings *set, double *place,
                                  int32_t (*should_stop)(void), double *gap)
{
    Search s = {.chain = chain, .set = set, .should_stop = should_stop};
    double *memory = prepared(&s, place);
    if (!memory)
        return 1;
    const double constraints = 12.0 * chain->n + 6.0 * (chain->n - 1);
    double weight = constraints / objective(chain, s.here.T);
    for (;;) {
        *gap = constraints / weight;
        centre(&s, weight, set->centred);
        if (s.stopped)
            break;
        if (constraints / weight < set->relative_gap * objective(chain, s.here.T)) {
            centre(&s, weight, set->polished);
            break;
        }
        weight /= set->barrier_reduction;
    }
    free(memory);
    return 0;
}
