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

"""What a motion along a path is planned for."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.path.arm_path import ArmPath


class PathTask(NamedTuple):
    """A path and the limits of the motion along it."""

    arm_path: ArmPath
    limits: JointLimits
    max_tip_speed: float               # [m/s], infinite: none
    steady_zones: bool                 # whether the tip keeps its speed on curved zones (5.58)
    should_stop: Callable[[], bool]
