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

"""Postures: of joint positions, of solutions, and where two of them meet."""

from helpers.random_cases import ARMS
import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics, nearest_solution
from rrr_traj_planner.core.kinematics.postures import (
    ELBOWS,
    Posture,
    posture_of,
    postures_near,
    SHOULDERS,
)

ROUNDING = 1e-13  # m
ALL_POSTURES = [Posture(elbow, shoulder) for elbow in ELBOWS for shoulder in SHOULDERS]


def turned(q, near):
    return q + 2.0 * np.pi * np.round((near - q) / (2.0 * np.pi))


@pytest.mark.parametrize('arm', ARMS)
def test_each_pose_is_the_solution_of_its_tip_in_its_own_posture(arm):
    rng, seen = np.random.default_rng(41), set()
    for q in rng.uniform(-7.0, 7.0, (300, 3)):
        if abs(np.cos(q[2])) < 0.05:  # stretched or folded: solutions lose digits
            continue
        posture = posture_of(arm, q)
        seen.add(posture)
        tip = forward_kinematics(arm, q)
        found = turned(inverse_kinematics(
            arm, tip, posture.elbow, shoulder=posture.shoulder), q)
        assert found == pytest.approx(q, abs=1e-9)
        assert nearest_solution(arm, tip, q) == pytest.approx(q, abs=1e-9)
    assert seen == set(ALL_POSTURES)


@pytest.mark.parametrize('arm', ARMS)
def test_all_four_postures_bring_the_tip_to_a_point_and_differ(arm):
    rng = np.random.default_rng(42)
    least, most = arm.reach
    for direction in rng.normal(size=(100, 3)):
        distance = rng.uniform(0.9 * least + 0.1 * most, 0.9 * most + 0.1 * least)
        point = direction / np.linalg.norm(direction) * distance + (0.0, 0.0, arm.d1)
        found = {p: inverse_kinematics(arm, point, p.elbow, shoulder=p.shoulder)
                 for p in ALL_POSTURES}
        for posture, q in found.items():
            assert np.linalg.norm(forward_kinematics(arm, q) - point) <= ROUNDING * most
            assert posture_of(arm, q) == posture
        gap = found[ALL_POSTURES[0]][0] - found[ALL_POSTURES[1]][0]
        assert abs(np.cos(gap) + 1.0) < 1e-12  # joint 1 half a turn away


def test_up_is_above_the_line_to_the_tip_with_the_shoulder_at_the_front():
    # By hand: upper arm upright, forearm level: the elbow is above; mirrored, below.
    assert posture_of(RobotModel(), np.array([0.3, np.pi / 2, 0.0])) == Posture('up', 'front')
    assert posture_of(RobotModel(), np.array([0.3, 0.0, np.pi])) == Posture('down', 'front')
    # The upper arm leans back 45 deg and the forearm goes on: 0.9 m and 0.7 m behind the axis.
    assert posture_of(RobotModel(), np.array([0.3, 0.75 * np.pi, 0.3])).shoulder == 'back'


def test_a_stretched_arm_and_one_on_the_axis_have_the_postures_that_meet_there():
    arm = RobotModel()
    upright = np.array([0.3, np.pi / 2, np.pi / 2])
    assert set(postures_near(arm, upright, 0.01)) == set(ALL_POSTURES)
    assert set(postures_near(arm, upright + [0.0, 1e-3, 1e-3], 0.01)) == set(ALL_POSTURES)
    assert len(postures_near(arm, upright + [0.0, 1e-3, 1e-3], 1e-4)) == 1
    level = np.array([0.3, 0.0, np.pi / 2])
    assert postures_near(arm, level, 0.01) == [Posture('up', 'front'), Posture('down', 'front')]
