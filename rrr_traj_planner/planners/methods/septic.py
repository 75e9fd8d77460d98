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
`septic`: as `cycloid`, with the seventh-order transitions of appendix C (C.1-C.11).

With the end position of (C.10) the coefficient of t^7 vanishes: position has degree 6. Jerk is
zero where a transition begins and ends, as with the cycloid.
"""

from __future__ import annotations

from rrr_traj_planner.core.kinematics.travel_time import ViaPointBehaviour
from rrr_traj_planner.core.motion_laws.septic import SEPTIC
from rrr_traj_planner.planners.registration import register
from rrr_traj_planner.planners.transitions.planner import planner_with

plan = register('septic', passing=ViaPointBehaviour(
    mean_acceleration=1.0 / SEPTIC.peak_acceleration))(planner_with(SEPTIC))
