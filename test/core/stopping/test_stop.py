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

"""Stopping: from any motion to rest, inside the ranges and within the limits."""

from __future__ import annotations

from dataclasses import replace
from math import inf

import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque, inverse_dynamics
from rrr_traj_planner.core.stopping.stop import stop, stop_of_state
from rrr_traj_planner.core.stopping.task import from_state, time_inside
from rrr_traj_planner.core.trajectory.reference_trajectory import reference_through
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints

MODEL, FREE = RobotModel(), np.full(3, inf)
LIMITS = JointLimits(max_effort=FREE)
NOW, NOW_NS = 7.0, 7_000_000_000
ROUNDING = 1e-9


def random_commands(count):
    rng = np.random.default_rng(4)
    for _ in range(count):
        yield tuple(rng.uniform((0.3, 0.8, -1.0) + (-0.5,) * 3 + (-1.0,) * 3,
                                (1.2, 1.2, 1.0) + (0.5,) * 3 + (1.0,) * 3).tolist())


def stopped(state, limits=LIMITS):
    return stop(from_state(state, NOW_NS), NOW, limits, MODEL)


def sampled(motion):
    """Return times from now to the end, and the states then."""
    times = np.linspace(NOW, motion.end, 2001)
    return times, np.array([motion(t) for t in times[:-1]] + [motion(times[-1] - 1e-12)])


def parabola(top, acceleration, duration=2.0):
    """Return a motion that touches `top` half way and comes back; the other joints rest."""
    t = np.linspace(0.0, duration, 21)
    q, qd, qdd = np.tile([[0.5, 1.0, 0.2]], (21, 1)), np.zeros((21, 3)), np.zeros((21, 3))
    x = t - 0.5 * duration
    q[:, 0], qd[:, 0], qdd[:, 0] = top - 0.5 * acceleration * x ** 2, -acceleration * x, -(
        acceleration)
    known = np.ones(21, dtype=bool)
    return reference_through(TrajectoryPoints(t, q, qd, qdd, known, known), NOW_NS)


def test_stop_starts_from_the_command_and_ends_at_rest():
    for command in random_commands(20):
        motion = stopped(command).motion
        np.testing.assert_allclose(motion(NOW), command, atol=1e-12)
        assert motion(motion.end + 1e-9)[3:] == (0.0,) * 6
        np.testing.assert_allclose(motion(motion.end - 1e-9), motion(motion.end + 1e-9), atol=1e-7)


def test_stop_is_within_acceleration_and_jerk_limits_and_ranges():
    for command in random_commands(20):
        motion, warnings = stopped(command)
        times, states = sampled(motion)
        assert warnings == ()
        assert np.abs(states[:, 6:]).max() <= 1.0 + 1e-6
        jerk = np.abs(np.diff(states[:, 6:], axis=0)) / np.diff(times)[:, np.newaxis]
        assert jerk.max() <= 10.0 + 1e-6
        assert (states[:, :3] >= LIMITS.min_position - ROUNDING).all()
        assert (states[:, :3] <= LIMITS.max_position + ROUNDING).all()


def test_velocity_is_the_derivative_of_position():
    for command in random_commands(10):
        times, states = sampled(stopped(command).motion)
        for n in (0, 3):
            rate = np.diff(states[:, n:n + 3], axis=0) / np.diff(times)[:, np.newaxis]
            middle = 0.5 * (states[1:, n + 3:n + 6] + states[:-1, n + 3:n + 6])
            error = 10.0 * np.diff(times).max()  # the trapezium's error where jerk steps
            np.testing.assert_allclose(rate, middle, atol=error)


@pytest.mark.parametrize(('max_acceleration', 'max_jerk', 'time', 'moved'), [
    (1.0, inf, 0.4, 0.08),            # v / A, v^2 / 2 A
    (inf, 10.0, 0.4, 0.08),           # 2 sqrt(v / J), half of it at v
    (1.0, 10.0, 0.5, 0.1)])           # v / A + A / J
def test_stop_from_a_velocity_alone_takes_its_closed_form(max_acceleration, max_jerk, time, moved):
    limits = replace(LIMITS, max_acceleration=np.full(3, max_acceleration),
                     max_jerk=np.full(3, max_jerk))
    motion = stopped((0.5, 1.0, 0.2, 0.4, 0.0, 0.0, 0.0, 0.0, 0.0), limits).motion
    assert motion.end - NOW == pytest.approx(time, abs=1e-9)
    np.testing.assert_allclose(motion.final, (0.5 + moved, 1.0, 0.2), atol=1e-9)


def test_arm_at_rest_stays():
    q = (0.5, 0.9, 0.2)
    motion = stopped((*q, *(0.0,) * 6)).motion
    assert motion.end == NOW
    assert motion(NOW) == (*q, *(0.0,) * 6)


def test_torque_binds_where_acceleration_does_not():
    command = (0.5, 1.2, 0.2, 0.0, -1.0, -1.0, 0.0, 0.0, 0.0)  # falling, braked by lifting
    rest = np.abs(inverse_dynamics(MODEL, command[:3], command[3:6], command[6:]))
    limits = JointLimits(max_acceleration=FREE, max_jerk=FREE, max_effort=rest + 60.0)
    _, states = sampled(stopped(command, limits).motion)
    torque = np.abs(inverse_dynamics(MODEL, states[:, :3], states[:, 3:6], states[:, 6:]))
    assert (torque.max(axis=0) <= limits.max_effort * 1.001).all()
    assert (torque.max(axis=0) >= limits.max_effort * 0.8).any()


def test_arm_that_cannot_be_held_stops_all_the_same_and_says_so():
    limits = JointLimits(max_effort=np.full(3, 1.0))
    motion, warnings = stopped((0.5, 1.0, 0.2, 0.5, 0.5, 0.5, 0.0, 0.0, 0.0), limits)
    assert motion.end - NOW < 4.0
    assert [w.split(', ')[0].split(' N m at ')[1] for w in warnings] == [
        'joint_1', 'joint_2', 'joint_3']
    assert all(w.startswith('stopping requires ') for w in warnings)


@pytest.mark.parametrize('max_jerk', [inf, 10.0])
@pytest.mark.parametrize('t', [0.5, 0.9, 0.999, 1.0, 1.001, 1.2])
def test_joint_that_turns_at_the_end_of_its_range_is_not_carried_beyond_it(t, max_jerk):
    # Any jerk towards rest before the turn would carry it beyond: v^2 / 2 A is left.
    limits = replace(LIMITS, max_jerk=np.full(3, max_jerk))
    motion, warnings = stop(parabola(np.pi / 2, 1.0), NOW + t, limits, MODEL)
    states = np.array([motion(x) for x in np.linspace(NOW + t, motion.end, 2001)])
    assert states[:, 0].max() <= np.pi / 2 + ROUNDING
    assert np.abs(states[:, 6:]).max() <= 1.0 + 1e-6
    assert warnings == ()
    assert motion.end - NOW - t < 1.2


@pytest.mark.parametrize(('end', 'sign'), [(np.pi / 2, 1.0), (0.0, -1.0)])
def test_state_that_is_too_fast_for_its_range_brakes_as_hard_as_that_takes(end, sign):
    q = end - 0.05 * sign
    motion, warnings = stopped((q, 1.0, 0.2, 0.9 * sign, *(0.0,) * 5))
    _, states = sampled(motion)
    assert motion.final[0] == end
    assert np.abs(states[:, 6]).max() == pytest.approx(0.9 ** 2 / 2.0 / 0.05)  # v^2 / 2 s
    assert warnings == (
        f'joint_1 moves at {0.9 * sign:.4g} rad/s at {q:.6g} rad (commanded), range [0, 1.5708] '
        'rad: it brakes with 8.1 rad/s^2, limit 1 rad/s^2, to rest inside it',)


def test_joint_that_is_fast_at_the_end_of_its_range_rests_there():
    motion, warnings = stopped((np.pi / 2, 1.0, 0.2, 0.9, *(0.0,) * 5))
    assert motion.final[0] == np.pi / 2
    assert 'range [0, 1.5708] rad: it stops at once' in warnings[0]


def test_joints_that_rest_at_the_ends_of_their_ranges_stay_while_another_brakes_hard():
    motion, warnings = stopped((np.pi / 2, 0.0, 6.2, 0.0, 0.0, 0.9, *(0.0,) * 3))
    np.testing.assert_allclose(motion.final, LIMITS.max_position * (1.0, 0.0, 1.0), atol=1e-12)
    assert len(warnings) == 1
    assert warnings[0].startswith('joint_3 moves at 0.9 rad/s at 6.2 rad')


def test_joint_outside_its_range_stops_and_goes_back():
    motion, warnings = stopped((1.7, 1.0, 0.2, 0.1, *(0.0,) * 5))
    _, states = sampled(motion)
    assert motion.final[0] == np.pi / 2
    assert np.abs(states[:, 6:]).max() <= 1.0 + 1e-6
    assert states[:, 0].max() <= 1.7 + ROUNDING
    assert warnings == (
        'joint_1 is commanded to 1.7 rad, outside its range [0, 1.5708] rad: it goes back '
        'inside',
        'joint_1 moves at 0.1 rad/s at 1.7 rad (commanded), range [0, 1.5708] rad: it stops at '
        'once')


@pytest.mark.parametrize('joint', [0, 1, 2])
@pytest.mark.parametrize('side', [-1.0, 1.0])
@pytest.mark.parametrize(('beyond', 'velocity'), [
    (1e-6, 3.0), (1e-6, 0.05), (5e-4, 0.2), (0.0156, 0.9), (0.3, 0.05), (0.3, 3.0)])
def test_joint_that_leaves_its_range_turns_back_as_soon_as_it_can(joint, side, beyond, velocity):
    end = (LIMITS.max_position if side > 0.0 else LIMITS.min_position)[joint]
    q, qd = np.array([0.5, 1.0, 0.2]), np.zeros(3)
    q[joint], qd[joint] = end + side * beyond, side * velocity
    motion, warnings = stopped((*q, *qd, 0.0, 0.0, 0.0))
    further = (side * (sampled(motion)[1][:, joint] - q[joint])).max()
    assert further <= ROUNDING
    # A quintic from rest to rest over s: v = 15 s / 8 T, a = 10 s / 3^(1/2) T^2, j = 60 s / T^3.
    s, A, J = beyond, 1.0, 10.0
    back = max(0.01, 1.875 * s, (10.0 / 3.0 ** 0.5 * s / A) ** 0.5, (60.0 * s / J) ** (1 / 3))
    assert motion.end - NOW <= back + ROUNDING
    assert motion.final[joint] == end
    reported = ' '.join(warnings)
    assert (f'{MODEL.joint_names[joint]} is commanded to {q[joint]:.6g} rad, outside its range'
            in reported) == (beyond > 1e-4)
    assert 'it stops at once' in reported


@pytest.mark.parametrize('velocity', [1e-12, 1e3, 1e6])
@pytest.mark.parametrize('max_acceleration', [1.0, inf])
def test_any_velocity_ends_inside_the_ranges(velocity, max_acceleration):
    limits = JointLimits(max_acceleration=np.full(3, max_acceleration))
    for state in ((0.5, 1.0, 0.2, velocity, -velocity, velocity, 0.0, 0.0, 0.0),
                  (0.5, 1.0, 0.2, velocity, 0.0, 0.0, -1e6, 1e6, 0.0)):
        motion = stopped(state, limits).motion
        assert motion.end - NOW < 60.0
        assert (motion.final >= limits.min_position).all()
        assert (motion.final <= limits.max_position).all()


def test_pose_that_cannot_be_held_is_flown_through():
    # Joint 2 at 0 takes 250 N m, at 1.4 rad far less: the motion goes from one side to the other.
    q = np.array([[0.5, -1.3, 0.0], [0.5, 1.3, 0.0]])
    limits = JointLimits(min_position=np.full(3, -np.pi), max_position=np.full(3, np.pi),
                         max_velocity=FREE, max_acceleration=FREE, max_jerk=FREE,
                         max_effort=np.array([inf, 0.9 * np.abs(gravity_torque(
                             MODEL, (0.5, 0.0, 0.0)))[1], inf]))
    t = np.linspace(0.0, 1.2, 61)
    s = (t / 1.2)[:, np.newaxis]
    d = (q[1] - q[0])
    known = np.ones(len(t), dtype=bool)
    motion = reference_through(TrajectoryPoints(
        t, q[0] + (10 - 15 * s + 6 * s ** 2) * s ** 3 * d,
        30 * (s * (1 - s)) ** 2 * d / 1.2, 60 * s * (1 - s) * (1 - 2 * s) * d / 1.2 ** 2, known,
        known), NOW_NS)
    final = stop(motion, NOW + 0.6, limits, MODEL).motion.final
    assert np.abs(gravity_torque(MODEL, final))[1] <= limits.max_effort[1] * 1.001


@pytest.mark.parametrize('order', [1, 3])
def test_steps_of_the_followed_motion_are_its_own_and_no_more(order):
    # A motion of lines or cubics steps at its points; a stop along it steps less, and only there.
    t = np.linspace(0.0, 3.0, 31)
    q = np.array([0.3, 1.0, 0.2]) + np.outer(0.3 * np.sin(1.1 * t), (1.0, 0.5, 1.0))
    qd = np.outer(0.33 * np.cos(1.1 * t), (1.0, 0.5, 1.0)) * (order > 1)
    known = np.full(31, order > 1)
    motion = reference_through(
        TrajectoryPoints(t, q, qd, np.zeros((31, 3)), known, known & False), NOW_NS)
    limits = replace(LIMITS, max_effort=np.array([150.0, 175.0, 65.0]), max_jerk=FREE)
    for begin in NOW + np.linspace(0.05, 2.8, 12):
        motion_to_rest = stop(motion, begin, limits, MODEL).motion
        x = np.linspace(begin, motion_to_rest.end, 3000)
        _, qd, qdd, _ = motion_to_rest.at(x)
        before, after = (motion.at(NOW + t[1:-1] + e)[1] for e in (-1e-6, 1e-6))
        steps = np.abs(after - before).max(axis=0) if order == 1 else 0.0
        own = np.abs(motion.at(np.linspace(begin, motion.end, 3000))[2]).max(axis=0)
        assert (np.abs(qdd) <= np.maximum(limits.max_acceleration, own) * 1.001).all()
        assert (np.abs(np.diff(qd, axis=0)) <= 1.01 * steps + 1.01 * np.diff(x).max() * np.maximum(
            limits.max_acceleration, own)).all()


def test_repeated_stop_requests_end_the_motion_no_later():
    motion = parabola(1.2, 1.0)
    first = stop(motion, NOW + 0.3, LIMITS, MODEL).motion
    again = first
    for now in NOW + np.linspace(0.3, 0.9, 20):
        again = stop(again, now, LIMITS, MODEL).motion
    assert again.end <= first.end + 1e-6
    np.testing.assert_allclose(again.final, first.final, atol=1e-6)


def test_time_inside_is_when_a_motion_leaves_its_ranges():
    motion = parabola(np.pi / 2 + 0.02, 1.0)  # beyond from 0.2 s before its turn on
    assert time_inside(motion, NOW, LIMITS) == pytest.approx(NOW + 0.8, abs=0.003)
    assert time_inside(motion, NOW + 1.0, LIMITS) == -inf
    assert time_inside(parabola(np.pi / 2, 1.0), NOW, LIMITS) == NOW + 2.0


def test_torque_is_kept_by_a_joint_that_stops_within_milliseconds_while_another_takes_seconds():
    """Joint 1 could stop in 3 ms, by jerk, with some 30 rad/s^2: a time sample or none."""
    limits = JointLimits(max_acceleration=[inf, 1.0, 0.1], max_jerk=[2e4, 10.0, 10.0],
                         max_effort=[150.0, 200.0, 200.0])
    state = (0.5, 1.1, -0.2, 0.05, 0.0, 0.4, 0.0, 0.0, 0.0)
    motion = stop_of_state(from_state(state, 0), limits, MODEL)
    assert motion.end > 4.0  # joint 3, with 0.1 rad/s^2
    t = np.concatenate([np.linspace(a, b, 50) for a, b in zip(motion.knots, motion.knots[1:])])
    torque = inverse_dynamics(MODEL, *motion.at(t)[:3])
    assert (np.abs(torque).max(axis=0) <= 1.001 * limits.max_effort).all()
    assert np.abs(torque[:, 0]).max() > 0.5 * limits.max_effort[0]


def test_a_stop_that_keeps_jerk_is_refused_where_only_more_jerk_would_do():
    """Joint 1 needs 0.049 rad to turn back with 10 rad/s^3, and is 0.04 rad from its end."""
    limits = replace(LIMITS, max_acceleration=FREE)
    state = (limits.max_position[0] - 0.04, 1.1, -0.2, 0.3, 0.0, 0.0, 0.0, 0.0, 0.0)
    assert stopped(state, limits).warnings == ()
    assert stop_of_state(from_state(state, 0), limits, MODEL) is None
