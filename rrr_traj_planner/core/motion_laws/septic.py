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
The seventh-order transition of appendix C: acceleration proportional to (1 - (t/T)^2)^2.

With the end position of (C.10) the cubic and higher odd terms of (C.1) to (C.9) vanish, which
leaves this law with t in [-T, T]. Here s = (t + T) / (2 T) in [0, 1], and
1 - (t/T)^2 = 4 s (1 - s).
"""

from __future__ import annotations

from math import sqrt

from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.motion_laws.transition_shape import TransitionShape


def _acceleration(s: Array) -> Array:
    product = s * (1.0 - s)
    return 30.0 * product * product


def _velocity(s: Array) -> Array:
    return s * s * s * (10.0 + s * (6.0 * s - 15.0))


def _position(s: Array) -> Array:
    square = s * s
    return square * square * (2.5 + s * (s - 3.0))


def _jerk(s: Array) -> Array:
    return 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s)


SEPTIC = TransitionShape('septic', _acceleration, _velocity, _position, _jerk,
                         # (C.11): the transition lasts 2 T = 1.875 |change| / peak
                         peak_acceleration=15.0 / 8.0,
                         # at t = T / sqrt(3), where (1 - x^2) x is largest
                         peak_jerk=10.0 / sqrt(3.0))
