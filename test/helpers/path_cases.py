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

"""Random via points of every kind for the tests of Cartesian paths."""

from __future__ import annotations

import numpy as np


def random_points(rng):
    """Return 3 to 10 points: anywhere, or with line segments of very different lengths."""
    n = rng.integers(3, 11)
    if rng.random() < 0.5:
        return rng.uniform(-1.0, 1.0, (n, 3))
    return np.cumsum(rng.normal(size=(n, 3)) * 10.0 ** rng.uniform(-1.5, 0.0, (n, 1)), axis=0)


def random_tasks(seed, count):
    """Return points and radii, from small ones that fit to large ones that do not."""
    rng = np.random.default_rng(seed)
    tasks = [random_points(rng) for _ in range(count)]
    return [(points, 10.0 ** rng.uniform(-3.0, 0.0, len(points) - 2)) for points in tasks]


def inside_pieces(path, per_piece, margin=1e-3):
    """Return path coordinates inside the pieces, at a distance from the joins."""
    knots = np.concatenate(([0.0], path.joins, [path.length]))
    share = np.linspace(margin, 1.0 - margin, per_piece)
    return (knots[:-1, np.newaxis] + np.diff(knots)[:, np.newaxis] * share).ravel()


def distance_to_polyline(points, at):
    """Return the distance of each place from the nearest leg, written plainly."""
    nearest = np.full(len(at), np.inf)
    for a, b in zip(points[:-1], points[1:]):
        share = np.clip((at - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
        foot = a + share[:, np.newaxis] * (b - a)
        nearest = np.minimum(nearest, np.linalg.norm(at - foot, axis=1))
    return nearest
