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

"""A node of this package: answers clients that DDS discovered only partly, and ends in order."""

from __future__ import annotations

from functools import partial
from typing import Any
import warnings

from rclpy.node import Node
from rclpy.service import Service
from rrr_traj_planner.nodes.process.responses import send_until_discovered

DROPPED = 'failed to send response'  # beginning of rclpy's warning


class ServiceNode(Node):
    """
    A node that sends a response again until the client's reader has been discovered.

    Parameters
    ----------
    *args, **kwargs
        Arguments of `rclpy.node.Node`.

    """

    def finish(self) -> bool:
        """
        End what the node does for clients, before it is destroyed; the process ends.

        Called until it returns True, for `node_runner.FINISH_TIMEOUT` at most, and spun between.

        Returns
        -------
        bool
            Whether there is nothing to end, and no client left to be told.

        """
        return True

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
        service.send_response = partial(self._send, service)
        return service

    def _send(self, service: Service, response: Any, header: Any) -> None:
        """Send a response, again if it is dropped."""
        send_until_discovered(
            self, service.service_name, partial(_goes_out, service, response, header))


def _goes_out(service: Service, response: Any, header: Any) -> bool:
    """Send a response, and return whether it was not dropped; rclpy only warns."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.filterwarnings('always', DROPPED, RuntimeWarning)
        Service.send_response(service, response, header)
    return not any(str(warning.message).startswith(DROPPED) for warning in caught)
