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

/* Convexification of 3 x 3 blocks. */
#ifndef RRR_TRAJ_PLANNER_CONVEXIFY_H
#define RRR_TRAJ_PLANNER_CONVEXIFY_H

/* Make a symmetric block positive definite: scaled to a unit diagonal, its eigenvalues are
 * replaced by their magnitudes, bounded away from zero (Nocedal & Wright, Numerical Optimization,
 * 3.4). */
void make_convex(double block[3][3]);

#endif
