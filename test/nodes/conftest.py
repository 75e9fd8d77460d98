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

"""ROS for tests: a context, a domain and a spinning executor for each of them."""

from __future__ import annotations

import os
from threading import Condition, Event, Thread

import pytest
import rclpy
from rclpy.action import ActionClient
from rclpy.context import Context
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

# Nothing here takes so long [s]; what waits longer has failed.
DEADLINE = 20.0


class Listener:
    """What arrives on a topic, to be waited for."""

    def __init__(self, node, message_type, topic, qos=10):
        self.messages = []
        self._arrived = Condition()
        node.create_subscription(message_type, topic, self._take, qos)

    def _take(self, message):
        with self._arrived:
            self.messages.append(message)
            self._arrived.notify_all()

    def wait_for(self, fits=lambda message: True, since=0):
        """Return the first message from an index on that fits; fail at the deadline."""
        def found():
            return next((m for m in self.messages[since:] if fits(m)), None)

        with self._arrived:
            assert self._arrived.wait_for(lambda: found() is not None, DEADLINE), (
                f'no message fits among {len(self.messages)} messages, '
                f'last {self.messages[-1:]}')
            return found()

    def wait_for_next(self, fits=lambda message: True):
        """Return the first fitting message that arrives from now on."""
        return self.wait_for(fits, len(self.messages))


class Ros:
    """A context of its own, an executor that spins in the background, a node to test with."""

    def __init__(self):
        self.context = Context()
        rclpy.init(context=self.context, domain_id=int(os.environ['ROS_DOMAIN_ID']))
        self._executor = SingleThreadedExecutor(context=self.context)
        self._nodes, self._action_clients = [], []
        self._closing = Event()
        self._thread = Thread(target=self._spin, daemon=True)
        self.node = self.add(Node('tester', context=self.context))
        self._thread.start()

    def add(self, node):
        """Spin a node until the test is over."""
        self._nodes.append(node)
        self._executor.add_node(node)
        return node

    def remove(self, node):
        """End a node early, in the thread that spins: which would find it half destroyed."""
        removed = Event()

        def remove_here():
            self._executor.remove_node(node)
            node.destroy_node()
            removed.set()

        self._nodes.remove(node)
        self._executor.create_task(remove_here)
        assert removed.wait(DEADLINE)

    def run(self, function, *args):
        """
        Return what a function returns in the thread that spins.

        rclpy's action clients are for that thread: to others an answer may come unexpected.
        """
        done, task = Event(), self._executor.create_task(function, *args)
        task.add_done_callback(lambda _: done.set())
        assert done.wait(DEADLINE)
        return task.result()

    def listen(self, message_type, topic, qos=10):
        """Return a listener to a topic."""
        return Listener(self.node, message_type, topic, qos)

    def publisher(self, message_type, topic, qos=10):
        """Return a publisher that somebody listens to."""
        matched, count = Condition(), []

        def on_match(status):
            with matched:
                count.append(status.current_count)
                matched.notify_all()

        publisher = self.node.create_publisher(
            message_type, topic, qos, event_callbacks=PublisherEventCallbacks(matched=on_match))
        with matched:
            assert matched.wait_for(lambda: count and count[-1] > 0, DEADLINE), f'no {topic}'
        return publisher

    def call(self, service_type, name, request=None):
        """Return a service's answer."""
        client = self.node.create_client(service_type, name)
        try:
            assert client.wait_for_service(DEADLINE), f'no service {name}'
            return client.call(request or service_type.Request(), timeout_sec=DEADLINE)
        finally:
            self.node.destroy_client(client)

    def action_client(self, action_type, name):
        """Return a client of an action that is there."""
        client = ActionClient(self.node, action_type, name)
        self._action_clients.append(client)  # it would keep the node alive
        assert client.wait_for_server(DEADLINE), f'no action {name}'
        return client

    def close(self):
        """End everything, in the order that leaves nothing behind."""
        # Not shut down while it spins: callbacks that are ready then would find it half destroyed.
        self._closing.set()
        if self._thread.is_alive():
            self._executor.create_task(lambda: None)  # wakes it
        self._thread.join(DEADLINE)
        self._executor.shutdown(timeout_sec=DEADLINE)
        while self._action_clients:
            self._action_clients.pop().destroy()
        while self._nodes:
            self._nodes.pop().destroy_node()
        self.context.try_shutdown()
        assert not self._thread.is_alive()

    def _spin(self):
        while not self._closing.is_set():
            self._executor.spin_once()


@pytest.fixture
def ros():
    """Give a test its own ROS."""
    yield from closed_after_use(Ros())


@pytest.fixture
def other_ros():
    """Give a test a second one, whose callbacks may wait for what the first one's do."""
    yield from closed_after_use(Ros())


@pytest.fixture(scope='module')
def module_ros():
    """Give the tests of a module one ROS context in common."""
    yield from closed_after_use(Ros())


def closed_after_use(ros):
    try:
        yield ros
    finally:
        ros.close()
