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

"""The arm's action: every code and text, feedback, interruptions; and from another process."""

from __future__ import annotations

import re
import signal
from time import monotonic

from action_msgs.msg import GoalStatus, GoalStatusArray
from control_msgs.action import FollowJointTrajectory
from helpers.arm_in_ros import Arm, at, GOAL, moving, NAMES, rest_to_rest, SECOND, stamp, START
from helpers.examples import example
from helpers.goal_client import DEADLINE, goal, GoalClient
from helpers.places import DOCS
from helpers.scripts import python, Script, script
import numpy as np
import pytest
from rcl_interfaces.msg import Log
from rclpy.action import get_action_names_and_types
from rrr_traj_planner.core.control.goal_end import ResultCode
from rrr_traj_planner.nodes.arm_node.arm_action import FEEDBACK_RATE
from rrr_traj_planner.nodes.arm_node.node import SimulatedArm
from rrr_traj_planner.nodes.output.latched import latched
from rrr_traj_planner.nodes.output.message_times import nanoseconds
from std_srvs.srv import SetBool

SUCCEEDED, CANCELED, ABORTED, REFUSED = 4, 5, 6, 0  # action_msgs/GoalStatus; refused: unknown
OUTSIDE = (-1.0, *START[1:])
NEAR = START + 0.2 * (GOAL - START)
FAR = rest_to_rest(START + 0.4, 8.0)

# From another process: goals that are answered at once or within a short motion, and how.
ENDINGS = {
    'reached': (goal(rest_to_rest(NEAR, 0.3)), SUCCEEDED, 0, 'Goal successfully reached!'),
    'too few names': (goal(rest_to_rest(NEAR, 0.3), names=NAMES[:2]), REFUSED, -2,
                      "Joints on incoming trajectory don't match the controller joints."),
    'unknown name': (goal(rest_to_rest(NEAR, 0.3), names=('a', 'b', 'c')), REFUSED, -2,
                     "Incoming joint a doesn't match the controller's joints."),
    'over': (goal(rest_to_rest(NEAR, 0.5), stamp=5 * SECOND), REFUSED, -3,
             'Received trajectory with non-zero start time (5.000000) that ends in the past '
             '(5.500000)'),
    'empty': (goal(), REFUSED, -1, 'Empty trajectory received.'),
    'moving end': (goal((0.3, NEAR, (0.1, 0.0, 0.0))), REFUSED, -1,
                   'Velocity of last trajectory point of joint joint_1 is not zero: '
                   '0.100000000000000; a stream of points with velocities needs '
                   'allow_nonzero_velocity_at_trajectory_end: true'),
    'path': (goal(rest_to_rest(START, 0.4), path=[('joint_3', 1e-9)]), ABORTED, -4,
             'Aborted due to path tolerance violation: joint_3 Position Error'),
    'goal': (goal(rest_to_rest(NEAR, 0.4), end=[('joint_1', 0.0, 1e-12)], goal_time=0.01),
             ABORTED, -5, 'Aborted due to goal_time_tolerance exceeding by 0.01'),
    'too soon': (goal(rest_to_rest(NEAR + 0.2, 0.2)), REFUSED, -1,
                 'The first point cannot be reached in time, it is due in 0.200 s: joint_1 '
                 'reaches 1.'),
    'elsewhere': (goal((0.0, NEAR + 0.02), rest_to_rest(NEAR + 0.2, 2.0)), REFUSED, -1,
                  'joint_1 is commanded '),
    'out of range': (goal(rest_to_rest(OUTSIDE, 0.3)), REFUSED, -1,
                     'the trajectory would end with joint_1 at -1 rad, range [0, 1.5708] rad'),
    'slowly out of range': (goal(rest_to_rest(OUTSIDE, 9.0)), REFUSED, -1,
                            'the trajectory would end with joint_1 at -1 rad, range [0, 1.5708]'),
    'in degrees': (goal(rest_to_rest((30.0, 54.0, 14.0), 9.0)), REFUSED, -1,
                   'the trajectory would end with joint_1 at 30 rad, range [0, 1.5708] rad (in '
                   'degrees?)'),
    'wrong tolerance': (goal(rest_to_rest(NEAR, 0.3), path=[('joint_9', 1e-9)]), SUCCEEDED, 0,
                        'Goal successfully reached!')}


def test_every_way_to_end_is_seen_from_another_process(ros):
    log = ros.listen(Log, '/rosout', 1000)
    with Script(script('simulated_arm')) as arm:
        client = GoalClient(ros)
        assert ('/simulated_arm/follow_joint_trajectory',
                ['control_msgs/action/FollowJointTrajectory']) in get_action_names_and_types(
                    ros.node)
        for message, status, code, text in ENDINGS.values():
            handle = client.send(message)
            assert handle.accepted is (status != REFUSED)
            found = client.result(handle)
            assert found[:2] == (status, code) and found[2].startswith(text)
            if status == REFUSED:
                log.wait_for(lambda m, text=text: m.msg.startswith(text) and m.level == 40)
        log.wait_for(lambda m: m.msg == (
            "joint 'joint_9' specified in goal.path_tolerance does not exist. Using default "
            'tolerances.'))
        first, second = client.send(goal(FAR)), client.send(goal(FAR))
        assert client.result(first) == (
            ABORTED, -1, 'Current goal preempted by new incoming action.')
        assert client.cancel(second) == 1
        assert client.result(second) == (CANCELED, 0, '')
        assert client.cancel(second) == 0  # it has ended
        arm.process.send_signal(signal.SIGTERM)
        assert arm.ended()[0] == 0


def test_codes_are_those_of_the_message():
    assert {code.name: code.value for code in ResultCode} == {
        name: getattr(FollowJointTrajectory.Result, name) for name in (
            'SUCCESSFUL', 'INVALID_GOAL', 'INVALID_JOINTS', 'OLD_HEADER_TIMESTAMP',
            'PATH_TOLERANCE_VIOLATED', 'GOAL_TOLERANCE_VIOLATED')}


def test_example_of_the_documentation_moves_the_arm():
    code = example(DOCS / 'arm.md', 'ActionClient')
    with Script(script('simulated_arm')), Script(python(code)) as client:
        assert client.ended() == (0, 'True 0 Goal successfully reached!\n', '')


def test_feedback_has_reference_and_measurement_of_the_goal(ros):
    feedback = ros.listen(FollowJointTrajectory.Impl.FeedbackMessage,
                          'simulated_arm/follow_joint_trajectory/_action/feedback')
    arm, client = Arm(ros), GoalClient(ros)
    begun = monotonic()
    handle = client.send(goal(FAR))
    feedback.wait_for(lambda _: len(feedback.messages) >= 5)
    assert client.cancel(handle) == 1
    taken = monotonic() - begun
    assert len(feedback.messages) <= taken * FEEDBACK_RATE + 1
    arm.desired.wait_for(lambda m: stamp(m) > nanoseconds(
        feedback.messages[-1].feedback.header.stamp))
    states = {stamp(m): m for m in arm.desired.messages}
    starts = set()
    for message in feedback.messages:
        m = message.feedback
        assert message.goal_id == handle.goal_id and m.joint_names == NAMES
        np.testing.assert_array_equal(
            m.error.positions, np.subtract(m.desired.positions, m.actual.positions))
        np.testing.assert_array_equal(
            m.error.velocities, np.subtract(m.desired.velocities, m.actual.velocities))
        now = nanoseconds(m.header.stamp)
        starts |= {now - nanoseconds(p.time_from_start) for p in (m.desired, m.actual)}
        if now in states:
            np.testing.assert_array_equal(m.desired.positions, states[now].position)
            np.testing.assert_array_equal(m.desired.velocities, states[now].velocity)
    assert len(starts) == 1  # of the trajectory


def test_canceled_goal_stops_short_of_it_and_holds(ros):
    arm, client = Arm(ros), GoalClient(ros)
    handle = client.send(goal(FAR))
    arm.desired.wait_for(moving)
    assert client.cancel(handle) == 1
    assert client.result(handle) == (CANCELED, 0, '')
    rest = arm.desired.wait_for_next(lambda m: not np.any(m.velocity))
    assert np.abs(np.subtract(rest.position, START)).max() < 0.3
    arm.actual.wait_for_next(at(rest.position))


@pytest.mark.parametrize(('service', 'text'), [
    ('hold', 'Current goal aborted: the arm is told to hold its position.'),
    ('reset', 'Current goal aborted: the arm is reset.')])
def test_service_that_stops_the_arm_aborts_its_goal(ros, service, text):
    arm, client = Arm(ros), GoalClient(ros)
    handle = client.send(goal(FAR))
    assert arm.trigger(service).success
    assert client.result(handle) == (ABORTED, -1, text)
    assert client.run(goal(rest_to_rest(START, 0.2)))[:2] == (SUCCEEDED, 0)


def test_topic_replaces_the_motion_of_a_goal_which_goes_on(ros):
    arm, client = Arm(ros), GoalClient(ros)
    handle = client.send(goal(FAR))
    arm.desired.wait_for(moving)
    arm.send(rest_to_rest(START, 1.0), names=NAMES[:2])  # refused: changes nothing
    assert not client.send(goal(FAR, names=NAMES[:2])).accepted
    arm.send(rest_to_rest(START, 1.0))
    assert client.result(handle) == (SUCCEEDED, 0, 'Goal successfully reached!')
    arm.actual.wait_for_next(at(START))


def test_goal_that_cannot_begin_in_time_leaves_the_running_one_alone(ros):
    arm, client = Arm(ros), GoalClient(ros)
    running = client.send(goal(rest_to_rest(NEAR, 1.5)))
    arm.desired.wait_for(moving)
    refused = client.send(goal(rest_to_rest(START + 0.3, 0.1), rest_to_rest(START + 0.31, 2.0)))
    assert not refused.accepted
    assert client.result(refused)[1] == ResultCode.INVALID_GOAL
    assert client.result(running)[:2] == (SUCCEEDED, 0)
    arm.actual.wait_for(at(NEAR))


def test_goal_that_was_under_way_is_joined_later_and_the_log_says_so(ros):
    log = ros.listen(Log, '/rosout', latched(100))
    arm, client = Arm(ros), GoalClient(ros)
    q = [START + 0.02 + x for x in np.linspace(0.0, 0.1, 11)]
    points = [(t, x) for t, x in zip(np.linspace(0.1, 2.1, 11), q)]
    late = goal(*points, rest_to_rest(q[-1], 2.4), stamp=arm.now() - SECOND // 5)
    assert client.run(late)[:2] == (SUCCEEDED, 0)
    text = log.wait_for(lambda m: 'missed' in m.msg and m.level == 30).msg
    assert re.fullmatch(r'[1-9] points? (is|are) missed: point \d+ of 12 is the first that can be '
                        'reached in time', text)


def test_goal_s_own_tolerances_come_before_the_parameters(ros):
    arm = Arm(ros, **{'constraints.joint_1.trajectory': 1e-9, 'constraints.goal_time': 1e-3})
    client = GoalClient(ros)
    assert client.run(goal(rest_to_rest(NEAR, 0.3)))[:2] == (ABORTED, -4)
    erased = goal(rest_to_rest(START, 0.3), path=[('joint_1', -1.0)], goal_time=-1.0)
    assert client.run(erased)[:2] == (SUCCEEDED, 0)
    arm.actual.wait_for(at(START))


def test_arm_that_ends_aborts_its_goal(ros):
    arm, client = Arm(ros), GoalClient(ros)
    status = ros.listen(GoalStatusArray, 'simulated_arm/follow_joint_trajectory/_action/status')
    client.send(goal(FAR))
    status.wait_for(lambda m: m.status_list[-1].status == GoalStatus.STATUS_EXECUTING)
    ros.remove(arm.node)
    status.wait_for(lambda m: m.status_list[-1].status == ABORTED)


def test_goal_is_pursued_in_the_arm_s_own_time(ros):
    """As fast as the arm can, and not at all while its time is paused."""
    arm = Arm(ros, publish_clock=True, real_time_factor=0.0)
    client = GoalClient(ros)
    longer_than_the_deadline = goal(rest_to_rest(START + 0.4, 2.0 * DEADLINE))
    assert client.run(longer_than_the_deadline)[:2] == (SUCCEEDED, 0)
    assert ros.call(SetBool, 'simulated_arm/pause', SetBool.Request(data=True)).success
    handle = client.send(goal(rest_to_rest(START, 2.0)))
    assert client.cancel(handle) == 1
    assert client.result(handle)[0] == CANCELED
    assert ros.call(SetBool, 'simulated_arm/pause', SetBool.Request(data=False)).success
    arm.actual.wait_for_next(at(START + 0.4))  # it had not moved


def test_two_arms_in_namespaces_have_goals_of_their_own(ros):
    for namespace in ('left', 'right'):
        ros.add(SimulatedArm(context=ros.context, namespace=namespace))
    left, right = (GoalClient(ros, f'{name}/simulated_arm/follow_joint_trajectory')
                   for name in ('left', 'right'))
    canceled, reached = left.send(goal(FAR)), right.send(goal(rest_to_rest(NEAR, 0.3)))
    assert left.cancel(canceled) == 1
    assert left.result(canceled)[0] == CANCELED
    assert right.result(reached)[:2] == (SUCCEEDED, 0)
