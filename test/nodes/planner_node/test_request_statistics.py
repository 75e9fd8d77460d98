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

"""The node's diagnostics: what is counted, and how it is published."""

from __future__ import annotations

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from helpers.plan_requests import patient, plan_request, TABLE_6_3
import numpy as np
import pytest
from rrr_traj_planner.nodes.planner_node.node import TrajectoryPlanner
from rrr_traj_planner.nodes.planner_node.request_statistics import CODES, RequestStatistics, WINDOW
from rrr_traj_planner.planners import registration
from rrr_traj_planner_interfaces.srv import PlanTrajectory

RESPONSE = PlanTrajectory.Response


def answer(code=RESPONSE.SUCCESS, seconds=0.1, message=''):
    return PlanTrajectory.Response(error_code=code, planning_time=seconds, message=message)


def status(statistics, busy=0.0):
    message = statistics.message('planner', Time(sec=9), busy)
    assert message.header.stamp.sec == 9
    status, = message.status
    return status, {v.key: v.value for v in status.values}


def test_every_code_of_the_service_is_counted():
    assert set(CODES.values()) == {
        name for name in dir(RESPONSE)
        if name.isupper() and isinstance(getattr(RESPONSE, name), int)}


def test_statistics_without_requests():
    diagnostics, values = status(RequestStatistics())
    assert (diagnostics.level, diagnostics.name) == (
        DiagnosticStatus.OK, 'planner: plan_trajectory')
    assert diagnostics.message == '0 requests answered, 0 of them refused'
    assert values['requests'] == '0'
    assert values['planning time, percentile 50 [s]'] == 'nan'
    assert values['last error'] == values['last error at [s]'] == ''


def test_answers_are_counted_by_code():
    statistics = RequestStatistics()
    for code in (RESPONSE.SUCCESS, RESPONSE.NO_IK_SOLUTION, RESPONSE.NO_IK_SOLUTION):
        statistics.add(answer(code), Time())
    diagnostics, values = status(statistics, busy=1.5)
    assert diagnostics.level == DiagnosticStatus.OK
    assert diagnostics.message == '3 requests answered, 2 of them refused'
    assert (values['requests'], values['SUCCESS'], values['NO_IK_SOLUTION'],
            values['FAILURE'], values['busy for [s]']) == ('3', '1', '2', '0', '1.500')


def test_bug_is_an_error_from_then_on():
    statistics = RequestStatistics()
    for code in (RESPONSE.FAILURE, RESPONSE.SUCCESS):
        statistics.add(answer(code), Time())
    diagnostics, _ = status(statistics)
    assert diagnostics.level == DiagnosticStatus.ERROR
    assert diagnostics.message == (
        '2 requests answered, 0 of them refused; 1 failed because of a bug, see the log')


def test_last_error_stays_with_its_time():
    statistics = RequestStatistics()
    for k, (code, message) in enumerate((
            (RESPONSE.PLANNING_FAILED, 'first'), (RESPONSE.NO_IK_SOLUTION, 'second'),
            (RESPONSE.SUCCESS, 'a note'))):
        statistics.add(answer(code, message=message), Time(sec=k, nanosec=5))
    _, values = status(statistics)
    assert values['last error'] == 'NO_IK_SOLUTION: second'
    assert values['last error at [s]'] == '1.000000005'


def test_percentiles_are_of_the_last_requests_alone():
    statistics = RequestStatistics()
    for seconds in [*[1e6] * 10, *np.linspace(0.0, 1.0, WINDOW)]:
        statistics.add(answer(seconds=float(seconds)), Time())
    _, values = status(statistics)
    assert values['requests'] == str(WINDOW + 10)
    for percentile in (50, 90, 99):
        assert float(values[f'planning time, percentile {percentile} [s]']) == pytest.approx(
            percentile / 100.0, abs=1e-6)


# A running node


def made(ros, **overrides):
    return ros.add(TrajectoryPlanner(
        context=ros.context, parameter_overrides=patient(**overrides)))


def values_of(message):
    return {v.key: v.value for v in message.status[0].values}


def ask(ros, *points, **fields):
    return ros.call(PlanTrajectory, 'plan_trajectory', plan_request(*points, **fields))


def test_node_publishes_statistics_once_a_second(ros):
    made(ros)
    diagnostics = ros.listen(DiagnosticArray, 'diagnostics')
    assert ask(ros).error_code == RESPONSE.SUCCESS
    assert ask(ros, TABLE_6_3).error_code == RESPONSE.GOAL_CONSTRAINTS_VIOLATED
    message = diagnostics.wait_for(lambda m: values_of(m)['requests'] == '2')
    assert message.status[0].name == 'trajectory_planner: plan_trajectory'
    values = values_of(message)
    assert (values['SUCCESS'], values['GOAL_CONSTRAINTS_VIOLATED']) == ('1', '1')
    assert values['last error'].startswith('GOAL_CONSTRAINTS_VIOLATED: via point 2: joint_2')
    assert float(values['last error at [s]']) == pytest.approx(
        message.header.stamp.sec, abs=10.0)
    later = [diagnostics.wait_for_next() for _ in range(2)]
    gap = later[1].header.stamp.sec - later[0].header.stamp.sec + 1e-9 * (
        later[1].header.stamp.nanosec - later[0].header.stamp.nanosec)
    assert gap == pytest.approx(1.0, abs=0.5)


def test_bug_is_seen_in_the_diagnostics(ros, monkeypatch):
    def broken(task):
        raise RuntimeError('no idea')

    monkeypatch.setitem(registration.REGISTERED, 'broken', registration.Registered(broken, False))
    made(ros)
    diagnostics = ros.listen(DiagnosticArray, 'diagnostics')
    assert ask(ros, planner_id='broken').error_code == RESPONSE.FAILURE
    message = diagnostics.wait_for(lambda m: m.status[0].level == DiagnosticStatus.ERROR)
    assert values_of(message)['last error'] == 'FAILURE: internal error, RuntimeError: no idea'


def test_diagnostics_continue_while_simulated_time_is_paused(ros):
    made(ros, use_sim_time=True)
    diagnostics = ros.listen(DiagnosticArray, 'diagnostics')
    diagnostics.wait_for()
    assert diagnostics.wait_for_next().header.stamp.sec == 0
