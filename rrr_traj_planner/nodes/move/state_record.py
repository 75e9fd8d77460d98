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

"""The states of an arm, kept to be compared with its plan."""

from __future__ import annotations

from collections.abc import Sequence

from control_msgs.msg import JointTrajectoryControllerState
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rrr_traj_planner.nodes.output.message_times import nanoseconds
from sensor_msgs.msg import JointState

# Matches every publisher; some tenths of a second of a fast one may wait.
QOS = QoSProfile(depth=200, reliability=ReliabilityPolicy.BEST_EFFORT)


class StateRecord:
    """
    Keeps the arm's measured states, from `joint_states` or, without it, from its controller.

    Parameters
    ----------
    node : Node
        Subscribes both topics.
    controller : str
        The controller's name.

    """

    def __init__(self, node: Node, controller: str) -> None:
        self._measured: list[JointState] = []
        self._of_controller: list[JointState] = []
        self._begun = False
        node.create_subscription(JointState, 'joint_states', self._take, QOS)
        node.create_subscription(
            JointTrajectoryControllerState, f'{controller}/controller_state',
            self._take_of_controller, QOS)

    def begin(self) -> None:
        """Keep states from now on, and forget those before."""
        self._begun = True
        self._measured.clear()
        self._of_controller.clear()

    def states(self, joint_names: Sequence[str]) -> list[JointState]:
        """
        Return the states that have all joints of an arm.

        Parameters
        ----------
        joint_names : sequence of str
            The joints.

        Returns
        -------
        list of JointState
            In the order in which they have arrived.

        """
        names = set(joint_names)
        return ([s for s in list(self._measured) if names <= set(s.name)]
                or [s for s in list(self._of_controller) if names <= set(s.name)])

    def has_since(self, stamp: int) -> bool:
        """
        Return whether there is a state of a time or later.

        Parameters
        ----------
        stamp : int
            The time [ns].

        Returns
        -------
        bool
            Whether one has arrived.

        """
        latest = self._measured[-1:] or self._of_controller[-1:]
        return bool(latest) and nanoseconds(latest[0].header.stamp) >= stamp

    def _take(self, message: JointState) -> None:
        if self._begun:
            self._measured.append(message)

    def _take_of_controller(self, message: JointTrajectoryControllerState) -> None:
        """Keep what a controller has measured."""
        if self._begun:
            self._of_controller.append(JointState(
                header=message.header, name=message.joint_names,
                position=message.feedback.positions, velocity=message.feedback.velocities))
