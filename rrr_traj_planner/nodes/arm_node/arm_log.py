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

"""What the arm's node logs: a line for what happens once, one in a while for what goes on."""

from __future__ import annotations

from collections.abc import Sequence
import re

from rclpy.node import Node
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.control.trajectory_limits import Excess
from rrr_traj_planner.core.simulation.condition import Condition, SOUND
from rrr_traj_planner.nodes.output.throttle import Throttle

# A number in a text, but for those in names.
NUMBER = re.compile(r'(?<![\w.])-?\d[\d.]*(?:e[-+]?\d+)?')


class ArmLog:
    """
    Writes the arm's lines to the node's log, each kind once in a while for each joint.

    Parameters
    ----------
    node : Node
        The arm's.
    joint_names : sequence of str
        The joints.

    """

    def __init__(self, node: Node, joint_names: Sequence[str]) -> None:
        self._log, self._joint_names = node.get_logger(), joint_names
        self._throttle = Throttle()

    def followed(self, points: int, seconds: float) -> None:
        """
        Say that a trajectory has been taken over.

        Parameters
        ----------
        points : int
            How many it has.
        seconds : float
            How long it goes on [s].

        """
        if self._throttle.passes('followed'):
            self._log.info(f'following {points} points, until {seconds:.3f} s from now'
                           + self._before('followed', 'trajectories were taken over'))

    def refused(self, text: str) -> None:
        """
        Say why a message has been refused.

        Parameters
        ----------
        text : str
            The reason; reasons that differ in numbers alone are of one kind.

        """
        kind = NUMBER.sub('#', text)
        if self._throttle.passes(kind):
            self._log.error(text + self._before(kind, 'messages were refused for it'))

    def exceeded(self, excesses: Sequence[Excess]) -> None:
        """
        Warn of a trajectory that leaves ranges or limits.

        Parameters
        ----------
        excesses : sequence of Excess
            Which.

        """
        if excesses and self._throttle.passes(*(e[:2] for e in excesses)):
            self._log.warning("the trajectory, as it was sent, leaves the joints' limits: "
                              + '; '.join(e.text(self._joint_names) for e in excesses))

    def strained(self, condition: Condition, limits: JointLimits) -> None:
        """
        Warn of motors that were saturated and stops that were hit or pressed.

        Parameters
        ----------
        condition : Condition
            What strained the arm.
        limits : JointLimits
            The arm's.

        """
        if condition is not SOUND:
            for kind, joint, text in (condition.motors(self._joint_names, limits)
                                      + condition.stops(self._joint_names, limits)):
                if self._throttle.passes((kind, joint)):
                    self._log.warning(text)

    def _before(self, kind: str, what: str) -> str:
        """Return what has happened since the last line of a kind."""
        held = self._throttle.held(kind)
        return f' (before, {held} more {what})' if held else ''
