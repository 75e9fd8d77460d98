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

"""`time_optimal` from states at which the arm moves."""

from dataclasses import replace
from itertools import count, product
from unittest.mock import patch

from helpers.measured_motions import Measured, planned_motions
from helpers.planning_cases import ARM, FREE, LIMITS, NONE
from helpers.time_optimal_cases import A, B, C, EITHER_LIMITS, through
import numpy as np
import pytest
from rrr_traj_planner.core.dynamics.motor_torque import motor_torque
from rrr_traj_planner.core.errors import InvalidInputError, StartStateError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.stopping.stop import stop
from rrr_traj_planner.core.stopping.task import from_state
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.planners.joint_timing import least_time
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.registry import planner_ids
from rrr_traj_planner.planners.request import PlanningRequest

SAME = 1e-9      # rad, rad/s, rad/s^2
ALLOWED = 1.001  # times a limit: what a state may need
RAISED = ('max_velocity', 'max_acceleration', 'max_effort')


def state(motion, t):
    """Return position, velocity and acceleration."""
    return [f[0] for f in motion(np.array([t]))[:3]]


def moving(q, points, velocity=(0.0, 0.0, 0.0), acceleration=(0.0, 0.0, 0.0), **request):
    """Return a request from a moving state through joint positions."""
    return PlanningRequest(**{
        'via_points': forward_kinematics(ARM, np.asarray(points, float)), 'start': q,
        'start_velocity': velocity, 'start_acceleration': acceleration,
        'planner_id': 'time_optimal', **request})


def onward(m, t):
    """Return the measured plan from a motion's state through the points that are left."""
    q, qd, qdd = state(m.trajectory, t)
    left = np.flatnonzero(m.plan.via_times > t)
    request = replace(
        m.task.request, via_points=m.task.request.via_points[left], start=q, start_velocity=qd,
        start_acceleration=qdd, elbow=None, shoulder=None)
    limits = replace(m.task.limits, **{f: ALLOWED * getattr(m.task.limits, f) for f in RAISED})
    points = m.task.q[len(m.task.q) - len(m.plan.via_times):][left]
    return Measured(replace(m.task, request=request, limits=limits, q=points),
                    plan(m.task.model, m.task.limits, request))


def test_motions_go_on_from_any_of_their_states_within_limits_and_no_later():
    rng, late = np.random.default_rng(17), {}
    for seed, m in list(planned_motions('time_optimal').items())[::2]:
        t = rng.uniform(0.0, m.trajectory.duration)
        if not m.plan.via_times[-1] > t:
            continue  # it stays where it is
        found = onward(m, t)
        assert found.violations() == [], seed
        first = found.plan.points
        for given, asked in zip((first.positions, first.velocities, first.accelerations),
                                state(m.trajectory, t)):
            assert given[0] == pytest.approx(asked, abs=SAME)
        late[seed] = found.trajectory.duration / (m.trajectory.duration - t) - 1.0
    assert len(late) > 20
    assert np.median(list(late.values())) <= 1e-3
    assert sum(x > 0.01 for x in late.values()) <= 2, late


@pytest.mark.parametrize('limits', EITHER_LIMITS, ids=['acceleration', 'torque'])
def test_other_points_are_reached_from_a_motion_s_states(limits):
    before = plan(ARM, limits, through([A, B, C])).trajectory
    for t in np.linspace(0.1, 0.9, 5) * before.duration:
        q, *rates = state(before, t)
        found = plan(ARM, limits, moving(q, [B, A], *rates))
        ends = found.trajectory(found.via_times)[0]
        assert ends == pytest.approx(np.array([B, A]), abs=SAME)
        assert np.array(state(found.trajectory, 0.0)) == pytest.approx(
            np.array(state(before, t)), abs=SAME)


def test_long_motions_are_not_much_slower_when_planning_is_stopped():
    rng = np.random.default_rng(107)
    before = plan(ARM, FREE, through([A, B, C])).trajectory
    q, *rates = state(before, 0.4 * before.duration)
    points = np.repeat(rng.uniform([0.3, 1.0, -0.5], [1.3, 1.6, 0.5], (5, 3)), 8, axis=0)
    points += rng.normal(0.0, 0.02, points.shape)
    counter = count()
    best = plan(ARM, FREE, moving(q, points, *rates, should_stop=lambda: next(counter) < 0))
    calls = next(counter)
    for k in np.linspace(0.5, 0.95, 6) * calls:
        counter = count()
        found = plan(ARM, FREE, moving(
            q, points, *rates, should_stop=lambda c=counter, k=k: next(c) >= k))
        assert found.trajectory.duration < 1.3 * best.trajectory.duration
        assert (found.peaks.acceleration <= ALLOWED * FREE.max_acceleration).all()
        assert np.array(state(found.trajectory, 0.0)) == pytest.approx(
            np.array([q, *rates]), abs=SAME)


def test_jerk_is_continuous_after_the_start():
    before = plan(ARM, LIMITS, through([A, B])).trajectory
    q, qd, qdd = state(before, 0.4 * before.duration)
    motion = plan(ARM, LIMITS, moving(q, [C], qd, qdd)).trajectory
    knots = motion.knots[1:-1]
    assert motion(knots - 1e-9)[3] == pytest.approx(motion(knots + 1e-9)[3], abs=1e-4)


def test_a_moving_arm_comes_back_to_where_it_was():
    found = plan(ARM, FREE, moving(A, [A], velocity=[0.5, -0.3, 0.2]))
    assert found.points.positions[-1] == pytest.approx(A, abs=SAME)
    assert np.abs(found.points.positions - A).max() > 0.05
    assert found.points.velocities[0].tolist() == [0.5, -0.3, 0.2]


def test_a_point_where_the_moving_arm_is_is_passed_at_once():
    found = plan(ARM, FREE, moving(A, [A, B], velocity=[0.3, 0.1, 0.1]))
    assert found.via_times[0] == 0.0
    assert found.points.positions[-1] == pytest.approx(B, abs=SAME)


def test_without_a_way_on_the_arm_stops_first_as_when_held():
    q, qd, qdd = np.array(A), np.array([0.6, -0.4, 0.5]), np.array([0.5, 0.2, -0.3])
    request = moving(q, [B], qd, qdd)
    with patch.object(least_time, '_fastest', lambda problem, start: (
            None if problem.task.start_rates is not None else FASTEST(problem, start))):
        found = plan(ARM, LIMITS, request)
    held = stop(from_state((*q, *qd, *qdd), 0), 0.0, LIMITS, ARM).motion
    t = np.linspace(0.0, held.end, 50)[:-1]
    assert found.trajectory(t)[0] == pytest.approx(held.at(t)[0], abs=2e-4)
    assert found.note.startswith(f'the arm stops first, in {held.end:.2g}'), found.note
    assert 'the arm stops' not in plan(ARM, LIMITS, request).note
    rest = plan(ARM, LIMITS, through([held.final, B])).trajectory
    assert found.trajectory.duration == pytest.approx(held.end + rest.duration, rel=5e-3)
    assert plan(ARM, LIMITS, request).trajectory.duration < found.trajectory.duration


@pytest.mark.parametrize('number', [5, 11, 31])
def test_via_points_closer_than_the_way_to_stop_are_passed_as_before(number):
    q = np.linspace((0.2, 0.8, 0.0), (1.2, 1.3, 0.5), number)
    before = plan(ARM, FREE, through(q))
    for part in (0.3, 0.42, 0.54, 0.66, 0.78):
        t = part * before.trajectory.duration
        start, *rates = state(before.trajectory, t)
        found = plan(ARM, FREE, moving(start, q[before.via_times > t], *rates))
        assert found.trajectory.duration < 1.005 * (before.trajectory.duration - t)


def test_close_points_of_a_curved_motion_are_passed_as_before_while_it_brakes():
    slow = []
    for limits in (FREE, replace(FREE, max_velocity=[3.0] * 3, max_jerk=[30.0] * 3)):
        before = plan(ARM, limits, through([A, B, C])).trajectory
        for number, part in product((21, 25, 31), (0.69, 0.74, 0.79, 0.84)):
            t = part * before.duration
            start, *rates = state(before, t)
            points = before(np.linspace(t, before.duration, number)[1:])[0]
            found = plan(ARM, limits, moving(start, points, *rates))
            if found.trajectory.duration > 1.002 * (before.duration - t):
                slow.append((number, part, found.trajectory.duration / (before.duration - t)))
    assert not slow


def test_an_arm_that_cannot_stop_goes_on_and_folds():
    """In a state of a motion between other points, joint 2 would need 224 N m to stop."""
    q, qd = [0.78170907, 0.57722076, 2.10736836], [0.9696377, -0.64859548, 0.99981035]
    qdd = [-0.47615928, 0.24986832, -0.00049661]
    limits = replace(LIMITS, max_acceleration=NONE, max_jerk=[100.0] * 3)
    state_of_arm = np.concatenate((q, qd, qdd))
    assert any('N m' in w for w in stop(from_state(tuple(state_of_arm), 0), 0.0, limits, ARM)[1])
    points = np.array([[0.554, 0.792, 0.122], [0.256, 0.22, 0.566]])
    found = plan(ARM, limits, replace(moving(q, [A], qd, qdd), via_points=points))
    t = np.linspace(0.0, found.trajectory.duration, 5000)
    torque = motor_torque(ARM, *found.trajectory(t)[:3])
    assert (np.abs(torque) <= ALLOWED * limits.max_effort).all()
    assert found.trajectory(np.zeros(1))[0][0] == pytest.approx(q, abs=SAME)
    tips = forward_kinematics(ARM, found.trajectory(found.via_times)[0])
    assert tips == pytest.approx(points, abs=1e-8)
    assert len(found.via_times) == 2 and 'stops' not in found.note


def test_planning_that_ends_at_once_still_finds_a_way_on_where_the_arm_cannot_stop():
    q, qd = [0.78170907, 0.57722076, 2.10736836], [0.9696377, -0.64859548, 0.99981035]
    limits = replace(LIMITS, max_acceleration=NONE, max_jerk=[100.0] * 3)
    points = np.array([[0.554, 0.792, 0.122], [0.256, 0.22, 0.566]])
    found = plan(ARM, limits, replace(
        moving(q, [A], qd, [-0.47615928, 0.24986832, -0.00049661]), via_points=points,
        should_stop=lambda: True))
    assert 'stops' not in found.note
    tips = forward_kinematics(ARM, found.trajectory(found.via_times)[0])
    assert tips == pytest.approx(points, abs=1e-8)


@pytest.mark.parametrize('way', [1e-5, 1e-4])
@pytest.mark.parametrize('period', [1e-3, 1e-2])
def test_a_point_beside_a_moving_arm_is_reached_without_a_stop_before(way, period):
    found = plan(ARM, FREE, moving(A, [np.add(A, way)], [0.5, -0.3, 0.2], sample_period=period))
    assert 'stops' not in found.note
    # it turns back: 0.5 rad/s with 1 rad/s^2 takes 0.5 s, and 0.125 rad back 0.71 s
    assert 1.2 < found.trajectory.duration < 1.7


# Times of Ruckig 0.19.4, in which joints overshoot their goals.
@pytest.mark.parametrize('q, velocity, acceleration, goal, ruckig', [
    ([1.45087, 1.13751, 2.6729], [-0.34177, 0.37962, -0.72726], [-0.51712, 0.62363, -0.99881],
     [1.34761, 1.41356, 2.29451], 1.3815),
    ([0.90949, 2.53014, -2.53846], [-0.00872, -0.15866, 0.61838], [-0.01424, -0.16927, 0.99956],
     [0.80461, 2.47425, -2.27117], 1.3463)])
def test_joints_that_overshoot_do_not_stop_first(q, velocity, acceleration, goal, ruckig):
    found = plan(ARM, FREE, moving(
        q, [q], velocity, acceleration, via_points=None, joint_via_points=[goal]))
    assert 'stops' not in found.note
    assert found.trajectory.duration <= 1.03 * ruckig


@pytest.mark.parametrize('soon', [1e-8, 1e-7, 1e-6, 1e-5])
def test_a_via_point_is_passed_however_soon_after_the_start_it_is(soon):
    q = [A, B, C]
    before = plan(ARM, FREE, through(q))
    T, t = before.trajectory.duration, before.via_times[1] - soon
    found = plan(ARM, FREE, moving(
        state(before.trajectory, t)[0], q[1:], *state(before.trajectory, t)[1:]))
    assert found.trajectory.duration < 1.002 * (T - t)
    assert found.via_times[0] == pytest.approx(soon, rel=1e-2, abs=2e-9)
    assert found.trajectory(found.via_times)[0] == pytest.approx(np.array(q[1:]), abs=SAME)
    assert np.diff(found.points.times).min() > 5e-6


@pytest.mark.parametrize('period', [0.005, 0.03])
def test_placeholder_efforts_do_not_keep_a_moving_arm_from_going_on(period):
    limits = replace(LIMITS, max_acceleration=NONE, max_jerk=NONE, max_effort=[5e6] * 3)
    before = plan(ARM, limits, through([A, B, C], sample_period=period)).trajectory
    q, *rates = state(before, 0.1 * before.duration)
    for points in ([q + 1e-4], [C, A]):
        found = plan(ARM, limits, moving(q, points, *rates, sample_period=period))
        assert found.trajectory(found.via_times)[0] == pytest.approx(np.array(points), abs=SAME)


def test_a_controller_keeps_the_limits_where_jerk_steps_in_a_stop():
    limits = replace(LIMITS, max_jerk=NONE, max_effort=NONE)
    request = moving(A, [B], [0.6, -0.4, 0.5], [0.5, 0.2, -0.3], sample_period=1e-3)
    with patch.object(least_time, '_fastest', lambda problem, start: (
            None if problem.task.start_rates is not None else FASTEST(problem, start))):
        found = plan(ARM, limits, request)
    assert 'stops first' in found.note
    spline = spline_through(found.points)
    qdd = spline.within(np.linspace(0.0, 1.0, 20), slice(None))[2]
    assert np.abs(qdd).max() <= ALLOWED


FASTEST = least_time._fastest


@pytest.mark.parametrize(('velocity', 'acceleration', 'text'), [
    ([1.01, 0.0, 0.0], [0.0] * 3, 'joint_1 cannot but reach 1.01 rad/s, limit 1 rad/s'),
    # 0.99 + 0.8^2 / (2 * 10)
    ([0.0, 0.99, 0.0], [0.0, 0.8, 0.0], 'joint_2 cannot but reach 1.022 rad/s, limit 1 rad/s'),
    ([0.0] * 3, [0.0, 0.0, -1.2], 'joint_3 accelerates with 1.2 rad/s^2, limit 1 rad/s^2'),
    # 1 rad/s: 0.1 s of falling acceleration, then v^2 / 2 from 0.95 rad/s: 0.5498333 rad
    ([1.0, 0.0, 0.0], [0.0] * 3,
     r'joint_1 is at 1.3 rad and moves at 1 rad/s, too fast towards the end of its range at '
     r'1.5708 rad: within its limits it goes at least 0.279 rad beyond')])
def test_a_start_beyond_limits_is_refused(velocity, acceleration, text):
    with pytest.raises(StartStateError, match=f'^start state: {text}'.replace('^2', r'\^2')):
        plan(ARM, LIMITS, moving([1.3, 1.8, 0.3], [A], velocity, acceleration))


@pytest.mark.parametrize('planner_id', [i for i in planner_ids() if i != 'time_optimal'])
def test_other_planners_start_from_rest_and_say_so(planner_id):
    with pytest.raises(StartStateError, match=(
            rf'^start state: joint_2 moves at -0\.2 rad/s, must be at rest .* for planner '
            rf'{planner_id}; from any state: time_optimal$')):
        plan(ARM, LIMITS, moving(A, [B], velocity=[0.0, -0.2, 0.0], planner_id=planner_id))


def test_durations_are_prescribed_from_rest_only():
    with pytest.raises(InvalidInputError, match='^segment_durations are given, and the start '):
        plan(ARM, LIMITS, moving(A, [B], velocity=[0.1, 0.0, 0.0], segment_durations=[3.0]))


def test_rates_need_a_start():
    with pytest.raises(InvalidInputError, match='^start_velocity and start_acceleration need '):
        through([A, B], start_velocity=[0.1, 0.0, 0.0])
