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

"""Where a new motion begins: at rest, on the motion in progress, or on somebody else's."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.nodes.motion.arm_states import ArmState
from rrr_traj_planner.nodes.motion.motion import Motion
from rrr_traj_planner.nodes.motion.splicing import first_point_from, spliced, state_at, time_of
from rrr_traj_planner.nodes.output.message_times import nanoseconds
from trajectory_msgs.msg import JointTrajectory

MESSAGE = SECOND // 20  # ns, more than a message to the controller takes; chosen
DELAY = SECOND // 10    # ns, from sending a motion that begins at rest to its begin; chosen


class TooLateError(Exception):
    """A plan whose begin has passed, or is no longer on the motion in progress."""


class Departure(NamedTuple):
    """
    The start of a plan.

    Attributes
    ----------
    state : ArmState
        What is planned from.
    running : Motion, optional
        The motion in progress on which it lies.
    point : int
        Index of the point of that motion's trajectory.

    """

    state: ArmState
    running: Motion | None = None
    point: int = -1

    @property
    def is_estimate(self) -> bool:
        """Return whether the arm moves, but not by a motion that is known."""
        return self.running is None and self.state.is_moving

    def joined(self, plan: JointTrajectory, running: Motion | None, now: int
               ) -> tuple[JointTrajectory, int]:
        """
        Return what to send to the controller.

        Parameters
        ----------
        plan : JointTrajectory
            From this start; its stamp is set if it is sent as it is.
        running : Motion, optional
            The motion in progress now.
        now : int
            [ns].

        Returns
        -------
        trajectory : JointTrajectory
            The plan, behind what is left of the motion in progress.
        begins : int
            When the plan begins [ns].

        Raises
        ------
        TooLateError
            If the plan cannot be joined in time.

        """
        if self.running is None:
            begins = self.state.stamp if self.is_estimate else now + DELAY
            plan.header.stamp.sec, plan.header.stamp.nanosec = divmod(begins, SECOND)
            trajectory = plan
        elif self.running is running:
            begins = time_of(running.trajectory, self.point)
            trajectory = spliced(running.trajectory, self.point, plan, now)
        else:
            raise TooLateError('the motion that was to be gone on from has ended meanwhile')
        if begins < now + MESSAGE:
            raise TooLateError('planning took longer than the time until the begin of the plan')
        return trajectory, begins


def departure(latest: ArmState, running: Motion | None, now: int, lead: int) -> Departure:
    """
    Return where a new motion begins.

    Parameters
    ----------
    latest : ArmState
        The arm's state.
    running : Motion, optional
        The motion in progress.
    now : int
        [ns].
    lead : int
        How far ahead a motion is gone on from [ns].

    Returns
    -------
    Departure
        The first point of the motion in progress that is so far ahead, or its end. At rest where
        the arm is. If somebody else moves the arm, where it will be with constant acceleration.

    """
    if running is not None:
        point = first_point_from(running.trajectory, now + lead)
        if time_of(running.trajectory, point) >= now + MESSAGE:
            return Departure(state_at(running.trajectory, point), running, point)
    return Departure(latest.later(now + lead) if latest.is_moving else latest.at_rest())


def moved(plan: JointTrajectory, latest: ArmState, tolerance: float) -> str:
    """
    Return how the arm is no longer where a plan begins.

    Parameters
    ----------
    plan : JointTrajectory
        Begins at rest.
    latest : ArmState
        The arm's state.
    tolerance : float
        Largest distance of a joint from its start [rad].

    Returns
    -------
    str
        Joint, distance and tolerance; empty if it still is there.

    """
    names, start = plan.joint_names, plan.points[0].positions
    missing = [name for name in names if name not in latest.joints]
    if missing:
        return f'the position of {", ".join(missing)} is not known any more'
    distances = np.abs([latest.joints[n][0] - q for n, q in zip(names, start)])
    i = int(distances.argmax())
    if distances[i] > tolerance:
        return (f'{names[i]} has moved by {distances[i]:.3g} rad since the plan was asked for, '
                f'allowed {tolerance:g} rad: nothing is sent')
    return ''


def elapsed(begins: int, duration: int, stamp: int) -> float:
    """
    Return the time since the begin of a motion.

    Parameters
    ----------
    begins, duration : int
        Of the motion [ns].
    stamp : int
        Now [ns].

    Returns
    -------
    float
        Between 0 and the duration [s].

    """
    return min(max(stamp - begins, 0), duration) / SECOND


def duration_of(plan: JointTrajectory) -> int:
    """
    Return the duration of a plan.

    Parameters
    ----------
    plan : JointTrajectory
        Times are from its first point.

    Returns
    -------
    int
        [ns].

    """
    return nanoseconds(plan.points[-1].time_from_start)
