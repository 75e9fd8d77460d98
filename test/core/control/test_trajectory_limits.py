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

"""Where trajectories leave ranges and limits: at their points, between them, in other units."""

from __future__ import annotations

import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.control.trajectory_limits import ACCURACY, excesses
from rrr_traj_planner.core.trajectory.reference_trajectory import reference_through
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints

LIMITS = JointLimits()  # ranges [0, pi/2], [0, pi], [-pi, 2 pi]; 1 rad/s, 1 rad/s^2
WIDE = JointLimits(max_velocity=[100.0] * 3, max_acceleration=[1000.0] * 3)
NAMES = ('joint_1', 'joint_2', 'joint_3')
Q = np.array([0.5, 1.0, 0.2])


def single(q, time=100.0):
    return TrajectoryPoints([time], [q], *np.zeros((2, 1, 3)), [False], [False])


def two(start, end, T, v=0.0, a=0.0, order=5):
    """Return two points of joint 1 with a velocity and acceleration at the first, rest after."""
    q = np.tile(Q, (2, 1))
    q[:, 0] = start, end
    qd, qdd = np.zeros((2, 2, 3))
    qd[0, 0], qdd[0, 0] = v, a
    return TrajectoryPoints([0.0, T], q, qd, qdd, [order > 1] * 2, [order > 3] * 2)


def texts(*arguments):
    return [x.text(NAMES) for x in excesses(*arguments)]


def test_point_outside_ranges_is_reported_with_joint_value_range_and_unit():
    assert texts(single((34.0, 57.0, 17.0)), LIMITS) == [
        'joint_1 goes to 34 rad, range [0, 1.5708] rad (in degrees?)',
        'joint_2 goes to 57 rad, range [0, 3.14159] rad (in degrees?)',
        'joint_3 goes to 17 rad, range [-3.14159, 6.28319] rad (in degrees?)']


@pytest.mark.parametrize(('q', 'hints'), [
    ((34.0, 57.0, -117.0), [True, True, True]),
    ((-34.0, 57.0, 17.0), [False, True, True]),  # -34 degrees are out of range too
    ((90.5, 1.0, 0.2), [False]),
    ((0.5, 1.0, 359.0), [True]),
    ((0.5, 1.0, 361.0), [False]),
    ((1.8, 1.0, 0.2), [False]),                  # a near miss is one in radians
    ((0.5, 3.5, 0.2), [False]),
    ((0.5, 1.0, 12.0), [False]),
    ((5.0, 1.0, 0.2), [True])])
def test_warning_asks_for_degrees_where_they_explain_the_numbers(q, hints):
    assert [x.in_degrees for x in excesses(single(q), LIMITS)] == hints


def test_all_numbers_of_a_joint_have_to_be_explained():
    points = TrajectoryPoints([1.0, 2.0], [(34.0, 1.0, 0.2), (-34.0, 1.0, 0.2)],
                              *np.zeros((2, 2, 3)), [False] * 2, [False] * 2)
    assert not any(x.in_degrees for x in excesses(points, WIDE))


def test_warning_asks_for_velocities_in_degrees():
    found = excesses(two(0.5, 0.5, 0.01, v=30.0), LIMITS)
    assert [x.in_degrees for x in found if x.quantity == 'velocity'] == [True]
    found = excesses(two(0.5, 0.5, 0.01, v=90.0), LIMITS)  # 1.57 rad/s is too fast as well
    assert [x.in_degrees for x in found if x.quantity == 'velocity'] == [False]


@pytest.mark.parametrize('q', [(0.0, 0.0, -np.pi), (np.pi / 2, np.pi, 2 * np.pi),
                               (1.5708, 3.1416, 6.2832), Q])
def test_ends_of_ranges_are_within_them_rounded_to_four_digits_too(q):
    assert excesses(single(q), LIMITS) == []


def test_cubic_overshoots_between_its_points():
    # q = q0 + v t (1 - t/T)^2 from rest position to the same: most at t = T/3, 4/27 v T
    found, = excesses(two(1.4, 1.4, 2.0, v=0.9, order=3), WIDE)
    assert found.value == pytest.approx(1.4 + 4.0 / 27.0 * 0.9 * 2.0, rel=ACCURACY)
    assert (found.joint, found.quantity, found.in_degrees) == (0, 'position', False)
    found, = excesses(two(0.1, 0.1, 2.0, v=-0.9, order=3), WIDE)
    assert found.value == pytest.approx(0.1 - 4.0 / 27.0 * 0.9 * 2.0, rel=1e-5)


def test_quintic_from_rest_to_rest_is_fastest_and_hardest_between_its_points():
    # 15/8 d/T at the middle; 10/sqrt(3) d/T^2
    d, T = 0.6, 1.0
    velocity, acceleration = excesses(two(0.3, 0.3 + d, T), LIMITS)
    assert velocity.value == pytest.approx(15.0 / 8.0 * d / T, rel=ACCURACY)
    assert abs(acceleration.value) == pytest.approx(10.0 / 3.0 ** 0.5 * d / T ** 2, rel=ACCURACY)
    T = 1.001 * max(15.0 / 8.0 * d, (10.0 / 3.0 ** 0.5 * d) ** 0.5)
    assert excesses(two(0.3, 0.3 + d, T), LIMITS) == []


def test_line_has_a_velocity_and_no_acceleration():
    assert texts(two(0.1, 1.1, 0.8, order=1), LIMITS) == [
        'joint_1 reaches 1.25 rad/s, limit 1 rad/s']


def test_approach_segment_is_checked_and_reported_apart_from_the_message():
    command = (*Q, *(0.0,) * 6)
    points = single(Q + (0.0, 0.0, 0.5), 0.25)
    assert texts(points, LIMITS, 0.0, command) == ['joint_3 reaches 2 rad/s, limit 1 rad/s']
    assert [x.leading_in for x in excesses(points, LIMITS, 0.0, command)] == [True]
    outside = excesses(single(Q + (0.0, 0.0, 9.8), 0.25), LIMITS, 0.0, command)
    assert [(x.quantity, x.leading_in) for x in outside] == [
        ('position', False), ('velocity', True)]
    # a cubic in t / T, fastest at its end
    moving = TrajectoryPoints([0.3], [Q + (0.0, 0.0, 0.3)], [(0.0, 0.0, 3.0)], np.zeros((1, 3)),
                              [True], [False])
    assert [(x.value, x.leading_in) for x in excesses(moving, LIMITS, 0.0, command)] == [
        (3.0, False)]
    # 0.5 rad in 0.9 s take 10 / 3^(1/2) 0.5 / 0.9^2 = 3.6 rad/s^2, of which nothing is said
    rest = TrajectoryPoints([0.95], [Q + (0.0, 0.0, 0.5)], *np.zeros((2, 1, 3)), [True], [True])
    assert excesses(rest, LIMITS, 0.0, command) == []
    assert excesses(single(Q + (0.0, 0.0, 0.5), 0.25), LIMITS, 0.3, command) == []  # it is past


def test_extremes_equal_those_of_dense_samples():
    rng = np.random.default_rng(8)
    for _ in range(30):
        n = int(rng.integers(2, 6))
        times = np.cumsum(rng.uniform(0.1, 1.0, n))
        points = TrajectoryPoints(times, *rng.uniform(-1.0, 1.0, (3, n, 3)), rng.random(n) < 0.8,
                                  rng.random(n) < 0.8)
        motion = reference_through(points)
        states = np.array([motion(t) for a, b in zip(times, times[1:])
                           for t in np.linspace(a, b - 2e-9, 1000)]).reshape(-1, 3, 3)
        tight = JointLimits(min_position=[-1e-9] * 3, max_position=[1e-9] * 3,
                            max_velocity=[1e-9] * 3, max_acceleration=[1e-9] * 3)
        for found in excesses(points, tight):
            n = ('position', 'velocity', 'acceleration').index(found.quantity)
            sampled = np.abs(states[:, n, found.joint]).max()
            if n < 2:
                last = (motion.final, motion.final_velocity)[n]
                sampled = max(sampled, abs(last[found.joint]))
            assert abs(found.value) == pytest.approx(sampled, rel=1e-4, abs=1e-4)


def test_many_points_take_no_time():
    s = np.linspace(0.0, 50.0, 5000)
    wave = np.sin(40.0 * s)[:, np.newaxis] * np.ones(3)
    points = TrajectoryPoints(s, 1.0 + wave, np.cos(40.0 * s)[:, np.newaxis] * np.full(3, 40.0),
                              -1600.0 * wave, np.ones(5000, bool), np.ones(5000, bool))
    assert [x.quantity for x in excesses(points, LIMITS)][:1] == ['position']
