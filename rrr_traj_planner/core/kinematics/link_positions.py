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

"""Positions of an arm's joints and tip for one joint state, in floats: to draw at a high rate."""

from __future__ import annotations

from collections.abc import Sequence

from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.rotations import rotated

Point = tuple[float, float, float]

BASE: Point = (0.0, 0.0, 0.0)


def link_positions(model: RobotModel, q: Sequence[float]) -> tuple[Point, ...]:
    """
    Return the points between which the arm is drawn, for one joint state.

    The thesis's arm has four, of (5.3)-(5.7) corrected: base, shoulder, elbow and tip.

    Parameters
    ----------
    model : RobotModel
        The arm.
    q : sequence of 3 floats
        Joint positions [rad].

    Returns
    -------
    tuple of 4 or 5 points
        Base frame [m]: the base's origin, the joints' points (one, where two joints have the same)
        and the tip. The base's origin and joint 1's point do not move; the number
        is the same in every pose.

    """
    chain = model.chain
    points: list[Point] = [_point(chain.tip.tolist())]
    for axis, point, angle in zip(chain.axis[::-1].tolist(), chain.point[::-1].tolist(),
                                  reversed(q)):
        at = _point(point)
        points = [_turned(p, axis, at, angle) for p in points]
        if points[0] != at:
            points.insert(0, at)
    return (BASE, *points)


def _point(values: Sequence[float]) -> Point:
    x, y, z = values
    return x, y, z


def _turned(p: Point, axis: Sequence[float], at: Point, angle: float) -> Point:
    """Return a point turned about an axis through another point."""
    x, y, z = rotated((p[0] - at[0], p[1] - at[1], p[2] - at[2]), axis, angle)
    return at[0] + x, at[1] + y, at[2] + z
