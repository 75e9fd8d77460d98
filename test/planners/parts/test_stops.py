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

"""Motions that stop at via points, by every planner: rests, times, limits and points."""

from dataclasses import replace
from functools import cache

from helpers.measured_motions import HIT, Measured
from helpers.planning_cases import ARM, LIMITS
from helpers.random_tasks import Task
import numpy as np
import pytest
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.core.errors import LimitViolationError, TimingError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.registry import planner, planner_ids
from rrr_traj_planner.planners.request import PlanningRequest

Q = np.array([[0.3, 1.4, 0.0], [0.9, 1.7, 0.2], [1.0, 1.5, 0.3], [0.5, 1.2, -0.1],
              [0.2, 1.3, 0.1]])
TIPS = forward_kinematics(ARM, Q)
STOP_AT = [False, True, False, True, True]
DWELL = [0.3, 0.5, 0.0, 0.0007, 0.25]  # the fourth is shorter than a tenth of the period
RESTS = [0, 1, 3, 4]
BETWEEN_POINTS = 1e-3  # relative, of the quintic through the points
NANOSECOND = 1e-9
ROUNDED = 1e-9  # rad/s, reached in half a nanosecond, to which times of points are rounded
CARTESIAN = ('line_arc', 'line_polynomial')

each_planner = pytest.mark.parametrize('planner_id', planner_ids())


@cache
def stopping(planner_id):
    """Return the plan of the task with stops."""
    return plan(ARM, LIMITS, PlanningRequest(
        TIPS, planner_id=planner_id, elbow='up', stop_at=STOP_AT, dwell=DWELL))


def planned(tips=TIPS, limits=LIMITS, **request):
    return plan(ARM, limits, PlanningRequest(tips, **request))


@each_planner
def test_limits_are_kept_and_via_points_hit_over_the_continuous_motion(planner_id):
    answer = stopping(planner_id)
    found = Measured(Task(0, '', ARM, LIMITS, Q, PlanningRequest(TIPS)), answer)
    missed = planner(planner_id).misses_via_points
    assert found.violations() == (['via points'] if missed else [])
    assert (found.via_point_errors()[RESTS] <= HIT).all()  # stops are hit by planners that blend
    dt, peaks = np.diff(found.t)[:, np.newaxis], answer.peaks
    assert (np.abs(np.diff(found.q, axis=0)) <= peaks.velocity * dt + HIT).all()
    assert (np.abs(np.diff(found.qd, axis=0)) <= peaks.acceleration * dt + HIT).all()


@each_planner
def test_arm_rests_exactly_for_each_dwell_and_moves_on_then(planner_id):
    answer = stopping(planner_id)
    for k in RESTS:
        arrival, t = answer.via_times[k], DWELL[k] * np.linspace(0.0, 1.0, 7)
        q, qd, qdd, _ = answer.trajectory(arrival + t)
        assert not qd.any() and not qdd.any()
        assert np.abs(q - q[0]).max() <= 1e-12
        times = answer.points.times
        within = (times >= arrival - NANOSECOND) & (times <= arrival + DWELL[k] + NANOSECOND)
        assert within.any() and np.abs(answer.points.velocities[within]).max() <= ROUNDED
        if k < len(Q) - 1:
            assert np.abs(answer.trajectory(arrival + DWELL[k] + 0.02)[1]).max() > 0.0
    assert answer.via_times[0] == 0.0
    assert answer.trajectory.duration == pytest.approx(answer.via_times[-1] + DWELL[-1], abs=1e-12)
    assert answer.points.times[-1] == pytest.approx(answer.trajectory.duration, abs=NANOSECOND)


@each_planner
def test_points_are_on_one_grid_and_at_every_via_time(planner_id):
    answer = stopping(planner_id)
    times, period = answer.points.times, 0.01
    fixed = np.append(answer.via_times, times[-1])
    assert np.abs(times[:, np.newaxis] - answer.via_times).min(axis=0).max() <= NANOSECOND
    is_fixed = np.abs(times[:, np.newaxis] - fixed).min(axis=1) <= 2.0 * NANOSECOND
    gaps = np.diff(times)
    assert gaps[~(is_fixed[1:] & is_fixed[:-1])].min() >= 0.1 * period - 2.0 * NANOSECOND
    assert gaps.max() <= 1.2 * period
    on_grid = np.abs(times / period - np.round(times / period)) < 1e-6
    # others are at via times, where the arm moves on, or divide an interval
    assert on_grid.sum() >= 0.9 * times[-1] / period
    q, qd, qdd = spline_through(answer.points).within(np.linspace(0.0, 1.0, 17))
    for values, limit in ((qd, LIMITS.max_velocity), (qdd, LIMITS.max_acceleration),
                          (inverse_dynamics(ARM, q, qd, qdd), LIMITS.max_effort)):
        assert (np.abs(values) <= (1.0 + BETWEEN_POINTS) * limit).all()


@pytest.mark.parametrize('planner_id', [i for i in planner_ids() if i not in CARTESIAN])
def test_parts_take_the_times_of_motions_of_their_own(planner_id):
    """The sum of three plans, each from stop to stop; by planners that keep the posture."""
    answer = stopping(planner_id)
    alone = sum(planned(tips, planner_id=planner_id, elbow='up').trajectory.duration
                for tips in (TIPS[:2], TIPS[1:4], TIPS[3:]))
    assert answer.trajectory.duration == pytest.approx(alone + sum(DWELL), abs=1e-9)


def test_cycloid_with_stops_everywhere_is_approach_c():
    """A second method: one optimises via velocities, the other has closed forms."""
    ours = planned(stop_at=[True] * 5)
    theirs = planned(planner_id='cycloid_approach_c')
    assert ours.via_times == pytest.approx(theirs.via_times, abs=1e-6)


def test_without_stops_and_dwells_nothing_changes():
    plain, given = planned(), planned(stop_at=[False] * 4 + [True], dwell=[0.0] * 5)
    for name in ('times', 'positions', 'velocities', 'accelerations'):
        assert getattr(plain.points, name).tolist() == getattr(given.points, name).tolist()


def test_dwell_alone_delays_the_start_and_holds_the_end():
    plain, held = planned(), planned(dwell=[0.5, 0.0, 0.0, 0.0, 1.0])
    assert held.via_times == pytest.approx([0.0, *(0.5 + plain.via_times[1:])], abs=1e-9)
    assert held.trajectory.duration == pytest.approx(plain.trajectory.duration + 1.5, abs=1e-9)
    assert not held.points.velocities[held.points.times > held.via_times[-1]].any()


def test_rests_remain_where_coarse_points_slow_the_motion():
    request = {'stop_at': STOP_AT, 'dwell': DWELL, 'planner_id': 'time_optimal'}
    fine, coarse = planned(**request), planned(sample_period=10.0, **request)
    assert 'sample_period 10 s makes the motion' in coarse.note
    assert coarse.trajectory.duration > 1.01 * fine.trajectory.duration
    assert coarse.trajectory.duration - coarse.via_times[-1] == pytest.approx(DWELL[-1])
    for k in RESTS:
        _, qd, _, _ = coarse.trajectory(coarse.via_times[k] + DWELL[k] * np.array([0.0, 1.0]))
        assert not qd.any()


def test_start_state_comes_before_the_first_via_point_at_which_the_arm_may_stop():
    answer = planned(TIPS[1:], start=Q[0], stop_at=STOP_AT[1:], dwell=DWELL[1:], elbow='up')
    whole = planned(stop_at=STOP_AT, dwell=[0.0, *DWELL[1:]], elbow='up')
    assert answer.via_times == pytest.approx(whole.via_times[1:], abs=1e-9)
    assert answer.points.positions[0].tolist() == Q[0].tolist()


@each_planner
def test_dwell_where_the_arm_is_already(planner_id):
    answer = planned(TIPS[[0, 0, 1]], start=Q[0], planner_id=planner_id, elbow='up',
                     stop_at=[True, True, True], dwell=[0.5, 0.25, 0.0])
    assert answer.via_times[:2].tolist() == [0.0, 0.5]
    assert answer.trajectory(0.74)[0] == pytest.approx(Q[0], abs=HIT)
    assert answer.via_times[2] > 1.0
    still = planned(TIPS[[0, 0]], planner_id=planner_id, stop_at=[True, True], dwell=[0.5, 0.25])
    assert (still.via_times.tolist(), still.trajectory.duration) == ([0.0, 0.5], 0.75)


def test_motion_that_starts_moving_does_so_in_its_first_part_alone():
    rates = {'start_velocity': [0.3, -0.2, 0.4], 'start_acceleration': [0.2, 0.1, 0.0]}
    answer = planned(TIPS[1:], start=Q[0], planner_id='time_optimal', elbow='up',
                     stop_at=STOP_AT[1:], dwell=DWELL[1:], **rates)
    first = planned(TIPS[1:2], start=Q[0], planner_id='time_optimal', elbow='up', **rates)
    others = planned(TIPS[1:], stop_at=STOP_AT[1:], dwell=DWELL[1:], planner_id='time_optimal',
                     elbow='up')
    assert answer.points.velocities[0].tolist() == rates['start_velocity']
    assert answer.via_times[0] == pytest.approx(first.via_times[0], abs=1e-9)
    assert answer.via_times - answer.via_times[0] == pytest.approx(others.via_times, abs=1e-9)


def test_motion_that_starts_moving_comes_back_to_stop_where_it_started():
    answer = planned(TIPS[[0, 1]], start=Q[0], start_velocity=[0.3, 0.0, 0.0], elbow='up',
                     planner_id='time_optimal', stop_at=[True, True], dwell=[0.2, 0.0])
    assert answer.via_times[0] > 0.3
    assert answer.trajectory(answer.via_times[0])[0] == pytest.approx(Q[0], abs=HIT)


def test_durations_are_those_of_the_segments_and_rests_come_on_top():
    durations = [2.5, 2.0, 3.0, 2.0]
    for planner_id in ('cycloid', 'time_optimal', 'poly_434', 'cycloid_approach_a'):
        answer = planned(planner_id=planner_id, stop_at=STOP_AT, dwell=DWELL, elbow='up',
                         segment_durations=durations)
        assert np.diff(answer.via_times) == pytest.approx(
            np.add(durations, DWELL[:-1]), abs=1e-9)
    free = planned(planner_id='time_optimal', stop_at=STOP_AT, elbow='up',
                   segment_durations=[2.5, np.nan, 3.0, np.nan])
    assert np.diff(free.via_times)[[0, 2]] == pytest.approx([2.5, 3.0], abs=1e-9)


def test_durations_that_are_too_short_are_told_by_the_numbers_of_the_request():
    durations = [3.0, 0.2, 3.0, 3.0]
    with pytest.raises(TimingError, match=(
            r'^segment_durations \[0\.2, 3\.0\] s are too short.* \(of segments 1, 2 alone\)$'
            )) as no:
        planned(stop_at=STOP_AT, elbow='up', segment_durations=durations)
    assert len(no.value.least_durations) == 4
    again = planned(stop_at=STOP_AT, elbow='up', segment_durations=no.value.least_durations)
    assert np.diff(again.via_times) == pytest.approx(no.value.least_durations, abs=1e-9)


def test_a_segment_that_cannot_be_held_has_its_number_in_the_request():
    weak = replace(LIMITS, max_effort=[150.0, 200.0, 50.0])
    q = [[0.3, 1.5, -1.5], [0.6, 1.5, -1.5], [0.3, np.pi / 2, 1.5]]
    with pytest.raises(LimitViolationError, match='^segment 1: along the segment joint_3 needs'):
        plan(ARM, weak, PlanningRequest(joint_via_points=q, stop_at=[True] * 3))
