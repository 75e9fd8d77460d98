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

/* The tip's position and its derivatives by joint positions. */
#ifndef RRR_TRAJ_PLANNER_TIP_H
#define RRR_TRAJ_PLANNER_TIP_H

#include "arm.h"

enum { ORDERS = 20 };  /* derivatives of order 0 to 3 */

typedef double Vector[3];

/* Numbers of the first derivative by joint i, of the second by i and j, of the third by i, j, k. */
static const int8_t first_by[3] = {1, 2, 3};
static const int8_t second_by[3][3] = {{4, 5, 6}, {5, 7, 8}, {6, 8, 9}};
static const int8_t third_by[3][3][3] = {
    {{10, 11, 12}, {11, 13, 14}, {12, 14, 15}}, {{11, 13, 14}, {13, 16, 17}, {14, 17, 18}},
    {{12, 14, 15}, {14, 17, 18}, {15, 18, 19}}};

/* The tip [m] and its derivatives at q up to an order, 1, 4, 10 or 20 vectors. */
void tip_derivatives(const Arm *arm, const double *q, int order, Vector *x);

#endif
