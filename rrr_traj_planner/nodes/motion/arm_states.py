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

"""Where the arm is: its controller's reference or, without one, its measured joints."""

from __future__ import annotations

from array import array
from collections.abc import Mapping, Sequence
from math import isfinite
from time import monotonic
from typing import Any, NamedTuple

from control_msgs.msg import JointTrajectoryControllerState
from rclpy.node import Node
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.nodes.motion.latest_messages import LatestMessages
from rrr_traj_planner.nodes.output.message_times import nanoseconds
from sensor_msgs.msg import JointState

FRESH = 1.0    # s after its arrival for which a state counts
MOVING = 0.01  # rad/s, above which an arm moves; the planner's start_state_tolerance
ROUNDING = 1e-6  # rad/s^2, of a reference at rest


class ArmState(NamedTuple):
    """
    Positions, velocities and accelerations of joints at a time.

    Attributes
    ----------
    joints : dict
        Position [rad], velocity [rad/s] and acceleration [rad/s^2] by the joint's name.
    stamp : int
        [ns].

    """

    joints: Mapping[str, tuple[float, float, float]]
    stamp: int

    @property
    def is_moving(self) -> bool:
        """Return whether any joint moves, or is about to."""
        return any(abs(qd) > MOVING or abs(qdd) > ROUNDING
                   for _, qd, qdd in self.joints.values())

    def at_rest(self) -> ArmState:
        """Return the state without velocities and accelerations."""
        return self._replace(joints={n: (q, 0.0, 0.0) for n, (q, _, _) in self.joints.items()})

    def later(self, stamp: int) -> ArmState:
        """
        Return the state that constant accelerations lead to.

        Parameters
        ----------
        stamp : int
            A later time [ns].

        Returns
        -------
        ArmState
            At that time.

        """
        t = max(stamp - self.stamp, 0) / SECOND
        return ArmState({name: (q + t * (qd + 0.5 * t * qdd), qd + t * qdd, qdd)
                         for name, (q, qd, qdd) in self.joints.items()}, stamp)

    def message(self) -> tuple[JointState, array[float]]:
        """
        Return the state as a start state of a request.

        Returns
        -------
        start_state : JointState
            Names, positions, velocities.
        start_acceleration : array
            [rad/s^2], in the same order.

        """
        q, qd, qdd = (array('d', column) for column in zip(*self.joints.values()))
        return JointState(name=list(self.joints), position=q, velocity=qd), qdd


class ArmStates:
    """
    The latest state of the arm.

    A controller's reference is preferred to what is measured: it has no noise, and the next
    motion is to begin there. Joints that are not the arm's may be among the measured ones.

    Parameters
    ----------
    node : Node
        Subscribes `joint_states` and the controller's `controller_state`.
    controller : str
        The controller's name.

    """

    def __init__(self, node: Node, controller: str) -> None:
        self._clock = node.get_clock()
        self._references = LatestMessages(
            node, JointTrajectoryControllerState, f'{controller}/controller_state')
        self._measurements = LatestMessages(node, JointState, 'joint_states')
        self._reference: tuple[float, ArmState] | None = None  # with the time of its arrival
        self._measured: dict[str, tuple[float, tuple[float, float, float]]] = {}
        self._stamp = 0
        self.sources = self._references.topic, self._measurements.topic

    def latest(self) -> ArmState | None:
        """
        Return the present state.

        Returns
        -------
        ArmState or None
            None if no message has come for `FRESH`.

        """
        self._take()
        oldest = monotonic() - FRESH
        if self._reference is not None and self._reference[0] >= oldest:
            return self._reference[1]
        joints = {name: state for name, (arrived, state) in self._measured.items()
                  if arrived >= oldest}
        return ArmState(joints, self._stamp) if joints else None

    def _take(self) -> None:
        """Take what has come: references, if any, and measured joints, some by each node."""
        now = monotonic()
        for message, age in self._references.take():
            reference = message.reference
            joints = _states(message.joint_names, reference.positions, reference.velocities,
                             reference.accelerations)
            if joints:
                self._reference = now - age, ArmState(joints, self._time_of(message, age))
        for message, age in self._measurements.take():
            self._measured.update({name: (now - age, state) for name, state in _states(
                message.name, message.position, message.velocity, ()).items()})
            self._stamp = self._time_of(message, age)

    def _time_of(self, message: Any, age: float) -> int:
        """Return the time of a message, of its arrival if it has none [ns]."""
        return nanoseconds(message.header.stamp) or (
            int(self._clock.now().nanoseconds) - round(age * SECOND))


def _states(names: Sequence[str], *columns: Sequence[float]
            ) -> dict[str, tuple[float, float, float]]:
    """
    Return states by name; velocities and accelerations that are not known are zero.

    Controllers that do not know a value leave it out, or give NaN.
    """
    filled = [column if len(column) == len(names) else [0.0] * len(names)
              for column in columns]
    if not len(columns[0]) == len(names) > 0:
        return {}
    return {name: (float(q), _known(qd), _known(qdd)) for name, q, qd, qdd in zip(names, *filled)
            if isfinite(q)}


def _known(value: float) -> float:
    return float(value) if isfinite(value) else 0.0
