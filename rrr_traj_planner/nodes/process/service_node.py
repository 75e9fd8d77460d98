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
A node whose services also answer clients that DDS has discovered only partly.

A service is two DDS topics, discovered one by one: a request may arrive before the reader of its
response is known. rmw_fastrtps and rmw_cyclonedds then wait 0.1 s and drop the response
(github.com/ros2/rmw_fastrtps/issues/842); rclpy only warns. A dropped response may be sent again
(ros2/rmw_fastrtps, pull request 467).
"""

from __future__ import annotations

from functools import partial
from typing import Any
import warnings

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.service import Service

DROPPED = 'failed to send response'  # beginning of rclpy's warning

FIRST_WAIT = 0.1  # s until the response is sent again; each further wait is twice as long
MAX_WAIT = 6.4    # s, the last of seven waits, 12.7 s in all; Fast DDS announces itself every 3 s


class ServiceNode(Node):
    """
    A node that sends a response again until the client's reader has been discovered.

    Parameters
    ----------
    *args, **kwargs
        Arguments of `rclpy.node.Node`.

    """

    def create_service(self, *args: Any, **kwargs: Any) -> Service:
        """
        Create a service, as `Node` does; `Node` creates its parameter services by this too.

        Parameters
        ----------
        *args, **kwargs
            Arguments of `Node.create_service`.

        Returns
        -------
        Service
            The service.

        """
        service = super().create_service(*args, **kwargs)
        service.send_response = partial(self._send, service, FIRST_WAIT)
        return service

    def _send(self, service: Service, wait: float, response: Any, header: Any) -> None:
        """Send a response; if it is dropped, send it again after a wait."""
        with warnings.catch_warnings(record=True) as caught:
            warnings.filterwarnings('always', DROPPED, RuntimeWarning)
            Service.send_response(service, response, header)
        if not any(str(warning.message).startswith(DROPPED) for warning in caught):
            return
        if wait > MAX_WAIT:
            self.get_logger().warning(
                f'a response of {service.service_name} is lost: '
                'its client has not been discovered')
            return

        def again() -> None:
            self.destroy_timer(timer)
            self._send(service, 2.0 * wait, response, header)

        timer = self.create_timer(wait, again, clock=Clock(clock_type=ClockType.STEADY_TIME))
