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

"""Parameters of the node `trajectory_planner`: defaults of requests, limits, refused changes."""

from __future__ import annotations

from helpers.own_limits import own_limits
from helpers.places import CONFIG
from helpers.plan_requests import NAMES, stamps, TABLE_6_1, TABLE_6_3
from helpers.planner_in_ros import (
    parameter_value,
    plan,
    planning_threads,
    set_parameter,
    start_planner,
)
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner_interfaces.srv import PlanTrajectory

CODES = PlanTrajectory.Response


def test_parameters_fill_what_a_request_leaves_out(ros):
    start_planner(ros, sample_period=0.05, default_planner_id='cycloid_approach_a',
                  base_frame='world', **own_limits('a', 'b', 'c'))
    response = plan(ros, frame='world')
    assert response.trajectory.header.frame_id == 'world'
    assert response.trajectory.joint_names == ['a', 'b', 'c']
    assert stamps(response.trajectory)[1] == 50_000_000
    assert response.via_times[-1] > 3.5  # cycloid takes 2.85 s
    requested = plan(ros, sample_period=0.02, planner_id='cycloid')
    assert stamps(requested.trajectory)[1] == 20_000_000
    assert requested.via_times[-1] < 2.9
    assert plan(ros, frame='base_link').error_code == CODES.FRAME_TRANSFORM_FAILURE


def test_max_deviation_reaches_the_request(ros, monkeypatch):
    seen = []

    def noting(model, limits, request):
        seen.append(request.max_deviation)
        raise InvalidInputError('seen')

    monkeypatch.setattr('rrr_traj_planner.nodes.planner_node.node.plan', noting)
    start_planner(ros, max_deviation=0.2)
    plan(ros)
    plan(ros, max_deviation=0.01)
    assert seen == [0.2, 0.01]


def test_parameters_come_from_a_file(ros):
    file = CONFIG / 'thesis_arm_joint_2_250.yaml'
    start_planner(ros, ['--ros-args', '--params-file', str(file)])
    response = plan(ros, TABLE_6_3)
    assert response.error_code == CODES.SUCCESS, response.message
    assert parameter_value(ros, 'joint_limits.joint_2.max_effort').double_value == 250.0


def test_changed_limits_hold_from_the_next_request_on(ros):
    start_planner(ros)
    assert plan(ros, TABLE_6_3).error_code == CODES.GOAL_CONSTRAINTS_VIOLATED
    assert set_parameter(ros, 'joint_limits.joint_2.max_effort', 250.0).successful
    assert plan(ros, TABLE_6_3).error_code == CODES.SUCCESS
    fast = plan(ros)
    assert set_parameter(ros, 'joint_limits.joint_2.max_velocity', 0.2).successful
    slow = plan(ros)
    assert slow.peak_velocity[1] == pytest.approx(0.2, rel=1e-3)
    assert slow.via_times[-1] > fast.via_times[-1]


@pytest.mark.parametrize(('name', 'value', 'text'), [
    ('sample_period', 0.0, 'sample_period'), ('max_deviation', -1.0, 'max_deviation'),
    ('joint_limits.joint_1.min_position', 2.0,
     'joint_limits.joint_1.min_position is 2 rad, must be below '
     'joint_limits.joint_1.max_position, 1.5708 rad'),
    ('default_planner_id', 'magic', "planner_id 'magic' is unknown, known are cycloid"),
    ('base_frame', 'world', 'read-only'), ('arm.a2', 0.5, 'read-only')])
def test_refused_change_says_why_and_changes_nothing(ros, name, value, text):
    start_planner(ros)
    before = plan(ros)
    result = set_parameter(ros, name, value)
    assert not result.successful
    assert text in result.reason
    assert plan(ros).trajectory == before.trajectory


@pytest.mark.parametrize(('name', 'value', 'text'), [
    ('default_planner_id', 'magic', r"'magic' is unknown, known are cycloid"),
    ('sample_period', 20.0, r'parameter sample_period is 20 s, must be in \[0.0001, 10\] s')])
def test_wrong_override_stops_the_node(ros, name, value, text):
    with pytest.raises(InvalidInputError, match=text):
        start_planner(ros, **{name: value})
    assert planning_threads() == []


def test_a_limit_switched_off_does_not_bind(ros):
    start_planner(ros, **{'joint_limits.joint_2.has_effort_limits': False})
    assert plan(ros, TABLE_6_3).error_code == CODES.SUCCESS


def test_planner_without_what_it_needs_says_so(ros):
    start_planner(ros, **{f'joint_limits.{name}.has_acceleration_limits': False for name in NAMES})
    response = plan(ros, TABLE_6_1)
    assert response.error_code == CODES.INVALID_GOAL_CONSTRAINTS
    assert 'acceleration' in response.message
