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

/* Limits of a chain near a motion: room, first derivatives, the barrier's Hessian. */
#ifndef RRR_TRAJ_PLANNER_LIMITS_H
#define RRR_TRAJ_PLANNER_LIMITS_H

#include "chain.h"

/* Which limits there are at a segment's points, and where a motion's values are kept. */
typedef struct {
    const Problem *p;
    const Settings *set;
    int boxes, general, M;   /* limits of a segment */
    int *box_at, *general_at;  /* offsets into (P, 4 J) and (P, E) */
    uint8_t *looked;         /* (P), whether there are general limits at a point */
    /* near a motion */
    double *z, *x;           /* states, and general values (N, P, E) */
    double *gradient;        /* (N, P, E, 4 J) */
    double *slack, *dual, *aside;  /* (N, M, 2): above and below; (N, 2) for floors after */
    double *inverse;         /* 1 / slack */
    double *relief;          /* how far beyond each limit a value may still be; in slacks */
    int relieved;            /* whether there is any */
    double log;              /* log_of(slack), where there is none */
    double *Q, *r, *Q_full, *r_T, *Q_T, *second;
    double *newton;
} Work;

size_t limits_size(const Work *w);
/* Room to the limits at a motion's states, a part of all relief with it. */
void room(const Work *w, const double *T, const double *z, double part, double *x, double *slack);
double log_of(const Work *w, const double *slack);
size_t limits_count(const Work *w);
/* First derivatives of a sum of limited quantities, pulled below by pull[1], above by pull[0]. */
void pulled(const Work *w, const double *pull, double *r, double *r_T);
/* The problem near a motion: room, derivatives, and the Hessian of the barrier: of Gauss and Newton,
 * and with the general limits' own curvature, Q_full. */
void localised(Work *w, Motion m, const double *dual, double barrier);
/* How slacks change along a step. */
void rates_of(const Work *w, Motion step, const double *dz, double *rate);

#endif
