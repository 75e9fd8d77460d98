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

"""Records topics in a bag, each message as it was serialized."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from importlib import import_module
from time import time_ns
from typing import Any

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.nodes.output.latched import latched
from rrr_traj_planner.nodes.recording.bag import Bag
from rrr_traj_planner.nodes.recording.message_definitions import definition

QUEUE_DEPTH = 1000      # messages per topic; some seconds of the fastest one
DISCOVERY_PERIOD = 0.1  # s between two checks for new topics

VOLATILE, LATCHED = QoSProfile(depth=QUEUE_DEPTH), latched(QUEUE_DEPTH)


class Recorder:
    """
    Subscribes to topics on a node and writes their messages to a bag.

    Parameters
    ----------
    node : Node
        The node; an executor must spin it.
    bag : Bag
        The bag to write to.
    topics : iterable of (type, str)
        Message types and topic names; relative names are in the node's namespace.
    latched_topics : iterable of (type, str)
        The same for topics with transient local publishers.

    """

    def __init__(self, node: Node, bag: Bag, topics: Iterable[tuple[Any, str]],
                 latched_topics: Iterable[tuple[Any, str]] = ()) -> None:
        self._node, self._bag = node, bag
        self._subscriptions: list[Any] = []
        self._known: set[str] = set()  # topics that are recorded, or cannot be
        for some, qos in ((topics, VOLATILE), (latched_topics, LATCHED)):
            for kind, topic in some:
                self._subscribe(kind, topic, qos)

    def record_all(self) -> None:
        """Subscribe to every other topic that has a publisher, now or later."""
        self._discover()
        self._timer = self._node.create_timer(
            DISCOVERY_PERIOD, self._discover, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def _discover(self) -> None:
        """Subscribe to new topics, except hidden ones, as rosbag2 does."""
        for topic, types in self._node.get_topic_names_and_types():
            if topic in self._known or '/_' in topic:
                continue
            offered = [i.qos_profile for i in self._node.get_publishers_info_by_topic(topic)]
            if not offered:
                continue
            try:
                definition(types[0])
                self._subscribe(message_type(types[0]), topic, _compatible_qos(offered))
            except (ImportError, AttributeError, LookupError, OSError) as error:
                self._known.add(topic)
                self._node.get_logger().warning(
                    f'{topic} is not recorded, its type {types[0]} is not installed: {error}')

    def _subscribe(self, kind: Any, topic: str, qos: QoSProfile) -> None:
        self._known.add(self._node.resolve_topic_name(topic))
        self._subscriptions.append(self._node.create_subscription(
            kind, topic, self._writer_of(kind, topic), qos, raw=True))

    def is_connected(self) -> bool:
        """Return whether every publisher that the node has discovered is matched."""
        return all(s.get_publisher_count() >= self._node.count_publishers(s.topic_name)
                   for s in self._subscriptions)

    def _writer_of(self, kind: Any, topic: str) -> Callable[[bytes, Any], None]:
        """Return a subscription's callback."""
        name = self._node.resolve_topic_name(topic)

        def write(message: bytes, info: Any) -> None:
            if not self._bag.has(name):
                text = type_name(kind)
                self._bag.add_topic(name, text, definition(text), _offered_qos(self._node, name))
            now = time_ns()
            self._bag.write(name, message, info['received_timestamp'] or now,
                            info['source_timestamp'] or now)

        return write


def _compatible_qos(offered: Sequence[QoSProfile]) -> QoSProfile:
    """
    Return the strictest quality of service that is compatible with all publishers of a topic.

    Parameters
    ----------
    offered : sequence of QoSProfile
        The publishers' profiles.

    Returns
    -------
    QoSProfile
        Reliable if all publishers are, transient local if all are.

    """
    def all_are(name: str, value: Any) -> bool:
        return all(getattr(qos, name) == value for qos in offered)

    qos = QoSProfile(depth=QUEUE_DEPTH)
    if all_are('durability', DurabilityPolicy.TRANSIENT_LOCAL):
        qos.durability = DurabilityPolicy.TRANSIENT_LOCAL
    if not all_are('reliability', ReliabilityPolicy.RELIABLE):
        qos.reliability = ReliabilityPolicy.BEST_EFFORT
    return qos


def message_type(name: str) -> Any:
    """
    Return a message class.

    Parameters
    ----------
    name : str
        Full name, such as `sensor_msgs/msg/JointState`.

    Returns
    -------
    type
        The class.

    """
    package, folder, kind = name.split('/')
    return getattr(import_module(f'{package}.{folder}'), kind)


def type_name(kind: Any) -> str:
    """
    Return a message type's full name.

    Parameters
    ----------
    kind : type
        A message class.

    Returns
    -------
    str
        Such as `sensor_msgs/msg/JointState`.

    """
    package, folder, *_ = kind.__module__.split('.')
    return f'{package}/{folder}/{kind.__name__}'


def _offered_qos(node: Node, topic: str) -> str:
    """
    Return the quality of service that a topic's publishers offer, for playback of the bag.

    Parameters
    ----------
    node : Node
        A node that has discovered the publishers.
    topic : str
        Full name.

    Returns
    -------
    str
        In rosbag2's YAML form.

    """
    return '\n'.join(_qos_text(info.qos_profile)
                     for info in node.get_publishers_info_by_topic(topic))


def _qos_text(qos: QoSProfile) -> str:
    def duration(name: str, value: Duration) -> str:
        sec, nanosec = divmod(value.nanoseconds, SECOND)
        return f'  {name}:\n    sec: {sec}\n    nsec: {nanosec}'

    return '\n'.join((
        f'- history: {qos.history.short_key}', f'  depth: {qos.depth}',
        f'  reliability: {qos.reliability.short_key}',
        f'  durability: {qos.durability.short_key}',
        duration('deadline', qos.deadline), duration('lifespan', qos.lifespan),
        f'  liveliness: {qos.liveliness.short_key}',
        duration('liveliness_lease_duration', qos.liveliness_lease_duration),
        f'  avoid_ros_namespace_conventions: {str(qos.avoid_ros_namespace_conventions).lower()}'))
