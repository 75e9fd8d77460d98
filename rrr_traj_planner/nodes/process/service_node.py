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
A node whose services answer clients that it has not discovered wholly yet.

A service is two DDS topics, found one by one: a request may arrive before the reader of its answer
is known. rmw_fastrtps and rmw_cyclonedds then wait 0.1 s and drop the answer
(github.com/ros2/rmw_fastrtps/issues/842), of which rclpy tells by a warning only. What was dropped
may be sent again (ros2/rmw_fastrtps, pull request 467).
"""

from __future__ import annotations

from functools import partial
from typing import Any
import warnings

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.service import Service

DROPPED = 'failed to send response'  # how rclpy's warning begins

FIRST_WAIT = 0.1    # s until an answer is sent again; every further wait is twice as long,
LONGEST_WAIT = 6.4  # s, of eight: 12.7 s in all. Fast DDS announces itself again every 3 s


class ServiceNode(Node):
    """
    Sends an answer again as long as its client's reader is not discovered.

    Parameters
    ----------
    *args, **kwargs
        For `rclpy.node.Node`.

    """

    def create_service(self, *args: Any, **kwargs: Any) -> Service:
        """
        Create a service, as `Node` does; a node's parameters are served by this too.

        Parameters
        ----------
        *args, **kwargs
            For `Node.create_service`.

        Returns
        -------
        Service
            The service.

        """
        service = super().create_service(*args, **kwargs)
        service.send_response = partial(self._send, service, FIRST_WAIT)
        return service

    def _send(self, service: Service, wait: float, response: Any, header: Any) -> None:
        """Send an answer; if it is dropped, again after a while."""
        with warnings.catch_warnings(record=True) as told:
            warnings.filterwarnings('always', DROPPED, RuntimeWarning)
            Service.send_response(service, response, header)
        if not any(str(warning.message).startswith(DROPPED) for warning in told):
            return
        if wait > LONGEST_WAIT:
            self.get_logger().warning(
                f'an answer of {service.service_name} is lost: its client is not discovered')
            return

        def again() -> None:
            self.destroy_timer(timer)
            self._send(service, 2.0 * wait, response, header)

        timer = self.create_timer(wait, again, clock=Clock(clock_type=ClockType.STEADY_TIME))
