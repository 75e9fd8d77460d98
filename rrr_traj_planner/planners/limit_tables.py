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

"""Limits of a chain of ramps as plain arrays: how the compiled method takes them."""

from __future__ import annotations

from typing import NamedTuple

from rrr_traj_planner.core.arrays import Array, BoolArray

ALONE, TORQUE, PATH = range(3)  # kinds of general limits; as in chain.h


class Tables(NamedTuple):
    """Limits as arrays; P = 2 n + 1 points of a segment, at each E general limits."""

    kind: int               # of the general limits: ALONE (none), TORQUE or PATH
    lower: Array            # (N, P, 4 J), of position, velocity, acceleration and jerk
    upper: Array
    boxed: BoolArray        # (P, 4 J), which of these there are
    general_lower: Array    # (N, P, E)
    general_upper: Array
    kept: BoolArray         # (P, E), which of these there are
    floor: Array | None = None    # (N,), of durations
    arm: Array | None = None      # constants of the equations of motion, of TORQUE
    table: Array | None = None    # (N, 4, intervals, 18), cubic coefficients, of PATH
    overshoot: Array | None = None  # (N, 2, 3), of PATH
    difference: float = 0.0
