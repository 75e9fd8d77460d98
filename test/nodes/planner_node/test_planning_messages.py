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

"""PlanTrajectory's request and response: conversions without a node."""

from __future__ import annotations

from dataclasses import replace
from math import nan
import re

from builtin_interfaces.msg import Duration, Time
from geometry_msgs.msg import TransformStamped
from helpers.plan_requests import NAMES, plan_request, points_of, stamps, START, TABLE_6_1
import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import JOINT_NAMES
from rrr_traj_planner.core.control.computed_torque import ControllerGains
from rrr_traj_planner.core.errors import (
    ConvergenceError,
    InvalidInputError,
    LimitViolationError,
    RrrPlannerError,
    StartStateError,
    TimingError,
    UnreachableError,
)
from rrr_traj_planner.core.simulation.arm_settings import ArmSettings
from rrr_traj_planner.core.simulation.controlled_arm import ControlledArm
from rrr_traj_planner.core.simulation.encoder import EncoderSettings
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.parameters.table import PLANNER, rows_of
from rrr_traj_planner.nodes.planner_node.planning_answer import (
    failure,
    joint_trajectory,
    refusal,
    success,
    tip_path,
)
from rrr_traj_planner.nodes.planner_node.planning_request import FrameError, planning_request
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from trajectory_msgs.msg import JointTrajectoryPoint

CODES = PlanTrajectory.Response


@pytest.fixture(scope='module')
def config():
    return PlannerConfig.from_values(
        {name: row.default for name, row in rows_of(PLANNER, JOINT_NAMES).items()})


def test_empty_fields_take_the_node_s_defaults(config):
    request = planning_request(plan_request(), config)
    np.testing.assert_array_equal(request.via_points, TABLE_6_1)
    assert (request.planner_id, request.sample_period, request.max_deviation) == (
        'cycloid', 0.01, 0.05)
    assert (request.velocity_scaling, request.acceleration_scaling) == (1.0, 1.0)
    assert request.start is request.segment_durations is request.elbow is None


def test_every_field_is_taken_over(config):
    request = planning_request(plan_request(
        frame='base_link', start=START, planner_id='gauss', segment_durations=[1.0, 2.0, 3.0],
        max_velocity_scaling_factor=0.5, max_acceleration_scaling_factor=0.25,
        sample_period=0.002, elbow='down', max_deviation=0.3), config)
    np.testing.assert_array_equal(request.start, START)
    np.testing.assert_array_equal(request.segment_durations, (1.0, 2.0, 3.0))
    assert (request.planner_id, request.sample_period, request.max_deviation) == (
        'gauss', 0.002, 0.3)
    assert (request.velocity_scaling, request.acceleration_scaling, request.elbow) == (
        0.5, 0.25, 'down')


def test_start_is_brought_into_the_arm_s_order(config):
    request = planning_request(plan_request(start={
        'name': [NAMES[2], 'tool', NAMES[0], NAMES[1]], 'position': [0.3, 9.0, 0.1, 0.2]}), config)
    assert request.start.tolist() == [0.1, 0.2, 0.3]


def moving(*velocity, **more):
    return plan_request(start={'position': START, 'velocity': list(velocity)}, **more)


def test_start_at_rest_within_noise_and_no_faster(config):
    assert planning_request(moving(0.0, -0.01, 0.0), config).start_rates is None
    found = planning_request(moving(0.0, -0.011, 0.002), config).start_rates
    assert found.velocity.tolist() == [0.0, -0.011, 0.002]
    assert found.acceleration.tolist() == [0.0] * 3
    loose = replace(config, start_state_tolerance=0.2)
    assert planning_request(moving(0.0, -0.2, 0.0), loose).start_rates is None


def test_start_accelerations_are_brought_into_the_arm_s_order(config):
    found = planning_request(plan_request(
        start={'name': [NAMES[2], 'tool', NAMES[0], NAMES[1]], 'position': [0.3, 9.0, 0.1, 0.2]},
        start_acceleration=[3.0, 9.0, 1.0, 2.0]), config).start_rates
    assert found.velocity.tolist() == [0.0] * 3  # it reverses
    assert found.acceleration.tolist() == [1.0, 2.0, 3.0]


def test_speed_slightly_above_the_tolerance_is_shown_with_enough_digits(config):
    with pytest.raises(StartStateError, match=(
            r'^start state: joint_2 moves at -0\.0100000001 rad/s, must be at rest \(no faster '
            r'than start_state_tolerance, 0\.01 rad/s\) for planner cycloid; from any state: '
            'time_optimal$')):
        plan(config.model, config.limits,
             planning_request(moving(0.0, -0.0100000001, 0.0), config))


@pytest.mark.parametrize('request_, text', [
    (plan_request(start_acceleration=[1.0, 0.0, 0.0]),
     'start_acceleration is given without a start_state'),
    (moving(0.1, 0.0, 0.0, start_acceleration=[1.0]),
     'start_acceleration has 1 value, must have one for each of the 3 names in start_state, or '
     'none'),
    (moving(0.1, 0.0, 0.0, start_acceleration=[nan, 0.0, 0.0]),
     'start state: joint_1 accelerates with nan rad/s^2, must be finite')])
def test_wrong_start_accelerations_are_refused(config, request_, text):
    with pytest.raises(StartStateError, match=f'^{re.escape(text)}$'):
        planning_request(request_, config)


@pytest.mark.parametrize('encoder', [
    {'noise': 1e-6}, {'noise': 1e-5}, {'resolution': 1e-4}, {'resolution': 1e-4, 'seed': 4}])
def test_an_arm_parked_at_the_end_of_a_range_is_never_refused_for_its_encoders(config, encoder):
    arm = ControlledArm(ArmSettings(
        config.model, config.limits, ControllerGains(30.0, 1.0),
        encoder=EncoderSettings(**encoder)), (0.0, 1.34567, 0.12345))
    outside = 0
    for _ in range(25):
        arm.advance(37)
        seen = arm.measured
        outside += seen[0] < 0.0
        request = planning_request(plan_request(TABLE_6_1, start={
            'position': seen[:3], 'velocity': seen[3:]}), config)
        first = plan(config.model, config.limits, request).points.positions[0]
        assert first.tolist() == [max(seen[0], 0.0), *seen[1:3]]
    assert outside > 3 or 'resolution' in encoder


@pytest.mark.parametrize(('field', 'wrong', 'text'), [
    ('max_velocity_scaling_factor', 2.0, 'is 2.0, must be in (0, 1]'),
    ('max_acceleration_scaling_factor', -1.0, 'is -1.0, must be in (0, 1]'),
    ('segment_durations', [0.0, 1.0], '[0] is 0.0 s, must be finite and at least 1e-09 s'),
    ('elbow', 'left', "is 'left', must be 'up', 'down' or empty")])
def test_errors_name_the_service_s_fields(config, field, wrong, text):
    message = plan_request()
    setattr(message, field, wrong)
    with pytest.raises(InvalidInputError) as caught:
        planning_request(message, config)
    assert str(caught.value) == f'{field}{"" if text.startswith("[") else " "}{text}'


def test_another_frame_is_refused(config):
    with pytest.raises(FrameError, match="in frame 'tool', must be in 'base_link'"):
        planning_request(plan_request(frame='tool'), config)


def test_via_points_in_another_frame_are_transformed(config):
    to_base = TransformStamped(child_frame_id='tool')
    to_base.transform.rotation.w = 1.0
    to_base.transform.translation.z = 0.25
    request = planning_request(plan_request(frame='tool'), config, to_base=to_base)
    assert request.via_points == pytest.approx(np.add(TABLE_6_1, [0.0, 0.0, 0.25]))


def joints(*points, **fields):
    return plan_request((), joint_via_points=[
        JointTrajectoryPoint(**{'positions': [0.3, 1.4, 0.1], **point}) for point in points],
        **fields)


def test_stops_dwells_and_joint_positions_are_taken_over(config):
    request = planning_request(joints({}, {'positions': [0.5, 1.2, 0.0]}, {}, frame='anywhere',
                                      stop_at=[False, True, True], dwell=[0.5, 0.0, 1.0]), config)
    assert request.via_points is None
    assert request.joint_via_points.tolist() == [[0.3, 1.4, 0.1], [0.5, 1.2, 0.0], [0.3, 1.4, 0.1]]
    assert request.stop_at.tolist() == [False, True, True]
    assert request.dwell.tolist() == [0.5, 0.0, 1.0]
    plain = planning_request(plan_request(), config)
    assert plain.joint_via_points is plain.stop_at is plain.dwell is None


@pytest.mark.parametrize(('message', 'text', 'via_point'), [
    (joints({}, {'positions': [0.3, 1.4]}), 'joint_via_points[1] has 2 positions, must have one '
     'for each of joint_1, joint_2, joint_3', 1),
    (joints({}, {'positions': [0.3, nan, 0.1]}),
     'via point 1: joint_2 is at nan rad, must be finite', 1),
    (joints({'velocities': [0.0] * 3}, {}), 'joint_via_points[0] has velocities, must have '
     'positions only: the planner chooses the rest (stop_at asks for a stop)', 0),
    (joints({}, {'accelerations': [0.0] * 3}), 'joint_via_points[1] has accelerations, must '
     'have positions only: the planner chooses the rest', 1),
    (joints({}, {'effort': [1.0]}), 'joint_via_points[1] has effort, must have positions only: '
     'the planner chooses the rest', 1),
    (joints({}, {'time_from_start': Duration(sec=2)}), 'joint_via_points[1] has time_from_start '
     '2 s, must be 0: segment_durations prescribe times', 1),
    (joints({}, {}, elbow='up'),
     "elbow is 'up', must be empty: joint_via_points have postures of their own", -1),
    (joints({}, {}, shoulder='back'),
     "shoulder is 'back', must be empty: joint_via_points have postures of their own", -1),
    (plan_request(joint_via_points=[JointTrajectoryPoint()]),
     '3 via points and 1 joint_via_points are given, must be one of the two', -1),
    (joints({}), '1 via point given, at least 2 needed', -1),
    (joints({}, {}, stop_at=[True]),
     'stop_at has 1 value for 2 via points, must have one for each, or none', -1),
    (plan_request(stop_at=[True, True, False]), 'stop_at[2] is false, must be true: the motion '
     'ends at the last via point, at rest', 2),
    (plan_request(dwell=[0.0, 1.0, 0.0]), 'dwell[1] is 1 s, but the arm does not stop at via '
     'point 1: stop_at must be true there', 1)])
def test_malformed_joint_positions_stops_and_dwells_are_refused(config, message, text, via_point):
    with pytest.raises(InvalidInputError, match=f'^{re.escape(text)}$') as refusal:
        planning_request(message, config)
    assert refusal.value.via_point == via_point


@pytest.mark.parametrize(('error', 'code', 'via_point'), [
    (FrameError('x'), CODES.FRAME_TRANSFORM_FAILURE, -1),
    (StartStateError('x'), CODES.START_STATE_INVALID, -1),
    (InvalidInputError('x', 3), CODES.INVALID_GOAL_CONSTRAINTS, 3),
    (UnreachableError('x', 0.5, 1), CODES.NO_IK_SOLUTION, 1),
    (LimitViolationError('x', 'joint_2', 2.0, 1.0, 2), CODES.GOAL_CONSTRAINTS_VIOLATED, 2),
    (TimingError('x', (1.0, 2.0)), CODES.PLANNING_FAILED, -1),
    (RrrPlannerError('x'), CODES.PLANNING_FAILED, -1)])
def test_each_error_has_its_code(error, code, via_point):
    response = refusal(error)
    assert (response.error_code, response.message, response.failed_via_point) == (
        code, 'x', via_point)


@pytest.mark.parametrize('error', [KeyError('x'), ConvergenceError('x')])
def test_a_bug_is_named_by_its_kind(error):
    response = failure(error)
    assert (response.error_code, response.failed_via_point) == (CODES.FAILURE, -1)
    assert response.message == f'internal error, {type(error).__name__}: {error}'


def test_codes_are_moveit_s():
    assert (CODES.SUCCESS, CODES.PLANNING_FAILED, CODES.GOAL_CONSTRAINTS_VIOLATED,
            CODES.INVALID_GOAL_CONSTRAINTS, CODES.FRAME_TRANSFORM_FAILURE,
            CODES.START_STATE_INVALID, CODES.NO_IK_SOLUTION, CODES.FAILURE) == (
        1, -1, -14, -16, -21, -26, -31, 99999)


def test_plan_is_written_as_it_is(config):
    found = plan(config.model, config.limits, planning_request(plan_request(), config))
    response = success(found, config)
    motion = points_of(response.trajectory)
    for field in ('positions', 'velocities', 'accelerations'):
        np.testing.assert_array_equal(getattr(motion, field), getattr(found.points, field))
    np.testing.assert_allclose(motion.times, found.points.times, atol=1e-12)
    assert response.via_times.tolist() == found.via_times.tolist()
    assert response.peak_jerk.tolist() == found.peaks.jerk.tolist()
    assert response.peak_effort.tolist() == found.effort.tolist()


def test_times_are_whole_nanoseconds_also_after_hours(config):
    times = np.array([0.0, 0.999999999, 1.0, 12345.678901234, 2e6 + 1e-9])
    zeros = np.zeros((len(times), 3))
    message = joint_trajectory(TrajectoryPoints(times, zeros, zeros, zeros), config)
    assert stamps(message).tolist() == [
        0, 999_999_999, 1_000_000_000, 12_345_678_901_234, 2_000_000_000_000_001]
    assert all(0 <= p.time_from_start.nanosec < 10 ** 9 for p in message.points)


def test_path_is_the_tip_s(config):
    points = TrajectoryPoints([0.0, 1.0], [START, START + (0.0, 0.1, 0.0)])
    path = tip_path(points, config, Time(sec=7))
    first, second = (p.pose.position for p in path.poses)
    assert (first.x, first.y, first.z) == pytest.approx(TABLE_6_1[0])
    assert second.z > first.z
    assert (path.header.frame_id, path.header.stamp.sec) == ('base_link', 7)
