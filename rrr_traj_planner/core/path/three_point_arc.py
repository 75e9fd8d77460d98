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

"""The thesis's construction of an arc through the middle one of three points (5.4.2)."""

from __future__ import annotations

from math import acos, atan2, cos, hypot, sin
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.path.tangent_lines import frames, Tangents


class ThreePointArc(NamedTuple):
    """An arc and its two tangents."""

    radius: float   # [m]; less than requested where an end lies inside the circle
    tangent: Array  # of the arc at the middle point, shape (1, 3)
    normal: Array
    before: float   # angles by which the arc turns before and after the middle point [rad]
    after: float
    lines: Tangents


def three_point_arc(points: Array, radius: float) -> ThreePointArc:
    """
    Return the circle with its centre at P_j + rho N, and its tangents from both other points.

    Parameters
    ----------
    points : ndarray, shape (3, 3)
        Via points [m].
    radius : float
        Requested radius [m].

    Returns
    -------
    ThreePointArc
        The arc; its radius at most so large that both other points are outside the circle.

    """
    legs = np.diff(points, axis=0)
    u = legs / np.linalg.norm(legs, axis=1)[:, np.newaxis]
    (T,), (N,) = frames(u[:1], u[1:])
    # The outer points as seen from the middle one: along the path away from it, and inward.
    ends = [(float(-legs[0] @ -T), float(-legs[0] @ N)), (float(legs[1] @ T), float(legs[1] @ N))]
    for x, y in ends:
        if 2.0 * radius * y > x * x + y * y:
            radius = (x * x + y * y) / (2.0 * y)
    before, after = (_turn(x, y, radius) for x, y in ends)
    touch = [points[1] + radius * (side * sin(a) * T + 2.0 * sin(0.5 * a) ** 2 * N)
             for side, a in ((-1.0, before), (1.0, after))]
    direction = np.array([cos(before) * T - sin(before) * N, cos(after) * T + sin(after) * N])
    lines = Tangents(direction, np.array([points[0], touch[1]]),
                     np.array([touch[0], points[2]]), np.array([0.5 * (before + after)]))
    return ThreePointArc(radius, T[np.newaxis], N[np.newaxis], before, after, lines)


def _turn(x: float, y: float, radius: float) -> float:
    """Return the angle from the middle point to where the tangent from (x, y) touches (5.67)."""
    distance = hypot(x, radius - y)
    if y <= 0.0:
        return 0.0
    return atan2(x, radius - y) - acos(min(radius / distance, 1.0))
