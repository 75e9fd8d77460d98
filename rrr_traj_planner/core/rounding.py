# Copyright 2026 rrr_traj_planner developers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Differences of positions that count as rounding: one value for each quantity, chosen."""

# Two positions of the tip no further apart than this are the same; a tip this near to joint axis 1
# or to the edge of the workspace is on it.
TIP_ROUNDING = 1e-9  # m

# Two positions of a joint no further apart than this are the same; a joint beyond the end of its
# range by no more than this is at its end, so that a taught position is accepted despite rounding.
JOINT_ROUNDING = 1e-9  # rad

# Times no further apart than this are the same: rounding of sums of durations; relative where
# they exceed a second. Chosen: thousands of times the rounding of a number of seconds.
TIME_ROUNDING = 1e-12  # s
