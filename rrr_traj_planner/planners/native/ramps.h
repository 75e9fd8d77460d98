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

/* The family of motions: accelerations that change from node to node in ramps of one shape. */
#ifndef RRR_TRAJ_PLANNER_RAMPS_H
#define RRR_TRAJ_PLANNER_RAMPS_H

/* A ramp of unit duration and unit rise of acceleration (core/motion_laws/ramps.py): the
 * displacement at its end and half-way, the velocity half-way, and the peak of jerk. */
typedef struct {
    double end_q, mid_q, mid_qd, peak_jerk;
} Ramp;

#endif
