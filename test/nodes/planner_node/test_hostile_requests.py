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

"""Hostile requests: each is answered as it should be, and the node is as well as before."""

from __future__ import annotations

from math import inf, nan
from time import monotonic

from geometry_msgs.msg import Point, Pose
from helpers.hostile_requests import (
    answered,
    assert_sound,
    CODES,
    CONFIG,
    hostile_requests,
    MAX_POINTS,
)
from helpers.plan_requests import is_refused, NAMES, NEAR, plan_request, START, TABLE_6_1
from hypothesis import given, HealthCheck, Phase, settings
import pytest
from rclpy.parameter import Parameter
from rrr_traj_planner.core.errors import ConvergenceError
from rrr_traj_planner.nodes.planner_node.node import TrajectoryPlanner
from rrr_traj_planner.planners.registry import planner_ids
from rrr_traj_planner_interfaces.srv import PlanTrajectory

INVALID, NO_IK = CODES.INVALID_GOAL_CONSTRAINTS, CODES.NO_IK_SOLUTION
A, B, C = TABLE_6_1

# Nothing refused takes so long [s], on a busy machine too.
AT_ONCE = 5.0

# Through the service, a few: the rest is the same.
THROUGH_ROS = 40

# The node stops these by the clock, and their answers may differ.
STOPPED = ('time_optimal', 'line_arc', 'line_polynomial')


@settings(max_examples=200, derandomize=True, database=None, deadline=None,
          phases=[Phase.generate, Phase.shrink], suppress_health_check=list(HealthCheck))
@given(hostile_requests())
def test_any_request_is_refused_with_a_reason_or_planned_within_limits(request):
    assert_sound(request, answered(request))


@settings(max_examples=50, derandomize=True, database=None, deadline=None,
          phases=[Phase.generate], suppress_health_check=list(HealthCheck))
@given(hostile_requests())
def test_same_request_has_the_same_answer(request):
    assert answered(request) == answered(request)


@pytest.mark.parametrize(('points', 'code', 'text', 'via_point'), [
    ((A, (0.0, 0.0, 2.0)), CODES.SUCCESS, '', -1),  # on axis 1, joint 1 anywhere
    ((A, (0.0, 0.0, 0.5)), NO_IK, "out of the arm's reach", 1),
    ((A, (0.1, 0.0, 0.5)), NO_IK, "out of the arm's reach", 1),
    ((A, (5e-324, 5e-324, 5e-324)), CODES.GOAL_CONSTRAINTS_VIOLATED, 'joint_2 would be at', 1),
    ((A, (1e300, 0.0, 0.0)), NO_IK, "out of the arm's reach", 1),
    ((A, (1e308, 1e308, 1e308)), NO_IK, "out of the arm's reach", 1),
    ((A, (0.0, -inf, 0.5)), INVALID, 'must be finite', 1),
    (((nan, nan, nan), A), INVALID, 'must be finite', 0),
    ((A, A, A), CODES.SUCCESS, '', -1),
    ((A, B) * 3, CODES.SUCCESS, '', -1)])
@pytest.mark.filterwarnings('error::RuntimeWarning')
def test_degenerate_positions_are_planned_or_refused(points, code, text, via_point):
    response = answered(plan_request(points))
    assert (response.error_code, response.failed_via_point) == (code, via_point), response.message
    assert text in response.message
    assert_sound(plan_request(points), response)


@pytest.mark.parametrize('planner_id', planner_ids())
@pytest.mark.parametrize(('fields', 'text'), [
    ({'max_velocity_scaling_factor': 1e-6}, f'more than {MAX_POINTS} points'),
    ({'max_velocity_scaling_factor': 1e-300}, f'more than {MAX_POINTS} points'),
    ({'max_acceleration_scaling_factor': 1e-300}, f'more than {MAX_POINTS} points'),
    ({'max_velocity_scaling_factor': 5e-324}, 'must be positive'),
    ({'max_velocity_scaling_factor': 1e300}, 'must be in (0, 1]'),
    ({'max_velocity_scaling_factor': -1e300}, 'must be in (0, 1]'),
    ({'sample_period': 1e300}, 'must be 0 or in [0.0001, 10] s'),
    ({'sample_period': 5e-324}, 'must be 0 or in [0.0001, 10] s'),
    ({'sample_period': 1e-8}, 'must be 0 or in [0.0001, 10] s')])  # 1e8 points
def test_scalings_and_periods_are_refused_before_anything_is_planned(
        monkeypatch, planner_id, fields, text):
    request = plan_request((A, B, C), planner_id=planner_id, **fields)
    for name in ('through_joints.JointTask', 'along_path.CartesianTask'):
        monkeypatch.setattr(f'rrr_traj_planner.planners.parts.{name}', must_not_be_made)
    if 'must be positive' in text:  # 1 rad/s times it is no number above 0, or the least one
        assert answered(request).error_code == INVALID
    else:
        is_refused(answered(request), INVALID, text)


def must_not_be_made(*_):
    raise ConvergenceError('a task for a planner was made')


@pytest.mark.parametrize('durations', [(1e5, 1.0), (1e300, 1e300), (1.7e308, 1.7e308)])
def test_prescribed_durations_too_long_for_an_answer_are_refused_at_once(durations):
    is_refused(answered(plan_request(segment_durations=list(durations))), INVALID,
               f'more than {MAX_POINTS} points')


def test_too_many_via_points_are_refused_at_once():
    request = plan_request()
    request.via_points.poses = [Pose(position=Point(x=nan))] * 100_000
    began = monotonic()
    is_refused(answered(request), INVALID, '100000 via points given, at most 1000 allowed')
    assert monotonic() - began < AT_ONCE


def test_texts_from_outside_are_shortened_in_messages():
    for fields in ({'planner_id': 'x' * 10 ** 6}, {'frame': 'x' * 10 ** 6},
                   {'elbow': 'a\nb' * 10 ** 5}):
        message = answered(plan_request(**fields)).message
        assert len(message) < 500
        assert '\n' not in message and '...' in message


# Through ROS


@pytest.fixture
def ask(ros):
    node = ros.add(TrajectoryPlanner(context=ros.context, parameter_overrides=[
        Parameter('max_points', value=MAX_POINTS), Parameter('transform_timeout', value=0.0),
        Parameter('planning_time_limit', value=60.0)]))  # however busy the machine is
    assert node._parameters_declared.config.max_points == CONFIG.max_points
    return lambda request: ros.call(PlanTrajectory, 'plan_trajectory', request)


def test_node_answers_as_the_planners_do_and_continues(ask):
    @settings(max_examples=THROUGH_ROS, derandomize=True, database=None, deadline=None,
              phases=[Phase.generate], suppress_health_check=list(HealthCheck))
    @given(hostile_requests())
    def run(request):
        if request.planner_id in STOPPED:
            request.planner_id = 'cycloid'
        response, expected = ask(request), answered(request, patience=inf)
        assert (response.error_code, response.failed_via_point) == (
            expected.error_code, expected.failed_via_point)
        if response.error_code != CODES.FRAME_TRANSFORM_FAILURE:  # there it tells of tf2
            assert response.message == expected.message
        assert response.trajectory == expected.trajectory

    run()
    assert ask(plan_request(NEAR)).error_code == CODES.SUCCESS


def test_hundred_thousand_points_are_refused_by_the_node(ask):
    request = plan_request()
    request.via_points.poses = [Pose(position=Point(x=1.0, y=0.6, z=1.0))] * 100_000
    request.start_state.name, request.start_state.position = NAMES, START.tolist()
    is_refused(ask(request), INVALID, '100000 via points given, at most 1000 allowed')
    assert ask(plan_request(NEAR)).error_code == CODES.SUCCESS
