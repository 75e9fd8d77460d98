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

/* Symmetric banded systems. */
#ifndef RRR_TRAJ_PLANNER_BAND_CHOLESKY_H
#define RRR_TRAJ_PLANNER_BAND_CHOLESKY_H

/* Solve a symmetric banded system of m unknowns, stored as w entries from the diagonal down, for
 * right-hand sides (m, sides); both are overwritten. Returns 0, or 1 where the matrix is not
 * positive definite. */
int solve_band(double *band, double *right, int m, int w, int sides);

#endif
