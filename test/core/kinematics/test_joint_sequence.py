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

"""Whole turns and free angles of all via points together, beside trial of all turns."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import UnreachableError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics
from rrr_traj_planner.core.kinematics.joint_sequence import joint_sequence
from rrr_traj_planner.core.kinematics.postures import Posture
from rrr_traj_planner.core.kinematics.travel_time import THROUGH, travel_time, ViaPointBehaviour

ARM, TURN = RobotModel(), 2.0 * np.pi
UP = Posture('up', 'front')


def ranges(low, high, **limits):
    """Return limits with a range of joint 1."""
    return JointLimits((low, -np.pi, -np.pi), (high, np.pi, TURN), **limits)


def around(*azimuths, radius=0.8, height=1.0):
    return np.array([(radius * np.cos(a), radius * np.sin(a), height) for a in azimuths])


def by_hand(D, velocity, acceleration, rests):
    """Return a displacement's time at half the acceleration, between rest and cruise."""
    ramp = velocity / (0.5 * acceleration)
    if D >= rests * 0.5 * velocity * ramp:
        return D / velocity + rests * 0.5 * ramp
    return rests * (2.0 * D / rests / (0.5 * acceleration)) ** 0.5


def blended_by_hand(D, velocity, acceleration, ends, turns):
    """
    Return a displacement's time in a blend, its mean acceleration given, by halving brackets.

    The line is as short as it can be for its speed to be within the limit and for half of the
    transition at each end to fit: a change of velocity from or to 0, or from v to -v.
    """
    def too_short(line):
        v = D / line
        return v > velocity or line < ends * 0.5 * v / acceleration + turns * v / acceleration

    low, high = 1e-9, 1e6
    for _ in range(200):
        middle = (low * high) ** 0.5
        low, high = (middle, high) if too_short(middle) else (low, middle)
    return high + ends * 0.5 * D / high / acceleration


def time_of(limits, q, passing=THROUGH):
    """Return the estimate of time, segment by segment and joint by joint."""
    total, steps = 0.0, np.diff(q, axis=0)
    for k, D in enumerate(steps):
        times = []
        for j in range(3):
            ends = (k == 0) + (k == len(steps) - 1)
            turns = sum((k > 0 and bool(steps[k - 1, j] * D[j] <= 0.0),
                         k < len(steps) - 1 and bool(steps[k + 1, j] * D[j] <= 0.0)))
            mean = passing.mean_acceleration * limits.max_acceleration[j]
            if passing.via == 'blend':
                times.append(blended_by_hand(
                    abs(D[j]), limits.max_velocity[j], mean, ends, turns))
            else:
                times.append(by_hand(abs(D[j]), limits.max_velocity[j], 2.0 * mean,
                                     2 if passing.via == 'stop' else ends + turns))
        total += max(times)
    return total


def best_by_trial(limits, points, start, passing):
    """Return the least time through the points, of all turns of joint 1 in its range."""
    base = [inverse_kinematics(ARM, p, 'up') for p in points]
    options = [[q + (TURN * k, 0.0, 0.0) for k in range(-4, 5)
                if limits.min_position[0] <= q[0] + TURN * k <= limits.max_position[0]]
               for q in base]
    before = [] if start is None else [start]
    return min(time_of(limits, [*before, *q], passing) for q in product(*options))


def test_a_range_of_more_than_a_turn_is_used_for_the_shorter_direction():
    # 3.1 and -3.1 rad are 2 pi - 6.2 = 0.083 rad apart.
    q = joint_sequence(ARM, ranges(-np.pi, TURN), around(-3.1, 3.1), UP)
    assert q[:, 0] == pytest.approx([TURN - 3.1, 3.1], abs=1e-12)
    assert joint_sequence(ARM, ranges(-np.pi, np.pi), around(-3.1, 3.1), UP)[:, 0] == (
        pytest.approx([-3.1, 3.1], abs=1e-12))


@pytest.mark.parametrize('half', [np.pi, 1.01 * np.pi, 1.5 * np.pi, 2.0 * np.pi])
def test_a_revolution_in_a_range_that_holds_it_has_no_unwinding(half):
    azimuths = np.linspace(-np.pi, np.pi, 13)
    q = joint_sequence(ARM, ranges(-half, half), around(*azimuths), UP)
    assert q[:, 0] == pytest.approx(azimuths, abs=1e-9)
    q = joint_sequence(ARM, ranges(-half, half), around(*azimuths[::-1]), UP)
    assert q[:, 0] == pytest.approx(azimuths[::-1], abs=1e-9)


@pytest.mark.parametrize('passing', [
    THROUGH, ViaPointBehaviour('stop', 2.0 / 3.0), ViaPointBehaviour('blend')])
@pytest.mark.parametrize('started', [False, True])
def test_turns_are_those_of_least_time_by_trial_of_all(started, passing):
    rng, unwound = np.random.default_rng(71), 0
    for _ in range(20 if passing.via == 'blend' else 60):
        low = rng.uniform(-8.0, 0.0)
        limits = ranges(low, low + rng.uniform(1.01, 2.2) * TURN,
                        max_velocity=rng.uniform(0.3, 2.0, 3),
                        max_acceleration=rng.uniform(0.3, 2.0, 3))
        points = forward_kinematics(ARM, np.column_stack((
            np.cumsum(rng.uniform(-1.0, 3.0, 5)), rng.uniform(0.8, 1.4, 5),
            rng.uniform(-0.5, 0.5, 5))))
        start = np.array([rng.uniform(limits.min_position[0], limits.max_position[0]), 1.0, 0.2])
        start = start if started else None
        q = joint_sequence(ARM, limits, points, UP, start, passing)
        assert (q[:, 0] >= limits.min_position[0]).all()
        assert (q[:, 0] <= limits.max_position[0]).all()
        assert forward_kinematics(ARM, q) == pytest.approx(points, abs=1e-12)
        whole = q if start is None else np.vstack((start, q))
        estimate = travel_time(limits, whole, passing)
        assert estimate == pytest.approx(time_of(limits, whole, passing), rel=1e-12)
        assert estimate <= best_by_trial(limits, points, start, passing) + 1e-4
        unwound += np.abs(np.diff(whole[:, 0])).max() > np.pi
    assert unwound > 1


def test_joint_turns_back_where_another_joint_takes_long_anyway():
    # Quarters of a revolution from 0 to 3 pi, in a range of 0 to 2.4 pi: joint 1 must unwind
    # before the sixth point, and can after the fourth. Joint 2 needs 8 s in one of the segments.
    limits = ranges(0.0, 1.2 * TURN, max_velocity=(10.0, 0.1, 1.0), max_acceleration=[50.0] * 3)
    joint_1 = np.arange(7) * 0.5 * np.pi
    for slow in (3, 4):
        joint_2 = np.where(np.arange(7) <= slow, 0.6, 1.4)
        q = joint_sequence(ARM, limits, forward_kinematics(
            ARM, np.column_stack((joint_1, joint_2, np.zeros(7)))), UP)
        expected = np.full(6, 0.5 * np.pi)
        expected[slow] -= TURN
        assert np.diff(q[:, 0]) == pytest.approx(expected)


def test_no_limits_of_velocity_or_acceleration_leave_the_least_travel():
    none = {'max_velocity': [np.inf] * 3, 'max_acceleration': [np.inf] * 3}
    q = joint_sequence(ARM, ranges(-np.pi, TURN, **none), around(-3.1, 3.1, 2.0), UP)
    assert q[:, 0] == pytest.approx([TURN - 3.1, 3.1, 2.0], abs=1e-12)


def test_ends_of_ranges_are_met_exactly():
    q = joint_sequence(ARM, ranges(-np.pi, 0.5), around(np.pi, 0.5 + 9e-10), UP)
    assert q[:, 0].tolist() == [-np.pi, 0.5]


@pytest.mark.parametrize('offset', [0.0, 1e-12, 7e-10])
def test_on_joint_axis_1_joint_1_is_between_its_neighbours(offset):
    limits = ranges(-np.pi, np.pi)
    a, b = around(0.6, 2.0)
    above, higher = (offset, -offset, 1.6), (-offset, 0.0, 1.8)
    q = joint_sequence(ARM, limits, np.array([a, above, b]), UP)
    assert 0.6 < q[1, 0] < 2.0
    q = joint_sequence(ARM, limits, np.array([a, above, higher, higher, b]), UP)
    assert (np.diff(q[:, 0]) >= 0.0).all()
    assert q[2].tolist() == q[3].tolist()
    for points, expected in (([above, a], [0.6, 0.6]), ([a, above, higher], [0.6] * 3),
                             ([higher, above, b, a], [2.0, 2.0, 2.0, 0.6])):
        assert joint_sequence(ARM, limits, np.array(points), UP)[:, 0] == pytest.approx(expected)


@pytest.mark.parametrize(('low', 'high', 'expected'), [
    (-1.0, 1.0, 0.0), (0.5, 2.0, 0.5), (-9.0, -7.0, -7.0), (-np.inf, np.inf, 0.0)])
@pytest.mark.parametrize('velocity', [1.0, 3.0, 100.0])
def test_points_all_on_the_axis_leave_joint_1_at_0_or_at_the_nearest_end(
        low, high, expected, velocity):
    points = np.array([(0.0, 0.0, 1.6), (0.0, 0.0, 1.9)])
    limits = ranges(low, high, max_velocity=[velocity] * 3)
    q = joint_sequence(ARM, limits, points, UP)
    assert q[:, 0].tolist() == [expected] * 2
    start = np.array([np.clip(0.7, low, high), 1.0, 0.0])
    assert joint_sequence(ARM, limits, points, UP, start)[:, 0].tolist() == (
        [start[0]] * 2)


def test_free_angles_do_not_break_the_choice_of_turns():
    # 2.5 rad, the axis, -2.5 rad: 1.283 rad apart on the far side, where joint 1 may pass.
    points = np.vstack((around(2.5), [(0.0, 0.0, 1.6)], around(-2.5)))
    q = joint_sequence(ARM, ranges(-np.pi, TURN), points, UP)
    assert q[[0, 2], 0] == pytest.approx([2.5, TURN - 2.5])
    q = joint_sequence(ARM, ranges(-np.pi, np.pi), points, UP)
    assert q[[0, 2], 0] == pytest.approx([2.5, -2.5])
    assert -2.5 < q[1, 0] < 2.5


def test_a_neighbour_out_of_range_is_not_reported_as_the_point_on_the_axis():
    points = np.vstack(([(0.0, 0.0, 1.6)], around(1.0), [(0.0, 0.0, 1.7)], around(0.2)))
    q = joint_sequence(ARM, ranges(0.0, 0.5), points, UP)
    assert q[:, 0] == pytest.approx([0.5, 1.0, 0.5, 0.2])


def test_joint_that_fits_nowhere_is_left_outside_and_a_point_out_of_reach_is_named():
    q = joint_sequence(ARM, ranges(0.0, 0.5), around(0.2, 1.0), UP)
    assert q[:, 0] == pytest.approx([0.2, 1.0])
    with pytest.raises(UnreachableError, match=r'^via point 1: \(3, 0, 1\) m is out of '):
        joint_sequence(ARM, ranges(0.0, 0.5), np.array([(1.0, 0.0, 1.0), (3.0, 0.0, 1.0)]), UP)


def test_a_thousand_turns_wide_range_and_an_open_one_are_no_burden():
    azimuths = np.cumsum(np.full(300, 3.0))
    for limits in (ranges(-400.0, 400.0), replace(
            ranges(0.0, 1.0), max_position=(np.inf, np.pi, TURN))):
        q = joint_sequence(ARM, limits, around(*azimuths), UP)[:, 0]
        assert (q >= limits.min_position[0]).all()
        assert (q <= limits.max_position[0]).all()
        assert np.exp(1j * q) == pytest.approx(np.exp(1j * azimuths), abs=1e-9)
