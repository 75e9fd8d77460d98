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

"""A signal to an arm that has a goal: the goal is aborted, its client told, the process ends."""

from __future__ import annotations

import signal

from helpers.arm_in_ros import moving, rest_to_rest, START
from helpers.goal_client import goal, GoalClient, waited_for
from helpers.scripts import Script, script
import pytest
from sensor_msgs.msg import JointState

ABORTED, INVALID_GOAL = 6, -1  # action_msgs/GoalStatus, FollowJointTrajectory.Result
TEXT = 'Current goal aborted: the arm shuts down.'
FAR = rest_to_rest(START + 0.4, 8.0)
END = 2.0  # s in which the process is to end

BOTH = pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])


@BOTH
def test_client_that_waits_for_the_result_gets_it(ros, number):
    with Script(script('simulated_arm')) as arm:
        client = GoalClient(ros)
        future = client.result_to_come(client.send(goal(FAR)))
        ros.listen(JointState, 'joint_states').wait_for(moving)
        arm.process.send_signal(number)
        assert arm.is_over_in(END)
        response = waited_for(future)
        code, _, errors = arm.ended()
    assert (response.status, response.result.error_code, response.result.error_string) == (
        ABORTED, INVALID_GOAL, TEXT)
    assert code == 0
    others = [line for line in errors.splitlines() if '[INFO]' not in line]
    assert len(others) == 1 and others[0].endswith(TEXT)


def test_client_that_asks_for_the_result_only_then_gets_it(ros):
    with Script(script('simulated_arm')) as arm:
        client = GoalClient(ros)
        handle = client.send(goal(FAR))
        arm.process.send_signal(signal.SIGTERM)
        arm.read_errors_until(TEXT)
        assert client.result(handle) == (ABORTED, INVALID_GOAL, TEXT)
        assert arm.is_over_in(END)
        assert arm.ended()[0] == 0


def test_client_that_never_asks_holds_nothing_up(ros):
    with Script(script('simulated_arm')) as arm:
        GoalClient(ros).send(goal(FAR))
        arm.process.send_signal(signal.SIGINT)
        assert arm.is_over_in(END)
        assert arm.ended()[0] == 0


def test_signal_to_bringup_aborts_the_goal_too(ros):
    with Script(script('bringup')) as bringup:
        client = GoalClient(ros)
        future = client.result_to_come(client.send(goal(FAR)))
        bringup.process.send_signal(signal.SIGTERM)
        assert waited_for(future).result.error_string == TEXT
        assert bringup.is_over_in(END)
        assert bringup.ended()[0] == 0
