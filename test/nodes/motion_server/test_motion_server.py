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

"""The motion server: one call that plans from where the arm is, and runs the plan."""

from __future__ import annotations

import signal

from helpers.arm_in_ros import Arm, at, GOAL, moving, NAMES, rest_to_rest, SECOND, stamp, START
from helpers.examples import example
from helpers.goal_client import waited_for
from helpers.motion_in_ros import assert_steady, random_places, RATE, SteppedClock
from helpers.move_client import move_goal, MoveClient, start_motion_server
from helpers.other_controller import OtherController
from helpers.places import DOCS
from helpers.plan_requests import TABLE_6_1
from helpers.planner_in_ros import start_planner
from helpers.scripts import python, Script, script
import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.nodes.arm_node.node import SimulatedArm
from rrr_traj_planner.nodes.motion_server.node import MotionServer
from rrr_traj_planner.nodes.planner_node.node import TrajectoryPlanner
from rrr_traj_planner_interfaces.action import MoveThrough
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectoryPoint

SUCCEEDED, CANCELED, ABORTED = 4, 5, 6  # action_msgs/GoalStatus
Result = MoveThrough.Result
REACHED = 1e-5   # m, of the tip: what computed torque leaves of the reference
DELAY = 0.1      # s, from sending a motion to its begin
LATE = 1.5       # s, of the first and last estimate of the time left, on a busy machine
TAKEOVERS = 12
FAR = TABLE_6_1[1]
MODEL = RobotModel()


@pytest.fixture
def arm(ros):
    """Give a test all three nodes; return the arm's."""
    start_planner(ros)
    start_motion_server(ros)
    return Arm(ros)


def tip(q):
    return forward_kinematics(MODEL, np.array(q))


def test_goal_s_fields_and_codes_are_the_service_s():
    request = PlanTrajectory.Request.get_fields_and_field_types()
    goal = MoveThrough.Goal.get_fields_and_field_types()
    assert {**goal, 'start_state': 'sensor_msgs/JointState',
            'start_acceleration': 'sequence<double>'} == request
    for name in dir(PlanTrajectory.Response):
        if name.isupper() and name != 'SLOT_TYPES':
            assert getattr(Result, name) == getattr(PlanTrajectory.Response, name)


def test_goal_moves_the_arm_from_where_it_is_through_every_point(ros, arm):
    feedback, client = [], MoveClient(ros)
    arm.desired.wait_for()  # discovered
    status, result = client.result(client.send(move_goal(*TABLE_6_1[1:]), feedback))
    assert (status, result.error_code, result.message) == (SUCCEEDED, Result.SUCCESS, '')
    start = result.trajectory.points[0].positions
    np.testing.assert_allclose(start, START, atol=1e-12)
    arm.desired.wait_for_next(lambda m: not moving(m))
    states = arm.desired.messages[:]  # more arrive
    times = 1e-9 * np.array([stamp(m) for m in states])
    moved = times[[moving(m) for m in states]]
    assert moved[-1] - moved[0] == pytest.approx(result.via_times[-1], abs=0.4)
    tips = tip([m.position for m in states])
    for place in TABLE_6_1[1:]:
        assert np.linalg.norm(tips - place, axis=1).min() < 0.005  # between two states
    arm.actual.wait_for_next(lambda m: np.linalg.norm(tip(m.position) - TABLE_6_1[2]) < REACHED)
    assert [f.next_via_point for f in feedback] == sorted(f.next_via_point for f in feedback)
    assert {f.next_via_point for f in feedback} == {0, 1}
    left = [f.time_left for f in feedback]
    assert left == sorted(left, reverse=True) and left[0] < result.via_times[-1] + 1e-9
    for f in feedback:  # both via points, then the last one
        left = np.array(result.via_times[f.next_via_point:]) - result.via_times[-1] + f.time_left
        np.testing.assert_allclose(f.via_times_left, left, atol=DELAY)
    assert all(f.joint_names == NAMES and np.abs(f.tracking_error).max() < 1e-3
               for f in feedback)


def test_without_a_controller_s_feedback_the_clock_tells_how_far_the_motion_is(ros):
    start_planner(ros)
    start_motion_server(ros, controller_name='/arm_controller')
    controller, client, feedback = OtherController(ros, '/arm_controller'), MoveClient(ros), []
    try:
        _, result = client.result(client.send(move_goal(*TABLE_6_1[1:]), feedback))
    finally:
        ros.run(controller.destroy)
    assert result.error_code == Result.SUCCESS
    left, duration = [f.time_left for f in feedback], result.via_times[-1]
    assert len(left) > 5 and left == sorted(left, reverse=True)
    assert left[0] == pytest.approx(duration, abs=LATE) and left[-1] < LATE
    for f in feedback:
        to_come = [t for t in result.via_times if t > duration - f.time_left] or [duration]
        np.testing.assert_allclose(
            f.via_times_left, np.array(to_come) - duration + f.time_left, atol=DELAY)
        assert (f.joint_names, len(f.tracking_error)) == ([], 0)


def test_new_goals_take_over_in_motion_without_a_step(ros):
    rng = np.random.default_rng(18)
    start_planner(ros)
    start_motion_server(ros, use_sim_time=True)
    arm, clock = Arm(ros, use_sim_time=True, publish_rate=RATE), SteppedClock(ros)
    client = MoveClient(ros)
    clock.advance(arm, 0.1)
    handle, in_motion = client.send(move_goal(FAR)), 0
    for _ in range(TAKEOVERS):
        places = random_places(rng, MODEL)
        following = client.send(move_goal(*places))
        status, result = client.result_while(handle, lambda: clock.advance(arm, 0.01))
        if status != SUCCEEDED:
            assert (status, result.error_code) == (ABORTED, Result.PREEMPTED)
            assert result.message == 'replaced by a newer goal'
            in_motion += 1
        clock.advance(arm, rng.uniform(0.0, 0.6))
        handle = following
    status, result = client.result_while(handle, lambda: clock.advance(arm, 0.05))
    assert (status, result.error_code) == (SUCCEEDED, Result.SUCCESS), result.message
    assert np.linalg.norm(tip(arm.actual.messages[-1].position) - places[-1]) < 1e-3
    assert_steady(arm.desired.messages[:])
    assert in_motion >= TAKEOVERS // 2


def test_refused_goal_leaves_the_motion_in_progress_alone(ros, arm):
    client = MoveClient(ros)
    running = client.send(move_goal(FAR))
    arm.desired.wait_for(moving)
    status, result = client.run(move_goal(TABLE_6_1[0], (9.0, 9.0, 9.0)))
    assert (status, result.error_code, result.failed_via_point) == (
        ABORTED, Result.NO_IK_SOLUTION, 1)
    assert result.message.startswith('via point 1: (9, 9, 9) m')
    status, result = client.run(move_goal(TABLE_6_1[0], planner_id='cycloid'))
    assert (status, result.error_code) == (ABORTED, Result.START_STATE_INVALID)
    assert 'cycloid' in result.message
    assert client.result(running)[1].error_code == Result.SUCCESS
    arm.actual.wait_for_next(lambda m: np.linalg.norm(tip(m.position) - FAR) < REACHED)


def test_malformed_goal_is_refused_with_the_planner_s_text(ros, arm):
    client = MoveClient(ros)
    for goal, code, text in (
            (MoveThrough.Goal(), Result.INVALID_GOAL_CONSTRAINTS, 'via point'),
            (move_goal(FAR, planner_id='fast'), Result.INVALID_GOAL_CONSTRAINTS, "'fast'"),
            (move_goal(FAR, stop_at=[False]), Result.INVALID_GOAL_CONSTRAINTS, 'stop_at'),
            (move_goal(FAR, segment_durations=[0.01]), Result.PLANNING_FAILED, ' s')):
        status, result = client.run(goal)
        assert (status, result.error_code) == (ABORTED, code), result.message
        assert text in result.message
        assert not result.trajectory.points
    assert not any(moving(m) for m in arm.desired.messages[:])


def test_joint_positions_stops_and_rests_are_planned_as_by_the_service(ros, arm):
    goal = MoveThrough.Goal(
        joint_via_points=[JointTrajectoryPoint(positions=list(q)) for q in (GOAL, START)],
        stop_at=[True, True], dwell=[0.2, 0.0])
    status, result = MoveClient(ros).run(goal)
    assert (status, result.error_code) == (SUCCEEDED, Result.SUCCESS), result.message
    resting = [m for m in arm.desired.messages[:] if at(GOAL, 1e-9)(m)]
    assert stamp(resting[-1]) - stamp(resting[0]) >= 0.19 * SECOND
    arm.actual.wait_for_next(at(START))


def test_canceled_goal_stops_the_arm(ros, arm):
    client = MoveClient(ros)
    handle = client.send(move_goal(FAR))
    arm.desired.wait_for(moving)
    assert client.cancel(handle) == 1
    status, result = client.result(handle)
    assert (status, result.error_code, result.message) == (CANCELED, Result.PREEMPTED, 'canceled')
    rest = arm.desired.wait_for_next(lambda m: not np.any(m.velocity))
    assert np.linalg.norm(tip(rest.position) - FAR) > 0.1
    status, result = client.run(move_goal(FAR))  # from where it stopped
    assert (status, result.error_code) == (SUCCEEDED, Result.SUCCESS), result.message


def test_goal_takes_over_from_somebody_else_s_motion(ros, arm):
    client = MoveClient(ros)
    arm.send(rest_to_rest(START + 0.4, 6.0))
    arm.desired.wait_for(moving)
    status, result = client.run(move_goal(FAR))
    assert (status, result.error_code) == (SUCCEEDED, Result.SUCCESS), result.message
    arm.actual.wait_for_next(lambda m: np.linalg.norm(tip(m.position) - FAR) < REACHED)


def test_controller_s_failure_is_told_with_its_code_and_text(ros):
    start_planner(ros)
    start_motion_server(ros)
    arm = Arm(ros, **{'constraints.joint_1.trajectory': 1e-3})
    client = MoveClient(ros)
    handle = client.send(move_goal(FAR))
    arm.desired.wait_for(moving)
    arm.disturb(joint_1=120.0)
    status, result = client.result(handle)
    assert (status, result.error_code, result.controller_error_code) == (
        ABORTED, Result.CONTROL_FAILED, -4)
    assert result.message.startswith(
        'the controller has aborted the trajectory (PATH_TOLERANCE_VIOLATED): Aborted due to path')


def test_what_is_missing_is_named(ros):
    start_motion_server(ros, controller_name='/a/controller', discovery_timeout=0.0)
    status, result = MoveClient(ros).run(move_goal(FAR))
    assert (status, result.error_code, result.message) == (
        ABORTED, Result.COMMUNICATION_FAILURE,
        'not there: the planner (service /plan_trajectory), the controller (action '
        "/a/controller/follow_joint_trajectory), the arm's state (topic "
        '/a/controller/controller_state or /joint_states)')


def test_controller_is_named_with_or_without_its_action(ros):
    for name in ('/a/controller/', '/a/controller/follow_joint_trajectory'):
        server = start_motion_server(ros, controller_name=name, discovery_timeout=0.0)
        result = MoveClient(ros).run(move_goal(FAR))[1]
        assert '(action /a/controller/follow_joint_trajectory)' in result.message
        ros.remove(server)
    with pytest.raises(InvalidInputError, match="^parameter controller_name is 'my arm', must be"):
        start_motion_server(ros, controller_name='my arm')


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_signal_stops_the_arm_and_aborts_the_goal(ros, number):
    start_planner(ros)
    arm = Arm(ros)
    with Script(script('motion_server')) as server:
        client = MoveClient(ros)
        handle = client.send(move_goal(FAR, max_velocity_scaling_factor=0.1))
        ended = client.result_to_come(handle)  # the server waits for those who ask late for 0.5 s
        arm.desired.wait_for(moving)
        server.process.send_signal(number)
        response = waited_for(ended)
        assert server.is_over_in(2.0)
        code, _, errors = server.ended()
    assert (response.status, response.result.error_code, response.result.message) == (
        ABORTED, Result.PREEMPTED, 'motion_server has ended')
    assert (code, 'Traceback' in errors) == (0, False)
    rest = arm.desired.wait_for_next(lambda m: not np.any(m.velocity))
    assert np.linalg.norm(tip(rest.position) - FAR) > 0.1


def test_two_arms_in_namespaces_move_by_themselves(ros):
    for namespace in ('left', 'right'):
        for node in (TrajectoryPlanner, SimulatedArm, MotionServer):
            ros.add(node(context=ros.context, namespace=namespace))
    left, right = (MoveClient(ros, f'{name}/move_through') for name in ('left', 'right'))
    canceled, reached = left.send(move_goal(FAR)), right.send(move_goal(TABLE_6_1[2]))
    ros.listen(JointState, 'left/joint_states').wait_for(moving)
    assert left.cancel(canceled) == 1
    assert left.result(canceled)[0] == CANCELED
    assert right.result(reached)[1].error_code == Result.SUCCESS
    ros.listen(JointState, 'right/joint_states').wait_for(
        lambda m: np.linalg.norm(tip(m.position) - TABLE_6_1[2]) < REACHED)


def test_example_of_the_documentation_moves_the_arm(ros):
    with Script(script('bringup')) as bringup, Script(
            python(example(DOCS / 'moving.md', 'MoveThrough'))) as client:
        code, output, errors = client.ended()
        bringup.started(3)
    assert (code, errors) == (0, '')
    assert output.endswith('s left\n1 \n')
