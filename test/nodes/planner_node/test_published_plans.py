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


"""What the planner publishes after it has answered: all of it, in order, whatever happens."""

from __future__ import annotations

from threading import Event

from helpers.plan_requests import NEAR, patient, plan_request
from nav_msgs.msg import Path
import pytest
from rcl_interfaces.msg import Log
from rcl_interfaces.srv import GetParameters
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.task import Future
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.nodes.planner_node import node as planner_node
from rrr_traj_planner.nodes.planner_node.node import TrajectoryPlanner
from rrr_traj_planner.nodes.planner_node.scheduler import FIRST_LEVEL
from rrr_traj_planner.planners import registration, registry
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from trajectory_msgs.msg import JointTrajectory
from visualization_msgs.msg import Marker, MarkerArray

# A bug in the planning thread would go unseen otherwise.
pytestmark = pytest.mark.filterwarnings(
    'error::pytest.PytestUnhandledThreadExceptionWarning')

DEADLINE = 20.0
CODES = PlanTrajectory.Response
REQUESTS = 12
ALL = QoSProfile(depth=2 * REQUESTS, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Gate:
    """Holds up calls of a function until it is opened."""

    def __init__(self, function):
        self._function = function
        self.reached, self.open = Event(), Event()

    def __call__(self, *arguments):
        self.reached.set()
        assert self.open.wait(DEADLINE)
        return self._function(*arguments)


@pytest.fixture
def drawing(ros, monkeypatch):
    """Return the gate before a path is made; it is opened before the node is closed."""
    gate = Gate(planner_node.tip_path)
    monkeypatch.setattr(planner_node, 'tip_path', gate)
    yield gate
    gate.open.set()


@pytest.fixture
def planner(ros):
    return ros.add(TrajectoryPlanner(context=ros.context, parameter_overrides=patient()))


class Topics:
    """What arrives on the topics of plans."""

    def __init__(self, ros):
        self.trajectory = ros.listen(JointTrajectory, 'planned_trajectory', ALL)
        self.path = ros.listen(Path, 'planned_path', ALL)
        self.markers = ros.listen(MarkerArray, 'markers', ALL)

    def wait_for(self, responses):
        """Assert that these plans arrive, one after the other, and no others."""
        expected = [r.trajectory for r in responses]
        for listener in (self.trajectory, self.path):
            listener.wait_for(since=len(expected) - 1)
        self.markers.wait_for(lambda _: len(self._lines()) == len(expected))
        assert self.trajectory.messages == expected
        lasts = [forward_kinematics(RobotModel(), t.points[-1].positions) for t in expected]
        for last, path, line in zip(lasts, self.path.messages, self._lines(), strict=True):
            for point in (path.poses[-1].pose.position, line.points[-1]):
                assert (point.x, point.y, point.z) == pytest.approx(last, abs=1e-12)

    def _lines(self):
        return [m for message in self.markers.messages for m in message.markers
                if m.ns == 'planned_path' and m.action == Marker.ADD]


class Client:
    """A client that does not wait between its requests."""

    def __init__(self, ros):
        self._node = ros.node
        self._client = ros.node.create_client(PlanTrajectory, 'plan_trajectory')
        assert self._client.wait_for_service(DEADLINE)

    def ask(self, *points, **fields):
        """Return the future answer, and an event that is set when it is there."""
        future, done = self._client.call_async(plan_request(*points, **fields)), Event()
        future.add_done_callback(lambda _: done.set())
        return future, done

    def leave(self):
        self._node.destroy_client(self._client)


def answered(pending):
    future, done = pending
    assert done.wait(DEADLINE)
    return future.result()


def to(height):
    """Return via points whose last one has this height."""
    return NEAR[0], (1.0, 0.6, height)


def is_responsive(ros):
    return ros.call(GetParameters, 'trajectory_planner/get_parameters',
                    GetParameters.Request(names=['sample_period'])).values[0].double_value == 0.01


def test_answer_comes_before_the_path_is_even_made(ros, planner, drawing):
    topics = Topics(ros)
    response = answered(Client(ros).ask())
    assert response.error_code == CODES.SUCCESS
    assert topics.trajectory.wait_for() == response.trajectory
    assert drawing.reached.wait(DEADLINE)
    assert not topics.path.messages
    assert is_responsive(ros)
    drawing.open.set()
    topics.wait_for([response])


def test_every_plan_of_many_is_published_in_order(ros, planner):
    topics, clients = Topics(ros), [Client(ros) for _ in range(2)]
    pending = [clients[i % 2].ask(to(1.0 + 0.01 * i)) for i in range(REQUESTS)]
    responses = [answered(a) for a in pending]
    assert {r.error_code for r in responses} == {CODES.SUCCESS}
    topics.trajectory.wait_for(since=REQUESTS - 1)
    # Which client's turn it is is not promised; the order of each one's short requests is.
    order = [[r.trajectory for r in responses].index(t) for t in topics.trajectory.messages]
    assert sorted(order) == list(range(REQUESTS))
    short = [i for i in order if responses[i].planning_time < FIRST_LEVEL]
    assert len(short) > REQUESTS // 2
    for client in range(2):
        own = [i for i in short if i % 2 == client]
        assert own == sorted(own)
    topics.wait_for([responses[i] for i in order])


def test_plan_of_a_client_that_has_left_is_published(ros, planner, monkeypatch):
    planning = Gate(registry.planner('cycloid').plan)
    monkeypatch.setitem(
        registration.REGISTERED, 'waiting', registration.Registered(planning, False))
    topics, client = Topics(ros), Client(ros)
    client.ask(planner_id='waiting')
    assert planning.reached.wait(DEADLINE)
    client.leave()
    planning.open.set()
    # The same request has the same answer.
    same = ros.call(PlanTrajectory, 'plan_trajectory', plan_request(planner_id='waiting'))
    topics.wait_for([same, same])


def test_plan_that_cannot_be_drawn_is_a_success_and_a_bug_in_the_log(ros, planner, monkeypatch):
    def broken(*_):
        raise RuntimeError('no path')

    topics, log = Topics(ros), ros.listen(Log, '/rosout', 100)
    with monkeypatch.context() as patch:
        patch.setattr(planner_node, 'tip_path', broken)
        first = answered(Client(ros).ask(to(1.0)))
        assert first.error_code == CODES.SUCCESS
        logged = log.wait_for(lambda m: 'a plan cannot be drawn' in m.msg)
    assert 'RuntimeError: no path' in logged.msg
    assert logged.level == Log.ERROR
    second = answered(Client(ros).ask(to(1.1)))
    topics.path.wait_for()
    assert topics.trajectory.messages == [first.trajectory, second.trajectory]
    assert len(topics.path.messages) == 1


def test_node_can_be_destroyed_while_a_path_is_made(ros, planner, drawing):
    assert answered(Client(ros).ask()).error_code == CODES.SUCCESS
    assert drawing.reached.wait(DEADLINE)
    ros.remove(planner)
    drawing.open.set()
    executor_continues(ros)


def test_node_can_be_destroyed_between_its_publications(ros, planner, monkeypatch):
    call = planner._pool.call

    def destroy_before_the_path(function, *arguments, **expected):
        if function is not planner_node._visualization:
            return call(function, *arguments, **expected)
        planner.destroy_node()
        done = Future()
        done.set_result((Path(), MarkerArray()))
        return done

    monkeypatch.setattr(planner._pool, 'call', destroy_before_the_path)
    topics = Topics(ros)
    response = answered(Client(ros).ask())
    assert topics.trajectory.wait_for() == response.trajectory
    executor_continues(ros)
    assert not topics.path.messages


def executor_continues(ros):
    ros.add(TrajectoryPlanner(context=ros.context, parameter_overrides=patient()))
    assert is_responsive(ros)
