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

/* The largest displacement of a segment and its derivatives; see
 * transitions/largest_displacement.py. */
#ifndef RRR_TRAJ_PLANNER_LARGEST_DISPLACEMENT_H
#define RRR_TRAJ_PLANNER_LARGEST_DISPLACEMENT_H

typedef struct {
    double slope, root, max_velocity;  /* of a joint: TransitionLaw, and [rad/s] */
} Law;

typedef struct {
    double distance, gradient[3], hessian[3][3];  /* by v0, v1 and T */
} DisplacementDerivatives;

double largest_change(const Law *law, double T);
double change_rate(const Law *law, double T);
double largest_displacement(const Law *law, double v0, double v1, double T);
DisplacementDerivatives displacement_derivatives(const Law *law, double v0, double v1, double T);

#endif
