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
from math import nan

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
        self._clock = node.get_clock()
        self._joints: dict[str, tuple[float, float, float]] = {}  # the latest of each
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
        Return the states that have all joints of an arm, of increasing times.

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
        for kept in (self._measured, self._of_controller):
            found: list[JointState] = []
            for state in list(kept):
                time = nanoseconds(state.header.stamp)
                if found and nanoseconds(found[-1].header.stamp) == time:
                    found.pop()  # the later one has more joints of this time
                if names <= set(state.name) and (
                        not found or nanoseconds(found[-1].header.stamp) < time):
                    found.append(state)
            if len(found) > 1:
                return found
        return []

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
            self._measured.append(self._whole(self._stamped(message)))

    def _take_of_controller(self, message: JointTrajectoryControllerState) -> None:
        """Keep what a controller has measured."""
        if self._begun:
            self._of_controller.append(self._stamped(JointState(
                header=message.header, name=message.joint_names,
                position=message.feedback.positions, velocity=message.feedback.velocities)))

    def _stamped(self, message: JointState) -> JointState:
        """Give a message that has no time that of its arrival."""
        if not nanoseconds(message.header.stamp):
            message.header.stamp = self._clock.now().to_msg()
        return message

    def _whole(self, message: JointState) -> JointState:
        """Return a message of some of the joints with the latest of the others."""
        if not len(message.position) == len(message.name) > 0:
            return message
        columns = [values if len(values) == len(message.name) else [nan] * len(message.name)
                   for values in (message.position, message.velocity, message.effort)]
        self._joints.update(zip(message.name, zip(*columns)))
        if len(message.name) == len(self._joints):
            return message
        position, velocity, effort = zip(*self._joints.values())
        return JointState(header=message.header, name=list(self._joints), position=position,
                          velocity=velocity, effort=effort)
