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

/* What all constraints have in common: their slacks, multipliers, and both along a step. */
#ifndef RRR_TRAJ_PLANNER_SLACKS_H
#define RRR_TRAJ_PLANNER_SLACKS_H

#include <stddef.h>

/* The sum of logarithms; most of them are taken of products, which is faster. */
double log_sum(const double *slack, size_t size);

/* The barrier's first derivatives f by the values of two-sided constraints, their shifts, if not
 * NULL, reduced along the step; and its primal-dual second derivatives. */
void barrier_derivatives(const double *dual, const double *shift, const double *inverse,
                         size_t constraints, double barrier, double *f, double *weight);

void invert(const double *slack, size_t size, double *inverse);

/* The largest part of itself by which a slack falls at these rates, to first order; at least 0. */
double largest_fall(const double *rate, const double *inverse, size_t size);

/* Whether every slack retains a part of itself. */
int all_retain(const double *slack, const double *moved, size_t size, double part);

/* The multipliers after a Newton step of their own towards barrier / slack, which is shortened so
 * that none falls by more than the part to_boundary. */
void step_duals(const double *dual, const double *rate, const double *inverse, size_t size,
                double barrier, double to_boundary, double *moved);

/* Confine multipliers to [1 / corridor, corridor] * barrier / slack (Waechter & Biegler 2006,
 * eq. 16); whether all are well inside. */
void confine_duals(double *dual, const double *slack, size_t size, double barrier,
                   double corridor);
int are_confined(const double *dual, const double *slack, size_t size, double barrier,
                 double corridor);

#endif
