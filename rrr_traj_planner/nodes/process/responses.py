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
Responses to clients that DDS has discovered only partly.

A service is two DDS topics, discovered one by one: a request may arrive before the reader of its
response is known. rmw_fastrtps and rmw_cyclonedds then wait 0.1 s and drop the response
(github.com/ros2/rmw_fastrtps/issues/842). A dropped response may be sent again
(ros2/rmw_fastrtps, pull request 467).
"""

from __future__ import annotations

from collections.abc import Callable

from rclpy.clock import Clock, ClockType
from rclpy.node import Node

FIRST_WAIT = 0.1  # s until the response is sent again; each further wait is twice as long
MAX_WAIT = 6.4    # s, the last of seven waits, 12.7 s in all; Fast DDS announces itself every 3 s


def send_until_discovered(node: Node, service: str, send: Callable[[], bool],
                          wait: float = FIRST_WAIT) -> None:
    """
    Send a response; if it is dropped, send it again after a wait.

    Parameters
    ----------
    node : Node
        Waits with timers.
    service : str
        Name of the service, for the log.
    send : callable
        Sends the response, and returns whether it went out.
    wait : float
        Time until it is sent again [s].

    """
    if send() or not node.context.ok():
        return
    if wait > MAX_WAIT:
        node.get_logger().warning(
            f'a response of {service} is lost: its client has not been discovered')
        return

    def again() -> None:
        node.destroy_timer(timer)
        send_until_discovered(node, service, send, 2.0 * wait)

    timer = node.create_timer(wait, again, clock=Clock(clock_type=ClockType.STEADY_TIME))
