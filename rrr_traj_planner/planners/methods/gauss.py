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
`gauss`: as `cycloid`, with Gauss's function for the transitions' acceleration (3.1, A.1-A.9).

Acceleration is continuous; jerk steps where a transition begins or ends.
"""

from __future__ import annotations

from rrr_traj_planner.core.kinematics.travel_time import ViaPointBehaviour
from rrr_traj_planner.core.motion_laws.gauss import GAUSS
from rrr_traj_planner.planners.registration import register
from rrr_traj_planner.planners.transitions.planner import planner_with

plan = register('gauss', passing=ViaPointBehaviour(
    mean_acceleration=1.0 / GAUSS.peak_acceleration))(planner_with(GAUSS))
