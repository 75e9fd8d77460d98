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

/* The functions that an arm's tables are sums of: 1, cos q, sin q, cos 2 q, sin 2 q. */
#ifndef RRR_TRAJ_PLANNER_TRIGONOMETRIC_H
#define RRR_TRAJ_PLANNER_TRIGONOMETRIC_H

#include "processor.h"

#include <math.h>

enum { FUNCTIONS = 5, MOST_ORDER = 3 };

/* A number of each of as many states, 1 by default, with which they are computed at once. */
#ifdef STATES
typedef double Real __attribute__((vector_size(STATES * sizeof(double))));
#else
#define STATES 1
typedef double Real;
#endif

/* The functions at one joint's position, and their derivatives. */
typedef struct {
    Real d[MOST_ORDER + 1][FUNCTIONS];
} Basis;

/* Evaluate them at all joints' positions, up to an order. */
INLINE void bases(const Real *q, int order, Basis *by)
{
    for (int j = 0; j < 3; ++j) {
        Real c, s, (*d)[FUNCTIONS] = by[j].d;
        for (int k = 0; k < STATES; ++k) {
            const double x = ((const double *)(q + j))[k];
            ((double *)&c)[k] = cos(x), ((double *)&s)[k] = sin(x);
        }
        d[0][0] = (Real){0.0} + 1.0, d[0][1] = c, d[0][2] = s;
        d[0][3] = c * c - s * s, d[0][4] = 2.0 * c * s;
        for (int n = 1; n <= order; ++n) {  /* cos k q becomes -k sin k q, sin k q k cos k q */
            d[n][0] = (Real){0.0};
            d[n][1] = -d[n - 1][2], d[n][2] = d[n - 1][1];
            d[n][3] = -2.0 * d[n - 1][4], d[n][4] = 2.0 * d[n - 1][3];
        }
    }
}

#endif
