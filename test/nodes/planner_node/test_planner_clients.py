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

"""Several clients of the planner at once, and parameters that change under them."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from threading import Condition

from helpers.plan_requests import NAMES, NEAR, patient, plan_request, TABLE_6_1
import numpy as np
import pytest
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.srv import GetParameters, SetParameters, SetParametersAtomically
from rclpy.node import Node
from rclpy.parameter import Parameter
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.nodes.planner_node.node import TrajectoryPlanner
from rrr_traj_planner.nodes.planner_node.scheduler import FIRST_LEVEL
from rrr_traj_planner.planners.planning import plan as library_plan
from rrr_traj_planner.planners.request import PlanningRequest
from rrr_traj_planner_interfaces.srv import PlanTrajectory

DEADLINE = 60.0
CLIENTS, REQUESTS = 4, 10
CODES = PlanTrajectory.Response
POSITIONS = [f'joint_limits.{name}.{end}_position' for name in NAMES for end in ('min', 'max')]


@pytest.fixture
def planner(ros):
    return ros.add(TrajectoryPlanner(context=ros.context, parameter_overrides=patient()))


def parameter(name, value):
    return ParameterMessage(name=name, value=Parameter(name, value=value).get_parameter_value())


def test_short_requests_of_many_clients_are_answered_in_the_order_of_each(ros, planner):
    arrived, answers = Condition(), []
    for k in range(CLIENTS):
        node = ros.add(Node(f'client_{k}', context=ros.context))
        client = node.create_client(PlanTrajectory, 'plan_trajectory')
        assert client.wait_for_service(DEADLINE)
        for i in range(REQUESTS):
            def note(future, k=k, i=i):
                with arrived:
                    answers.append((k, i, future.result()))
                    arrived.notify_all()

            client.call_async(plan_request(NEAR)).add_done_callback(note)
    with arrived:
        assert arrived.wait_for(lambda: len(answers) == CLIENTS * REQUESTS, DEADLINE), answers
    assert {answer.error_code for *_, answer in answers} == {CODES.SUCCESS}
    # A request that has taken longer, on a busy machine, rightly gives way to the others.
    short = [(k, i) for k, i, answer in answers if answer.planning_time < FIRST_LEVEL]
    assert len(short) > CLIENTS * REQUESTS // 2
    for k in range(CLIENTS):
        order = [i for client, i in short if client == k]
        assert order == sorted(order)


def test_parameters_of_a_refused_whole_are_all_as_before(ros, planner):
    before = values(ros)
    answer = ros.call(
        SetParametersAtomically, 'trajectory_planner/set_parameters_atomically',
        SetParametersAtomically.Request(parameters=[
            parameter('sample_period', 0.02), parameter('max_points', 50),
            parameter(POSITIONS[0], 3.0)]))  # above joint_1's max_position
    assert not answer.result.successful
    assert 'joint_limits.joint_1.min_position is 3 rad, must be below' in answer.result.reason
    assert values(ros) == before
    assert len(plan(ros).trajectory.points) > 50


def test_single_sets_are_judged_each_on_what_is_then_in_force(ros, planner):
    results = ros.call(
        SetParameters, 'trajectory_planner/set_parameters', SetParameters.Request(parameters=[
            parameter(POSITIONS[0], 2.0), parameter(POSITIONS[1], 3.0),
            parameter(POSITIONS[0], 2.0)])).results
    assert [r.successful for r in results] == [False, True, True]
    assert planner._parameters_declared.config.limits.min_position[0] == 2.0


def test_max_points_is_the_largest_answer(ros, planner):
    size = len(plan(ros).trajectory.points)
    for bound, code in ((size, CODES.SUCCESS), (size - 1, CODES.INVALID_GOAL_CONSTRAINTS)):
        assert ros.call(
            SetParameters, 'trajectory_planner/set_parameters', SetParameters.Request(
                parameters=[parameter('max_points', bound)])).results[0].successful
        assert plan(ros).error_code == code


def plan(ros):
    return ros.call(PlanTrajectory, 'plan_trajectory', plan_request(NEAR))


def values(ros):
    return ros.call(
        GetParameters, 'trajectory_planner/get_parameters', GetParameters.Request(
            names=['sample_period', 'max_points', *POSITIONS])).values


def test_small_request_is_answered_before_long_ones_that_came_first(ros, planner):
    """Several long requests cannot all be planned before the small one comes."""
    arrived, answers = Condition(), []
    t = np.linspace(0.0, 2.0 * np.pi, 400)
    many = np.stack((0.7 + 0.1 * np.cos(t), 0.5 + 0.1 * np.sin(2.0 * t), 1.0 + 0.1 * np.sin(t)),
                    axis=1)
    node = ros.add(Node('clients', context=ros.context))

    def ask(name, request):
        def note(future):
            with arrived:
                answers.append((name, future.result()))
                arrived.notify_all()

        client = node.create_client(PlanTrajectory, 'plan_trajectory')
        assert client.wait_for_service(DEADLINE)
        client.call_async(request).add_done_callback(note)

    for k in range(3):
        ask(f'long {k}', plan_request(many, planner_id='time_optimal'))
    ask('small', plan_request(NEAR))
    with arrived:
        assert arrived.wait_for(lambda: len(answers) == 4, DEADLINE), [n for n, _ in answers]
    names = [name for name, _ in answers]
    assert names.index('small') < 2, names  # the first long one may be near its end
    small = dict(answers)['small']
    alone = plan(ros)
    assert small.trajectory == alone.trajectory  # bit for bit


def test_library_plans_the_same_in_threads_as_alone():
    tasks = [(planner_id, k) for planner_id in ('cycloid', 'time_optimal', 'line_arc', 'poly_434')
             for k in range(3)]

    def planned(task):
        planner_id, k = task
        points = [*TABLE_6_1[:2], (0.5, 0.4 + 0.05 * k, 1.3)]
        return library_plan(RobotModel(), JointLimits(), PlanningRequest(
            points, planner_id=planner_id)).points

    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(planned, tasks))
    for task, points in zip(tasks, together):
        alone = planned(task)
        for field in ('times', 'positions', 'velocities', 'accelerations'):
            assert getattr(points, field).tolist() == getattr(alone, field).tolist()
