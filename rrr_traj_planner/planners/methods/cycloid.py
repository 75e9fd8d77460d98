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

"""
`cycloid`: transition, cruise, transition in every segment, free via velocities (thesis 4.2.3).

Every transition is a full-period cycloid (4.3-4.9); the total time is the least.
"""

from __future__ import annotations

from rrr_traj_planner.core.motion_laws.cycloid_transitions import CYCLOID
from rrr_traj_planner.planners.registration import register
from rrr_traj_planner.planners.transitions.planner import planner_with

plan = register('cycloid')(planner_with(CYCLOID))
