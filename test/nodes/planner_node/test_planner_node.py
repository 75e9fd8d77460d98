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

"""The node `trajectory_planner`: busy and responsive, its parameters, what it publishes, bugs."""

from __future__ import annotations

from threading import enumerate as threads
from threading import Event

from helpers.own_limits import own_limits
from helpers.places import CONFIG
from helpers.plan_requests import (
    is_refused,
    NAMES,
    NEAR,
    patient,
    plan_request,
    points_of,
    stamps,
    TABLE_6_1,
    TABLE_6_3,
)
from nav_msgs.msg import Path
import numpy as np
import pytest
from rcl_interfaces.msg import Log, ParameterType, ParameterValue
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.srv import GetParameters, SetParameters
from rclpy.qos import DurabilityPolicy, QoSProfile
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import ConvergenceError, InvalidInputError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.nodes.planner_node.node import TrajectoryPlanner
from rrr_traj_planner.planners import registration, registry
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from trajectory_msgs.msg import JointTrajectory

DEADLINE = 20.0
CODES = PlanTrajectory.Response
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)

# A bug in the planning thread would go unseen otherwise.
pytestmark = pytest.mark.filterwarnings(
    'error::pytest.PytestUnhandledThreadExceptionWarning')


def made(ros, cli_args=None, **overrides):
    return ros.add(TrajectoryPlanner(
        context=ros.context, cli_args=cli_args, parameter_overrides=patient(**overrides)))


def plan(ros, *points, **fields):
    return ros.call(PlanTrajectory, 'plan_trajectory', plan_request(*points, **fields))


def ask_for(ros, name='sample_period'):
    return ros.call(GetParameters, 'trajectory_planner/get_parameters',
                    GetParameters.Request(names=[name])).values[0]


def set_to(ros, name, value):
    kind = ({'type': ParameterType.PARAMETER_STRING, 'string_value': value}
            if isinstance(value, str) else
            {'type': ParameterType.PARAMETER_DOUBLE, 'double_value': value})
    answer = ros.call(SetParameters, 'trajectory_planner/set_parameters', SetParameters.Request(
        parameters=[ParameterMessage(name=name, value=ParameterValue(**kind))]))
    return answer.results[0]


class Gate:
    """A planner that waits to be let go, then plans as `cycloid` does."""

    def __init__(self):
        self.begun, self.open = Event(), Event()

    def __call__(self, task):
        self.begun.set()
        assert self.open.wait(DEADLINE)
        return registry.planner('cycloid').plan(task)


@pytest.fixture
def gate(ros, monkeypatch):
    """Return the planner 'waiting'; it is let go before the node is closed."""
    gate = Gate()
    monkeypatch.setitem(registration.REGISTERED, 'waiting', registration.Registered(gate, False))
    try:
        yield gate
    finally:
        gate.open.set()


def call_async(ros, **fields):
    client = ros.node.create_client(PlanTrajectory, 'plan_trajectory')
    assert client.wait_for_service(DEADLINE)
    future, done = client.call_async(plan_request(**fields)), Event()
    future.add_done_callback(lambda _: done.set())
    return future, done


# While it plans


def test_node_answers_all_else_while_it_plans(ros, gate):
    made(ros)
    future, done = call_async(ros, planner_id='waiting')
    assert gate.begun.wait(DEADLINE)
    assert ask_for(ros).double_value == 0.01
    assert set_to(ros, 'sample_period', 0.02).successful
    assert not done.is_set()
    gate.open.set()
    assert done.wait(DEADLINE)
    assert future.result().error_code == CODES.SUCCESS
    # The parameters at the time of the request.
    assert stamps(future.result().trajectory)[1] == 10_000_000


def test_requests_that_wait_for_one_that_gives_no_turn_are_all_answered(ros, gate):
    made(ros)
    order = []
    client = ros.node.create_client(PlanTrajectory, 'plan_trajectory')
    assert client.wait_for_service(DEADLINE)
    finished = Event()
    for name in ('waiting', 'cycloid', 'magic', ''):
        def note(_, name=name):
            order.append(name)
            if len(order) == 4:
                finished.set()

        client.call_async(plan_request(planner_id=name)).add_done_callback(note)
    assert gate.begun.wait(DEADLINE)
    ask_for(ros)
    assert order == []
    gate.open.set()
    assert finished.wait(DEADLINE)
    assert sorted(order) == ['', 'cycloid', 'magic', 'waiting']


def planning_threads():
    return [thread for thread in threads() if thread.name == 'planning']


def test_node_can_be_closed_while_it_plans(ros, gate):
    made(ros)
    call_async(ros, planner_id='waiting')
    assert gate.begun.wait(DEADLINE)
    thread, = planning_threads()
    ros.close()  # fails if it hangs
    gate.open.set()
    thread.join(DEADLINE)
    assert not thread.is_alive()


def test_node_can_be_destroyed_while_others_spin(ros, gate):
    node = made(ros)
    call_async(ros, planner_id='waiting')
    assert gate.begun.wait(DEADLINE)
    thread, = planning_threads()
    ros.remove(node)
    gate.open.set()
    thread.join(DEADLINE)
    assert not thread.is_alive()
    made(ros)  # the executor continues
    assert plan(ros).error_code == CODES.SUCCESS


def test_idle_node_leaves_no_thread(ros):
    made(ros)
    assert plan(ros).error_code == CODES.SUCCESS
    thread, = planning_threads()
    ros.close()
    thread.join(DEADLINE)
    assert not thread.is_alive()


# Bugs


@pytest.mark.parametrize(('error', 'text'), [
    (RuntimeError('no idea'), 'internal error, RuntimeError: no idea'),
    (ConvergenceError('planner broken broke a limit'),
     'internal error, ConvergenceError: planner broken broke a limit'),
    (MemoryError(), 'internal error, MemoryError')])
def test_bug_is_reported_logged_and_survived(ros, monkeypatch, error, text):
    def broken(task):
        raise error

    monkeypatch.setitem(registration.REGISTERED, 'broken', registration.Registered(broken, False))
    log = ros.listen(Log, '/rosout', 100)
    made(ros)
    is_refused(plan(ros, planner_id='broken'), CODES.FAILURE, text)
    logged = log.wait_for(lambda m: text in m.msg)
    assert 'Traceback' in logged.msg
    assert 'in broken' in logged.msg
    assert plan(ros).error_code == CODES.SUCCESS


def test_answer_that_cannot_be_written_is_no_success(ros, monkeypatch):
    def broken(*_):
        raise RuntimeError('no message')

    monkeypatch.setattr('rrr_traj_planner.nodes.planner_node.node.success', broken)
    made(ros)
    published = ros.listen(JointTrajectory, 'planned_trajectory', LATCHED)
    is_refused(plan(ros), CODES.FAILURE, 'internal error, RuntimeError: no message')
    monkeypatch.undo()
    good = plan(ros)
    assert published.wait_for() == good.trajectory


def test_each_request_is_one_line_in_the_log(ros):
    log = ros.listen(Log, '/rosout', 100)
    made(ros)
    plan(ros)
    log.wait_for(lambda m: m.msg.startswith('cycloid planned 3 via points in ')
                 and m.msg.endswith(' ms: 2.850 s, 286 points'))
    plan(ros, TABLE_6_3)
    refused = log.wait_for(lambda m: m.msg.startswith('cycloid refused in '))
    assert refused.msg.endswith(
        ' ms (-14): via point 2: joint_2 needs 218.9 N m to hold, limit 200 N m')
    assert refused.level == Log.WARN


# Topics


def test_late_subscriber_gets_the_last_success(ros):
    made(ros)
    plan(ros)
    last = plan(ros, NEAR)
    plan(ros, TABLE_6_3)  # refused
    trajectory = ros.listen(JointTrajectory, 'planned_trajectory', LATCHED)
    path = ros.listen(Path, 'planned_path', LATCHED)
    assert trajectory.wait_for() == last.trajectory
    tip = [(p.pose.position.x, p.pose.position.y, p.pose.position.z)
           for p in path.wait_for().poses]
    np.testing.assert_allclose(tip, forward_kinematics(
        RobotModel(), points_of(last.trajectory).positions), atol=1e-12)
    header = path.messages[0].header
    assert header.frame_id == 'base_link'
    assert header.stamp.sec > 0
    assert all(p.header == header for p in path.messages[0].poses)
    assert all(p.pose.orientation.w == 1.0 for p in path.messages[0].poses)


def test_refusal_is_not_published(ros):
    made(ros)
    listeners = [ros.listen(JointTrajectory, 'planned_trajectory', LATCHED),
                 ros.listen(Path, 'planned_path', LATCHED)]
    first = plan(ros)
    for listener in listeners:
        listener.wait_for()
    plan(ros, TABLE_6_3)
    second = plan(ros, NEAR)
    listeners[1].wait_for(since=1)
    assert listeners[0].wait_for(since=1) == second.trajectory
    assert listeners[0].messages == [first.trajectory, second.trajectory]
    assert len(listeners[1].messages) == 2


# Parameters


def test_parameters_fill_what_a_request_leaves_out(ros):
    made(ros, sample_period=0.05, default_planner_id='cycloid_approach_a', base_frame='world',
         **own_limits('a', 'b', 'c'))
    response = plan(ros, frame='world')
    assert response.trajectory.header.frame_id == 'world'
    assert response.trajectory.joint_names == ['a', 'b', 'c']
    assert stamps(response.trajectory)[1] == 50_000_000
    assert response.via_times[-1] > 3.5  # cycloid takes 2.85 s
    asked = plan(ros, sample_period=0.02, planner_id='cycloid')
    assert stamps(asked.trajectory)[1] == 20_000_000
    assert asked.via_times[-1] < 2.9
    assert plan(ros, frame='base_link').error_code == CODES.FRAME_TRANSFORM_FAILURE


def test_max_deviation_reaches_the_request(ros, monkeypatch):
    seen = []

    def noting(model, limits, request):
        seen.append(request.max_deviation)
        raise InvalidInputError('seen')

    monkeypatch.setattr('rrr_traj_planner.nodes.planner_node.node.plan', noting)
    made(ros, max_deviation=0.2)
    plan(ros)
    plan(ros, max_deviation=0.01)
    assert seen == [0.2, 0.01]


def test_parameters_come_from_a_file(ros):
    file = CONFIG / 'thesis_arm_joint_2_250.yaml'
    made(ros, ['--ros-args', '--params-file', str(file)])
    response = plan(ros, TABLE_6_3)
    assert response.error_code == CODES.SUCCESS, response.message
    assert ask_for(ros, 'joint_limits.joint_2.max_effort').double_value == 250.0


def test_changed_limits_hold_from_the_next_request_on(ros):
    made(ros)
    assert plan(ros, TABLE_6_3).error_code == CODES.GOAL_CONSTRAINTS_VIOLATED
    assert set_to(ros, 'joint_limits.joint_2.max_effort', 250.0).successful
    assert plan(ros, TABLE_6_3).error_code == CODES.SUCCESS
    fast = plan(ros)
    assert set_to(ros, 'joint_limits.joint_2.max_velocity', 0.2).successful
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
    made(ros)
    before = plan(ros)
    result = set_to(ros, name, value)
    assert not result.successful
    assert text in result.reason
    assert plan(ros).trajectory == before.trajectory


@pytest.mark.parametrize(('name', 'value', 'text'), [
    ('default_planner_id', 'magic', r"'magic' is unknown, known are cycloid"),
    ('sample_period', 20.0, r'parameter sample_period is 20 s, must be in \[0.0001, 10\] s')])
def test_wrong_override_stops_the_node(ros, name, value, text):
    with pytest.raises(InvalidInputError, match=text):
        made(ros, **{name: value})
    assert planning_threads() == []


def test_a_limit_switched_off_does_not_bind(ros):
    made(ros, **{'joint_limits.joint_2.has_effort_limits': False})
    assert plan(ros, TABLE_6_3).error_code == CODES.SUCCESS


def test_planner_without_what_it_needs_says_so(ros):
    made(ros, **{f'joint_limits.{name}.has_acceleration_limits': False for name in NAMES})
    response = plan(ros, TABLE_6_1)
    assert response.error_code == CODES.INVALID_GOAL_CONSTRAINTS
    assert 'acceleration' in response.message
