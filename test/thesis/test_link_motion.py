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

"""Frames and centres of mass: by table 5.1's matrices, by Pinocchio, by differences."""

from helpers.pinocchio_arm import PinocchioArm
from helpers.random_cases import ARMS, central_difference, random_states
from helpers.thesis_arm import ThesisArm
from helpers.thesis_link_motion import link_motion
import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics

# Accelerations reach some hundred m/s^2 in the random states.
ROUNDING = 1e-12


def denavit_hartenberg(theta, a, d, alpha):
    """Return the transformation of equation 5.2 with its translation, one row of table 5.1."""
    c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    return np.array([[c, -s * ca, s * sa, a * c],
                     [s, c * ca, -c * sa, a * s],
                     [0.0, sa, ca, d],
                     [0.0, 0.0, 0.0, 1.0]])


@pytest.mark.parametrize('arm', ARMS)
def test_frames_are_products_of_table_5_1_s_matrices(arm):
    for q in random_states(np.random.default_rng(21), 50)[0]:
        first = denavit_hartenberg(q[0], 0.0, arm.d1, np.pi / 2)
        second = first @ denavit_hartenberg(q[1], arm.a2, 0.0, 0.0)
        third = second @ denavit_hartenberg(q[2], 0.0, 0.0, np.pi / 2)
        tip = third @ (0.0, 0.0, arm.d4, 1.0)  # the printed d3 is a length along z3
        motion = link_motion(arm, q, np.zeros(3), np.zeros(3))
        for i, frame in enumerate((first, second, third)):
            assert motion.rotation[i] == pytest.approx(frame[:3, :3], abs=ROUNDING)
        origins = (first[:3, 3], second[:3, 3], tip[:3])
        assert motion.frame.position == pytest.approx(np.array(origins), abs=ROUNDING)
        assert forward_kinematics(arm, q) == pytest.approx(tip[:3], abs=ROUNDING)


@pytest.mark.parametrize('arm', ARMS)
def test_motion_of_every_link_agrees_with_pinocchio(arm):
    reference = PinocchioArm(arm)
    states = random_states(np.random.default_rng(22), 200)
    motion = link_motion(arm, *states)
    for k, state in enumerate(zip(*states)):
        reference.move(*state)
        for i in range(3):
            frame, centre = reference.frame_ids[i], reference.centre_ids[i]
            velocity, acceleration = reference.angular_motion(frame)
            assert motion.rotation[k, i] == pytest.approx(reference.rotation(frame), abs=ROUNDING)
            assert motion.angular_velocity[k, i] == pytest.approx(velocity, abs=ROUNDING)
            assert motion.angular_acceleration[k, i] == pytest.approx(acceleration, abs=ROUNDING)
            for points, point in ((motion.frame, frame), (motion.centre_of_mass, centre)):
                expected = reference.point_motion(point)
                assert points.position[k, i] == pytest.approx(expected[0], abs=ROUNDING)
                assert points.velocity[k, i] == pytest.approx(expected[1], abs=ROUNDING)
                assert points.acceleration[k, i] == pytest.approx(expected[2], abs=10 * ROUNDING)


@pytest.mark.parametrize('arm', ARMS)
def test_velocities_and_accelerations_are_derivatives_in_time(arm):
    q, qd, qdd = random_states(np.random.default_rng(23), 50)

    def at(t):
        return link_motion(arm, q + t * qd + 0.5 * t * t * qdd, qd + t * qdd, qdd)

    now = at(0.0)
    for kind in ('frame', 'centre_of_mass'):
        points = getattr(now, kind)
        for derivative, quantity in ((points.velocity, 'position'),
                                     (points.acceleration, 'velocity')):
            by_differences = central_difference(
                lambda t, k=kind, n=quantity: getattr(getattr(at(t), k), n), 0.0, 2e-4)
            assert derivative == pytest.approx(by_differences, abs=1e-7)
    turning = central_difference(lambda t: at(t).angular_velocity, 0.0, 2e-4)
    assert now.angular_acceleration == pytest.approx(turning, abs=1e-7)


def test_angular_velocity_of_link_2_is_5_14_corrected():
    # First row s2, not the printed c2: at theta_2 = 30 deg they differ.
    motion = link_motion(ThesisArm(), (0.0, np.pi / 6, 0.0), (2.0, 3.0, 0.0), np.zeros(3))
    assert motion.angular_velocity[1] == pytest.approx((1.0, np.sqrt(3.0), 3.0), abs=1e-15)


def test_shoulder_and_first_centre_of_mass_never_move():
    motion = link_motion(ThesisArm(), *random_states(np.random.default_rng(24), 10))
    for points in (motion.frame, motion.centre_of_mass):
        assert (points.position[:, 0] == (0.0, 0.0, 0.5)).all()
        assert (points.velocity[:, 0] == 0.0).all()
        assert (points.acceleration[:, 0] == 0.0).all()


def test_many_states_at_once_equal_one_by_one():
    states = [v.reshape(2, 3, 3) for v in random_states(np.random.default_rng(25), 6)]
    at_once = link_motion(ARMS[2], *states)
    assert at_once.rotation.shape == (2, 3, 3, 3, 3)
    for k in np.ndindex(2, 3):
        one = link_motion(ARMS[2], *(v[k] for v in states))
        for name in ('rotation', 'angular_velocity', 'angular_acceleration'):
            assert getattr(at_once, name)[k] == pytest.approx(getattr(one, name), abs=ROUNDING)
        for name in ('frame', 'centre_of_mass'):
            for several, single in zip(getattr(at_once, name), getattr(one, name)):
                assert several[k] == pytest.approx(single, abs=10 * ROUNDING)


@pytest.mark.parametrize('name', ['q', 'qd', 'qdd'])
def test_wrong_shape_is_refused_by_name(name):
    values = {'q': np.zeros(3), 'qd': np.zeros(3), 'qdd': np.zeros(3), name: np.zeros(4)}
    with pytest.raises(InvalidInputError, match=rf'^{name} has shape \(4,\), must have'):
        link_motion(ThesisArm(), **values)
