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

"""The node `trajectory_planner` while it plans: it answers, waits, and can be closed."""

from __future__ import annotations

from threading import Event

from helpers.plan_requests import plan_request, stamps
from helpers.planner_in_ros import (
    parameter_value,
    plan,
    planning_threads,
    set_parameter,
    start_planner,
)
import pytest
from rrr_traj_planner.planners import registration, registry
from rrr_traj_planner_interfaces.srv import PlanTrajectory

DEADLINE = 20.0  # s
CODES = PlanTrajectory.Response

# A bug in the planning thread would go unseen otherwise.
pytestmark = pytest.mark.filterwarnings(
    'error::pytest.PytestUnhandledThreadExceptionWarning')


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


def test_node_answers_all_else_while_it_plans(ros, gate):
    start_planner(ros)
    future, done = call_async(ros, planner_id='waiting')
    assert gate.begun.wait(DEADLINE)
    assert parameter_value(ros).double_value == 0.01
    assert set_parameter(ros, 'sample_period', 0.02).successful
    assert not done.is_set()
    gate.open.set()
    assert done.wait(DEADLINE)
    assert future.result().error_code == CODES.SUCCESS
    # The parameters at the time of the request.
    assert stamps(future.result().trajectory)[1] == 10_000_000


def test_requests_behind_one_that_never_yields_are_all_answered(ros, gate):
    start_planner(ros)
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
    parameter_value(ros)
    assert order == []
    gate.open.set()
    assert finished.wait(DEADLINE)
    assert sorted(order) == ['', 'cycloid', 'magic', 'waiting']


def test_node_can_be_closed_while_it_plans(ros, gate):
    start_planner(ros)
    call_async(ros, planner_id='waiting')
    assert gate.begun.wait(DEADLINE)
    thread, = planning_threads()
    ros.close()  # fails if it hangs
    gate.open.set()
    thread.join(DEADLINE)
    assert not thread.is_alive()


def test_node_can_be_destroyed_while_others_spin(ros, gate):
    node = start_planner(ros)
    call_async(ros, planner_id='waiting')
    assert gate.begun.wait(DEADLINE)
    thread, = planning_threads()
    ros.remove(node)
    gate.open.set()
    thread.join(DEADLINE)
    assert not thread.is_alive()
    start_planner(ros)  # the executor continues
    assert plan(ros).error_code == CODES.SUCCESS


def test_idle_node_leaves_no_thread(ros):
    start_planner(ros)
    assert plan(ros).error_code == CODES.SUCCESS
    thread, = planning_threads()
    ros.close()
    thread.join(DEADLINE)
    assert not thread.is_alive()
