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

"""Which trajectories are refused, in which words; the rules of joint_trajectory_controller."""

from __future__ import annotations

from array import array
from math import inf, nan

import numpy as np
import pytest
from rrr_traj_planner.core.control.trajectory_validation import (
    check_trajectory,
    commanded_points,
    IncomingPoint,
    IncomingTrajectory,
    Rules,
)
from rrr_traj_planner.core.errors import InvalidInputError

NAMES = ('joint_1', 'joint_2', 'joint_3')
SECOND = 10 ** 9
NOW = 1000 * SECOND
Q = (0.1, 0.2, 0.3)
ZERO = (0.0, 0.0, 0.0)


def trajectory(*points, names=NAMES, stamp=0):
    return IncomingTrajectory(names, stamp, points)


def point(time=1.0, q=Q, **fields):
    return IncomingPoint(round(time * SECOND), q, **fields)


REFUSED = {
    'a joint missing': (
        trajectory(point(), names=NAMES[:2]),
        "Joints on incoming trajectory don't match the controller joints."),
    'no names': (
        trajectory(point(), names=()),
        "Joints on incoming trajectory don't match the controller joints."),
    'no points': (trajectory(), 'Empty trajectory received.'),
    'another name': (
        trajectory(point(), names=('joint_1', 'joint_2', 'elbow')),
        "Incoming joint elbow doesn't match the controller's joints."),
    'a name twice': (
        trajectory(point(), names=('joint_1', 'joint_2', 'joint_1')),
        'Incoming joint joint_1 is named twice.'),
    'moving at the end': (
        trajectory(point(velocities=(0.0, 0.25, 0.0))),
        'Velocity of last trajectory point of joint joint_2 is not zero: 0.250000000000000'),
    'ended before now': (
        trajectory(point(2.5), stamp=900 * SECOND),
        'Received trajectory with non-zero start time (900.000000) that ends in the past '
        '(902.500000)'),
    'times that repeat': (
        trajectory(point(0.5), point(1.25), point(1.25)),
        'Time between points 1 and 2 is not strictly increasing, it is 1.250000 and 1.250000 '
        'respectively'),
    'a negative first time': (
        trajectory(point(-0.5), point(1.0)), 'Time of point #0 is negative: -0.500000'),
    'no positions': (
        trajectory(point(q=())),
        'Mismatch between joint_names size (3) and positions (0) at point #0.'),
    'a velocity too few': (
        trajectory(point(0.5, velocities=(0.0, 0.0)), point()),
        'Mismatch between joint_names size (3) and velocities (2) at point #0.'),
    'an acceleration too many': (
        trajectory(point(0.5), point(accelerations=ZERO + (0.0,))),
        'Mismatch between joint_names size (3) and accelerations (4) at point #1.'),
    'a velocity too many at the end': (
        trajectory(point(velocities=ZERO + (1.0,))),
        'Mismatch between joint_names size (3) and velocities (4) at point #0.'),
    'efforts': (
        trajectory(point(effort=ZERO)),
        'Trajectories with effort fields are only supported for controllers using the '
        "'effort' command interface."),
    'a position that is no number': (
        trajectory(point(q=(0.0, nan, 0.0))),
        'Value of positions of joint joint_2 at point #0 is not finite: nan'),
    'an infinite acceleration': (
        trajectory(point(accelerations=(0.0, 0.0, -inf))),
        'Value of accelerations of joint joint_3 at point #0 is not finite: -inf'),
    'a position that only makes numbers overflow': (
        trajectory(point(q=(0.0, 1e150, 0.0))),
        'Value of positions of joint joint_2 at point #0 is 1e+150, must be within 1e+06'),
    'a velocity, likewise': (
        trajectory(point(0.5, velocities=(-1.1e6, 0.0, 0.0)), point()),
        'Value of velocities of joint joint_1 at point #0 is -1.1e+06, must be within 1e+06'),
}


@pytest.mark.parametrize('case', REFUSED)
def test_refused_with_the_controller_s_text(case):
    incoming, text = REFUSED[case]
    with pytest.raises(InvalidInputError) as caught:
        check_trajectory(incoming, NAMES, NOW)
    assert str(caught.value) == text


@pytest.mark.parametrize('incoming', [
    trajectory(point(0.0)), trajectory(point(velocities=(1e-8, 0.0, 0.0))),
    trajectory(point(velocities=ZERO, accelerations=ZERO)),
    trajectory(point(101.0), stamp=900 * SECOND), trajectory(point(), stamp=2 * NOW),
    trajectory(point(0.5, velocities=(1.0, 1.0, 1.0)), point())])
def test_accepted(incoming):
    check_trajectory(incoming, NAMES, NOW)


PARTIAL = Rules(allow_partial_joints_goal=True)


def test_partial_goal_is_taken_where_it_is_allowed_and_the_rest_held():
    incoming = trajectory(point(0.5, (3.0, 1.0), velocities=(0.3, 0.1)), point(1.0, (6.0, 4.0)),
                          names=('joint_3', 'joint_1'))
    with pytest.raises(InvalidInputError, match="Joints on incoming trajectory don't match"):
        check_trajectory(incoming, NAMES, NOW)
    check_trajectory(incoming, NAMES, NOW, PARTIAL)
    points = commanded_points(incoming, NAMES, held=(7.0, 8.0, 9.0))
    np.testing.assert_array_equal(points.positions, ((1.0, 8.0, 3.0), (4.0, 8.0, 6.0)))
    np.testing.assert_array_equal(points.velocities, ((0.1, 0.0, 0.3), ZERO))
    assert points.has_velocity.tolist() == [True, False]


@pytest.mark.parametrize(('incoming', 'text'), [
    (trajectory(point(), names=()), 'Empty joint names on incoming trajectory.'),
    (trajectory(point(), names=('joint_2',)),
     'Mismatch between joint_names size (1) and positions (3) at point #0.'),
    (trajectory(point(q=(0.1,)), names=('elbow',)),
     "Incoming joint elbow doesn't match the controller's joints."),
    (trajectory(point(q=(0.1, 0.2)), names=('joint_1', 'joint_1')),
     'Incoming joint joint_1 is named twice.')])
def test_partial_goals_are_checked_too(incoming, text):
    with pytest.raises(InvalidInputError) as caught:
        check_trajectory(incoming, NAMES, NOW, PARTIAL)
    assert str(caught.value) == text


def test_velocity_at_the_end_is_taken_where_it_is_allowed():
    incoming = trajectory(point(velocities=(0.0, 0.25, 0.0)))
    check_trajectory(incoming, NAMES, NOW, Rules(allow_nonzero_velocity_at_trajectory_end=True))


def test_joints_come_out_in_the_arm_s_order():
    incoming = trajectory(
        point(0.5, (3.0, 1.0, 2.0), velocities=(0.3, 0.1, 0.2)), point(1.0, (6.0, 4.0, 5.0)),
        names=('joint_3', 'joint_1', 'joint_2'))
    check_trajectory(incoming, NAMES, NOW)
    points = commanded_points(incoming, NAMES)
    np.testing.assert_array_equal(points.times, (0.5, 1.0))
    np.testing.assert_array_equal(points.positions, ((1.0, 2.0, 3.0), (4.0, 5.0, 6.0)))
    np.testing.assert_array_equal(points.velocities, ((0.1, 0.2, 0.3), ZERO))
    assert points.has_velocity.tolist() == [True, False]
    assert points.has_acceleration.tolist() == [False, False]


def test_arrays_of_a_message_are_read():
    incoming = trajectory(point(0.5, array('d', Q), velocities=array('d')),
                          point(1.0, array('d', Q), velocities=array('d', ZERO)))
    check_trajectory(incoming, list(NAMES), NOW)
    assert commanded_points(incoming, list(NAMES)).has_velocity.tolist() == [False, True]
