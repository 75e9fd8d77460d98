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

"""How far a path leaves the polyline through its via points."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from rrr_traj_planner.core.arrays import Array, IntArray

SAMPLES = 33        # on each half of a zone
ZOOM_POINTS = 9     # each round narrows the bracket of the largest distance to a quarter
ZOOM_ROUNDS = 8      # to 1e-7 of the distance between two samples, whose error is its square


def polyline_deviation(points: Array, position: Callable[[Array], Array], via_s: Array,
                       zone_ends: Array) -> Array:
    """
    Return the largest distance between each zone and the legs that meet at its via point.

    Along a line the distance from a leg is convex, so it is largest at an end, which belongs to
    a zone: nothing of the path is farther away.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Via points [m].
    position : callable
        Points of the path, shape (m, 3), at places of shape (m,) [m].
    via_s : ndarray, shape (n,)
        Places of the via points [m].
    zone_ends : ndarray, shape (n - 2, 2)
        Where each zone begins and ends [m].

    Returns
    -------
    ndarray, shape (n - 2,)
        Distances [m].

    """
    k = len(zone_ends)
    if k == 0:
        return np.zeros(0)
    middle = via_s[1:-1]
    # A row for each half of a zone: first those before the via points, then those after.
    low = np.concatenate((zone_ends[:, 0], middle))
    high = np.concatenate((middle, zone_ends[:, 1]))
    corner = np.tile(np.arange(1, k + 1), 2)
    largest = np.zeros(2 * k)
    left, right, count = low, high, SAMPLES
    for _ in range(1 + ZOOM_ROUNDS):
        s = left[:, np.newaxis] + np.linspace(0.0, 1.0, count) * (right - left)[:, np.newaxis]
        distance = _leg_distance(points, position(s.ravel()).reshape(s.shape + (3,)), corner)
        best = distance.argmax(axis=1)
        rows = np.arange(2 * k)
        largest = np.maximum(largest, distance[rows, best])
        width = (right - left) / (count - 1)
        left = np.maximum(s[rows, best] - width, low)
        right = np.minimum(s[rows, best] + width, high)
        count = ZOOM_POINTS
    return np.asarray(largest.reshape(2, k).max(axis=0))


def distance_from_polyline(points: Array, at: Array) -> Array:
    """
    Return how far positions are from a polyline.

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
    legs = np.diff(points, axis=0)
    from_start = at[:, np.newaxis] - points[:-1]
    squared = np.maximum((legs * legs).sum(axis=1), np.finfo(float).tiny)
    share = np.clip((from_start * legs).sum(axis=-1) / squared, 0.0, 1.0)
    return np.asarray(np.linalg.norm(
        from_start - share[..., np.newaxis] * legs, axis=-1).min(axis=1))


def _leg_distance(points: Array, at: Array, corner: IntArray) -> Array:
    """Return the distance of points, a row for each corner, from the nearer of its legs."""
    nearest = np.full(at.shape[:-1], np.inf)
    for other in (-1, 1):
        from_corner = at - points[corner][:, np.newaxis]
        leg = points[corner + other] - points[corner]
        share = np.einsum('kmi,ki->km', from_corner, leg) / (leg * leg).sum(axis=1)[:, np.newaxis]
        foot = np.clip(share, 0.0, 1.0)[..., np.newaxis] * leg[:, np.newaxis]
        nearest = np.minimum(nearest, np.linalg.norm(from_corner - foot, axis=-1))
    return nearest
