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

"""Sections 5.2.4-5.2.5, how links move, as printed and as corrected, against differentiation."""

from math import cos, sin

from helpers import table_5_1
from helpers.comparison import differ, DIFFERENCES, rate, ROUNDING
from helpers.random_cases import ARMS, random_states
from helpers.thesis_arm import ThesisArm
from helpers.thesis_link_motion import link_motion
import numpy as np
import pytest
from rrr_traj_planner.core.kinematics.forward import jacobian

K = np.array([0.0, 0.0, 1.0])


def states(seed, n=20):
    return list(zip(*random_states(np.random.default_rng(seed), n)))


def inverse_rotation_1(theta, sign):
    """Return the matrix of 5.13 and 5.19 with a sign before s1."""
    c, s = cos(theta), sin(theta)
    return np.array([[c, sign * s, 0.0], [0.0, 0.0, 1.0], [s, -c, 0.0]])


def test_5_13_and_5_19_print_a_matrix_that_is_no_rotation():
    for q, _, _ in states(210):
        true = table_5_1.rotation(ThesisArm(), q, 1).T
        assert inverse_rotation_1(q[0], 1.0) == pytest.approx(true, abs=ROUNDING)
        printed = inverse_rotation_1(q[0], -1.0)
        assert differ(printed, true)
        assert differ(printed @ printed.T, np.eye(3))
        # Their results stand: only the third column is used.
        assert printed @ K == pytest.approx(true @ K, abs=ROUNDING)


def test_5_14_s_first_row_is_s2():
    for q, qd, qdd in states(211):
        true = table_5_1.angular_velocity(ThesisArm(), q, qd, 2)
        printed, corrected = ((first * qd[0], cos(q[1]) * qd[0], qd[1])
                              for first in (cos(q[1]), sin(q[1])))
        assert differ(printed, true)
        assert corrected == pytest.approx(true, abs=ROUNDING)
        motion = link_motion(ThesisArm(), q, qd, qdd)
        assert motion.angular_velocity[1] == pytest.approx(corrected, abs=ROUNDING)


def test_5_15_repeats_the_slip_of_5_14_but_its_result_holds():
    for q, qd, qdd in states(212):
        true = table_5_1.angular_velocity(ThesisArm(), q, qd, 3)
        c3, s3, q23 = cos(q[2]), sin(q[2]), q[1] + q[2]
        turn = np.array([[c3, s3, 0.0], [0.0, 0.0, 1.0], [s3, -c3, 0.0]])
        printed, corrected = (
            turn @ (np.array([first * qd[0], cos(q[1]) * qd[0], qd[1]]) + qd[2] * K)
            for first in (cos(q[1]), sin(q[1])))
        assert differ(printed, true)
        assert corrected == pytest.approx(true, abs=ROUNDING)
        result = (sin(q23) * qd[0], qd[1] + qd[2], -cos(q23) * qd[0])
        assert result == pytest.approx(true, abs=ROUNDING)
        motion = link_motion(ThesisArm(), q, qd, qdd)
        assert motion.angular_velocity[2] == pytest.approx(result, abs=ROUNDING)


@pytest.mark.parametrize('arm', ARMS)
def test_5_18_a_lacks_the_elbow_s_velocity(arm):
    for q, qd, _ in states(213):
        true = rate(lambda x: table_5_1.tip(arm, x), q, qd)
        R, w = table_5_1.rotation(arm, q, 3), table_5_1.angular_velocity(arm, q, qd, 3)
        printed = R @ np.cross(w, arm.d4 * K)
        of_elbow = rate(lambda x: table_5_1.elbow(arm, x), q, qd)
        assert differ(printed, true)
        assert of_elbow + printed == pytest.approx(true, abs=10 * ROUNDING)
        assert jacobian(arm, q) @ qd == pytest.approx(true, abs=10 * ROUNDING)  # 5.18.b


def angular_acceleration(q, qd, qdd, link):
    """Return a link's angular acceleration in its own frame, by differentiation."""
    return table_5_1.second_rate(
        lambda x, xd: table_5_1.angular_velocity(ThesisArm(), x, xd, link), q, qd, qdd)


def test_5_20_takes_joint_2_s_rate_and_acceleration():
    for q, qd, qdd in states(214):
        turn = np.array([[cos(q[1]), sin(q[1]), 0.0], [-sin(q[1]), cos(q[1]), 0.0], K])
        w1, wd1 = np.array([0.0, qd[0], 0.0]), np.array([0.0, qdd[0], 0.0])
        true = angular_acceleration(q, qd, qdd, 2)
        printed, corrected = (turn @ (wd1 + qdd[i] * K + np.cross(w1, qd[i] * K))
                              for i in (0, 1))
        assert differ(printed, true)
        assert corrected == pytest.approx(true, abs=DIFFERENCES)
        motion = link_motion(ThesisArm(), q, qd, qdd)
        assert motion.angular_acceleration[1] == pytest.approx(corrected, abs=10 * ROUNDING)


def test_5_22_is_link_3_s_acceleration_of_joint_3():
    for q, qd, qdd in states(215):
        w2 = table_5_1.angular_velocity(ThesisArm(), q, qd, 2)
        wd2, true = (angular_acceleration(q, qd, qdd, link) for link in (2, 3))
        c3, s3 = cos(q[2]), sin(q[2])
        turn = np.array([[c3, s3, 0.0], [0.0, 0.0, 1.0], [s3, -c3, 0.0]])
        printed, corrected = (wd2 + qdd[i] * K + np.cross(w2, qd[i] * K) for i in (1, 2))
        assert differ(printed, wd2)  # as printed, it should be link 2's own
        assert differ(turn @ printed, true)
        assert turn @ corrected == pytest.approx(true, abs=10 * DIFFERENCES)
        motion = link_motion(ThesisArm(), q, qd, qdd)
        assert motion.angular_acceleration[2] == pytest.approx(true, abs=10 * DIFFERENCES)


def test_5_28_takes_l3_for_the_centre_of_mass():
    for arm in ARMS:
        for q, qd, qdd in states(216, 5):
            def velocity(x, xd, arm=arm):
                return rate(lambda y: table_5_1.centre_of_mass(arm, y, 3), x, xd)

            motion = link_motion(arm, q, qd, qdd)
            w, wd, R = (m[2] for m in (motion.angular_velocity, motion.angular_acceleration,
                                       motion.rotation))
            true = table_5_1.second_rate(velocity, q, qd, qdd)
            printed, corrected = (
                motion.frame.acceleration[1] + R @ (
                    np.cross(wd, out * K) + np.cross(w, np.cross(w, out * K)))
                for out in (arm.d4, arm.l3))
            assert differ(printed, true)
            assert corrected == pytest.approx(true, abs=100 * DIFFERENCES)
            assert motion.centre_of_mass.acceleration[2] == pytest.approx(
                corrected, abs=100 * ROUNDING)
