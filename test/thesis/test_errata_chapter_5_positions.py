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

"""Sections 5.2.1-5.2.3, positions, as printed and as corrected, against table 5.1's matrices."""

from math import acos, atan, atan2, cos, hypot, pi, sin

from helpers import table_5_1
from helpers.comparison import differ, rate, ROUNDING
from helpers.pinocchio_arm import PinocchioArm
from helpers.random_cases import ARMS, random_states
from helpers.thesis_arm import ThesisArm
import numpy as np
import pytest
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics


def states(seed, n=20):
    return list(zip(*random_states(np.random.default_rng(seed), n)))


def test_table_5_1_s_d3_is_d4_along_z3():
    for arm in ARMS:
        reference = PinocchioArm(arm)
        for q, qd, qdd in states(201):
            second = table_5_1.frames(arm, q)[1]
            offset = table_5_1.denavit_hartenberg(q[2], 0.0, arm.d4, pi / 2)  # d3 along z2
            printed, corrected = (second @ offset)[:3, 3], table_5_1.tip(arm, q)
            # The thesis's own 5.18 tells which of both is meant: the tip's velocity.
            Z = arm.d4 * cos(q[1] + q[2]) - arm.a2 * sin(q[1])
            column = np.array([Z * cos(q[0]), Z * sin(q[0]), arm.d4 * sin(q[1] + q[2])
                               + arm.a2 * cos(q[1])])
            assert rate(lambda x, a=arm: table_5_1.tip(a, x), q, (0.0, 1.0, 0.0)) == pytest.approx(
                column, abs=ROUNDING)
            assert differ(printed, corrected)
            reference.move(q, qd, qdd)
            assert forward_kinematics(arm, q) == pytest.approx(corrected, abs=ROUNDING)


def reach_and_height(arm, q, sign=-1.0, length=None):
    """Return r and h of 5.6 and 5.5, as corrected or with a slip of the print."""
    length = arm.d4 if length is None else length
    return (arm.a2 * cos(q[1]) + length * sin(q[1] + q[2]),
            arm.a2 * sin(q[1]) + sign * length * cos(q[1] + q[2]))


@pytest.mark.parametrize('arm', ARMS)
def test_5_4_to_5_6_corrected_are_the_tip(arm):
    for q, _, _ in states(202):
        true = table_5_1.tip(arm, q)
        r, h = reach_and_height(arm, q)
        corrected = np.array([cos(q[0]) * r, sin(q[0]) * r, arm.d1 + h])
        assert corrected == pytest.approx(true, abs=ROUNDING)
        assert forward_kinematics(arm, q) == pytest.approx(corrected, abs=ROUNDING)


@pytest.mark.parametrize('arm', ARMS)
def test_5_4_turns_the_arm_by_a_right_angle(arm):
    for q, _, _ in states(203):
        r, h = reach_and_height(arm, q)
        printed = np.array([-sin(q[0]) * r, cos(q[0]) * r, arm.d1 + h])
        true = table_5_1.tip(arm, q)
        assert differ(printed, true)
        # At odds with 5.8 too: the arm would lie across the direction theta_1 = atan(y / x).
        across = printed[0] * cos(q[0]) + printed[1] * sin(q[0])
        assert across == pytest.approx(0.0, abs=ROUNDING)


@pytest.mark.parametrize('arm', ARMS)
def test_5_5_needs_minus_and_d4(arm):
    q = np.array([s[0] for s in states(204)])
    true = [table_5_1.tip(arm, x)[2] - arm.d1 for x in q]
    assert differ([reach_and_height(arm, x, sign=1.0)[1] for x in q], true)
    assert differ([reach_and_height(arm, x, length=0.0)[1] for x in q], true)  # a3 is 0
    assert [reach_and_height(arm, x)[1] for x in q] == pytest.approx(true, abs=ROUNDING)


@pytest.mark.parametrize('arm', ARMS)
def test_5_6_needs_d4(arm):
    q = np.array([s[0] for s in states(205)])
    true = [np.cos(x[0]) * table_5_1.tip(arm, x)[0] + np.sin(x[0]) * table_5_1.tip(arm, x)[1]
            for x in q]
    assert differ([reach_and_height(arm, x, length=0.0)[0] for x in q], true)  # a3 is 0
    assert [reach_and_height(arm, x)[0] for x in q] == pytest.approx(true, abs=ROUNDING)


def test_5_8_needs_the_quadrant():
    arm, q = ThesisArm(), np.array([2.5, 0.9, 0.4])  # x < 0
    x, y, _ = table_5_1.tip(arm, q)
    assert differ(atan(y / x), q[0])
    assert atan2(y, x) == pytest.approx(q[0], abs=ROUNDING)
    assert inverse_kinematics(arm, table_5_1.tip(arm, q))[0] == pytest.approx(q[0], abs=ROUNDING)


def elbow_up_poses(arm, seed):
    """Return poses with theta_3 in (-90, 90) deg, their tips, r, h and the shoulder's distance."""
    rng = np.random.default_rng(seed)
    for q in np.column_stack((rng.uniform(-3.0, 3.0, 20), rng.uniform(0.2, 1.2, 20),
                              rng.uniform(-1.4, 1.4, 20))):
        tip = table_5_1.tip(arm, q)
        radius, height = hypot(tip[0], tip[1]), tip[2] - arm.d1
        if cos(q[0]) * tip[0] + sin(q[0]) * tip[1] > 0.0:
            yield q, tip, radius, height, hypot(radius, height)


@pytest.mark.parametrize('arm', ARMS)
def test_5_9_needs_the_square_of_a2(arm):
    printed, corrected, true = [], [], []
    for q, tip, _, _, W in elbow_up_poses(arm, 206):
        joint = table_5_1.elbow(arm, q)
        back, out = np.array([0.0, 0.0, arm.d1]) - joint, tip - joint
        true.append(back @ out / (arm.a2 * arm.d4))  # the cosine of the triangle's angle
        printed.append((arm.a2 + arm.d4 ** 2 - W ** 2) / (2.0 * arm.a2 * arm.d4))
        corrected.append((arm.a2 ** 2 + arm.d4 ** 2 - W ** 2) / (2.0 * arm.a2 * arm.d4))
    assert differ(printed, true)
    assert corrected == pytest.approx(true, abs=ROUNDING)


@pytest.mark.parametrize('arm', ARMS)
def test_5_10_needs_minus(arm):
    for q, tip, _, _, W in elbow_up_poses(arm, 207):
        gamma = acos((arm.a2 ** 2 + arm.d4 ** 2 - W ** 2) / (2.0 * arm.a2 * arm.d4))
        assert differ(gamma + pi / 2, q[2])
        assert gamma - pi / 2 == pytest.approx(q[2], abs=1e-8)  # acos near its ends
        assert inverse_kinematics(arm, tip, 'up')[2] == pytest.approx(q[2], abs=1e-10)
        down = inverse_kinematics(arm, tip, 'down')
        assert (1.5 * pi - gamma - down[2] + 1.0) % (2.0 * pi) == pytest.approx(1.0, abs=1e-8)
        assert table_5_1.tip(arm, down) == pytest.approx(tip, abs=1e-10)


@pytest.mark.parametrize('arm', ARMS)
def test_5_11_needs_the_square_of_a2_and_w_in_its_denominator(arm):
    printed, squared, corrected, true = [], [], [], []
    for q, tip, _, _, W in elbow_up_poses(arm, 208):
        shoulder = np.array([0.0, 0.0, arm.d1])
        true.append((table_5_1.elbow(arm, q) - shoulder) @ (tip - shoulder) / (arm.a2 * W))
        printed.append((arm.a2 - arm.d4 ** 2 + W ** 2) / (2.0 * arm.a2 * arm.d4))
        squared.append((arm.a2 ** 2 - arm.d4 ** 2 + W ** 2) / (2.0 * arm.a2 * arm.d4))
        corrected.append((arm.a2 ** 2 - arm.d4 ** 2 + W ** 2) / (2.0 * arm.a2 * W))
    assert differ(printed, true)
    assert differ(squared, true)
    assert corrected == pytest.approx(true, abs=ROUNDING)


@pytest.mark.parametrize('arm', ARMS)
def test_5_12_needs_height_over_reach(arm):
    printed, corrected, true = [], [], []
    for q, tip, r, h, W in elbow_up_poses(arm, 209):
        alpha = acos((arm.a2 ** 2 - arm.d4 ** 2 + W ** 2) / (2.0 * arm.a2 * W))
        printed.append(atan(r / h) + alpha)
        corrected.append(atan2(h, r) + alpha)
        true.append(q[1])
        assert inverse_kinematics(arm, tip, 'up')[1] == pytest.approx(q[1], abs=1e-10)
    assert differ(printed, true)
    assert corrected == pytest.approx(true, abs=1e-7)  # acos near its ends
