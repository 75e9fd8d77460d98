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

"""Tip position and Jacobian: by hand, by Pinocchio, by differences."""

from helpers import thesis_cases as thesis
from helpers.pinocchio_arm import PinocchioArm
from helpers.random_cases import ARMS, central_difference, random_states
import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics, jacobian, jacobian_rate

# Sums of a few sines times lengths of about a metre, times joint velocities of a few rad/s.
ROUNDING = 1e-13
# Fourth-order differences with a step of 1e-3 on functions of unit scale.
DIFFERENCES = 1e-9
RIGHT = np.pi / 2


@pytest.mark.parametrize(('q', 'tip'), [
    ((0.0, 0.0, 0.0), (0.9, 0.0, -0.2)),            # upper arm level, forearm hanging
    ((0.0, 0.0, RIGHT), (1.6, 0.0, 0.5)),           # stretched out along x
    ((RIGHT, 0.0, RIGHT), (0.0, 1.6, 0.5)),         # the same along y
    ((0.3, RIGHT, RIGHT), (0.0, 0.0, 2.1)),         # stretched straight up
    ((0.0, 0.0, -RIGHT), (0.2, 0.0, 0.5)),          # folded back
    ((np.pi, RIGHT, 0.0), (-0.7, 0.0, 1.4)),        # upper arm up, forearm level, turned round
    ((0.0, np.pi / 6, np.pi / 3), (0.9 * np.sqrt(0.75) + 0.7, 0.0, 0.95)),
])
def test_tip_is_where_a_drawing_puts_it(q, tip):
    assert forward_kinematics(RobotModel(), q) == pytest.approx(tip, abs=1e-15)


@pytest.mark.parametrize('name', thesis.POINTS)
def test_thesis_joint_angles_lead_to_its_points(name):
    position, angles, _ = thesis.POINTS[name]
    tip = forward_kinematics(RobotModel(), np.deg2rad(angles))
    # Angles of four decimals place the tip of a 1.6 m arm to about 2 um.
    assert tip == pytest.approx(position, abs=3e-6)


@pytest.mark.parametrize('arm', ARMS)
def test_tip_jacobian_and_its_rate_agree_with_pinocchio(arm):
    reference = PinocchioArm(arm)
    states = random_states(np.random.default_rng(11), 200)
    tips = forward_kinematics(arm, states[0])
    jacobians = jacobian(arm, states[0])
    rates = jacobian_rate(arm, *states[:2])
    for i, (q, qd, qdd) in enumerate(zip(*states)):
        reference.move(q, qd, qdd)
        position, velocity, acceleration = reference.point_motion(reference.frame_ids[2])
        assert tips[i] == pytest.approx(position, abs=ROUNDING)
        assert jacobians[i] == pytest.approx(reference.tip_jacobian(), abs=ROUNDING)
        assert rates[i] == pytest.approx(reference.tip_jacobian_rate(), abs=10 * ROUNDING)
        assert jacobians[i] @ qd == pytest.approx(velocity, abs=10 * ROUNDING)
        assert jacobians[i] @ qdd + rates[i] @ qd == pytest.approx(
            acceleration, abs=100 * ROUNDING)


@pytest.mark.parametrize('arm', ARMS)
def test_jacobian_is_the_derivative_of_the_tip(arm):
    for q in random_states(np.random.default_rng(12), 50)[0]:
        for joint, direction in enumerate(np.eye(3)):
            along = central_difference(
                lambda x, d=direction, q=q: forward_kinematics(arm, q + x * d), 0.0, 1e-3)
            assert jacobian(arm, q)[:, joint] == pytest.approx(along, abs=DIFFERENCES)


@pytest.mark.parametrize('arm', ARMS)
def test_jacobian_rate_is_the_jacobian_s_derivative_in_time(arm):
    q, qd, _ = random_states(np.random.default_rng(13), 50)
    by_differences = central_difference(lambda t: jacobian(arm, q + t * qd), 0.0, 2e-4)
    assert jacobian_rate(arm, q, qd) == pytest.approx(by_differences, abs=DIFFERENCES)


def test_jacobian_loses_rank_where_the_arm_is_stretched():
    # The tip cannot move further out: velocity along the stretched arm is zero.
    J = jacobian(RobotModel(), (0.4, 0.7, RIGHT))
    outward = np.array([np.cos(0.4) * np.cos(0.7), np.sin(0.4) * np.cos(0.7), np.sin(0.7)])
    assert outward @ J == pytest.approx(np.zeros(3), abs=1e-15)


def test_many_poses_at_once_equal_one_by_one():
    arm = ARMS[1]
    q, qd, _ = (v.reshape(4, 5, 3) for v in random_states(np.random.default_rng(14), 20))
    for at_once, one in ((forward_kinematics(arm, q), lambda i: forward_kinematics(arm, q[i])),
                         (jacobian(arm, q), lambda i: jacobian(arm, q[i])),
                         (jacobian_rate(arm, q, qd), lambda i: jacobian_rate(arm, q[i], qd[i]))):
        for i in np.ndindex(4, 5):
            assert at_once[i] == pytest.approx(one(i), abs=ROUNDING)


@pytest.mark.parametrize('call', [
    lambda bad: forward_kinematics(RobotModel(), bad),
    lambda bad: jacobian(RobotModel(), bad),
    lambda bad: jacobian_rate(RobotModel(), bad, np.zeros(3))])
def test_wrong_shape_is_refused(call):
    with pytest.raises(InvalidInputError, match=r'^q has shape \(2,\), must have \(\.\.\., 3\)$'):
        call([0.0, 1.0])


def test_velocity_of_wrong_shape_is_refused_by_name():
    with pytest.raises(InvalidInputError, match=r'^qd has shape \(\), must have'):
        jacobian_rate(RobotModel(), np.zeros(3), 1.0)
