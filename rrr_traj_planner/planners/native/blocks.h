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

/* Small symmetric matrices. */
#ifndef RRR_TRAJ_PLANNER_BLOCKS_H
#define RRR_TRAJ_PLANNER_BLOCKS_H

/* Give a symmetric block the magnitudes of the eigenvalues that it has when its diagonal is scaled to
 * 1, none of them next to zero. */
void made_convex(double block[3][3]);
/* Solve a symmetric band of m unknowns, w entries from the diagonal down, for right sides (m,
 * sides); both are overwritten. Not 0 where it is not positive definite. */
int band_solved(double *band, double *right, int m, int w, int sides);

#endif
