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

"""The full-period cycloid as a transition function (4.3-4.10)."""

from __future__ import annotations

from math import pi
from typing import Any

from rrr_traj_planner.core.motion_laws import cycloid
from rrr_traj_planner.core.motion_laws.cycloid import CycloidPiece
from rrr_traj_planner.core.trajectory.pieces import TransitionFunction


class CycloidTransitions(TransitionFunction):
    """Full-period transitions and cruises as cycloid pieces; see `TransitionFunction`."""

    name = 'cycloid'
    peak_acceleration = 2.0  # (4.10)
    peak_jerk = 2.0 * pi

    def transition(self, duration: Any, position: Any, velocity: Any,
                   end_velocity: Any) -> CycloidPiece:
        """Return a transition; see `TransitionFunction`."""
        return cycloid.transition(duration, position, velocity, end_velocity)

    def cruise(self, duration: Any, position: Any, velocity: Any) -> CycloidPiece:
        """Return a piece at constant velocity; see `TransitionFunction`."""
        return cycloid.cruise(duration, position, velocity)


CYCLOID = CycloidTransitions()
