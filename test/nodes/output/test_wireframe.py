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

"""Shapes for drawing the arm: rods, the trail, picked points."""

from __future__ import annotations

import numpy as np
import pytest
from rrr_traj_planner.nodes.output.wireframe import picked, rod, Trail

ROUNDING = 1e-12  # m, rad


def rotated_z(quaternion):
    """Return the third column of a quaternion's rotation matrix."""
    x, y, z, w = quaternion
    return np.array([2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)])


def ends(shape):
    half = 0.5 * shape.length * rotated_z(shape.quaternion)
    return np.array([shape.centre - half, shape.centre + half])


AXES = [tuple(s * x for x in row) for row in np.eye(3).tolist() for s in (1.0, -1.0)]
SLANTED = [tuple(row) for row in np.random.default_rng(2).normal(size=(10, 3)).tolist()]


@pytest.mark.parametrize('end', [*AXES, *SLANTED, (1e-9, 0.0, -1.0), (0.0, 1e-9, 1e-9)])
def test_rod_ends_at_both_points(end):
    start = (0.3, -0.2, 0.1)
    end = tuple(a + b for a, b in zip(start, end))
    shape = rod(start, end)
    assert np.linalg.norm(shape.quaternion) == pytest.approx(1.0, abs=ROUNDING)
    found = ends(shape)
    if np.linalg.norm(found[0] - start) > np.linalg.norm(found[1] - start):
        found = found[::-1]
    np.testing.assert_allclose(found, [start, end], rtol=0.0, atol=ROUNDING)


def test_rod_between_equal_points_has_no_length():
    assert rod((1.0, 2.0, 3.0), (1.0, 2.0, 3.0)) == ((1.0, 2.0, 3.0), (0.0, 0.0, 0.0, 1.0), 0.0)


def test_trail_keeps_steps_and_forgets_the_oldest():
    trail = Trail(0.1, 5)
    for x in np.arange(0.0, 1.0, 0.03125).tolist():  # exact in binary
        trail.add((x, 0.0, 0.0))
    assert [x for x, _, _ in trail.places] == [0.375, 0.5, 0.625, 0.75, 0.875]
    trail.clear()
    assert not trail.places


def test_trail_of_what_rests_is_one_place():
    trail = Trail(0.1, 5)
    for _ in range(100):
        trail.add((1.0, 1.0, 1.0))
    assert list(trail.places) == [(1.0, 1.0, 1.0)]


@pytest.mark.parametrize(('count', 'most', 'wanted', 'expected'), [
    (4, 10, None, [0, 1, 2, 3]), (0, 10, None, []), (1, 1, None, [0]),
    (101, 3, None, [0, 50, 100]), (101, 3, [50, 51], [0, 50, 51, 100])])
def test_points_are_picked_evenly_with_ends_and_what_is_wanted(count, most, wanted, expected):
    indices = picked(count, most, None if wanted is None else np.array(wanted))
    assert indices.tolist() == expected


def test_neighbours_among_picked_points_are_equally_far_apart():
    steps = np.diff(picked(12345, 1000))
    assert set(steps.tolist()) <= {12, 13}
