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
Positions of the links' ends for one joint state, in floats: for drawing at a high rate.

Thesis (5.3)-(5.7) corrected.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, sin

from rrr_traj_planner.core.arm.model import RobotModel

Point = tuple[float, float, float]


def link_positions(model: RobotModel, q: Sequence[float]) -> tuple[Point, Point, Point, Point]:
    """
    Return the positions of base, shoulder, elbow and tip for one joint state.

    Parameters
    ----------
    model : RobotModel
        The arm.
    q : sequence of 3 floats
        Joint positions [rad].

    Returns
    -------
    tuple of 4 points
        Base frame [m].

    """
    c1, s1, q23 = cos(q[0]), sin(q[0]), q[1] + q[2]
    r, h = model.a2 * cos(q[1]), model.d1 + model.a2 * sin(q[1])
    r_tip, h_tip = r + model.d4 * sin(q23), h - model.d4 * cos(q23)
    return ((0.0, 0.0, 0.0), (0.0, 0.0, model.d1), (c1 * r, s1 * r, h),
            (c1 * r_tip, s1 * r_tip, h_tip))
