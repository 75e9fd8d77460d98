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

"""An action server whose goals are ended from outside: results, refusals, faults."""

from __future__ import annotations

from collections import Counter

from action_msgs.msg import GoalStatus
from action_msgs.srv import CancelGoal
from control_msgs.action import FollowJointTrajectory
from helpers.goal_client import GoalClient, waited_for
import pytest
from rcl_interfaces.msg import Log
from rclpy.node import Node
from rrr_traj_planner.nodes.output.latched import latched
from rrr_traj_planner.nodes.process import goal_server
from rrr_traj_planner.nodes.process.goal_server import (
    ABORTED,
    GoalServer,
    REFUSALS,
    RefusedGoal,
    SUCCEEDED,
)

Goal, Result = FollowJointTrajectory.Goal, FollowJointTrajectory.Result
DROPS = 2


class Served(Node):
    """A node with an action that does what a goal's `goal_time_tolerance` says, and a client."""

    REFUSE, FAIL_CHECK, FAIL_BEGIN, FAIL_CANCEL, GO_ON, SUCCEED = range(6)

    def __init__(self, ros):
        super().__init__('server', context=ros.context)
        self.begun = []
        self.server = GoalServer(self, FollowJointTrajectory, '~/act', self._check, self._begin,
                                 self._cancel)
        ros.add(self)
        self.client = GoalClient(ros, 'server/act')

    def destroy_node(self):
        self.server.destroy()
        super().destroy_node()

    def send(self, what, number=0):
        message = Goal()
        message.goal_time_tolerance.sec, message.goal_time_tolerance.nanosec = what, number
        return self.client.send(message)

    def _check(self, goal):
        what = goal.goal_time_tolerance.sec
        if what == self.REFUSE:
            raise RefusedGoal(Result(error_code=-goal.goal_time_tolerance.nanosec))
        if what == self.FAIL_CHECK:
            raise KeyError('check')
        return what

    def _begin(self, handle, what):
        self.begun.append((handle, what))
        if what == self.FAIL_BEGIN:
            raise KeyError('begin')
        if what == self.SUCCEED:
            self.server.end(handle, SUCCEEDED, Result(error_string='done'))

    def _cancel(self, handle):
        if handle is self.begun[-1][0] and self.begun[-1][1] == self.FAIL_CANCEL:
            raise KeyError('cancel')
        return Result(error_string='canceled')


def test_result_is_told_to_who_asks_before_and_after_the_end(ros):
    served = Served(ros)
    handle = served.send(Served.GO_ON)
    early = served.client.result_to_come(handle)
    assert served.client.cancel(handle) == 1
    late = served.client.result_to_come(handle)
    for future in (early, late):
        response = waited_for(future)
        assert (response.status, response.result.error_string) == (
            GoalStatus.STATUS_CANCELED, 'canceled')
    assert served.client.result(served.send(Served.SUCCEED)) == (
        GoalStatus.STATUS_SUCCEEDED, 0, 'done')
    assert served.begun[0][0].request is None  # which may be long


def test_refused_goal_s_result_is_told_until_there_are_many_later_ones(ros):
    served = Served(ros)
    handles = [served.send(Served.REFUSE, number) for number in range(1, REFUSALS + 2)]
    assert not any(handle.accepted for handle in handles)
    assert served.client.result(handles[0]) == (GoalStatus.STATUS_UNKNOWN, 0, '')
    assert served.client.result(handles[1]) == (GoalStatus.STATUS_UNKNOWN, -2, '')
    assert served.client.result(handles[-1]) == (GoalStatus.STATUS_UNKNOWN, -REFUSALS - 1, '')


def test_result_is_forgotten_after_a_while(ros, monkeypatch):
    monkeypatch.setattr(goal_server, 'RESULT_TIMEOUT', 0)
    served = Served(ros)
    handles = [served.send(Served.SUCCEED) for _ in range(2)]
    assert all(handle.accepted for handle in handles)
    assert served.client.result(handles[0]) == (GoalStatus.STATUS_UNKNOWN, 0, '')


def test_goal_of_the_same_id_is_refused_while_the_first_is_known(ros):
    served = Served(ros)
    first = served.send(Served.GO_ON)
    assert not served.client.send(Goal(), goal_id=first.goal_id).accepted
    assert served.client.cancel(first) == 1


def test_all_goals_are_canceled_at_once(ros):
    served = Served(ros)
    handles = [served.send(Served.GO_ON) for _ in range(3)]
    answer = ros.call(CancelGoal, 'server/act/_action/cancel_goal')  # of no id: all
    assert len(answer.goals_canceling) == 3
    assert [served.client.result(handle)[0] for handle in handles] == [
        GoalStatus.STATUS_CANCELED] * 3


@pytest.mark.parametrize(('what', 'text', 'status'), [
    (Served.FAIL_CHECK, 'check', GoalStatus.STATUS_UNKNOWN),
    (Served.FAIL_BEGIN, 'begin', GoalStatus.STATUS_ABORTED),
    (Served.FAIL_CANCEL, 'cancel', GoalStatus.STATUS_CANCELED)])
def test_a_fault_is_logged_and_ends_the_goal_alone(ros, what, text, status):
    log = ros.listen(Log, '/rosout', latched(100))
    served = Served(ros)
    handle = served.send(what)
    assert handle.accepted is (what != Served.FAIL_CHECK)
    if what == Served.FAIL_CANCEL:
        assert served.client.cancel(handle) == 1
    assert served.client.result(handle) == (status, 0, '')
    log.wait_for(lambda m: f"KeyError: '{text}'" in m.msg and m.level == 40)
    assert served.client.result(served.send(Served.SUCCEED))[2] == 'done'


def test_response_that_is_dropped_is_sent_again(ros, monkeypatch):
    goes_out, dropped = goal_server._goes_out, Counter()

    def drop_at_first(send, header, response):
        if dropped[type(response)] == DROPS:
            return goes_out(send, header, response)
        dropped[type(response)] += 1
        return False

    monkeypatch.setattr(goal_server, '_goes_out', drop_at_first)
    served = Served(ros)
    handle = served.send(Served.GO_ON)
    assert served.client.cancel(handle) == 1
    assert served.client.result(handle)[2] == 'canceled'
    assert list(dropped.values()) == [DROPS] * 3


def test_goal_that_is_aborted_from_outside_is_told(ros):
    served = Served(ros)
    handle = served.send(Served.GO_ON)
    future = served.client.result_to_come(handle)
    served.create_timer(0.01, lambda: served.begun and served.server.end(
        served.begun.pop()[0], ABORTED, Result(error_string='over')))
    assert waited_for(future).result.error_string == 'over'
