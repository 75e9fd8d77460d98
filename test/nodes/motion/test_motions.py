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

"""Motions with planners and controllers that fail, lag or fall silent."""

from __future__ import annotations

from control_msgs.action import FollowJointTrajectory
from helpers.arm_in_ros import Arm, moving, NAMES, START
from helpers.move_client import move_goal, MoveClient, start_motion_server
from helpers.plan_requests import TABLE_6_1
from helpers.planner_in_ros import start_planner
import pytest
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.task import Future
from rrr_traj_planner.nodes.process.goal_server import GoalServer, RefusedGoal, SUCCEEDED
from rrr_traj_planner_interfaces.action import MoveThrough
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

Result = MoveThrough.Result
RATE = 50.0  # Hz


class Controller:
    """A controller in a test's node: it measures what it is told, and ends goals when told so."""

    def __init__(self, ros, name='other', accepts=True):
        self.node, self.goals, self.accepts = ros.node, [], accepts
        self.server = GoalServer(
            ros.node, FollowJointTrajectory, f'{name}/follow_joint_trajectory', self._check,
            self._begin, lambda _: self.goals.clear())
        self.position = list(START)
        self._states = ros.node.create_publisher(JointState, 'joint_states', 10)
        ros.node.create_timer(1.0 / RATE, self._measure)

    def _measure(self):
        self._states.publish(JointState(  # with a gripper, which is not planned for
            header=self._stamp(), name=['gripper', *reversed(NAMES)],
            position=[0.0, *reversed(self.position)], velocity=self._velocity()))

    def _velocity(self):
        return []

    def _stamp(self):
        message = JointState()
        message.header.stamp = self.node.get_clock().now().to_msg()
        return message.header

    def _check(self, goal):
        if not self.accepts:
            raise RefusedGoal(FollowJointTrajectory.Result())  # as from other controllers

    def _begin(self, handle, _):
        self.goals.append(handle.request.trajectory)
        self.position = list(self.goals[-1].points[-1].positions)
        self.server.end(handle, SUCCEEDED, FollowJointTrajectory.Result())


class Reluctant(Controller):
    """A controller of an arm in motion: it rejects a goal, and takes its time for the next."""

    VELOCITY = [0.0, 0.0, 0.0, 0.02]  # rad/s
    DURATION = 0.5                    # s, in which other plans would arrive

    def __init__(self, ros):
        super().__init__(ros)
        self.asked = 0

    def _velocity(self):
        return self.VELOCITY

    def _check(self, goal):
        self.asked += 1
        if self.asked == 1:
            raise RefusedGoal(FollowJointTrajectory.Result())

    def _begin(self, handle, _):
        self.goals.append(handle.request.trajectory)

        def end():
            timer.cancel()
            self.server.end(handle, SUCCEEDED, FollowJointTrajectory.Result())

        timer = self.node.create_timer(self.DURATION, end)


@pytest.fixture
def ended_in_order(ros):
    """Destroy the controllers of a test with its node."""
    controllers = []
    yield controllers
    for controller in controllers:
        controller.server.destroy()


def test_controller_without_a_reference_is_planned_for_by_measured_joints(ros, ended_in_order):
    ended_in_order.append(controller := Controller(ros, '/robot/other'))
    start_planner(ros)
    start_motion_server(ros, controller_name='/robot/other')
    result = MoveClient(ros).run(move_goal(*TABLE_6_1[1:]))[1]
    assert result.error_code == Result.SUCCESS, result.message
    sent, = controller.goals
    assert list(sent.points[0].positions) == list(START)
    assert sent.joint_names == NAMES
    assert sent.points == result.trajectory.points


def test_rejection_without_a_reason_is_told(ros, ended_in_order):
    ended_in_order.append(Controller(ros, accepts=False))
    start_planner(ros)
    start_motion_server(ros, controller_name='other')
    result = MoveClient(ros).run(move_goal(TABLE_6_1[1]))[1]
    assert (result.error_code, result.message) == (
        Result.CONTROL_FAILED, 'the controller has rejected the trajectory; its log says why')


def test_a_rejected_goal_of_an_arm_in_motion_is_planned_again_by_one_plan_at_a_time(
        ros, ended_in_order):
    ended_in_order.append(controller := Reluctant(ros))
    start_planner(ros)
    start_motion_server(ros, controller_name='other')
    result = MoveClient(ros).run(move_goal(TABLE_6_1[1]))[1]
    assert (result.error_code, result.message) == (Result.SUCCESS, '')
    assert (controller.asked, len(controller.goals)) == (2, 1)


def test_nothing_is_sent_where_the_arm_has_moved_since_the_plan(ros, ended_in_order):
    ended_in_order.append(controller := Controller(ros))

    def plan(_, response):
        response.error_code = response.SUCCESS
        q = [START[0], START[1] + 0.2, START[2]]
        response.trajectory = JointTrajectory(joint_names=NAMES, points=[
            JointTrajectoryPoint(positions=q)] * 2)
        return response

    ros.node.create_service(PlanTrajectory, 'plan_trajectory', plan)
    start_motion_server(ros, controller_name='other')
    result = MoveClient(ros).run(move_goal(TABLE_6_1[1]))[1]
    assert (result.error_code, result.message) == (
        Result.START_STATE_INVALID, 'joint_2 has moved by 0.2 rad since the plan was asked for, '
        'allowed 0.01 rad: nothing is sent')
    assert controller.goals == []


def test_silent_planner_ends_a_goal_after_its_time_and_the_next_goal_is_served(
        ros, ended_in_order):
    ended_in_order.append(controller := Controller(ros))

    async def silent(request, response):
        await Future()  # for ever

    service = ros.node.create_service(
        PlanTrajectory, 'plan_trajectory', silent, callback_group=ReentrantCallbackGroup())
    start_motion_server(ros, controller_name='other', planning_timeout=0.1)
    client = MoveClient(ros)
    result = client.run(move_goal(TABLE_6_1[1]))[1]
    assert (result.error_code, result.message) == (
        Result.COMMUNICATION_FAILURE,
        'the planner (service /plan_trajectory) has not answered for 0.1 s')
    assert controller.goals == []
    ros.node.destroy_service(service)
    start_planner(ros)
    result = client.run(move_goal(TABLE_6_1[1]))[1]
    while result.error_code == Result.COMMUNICATION_FAILURE:  # the old one is still discovered
        result = client.run(move_goal(TABLE_6_1[1]))[1]
    assert result.error_code == Result.SUCCESS, result.message


def test_nothing_is_sent_to_an_arm_by_another_clock(ros):
    start_planner(ros)
    arm = Arm(ros, publish_clock=True)  # its own time, from 0
    start_motion_server(ros, discovery_timeout=3.0)
    arm.desired.wait_for()
    result = MoveClient(ros).run(move_goal(TABLE_6_1[1]))[1]
    assert (result.error_code, result.message) == (
        Result.COMMUNICATION_FAILURE, "not there: the arm's time (its states are stamped by "
        'another clock than this one; use_sim_time must be the same for controller and this node)')
    assert not any(moving(m) for m in arm.desired.messages[:])


def test_goals_that_come_while_one_is_planned_replace_it(ros, ended_in_order):
    ended_in_order.append(controller := Controller(ros))
    start_planner(ros)
    start_motion_server(ros, controller_name='other')
    client = MoveClient(ros)
    handles = [client.send(move_goal(TABLE_6_1[i % 3])) for i in range(6)]
    results = [client.result(handle)[1] for handle in handles]
    assert {(r.error_code, r.message) for r in results[:-1]} <= {
        (Result.PREEMPTED, 'replaced by a newer goal'), (Result.SUCCESS, '')}
    assert results[-1].error_code == Result.SUCCESS, results[-1].message
    assert 1 <= len(controller.goals) <= 6
