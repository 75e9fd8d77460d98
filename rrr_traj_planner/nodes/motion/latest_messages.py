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

"""
A subscription whose messages are taken when they are needed.

States come at some hundred hertz. A callback for each would keep an idle node busy; the middleware
keeps the last ones anyway.
"""

from __future__ import annotations

from collections.abc import Iterator
from time import time_ns
from typing import Any

from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rrr_traj_planner.core.nanoseconds import SECOND


class _NotSpun(CallbackGroup):
    """Keeps entities from the executor."""

    def can_execute(self, _: Any) -> bool:
        return False

    def beginning_execution(self, _: Any) -> bool:
        return False

    def ending_execution(self, _: Any) -> None:
        pass


class LatestMessages:
    """
    The last messages of a topic: as many as quality of service "sensor data" keeps.

    Parameters
    ----------
    node : Node
        Subscribes the topic.
    message_type : type
        Of the messages.
    topic : str
        Its name.

    """

    def __init__(self, node: Node, message_type: Any, topic: str) -> None:
        self._group = _NotSpun()  # the subscription has a weak reference only
        self._subscription = node.create_subscription(
            message_type, topic, lambda _: None, qos_profile_sensor_data,
            callback_group=self._group)
        self.topic = node.resolve_topic_name(topic)

    def take(self) -> Iterator[tuple[Any, float]]:
        """
        Take what has come since the last time.

        Yields
        ------
        message : object
            Oldest first.
        age : float
            Time since it came [s].

        """
        subscription = self._subscription
        while True:
            with subscription.handle:
                taken = subscription.handle.take_message(subscription.msg_type, subscription.raw)
            if taken is None:
                return
            message, info = taken
            received = info['received_timestamp'] or time_ns()  # 0: not known
            yield message, (time_ns() - received) / SECOND
