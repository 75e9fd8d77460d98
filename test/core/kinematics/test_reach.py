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

"""The surface of what the tip reaches, against volumes and points that are known."""

from __future__ import annotations

from collections import Counter
from math import inf, pi

from helpers.places import CONFIG
from helpers.thesis_arm import ThesisArm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.urdf_arm import read_urdf
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.reach import reach

ARM = ThesisArm()
OFF = 0.03  # of the reach: about one cell


def limits(low, high):
    none = np.full(3, inf)
    return JointLimits(np.array(low), np.array(high), none, none, none, none)


NO_RANGES = limits((-inf,) * 3, (inf,) * 3)


def volume(surface):
    """Return the volume inside, positive where faces are counterclockwise from outside."""
    a, b, c = (surface.vertices[surface.faces[:, i]] for i in range(3))
    return np.einsum('ij,ij->', a, np.cross(b, c)) / 6.0


def test_without_ranges_it_is_the_shell_about_the_shoulder():
    surface = reach(ARM, NO_RANGES)
    near, far = ARM.reach
    assert volume(surface) == pytest.approx(4.0 / 3.0 * pi * (far ** 3 - near ** 3), rel=0.05)
    distance = np.linalg.norm(surface.vertices - (0.0, 0.0, ARM.d1), axis=1)
    is_outer = distance > 0.5 * (near + far)
    assert np.abs(distance[is_outer] - far).max() < OFF * far
    assert np.abs(distance[~is_outer] - near).max() < 2.0 * OFF * far  # across the cells' corners


def test_half_the_range_of_joint_1_is_half_the_space():
    # elbow and tip in front of the arm, so that no point is reached from both sides
    low, high = (0.0, 0.0, -0.5), (0.8, 0.5)
    half = reach(ARM, limits(low, (pi, *high)))
    whole = reach(ARM, limits((-inf, *low[1:]), (inf, *high)))
    assert volume(half) == pytest.approx(0.5 * volume(whole), rel=0.05)


@pytest.mark.parametrize(('low', 'high'), [
    ((0.0, 0.0, -1.0), (0.5 * pi, 2.0, 2.0)), ((-2.0, -1.0, -2.5), (2.5, 1.0, 0.5))])
def test_all_tips_are_within_and_the_surface_is_near_some(low, high):
    surface = reach(ARM, limits(low, high))
    tips = forward_kinematics(ARM, np.random.default_rng(1).uniform(low, high, (60000, 3)))
    room = 3.0 * OFF * ARM.reach[1]  # sharp edges are rounded
    assert (tips > surface.vertices.min(axis=0) - room).all()
    assert (tips < surface.vertices.max(axis=0) + room).all()
    for vertex in surface.vertices[::400]:
        assert np.linalg.norm(tips - vertex, axis=1).min() < room


@pytest.mark.parametrize('file', sorted((CONFIG / 'arms').glob('*.urdf')), ids=lambda f: f.stem)
def test_other_arms_are_within_their_size(file):
    arm = read_urdf(file)
    surface = reach(arm.model(), arm.joint_limits())
    distance = np.linalg.norm(surface.vertices - arm.chain.point[0], axis=1)
    tips = forward_kinematics(arm.model(), np.random.default_rng(3).uniform(
        np.maximum(arm.min_position, -pi), np.minimum(arm.max_position, pi), (5000, 3)))
    largest = np.linalg.norm(tips - arm.chain.point[0], axis=1).max()
    assert distance.max() == pytest.approx(largest, rel=0.06)


def test_surface_is_closed_but_for_the_axis():
    surface = reach(ARM, limits((0.0, 0.0, -1.0), (1.0, 2.0, 2.0)))
    ends = [tuple(sorted(edge)) for face in surface.faces.tolist()
            for edge in zip(face, face[1:] + face[:1])]
    open_ends = [edge for edge, count in Counter(ends).items() if count % 2]
    assert not surface.vertices[open_ends][..., :2].any()
