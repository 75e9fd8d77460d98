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
Deviation of a path from the polyline through its via points.

Our own method: sampling of each half of a zone, then repeated sampling around the largest value.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from rrr_traj_planner.core.arrays import Array, IntArray

FIRST_SAMPLES = 33  # on each half of a zone; chosen
ZOOM_SAMPLES = 9    # each round narrows the bracket of the largest distance to a quarter
ZOOM_ROUNDS = 8     # to 1e-5 of the distance between two samples; the error is its square


def polyline_deviation(points: Array, position: Callable[[IntArray, Array], Array]) -> Array:
    """
    Return the largest distance between each zone and the legs that meet at its via point.

    Along a line the distance from a leg is convex, so it is largest at an end, which belongs to
    a zone: nothing of the path is farther away.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Via points [m].
    position : callable
        Points in zones, shape (m, 3), from the zones' numbers and parts, each of shape (m,): -1
        and 1 are a zone's ends, 0 is its middle [m].

    Returns
    -------
    ndarray, shape (n - 2,)
        Distances [m].

    """
    k = len(points) - 2
    if k == 0:
        return np.zeros(0)
    # A row for each half of a zone.
    zone, low = np.tile(np.arange(k), 2), np.repeat([-1.0, 0.0], k)
    rows, largest = np.arange(2 * k), np.zeros(2 * k)
    left, right, count = low, low + 1.0, FIRST_SAMPLES
    for _ in range(1 + ZOOM_ROUNDS):
        part = left[:, np.newaxis] + np.linspace(0.0, 1.0, count) * (right - left)[:, np.newaxis]
        at = position(np.repeat(zone, count), part.ravel())
        distance = _leg_distance(points, at.reshape(part.shape + (3,)), zone + 1)
        best = distance.argmax(axis=1)
        largest = np.maximum(largest, distance[rows, best])
        width = (right - left) / (count - 1)
        left = np.maximum(part[rows, best] - width, low)
        right = np.minimum(part[rows, best] + width, low + 1.0)
        count = ZOOM_SAMPLES
    return np.asarray(largest.reshape(2, k).max(axis=0))


def distance_from_polyline(points: Array, at: Array) -> Array:
    """
    Return the distances of positions from a polyline.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Its corners [m], at least two.
    at : ndarray, shape (m, 3)
        Positions [m].

    Returns
    -------
    ndarray, shape (m,)
        Distances [m].

    """
    from_starts = at - points[:-1, np.newaxis]
    return np.asarray(_segment_distance(from_starts, np.diff(points, axis=0)).min(axis=0))


def _leg_distance(points: Array, at: Array, corner: IntArray) -> Array:
    """Return the distance of points, a row for each corner, from the nearer of its legs."""
    from_corner = at - points[corner][:, np.newaxis]
    before, after = (_segment_distance(from_corner, points[corner + other] - points[corner])
                     for other in (-1, 1))
    return np.minimum(before, after)


def _segment_distance(offset: Array, leg: Array) -> Array:
    """Return distances (k, m) of points (k, m, 3) from segments (k, 3), relative to its start."""
    squared = np.maximum((leg * leg).sum(axis=1), np.finfo(float).tiny)[:, np.newaxis]
    projection = np.clip(np.einsum('kmi,ki->km', offset, leg) / squared, 0.0, 1.0)
    foot = projection[..., np.newaxis] * leg[:, np.newaxis]
    return np.asarray(np.linalg.norm(offset - foot, axis=-1))
