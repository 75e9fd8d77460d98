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
Paul's transition, the 4 of 4-1-4 (6.1-6.8): acceleration proportional to h (1 - h), h in [0, 1].

Written with a change of velocity D = dC/T1 + dB/t_acc over 2 t_acc, (6.7) is 3 D h (1 - h) / t_acc
= (D / duration) 6 h (1 - h). Acceleration is continuous; jerk steps at both ends, where it peaks.
"""

from __future__ import annotations

from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.motion_laws.transition_shape import TransitionShape


def _acceleration(s: Array) -> Array:
    return 6.0 * s * (1.0 - s)


def _velocity(s: Array) -> Array:
    return s * s * (3.0 - 2.0 * s)


def _position(s: Array) -> Array:
    return s * s * s * (1.0 - 0.5 * s)


def _jerk(s: Array) -> Array:
    return 6.0 - 12.0 * s


QUARTIC = TransitionShape('quartic', _acceleration, _velocity, _position, _jerk,
                          peak_acceleration=1.5,  # at s = 1/2
                          peak_jerk=6.0)          # at the ends
