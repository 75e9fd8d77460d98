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

"""Shapes for drawing the arm: rods between points, a trail of the tip, points picked evenly."""

from __future__ import annotations

from collections import deque
from math import dist, sqrt
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, IntArray
from rrr_traj_planner.core.kinematics.link_positions import Point


class Rod(NamedTuple):
    """A rod that lies along z of its own frame."""

    centre: Point                                   # [m]
    quaternion: tuple[float, float, float, float]   # x, y, z, w
    length: float                                   # [m]


def rod(start: Point, end: Point) -> Rod:
    """
    Return the rod from one point to another.

    Parameters
    ----------
    start, end : tuple of 3 floats
        [m].

    Returns
    -------
    Rod
        Not turned where the points are the same.

    """
    length = dist(start, end)
    centre = (0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1]), 0.5 * (start[2] + end[2]))
    if length == 0.0:
        return Rod(centre, (0.0, 0.0, 0.0, 1.0), 0.0)
    x, y, z = ((b - a) / length for a, b in zip(start, end))
    # A rod is symmetric: of its two directions, the one within a right angle of z.
    if z < 0.0:
        x, y, z = -x, -y, -z
    w = sqrt(0.5 * (1.0 + z))
    return Rod(centre, (-0.5 * y / w, 0.5 * x / w, 0.0, w), length)


class Trail:
    """
    The last positions of a point, at least a step apart.

    Parameters
    ----------
    step : float
        Least distance between consecutive positions [m].
    most : int
        Largest number of positions; older ones are dropped.

    Attributes
    ----------
    places : deque of points
        From the oldest to the newest [m].

    """

    def __init__(self, step: float, most: int) -> None:
        self.step = step
        self.places: deque[Point] = deque(maxlen=most)

    def add(self, place: Point) -> None:
        """
        Add a position if it is a step from the last one.

        Parameters
        ----------
        place : tuple of 3 floats
            [m].

        """
        if not self.places or dist(place, self.places[-1]) >= self.step:
            self.places.append(place)

    def clear(self) -> None:
        """Drop all positions."""
        self.places.clear()


def picked(count: int, most: int, wanted: Array | IntArray | None = None) -> IntArray:
    """
    Return the indices of evenly spread points to draw, ends included.

    Parameters
    ----------
    count : int
        Number of points.
    most : int
        Largest number of evenly spread ones.
    wanted : ndarray of int, optional
        Indices to include in any case.

    Returns
    -------
    ndarray of int
        Increasing, without repetition.

    """
    even = np.arange(count) if count <= most else np.linspace(0, count - 1, most).round()
    chosen = np.union1d(even, np.zeros(0) if wanted is None else wanted)
    return chosen.astype(np.int64)
