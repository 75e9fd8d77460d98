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

"""Log messages of the arm node, throttled by kind and joint."""

from __future__ import annotations

from collections.abc import Sequence
import re

from rclpy.node import Node
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.control.goal_end import GoalEnd, PREEMPTED, ResultCode
from rrr_traj_planner.core.control.replacement import Missed
from rrr_traj_planner.core.control.tolerances import Outcome
from rrr_traj_planner.core.control.trajectory_limits import Excess
from rrr_traj_planner.core.errors import counted
from rrr_traj_planner.core.simulation.saturation_and_contact import (
    NONE_RECORDED,
    SaturationAndContact,
)
from rrr_traj_planner.nodes.output.throttle import Throttle

# A number in a text, except in names such as joint_1.
NUMBER = re.compile(r'(?<![\w.])-?\d[\d.]*(?:e[-+]?\d+)?')


class ArmLog:
    """
    Logs the arm's events: repeated ones at most once per period for each kind and joint.

    Parameters
    ----------
    node : Node
        The arm node.
    joint_names : sequence of str
        Names of the joints.

    """

    def __init__(self, node: Node, joint_names: Sequence[str]) -> None:
        self._log, self._joint_names = node.get_logger(), joint_names
        self._throttle = Throttle()

    def followed(self, points: int, seconds: float) -> None:
        """
        Log that a trajectory has been accepted.

        Parameters
        ----------
        points : int
            Number of its points.
        seconds : float
            Time until its end [s].

        """
        if self._throttle.passes('followed'):
            self._log.info(f'following {counted(points, "point")}, which end in {seconds:.3f} s'
                           + self._suppressed('followed'))

    def refused(self, text: str) -> None:
        """
        Log why a message has been refused.

        Parameters
        ----------
        text : str
            The reason; reasons that differ only in numbers are of one kind.

        """
        kind = NUMBER.sub('#', text)
        if self._throttle.passes(kind):
            self._log.error(text + self._suppressed(kind))

    def ignored(self, text: str) -> None:
        """
        Warn of what is ignored.

        Parameters
        ----------
        text : str
            What, and why.

        """
        if self._throttle.passes(text):
            self._log.warning(text)

    def goal_ended(self, end: GoalEnd) -> None:
        """
        Log how a goal has ended.

        Parameters
        ----------
        end : GoalEnd
            How.

        """
        kind = NUMBER.sub('#', end.text)
        if not self._throttle.passes(kind):
            return
        if end.code is ResultCode.SUCCESSFUL or end is PREEMPTED:
            self._log.info(end.text + self._suppressed(kind))
        else:
            self._log.warning(end.text + self._suppressed(kind))

    def given_up(self, lines: Sequence[str]) -> None:
        """
        Log why a trajectory has been given up.

        Parameters
        ----------
        lines : sequence of str
            The exceeded tolerances, and the consequence.

        """
        for line in lines:  # rclpy has one severity for each line of code
            if line == Outcome.TIMED_OUT.value:
                self._log.warning(line)
            else:
                self._log.error(line)

    def goal_canceled(self) -> None:
        """Log that a goal has been canceled."""
        if self._throttle.passes('canceled'):
            self._log.info('goal canceled, stopping' + self._suppressed('canceled'))

    def exceeded(self, excesses: Sequence[Excess], missed: Missed) -> None:
        """
        Warn of a trajectory, or a lead-in segment, that exceeds ranges or limits.

        Parameters
        ----------
        excesses : sequence of Excess
            The exceeded ranges and limits.
        missed : Missed
            Which points are not reached in time.

        """
        own = [e for e in excesses if not e.leading_in]
        leading_in = [e for e in excesses if e.leading_in]
        for found, text, end in (
                (own, 'the received trajectory', ''),
                (leading_in, 'the lead-in segment', missed.text and f'; {missed.text}')):
            if found and self._throttle.passes(*(e.kind for e in found)):
                self._log.warning(f'{text} exceeds joint limits: ' + '; '.join(
                    e.text(self._joint_names) for e in found) + end)
        if missed.points and not leading_in and self._throttle.passes('missed'):
            self._log.warning(missed.text + self._suppressed('missed'))

    def strained(self, condition: SaturationAndContact, limits: JointLimits) -> None:
        """
        Warn of saturated motors and of contact with stops.

        Parameters
        ----------
        condition : SaturationAndContact
            Saturation and contact since the last call.
        limits : JointLimits
            The arm's limits.

        """
        if condition is not NONE_RECORDED:
            for kind, joint, text in (condition.motors(self._joint_names, limits)
                                      + condition.stops(self._joint_names, limits)):
                if self._throttle.passes((kind, joint)):
                    self._log.warning(text)

    def _suppressed(self, kind: str) -> str:
        """Return the number of messages of a kind that were suppressed, as text."""
        count = self._throttle.suppressed(kind)
        return f' ({count} more since the last such line)' if count else ''
