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

"""Rotations: each form agrees with SciPy's, and the forms with one another."""

from __future__ import annotations

import numpy as np
import pytest
from rrr_traj_planner.core.rotations import (
    from_roll_pitch_yaw,
    quaternion,
    quaternion_product,
    roll_pitch_yaw,
    rotated,
    rotation,
    rotation_z_to,
)
from scipy.spatial.transform import Rotation

ROUNDING = 1e-14
RIGHT = np.pi / 2.0


def directions(count):
    found = np.random.default_rng(1).normal(size=(count, 3))
    return found / np.linalg.norm(found, axis=1)[:, np.newaxis]


def test_rotations_about_an_axis_are_scipy_s_for_one_angle_and_for_many():
    angles = np.linspace(-7.0, 7.0, 12).reshape(3, 4)
    for axis in directions(20):
        expected = Rotation.from_rotvec(angles.reshape(-1, 1) * axis).as_matrix()
        found = rotation(axis, angles)
        assert found == pytest.approx(expected.reshape(3, 4, 3, 3), abs=ROUNDING)
        assert rotation(axis, 0.4) == pytest.approx(
            Rotation.from_rotvec(0.4 * axis).as_matrix(), abs=ROUNDING)


def test_a_vector_is_rotated_as_by_the_matrix():
    vector = (0.3, -1.2, 0.7)
    for axis in directions(20):
        assert rotated(vector, axis.tolist(), 2.5) == pytest.approx(
            rotation(axis, 2.5) @ vector, abs=ROUNDING)


def test_z_is_taken_to_any_direction():
    for direction in (*directions(50), (0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0)):
        R = rotation_z_to(np.array(direction))
        assert R[:, 2] == pytest.approx(direction, abs=ROUNDING)
        assert R @ R.T == pytest.approx(np.eye(3), abs=ROUNDING)
        assert np.linalg.det(R) == pytest.approx(1.0)


def test_of_directions_above_the_horizon_the_rotation_is_the_shortest():
    for direction in directions(50):
        if direction[2] > 0.0:
            angle = Rotation.from_matrix(rotation_z_to(direction)).magnitude()
            assert np.cos(angle) == pytest.approx(direction[2])


@pytest.mark.parametrize('pitch', [-RIGHT, -1.0, 0.0, 0.3, RIGHT])
def test_roll_pitch_and_yaw_are_about_fixed_axes_and_are_found_again(pitch):
    for roll, yaw in np.random.default_rng(2).uniform(-3.0, 3.0, (20, 2)):
        R = from_roll_pitch_yaw((roll, pitch, yaw))
        assert R == pytest.approx(
            Rotation.from_euler('xyz', (roll, pitch, yaw)).as_matrix(), abs=ROUNDING)
        assert from_roll_pitch_yaw(roll_pitch_yaw(R)) == pytest.approx(R, abs=ROUNDING)


def rotations():
    """Return random rotations, and those in which components of the quaternion vanish."""
    halves = [Rotation.from_rotvec(np.pi * np.array(axis)) for axis in np.eye(3)]
    return [Rotation.identity(), *halves, halves[0] * Rotation.from_rotvec((1e-9, 0.0, 0.0)),
            *Rotation.random(50, random_state=3)]


def test_quaternions_are_scipy_s():
    for R in rotations():
        found = np.array(quaternion(R.as_matrix()))
        assert np.abs(found @ R.as_quat()) == pytest.approx(1.0, abs=ROUNDING)
        assert Rotation.from_quat(found).as_matrix() == pytest.approx(R.as_matrix(), abs=1e-13)


def test_product_of_quaternions_is_that_of_rotations():
    for a, b in zip(rotations(), reversed(rotations())):
        found = Rotation.from_quat(quaternion_product(tuple(a.as_quat()), tuple(b.as_quat())))
        assert found.as_matrix() == pytest.approx((a * b).as_matrix(), abs=1e-13)
