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

"""`plan`: the thesis's tables, hard cases, scaling, start states and refusals."""

from dataclasses import replace

from helpers.hard_cases import HARD_CASES, NOT_FOR_APPROACH_A
from helpers.measured_motions import LIMIT_MARGIN, Measured
from helpers.planning_cases import ARM, FREE, LIMITS, STRONG, table, through
from helpers.random_tasks import Task
import numpy as np
import pytest
from rrr_traj_planner.core.errors import (
    ConvergenceError,
    InvalidInputError,
    LimitViolationError,
    RrrPlannerError,
    StartStateError,
    UnreachableError,
)
from rrr_traj_planner.planners import planning
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.registration import Registered
from rrr_traj_planner.planners.registry import planner_ids
from rrr_traj_planner.planners.request import PlanningRequest

PLANNERS = ['cycloid', 'cycloid_approach_a']


def duration(limits, request):
    return plan(ARM, limits, request).trajectory.duration


@pytest.mark.parametrize(('planner_id', 'name', 'seconds', 'worse'), [
    ('cycloid', '6.1', 2.850, 1.0005), ('cycloid', '6.3', 3.490, 1.0005),
    ('cycloid_approach_a', '6.1', 3.552, 1.01), ('cycloid_approach_a', '6.3', 4.045, 1.01)])
def test_tables_take_the_times_that_are_known(planner_id, name, seconds, worse):
    found = duration(FREE, table(name, planner_id=planner_id))
    assert seconds - 5.1e-4 <= found <= seconds * worse + 5.1e-4


@pytest.mark.parametrize('planner_id', PLANNERS)
def test_table_6_3_with_the_thesis_s_own_limits_is_refused_by_name(planner_id):
    with pytest.raises(LimitViolationError, match=(
            r'^via point 2: joint_2 needs 218\.9 N m to hold, limit 200 N m$')) as refusal:
        plan(ARM, LIMITS, table('6.3', planner_id=planner_id, elbow='up'))
    assert refusal.value.via_point == 2
    assert refusal.value.joint == 'joint_2'
    assert refusal.value.limit == 200.0
    assert refusal.value.value == pytest.approx(218.9, abs=0.051)


@pytest.mark.parametrize('planner_id', PLANNERS)
def test_table_6_3_is_refused_on_either_branch_and_planned_with_a_stronger_joint_2(planner_id):
    with pytest.raises(LimitViolationError, match='joint_2 needs 218.9 N m to hold'):
        plan(ARM, LIMITS, table('6.3', planner_id=planner_id))
    answer = plan(ARM, STRONG, table('6.3', planner_id=planner_id))
    assert (answer.effort <= STRONG.max_effort * (1.0 + LIMIT_MARGIN)).all()


@pytest.mark.parametrize('planner_id', PLANNERS)
@pytest.mark.parametrize('name', HARD_CASES)
def test_hard_cases_are_planned_within_every_limit_or_refused_for_a_reason(planner_id, name):
    q, changes = HARD_CASES[name]
    limits = replace(LIMITS, **changes)
    task = Task(0, name, ARM, limits, np.asarray(q), through(q, planner_id=planner_id))
    if planner_id == 'cycloid_approach_a' and name in NOT_FOR_APPROACH_A:
        with pytest.raises(RrrPlannerError, match='along the segment|no durations are found'):
            plan(ARM, limits, task.request)
        return
    assert Measured(task, plan(ARM, limits, task.request)).violations() == []


@pytest.mark.parametrize('factor', [0.3, 0.7])
def test_scaling_factors_scale_the_limits(factor):
    request = table('6.1', velocity_scaling=factor, acceleration_scaling=factor ** 2)
    expected = replace(FREE, max_velocity=factor * FREE.max_velocity,
                       max_acceleration=factor ** 2 * FREE.max_acceleration)
    assert duration(FREE, request) == pytest.approx(duration(expected, table('6.1')), rel=1e-9)
    # Velocities by k, accelerations by k^2: the same motion, 1 / k as long.
    unlimited = replace(FREE, max_jerk=np.full(3, np.inf))
    assert duration(unlimited, request) == pytest.approx(
        duration(unlimited, table('6.1')) / factor, rel=1e-6)


@pytest.mark.parametrize('planner_id', PLANNERS)
def test_points_in_reverse_order_take_the_same_time_with_cycloid_alone(planner_id):
    forwards, backwards = (through(q, planner_id=planner_id) for q in (
        [[0.3, 1.4, 0.0], [1.0, 1.8, 0.3], [0.2, 1.3, -0.5]],
        [[0.2, 1.3, -0.5], [1.0, 1.8, 0.3], [0.3, 1.4, 0.0]]))
    if planner_id == 'cycloid':
        assert duration(FREE, forwards) == pytest.approx(duration(FREE, backwards), rel=1e-6)
    else:  # approach (a) leaves a point at the velocity at which it arrived
        assert duration(FREE, forwards) != pytest.approx(duration(FREE, backwards), rel=1e-3)


@pytest.mark.parametrize('planner_id', PLANNERS)
def test_joint_1_mirrored_takes_the_same_time(planner_id):
    wide = replace(LIMITS, min_position=[-3.0, 0.0, -np.pi], max_position=[3.0, np.pi, np.pi])
    q = np.array([[0.3, 1.4, 0.0], [1.0, 1.8, 0.3], [0.2, 1.3, -0.5]])
    times = [duration(wide, through(q * side, planner_id=planner_id))
             for side in ([1.0, 1.0, 1.0], [-1.0, 1.0, 1.0])]
    assert times[0] == pytest.approx(times[1], rel=1e-6)


def test_repeated_points_share_a_via_time_and_cost_nothing():
    q = [[0.3, 1.4, 0.0], [1.0, 1.8, 0.3], [1.0, 1.8, 0.3], [0.2, 1.3, -0.5]]
    answer = plan(ARM, LIMITS, through(q))
    assert answer.via_times[1] == answer.via_times[2]
    assert answer.trajectory.duration == pytest.approx(
        duration(LIMITS, through([q[0], q[1], q[3]])), rel=1e-12)


def test_equal_points_are_rest_for_a_sample_period():
    answer = plan(ARM, LIMITS, through([[0.3, 1.4, 0.0]] * 3, sample_period=0.02))
    assert answer.trajectory.duration == 0.02
    assert answer.via_times.tolist() == [0.0, 0.0, 0.0]
    assert answer.points.velocities.tolist() == [[0.0] * 3] * 2
    assert answer.peaks.velocity.tolist() == [0.0] * 3


def test_start_state_is_a_point_before_the_first():
    q = [[0.3, 1.4, 0.0], [1.0, 1.8, 0.3], [0.2, 1.3, -0.5]]
    answer = plan(ARM, LIMITS, through(q[1:], start=q[0]))
    assert len(answer.via_times) == 2
    assert answer.via_times[0] > 0.0
    assert answer.trajectory(0.0)[0].tolist() == q[0]
    assert answer.trajectory.duration == pytest.approx(duration(LIMITS, through(q)), rel=1e-9)
    alone = plan(ARM, LIMITS, through(q[1:2], start=q[0], segment_durations=[5.0]))
    assert alone.via_times == pytest.approx([5.0], abs=1e-9)


@pytest.mark.parametrize(('start', 'message'), [
    ([1.7, 1.4, 0.0], r'^start state: joint_1 is at 1\.7 rad, limits 0 to 1\.5708 rad$'),
    ([0.3, 0.0, np.pi / 2], r'^start state: joint_2 needs 243\.3 N m to hold, limit 200 N m$')])
def test_impossible_start_states_are_refused(start, message):
    # By hand: 16 * 0.5 * 9.81 + 12 * 9.81 * (0.9 + 0.5) = 243.3 N m.
    with pytest.raises(StartStateError, match=message):
        plan(ARM, LIMITS, through([[0.3, 1.4, 0.0]], start=start))


@pytest.mark.parametrize('planner_id', PLANNERS)
def test_a_path_that_cannot_be_held_is_refused_by_segment_joint_and_torque(planner_id):
    # Both ends hold 0 N m at joint 3 (theta_2 + theta_3 a multiple of pi); half-way the forearm
    # is level: 12 * 9.81 * 0.5 = 58.9 N m.
    weak = replace(LIMITS, max_effort=[150.0, 200.0, 50.0])
    q = [[0.3, 1.5, -1.5], [0.3, np.pi / 2, 1.5]]
    with pytest.raises(LimitViolationError, match=(
            r'^segment 0: along the segment joint_3 '
            r'needs 58\.9 N m to hold, limit 50 N m$')) as no:
        plan(ARM, weak, through(q, planner_id=planner_id))
    assert no.value.via_point == -1
    assert no.value.joint == 'joint_3'


def test_refused_segment_is_counted_as_the_caller_counts():
    weak = replace(LIMITS, max_effort=[150.0, 200.0, 50.0])
    q = [[0.3, 1.5, -1.5], [0.3, 1.5, -1.5], [0.3, np.pi / 2, 1.5]]
    with pytest.raises(LimitViolationError, match='^segment 1: along the segment joint_3'):
        plan(ARM, weak, through(q))


def test_unreachable_point_is_refused_with_its_miss():
    with pytest.raises(UnreachableError, match=(
            r"^via point 1: \(3, 0, 0\.5\) m is out of the arm's reach: it misses by "
            r'1\.4 m$')) as no:
        plan(ARM, LIMITS, PlanningRequest([[1.0, 0.6, 1.0], [3.0, 0.0, 0.5]]))
    assert no.value.via_point == 1
    assert no.value.distance == pytest.approx(1.4)


@pytest.mark.parametrize('planner_id', PLANNERS)
def test_missing_acceleration_limit_is_refused_by_joint(planner_id):
    limits = replace(LIMITS, max_acceleration=[1.0, np.inf, 1.0])
    with pytest.raises(InvalidInputError, match='needs acceleration limits, joint_2 has none$'):
        plan(ARM, limits, table('6.1', planner_id=planner_id))


@pytest.mark.parametrize(('changes', 'message'), [
    ({'velocity_scaling': 1.5}, r'^velocity_scaling is 1\.5, must be in \(0, 1\]$'),
    ({'acceleration_scaling': 0.0},
     r'^acceleration_scaling is 0\.0, must be in \(0, 1\]$'),
    ({'planner_id': 'teleport'}, r"^planner_id 'teleport' is unknown, known are cycloid, ")])
def test_malformed_requests_are_refused(changes, message):
    with pytest.raises(InvalidInputError, match=message):
        plan(ARM, LIMITS, table('6.1', **changes))


def test_every_planner_is_found_by_its_id():
    assert set(PLANNERS) <= set(planner_ids())


def test_a_planner_that_exceeds_a_limit_is_detected(monkeypatch):
    quick = plan(ARM, LIMITS, table('6.1')).trajectory.time_scaled(0.9)
    monkeypatch.setattr(planning, 'planner', lambda _: Registered(lambda task: quick, False))
    tight = replace(LIMITS, max_jerk=[1.0, 1.0, 1.0], max_acceleration=[9.0] * 3,
                    max_velocity=[9.0] * 3)
    with pytest.raises(ConvergenceError, match=(
            r'^planner cycloid broke a limit: joint_\d jerk reaches [\d.]+ rad/s\^3, '
            r'limit 1 rad/s\^3$')):
        plan(ARM, tight, table('6.1'))


@pytest.mark.parametrize('planner_id', ['cycloid', 'time_optimal', 'poly_434', 'line_arc'])
@pytest.mark.parametrize('factor', [1e308, 1e154, 5e-324, 1e-154])
def test_time_scaling_that_no_float_holds_is_refused(planner_id, factor):
    trajectory = plan(ARM, LIMITS, table('6.1', planner_id=planner_id)).trajectory
    with pytest.raises(InvalidInputError, match=r'^factor is .*, must be in \[1e-30, 1e\+30\]$'):
        trajectory.time_scaled(factor)
