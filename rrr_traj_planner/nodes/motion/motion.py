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

"""A motion: what is asked for, what is planned and sent, and how it ends."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import IntEnum
from time import monotonic
from typing import Any, NamedTuple

from rrr_traj_planner_interfaces.srv import PlanTrajectory
from trajectory_msgs.msg import JointTrajectory


class EndCode(IntEnum):
    """Codes of ends beside the planner's, with the values of moveit_msgs/MoveItErrorCodes."""

    SUCCESS = 1
    CONTROL_FAILED = -4
    PREEMPTED = -7
    COMMUNICATION_FAILURE = -25
    START_STATE_INVALID = -26
    FAILURE = 99999


class MotionEnd(NamedTuple):
    """
    How a motion has ended.

    Attributes
    ----------
    code : int
        Of `EndCode`, or of the planner.
    text : str
        Empty for an unqualified success.
    via_point : int
        Index of the via point at fault, else -1.
    controller_code : int
        Of FollowJointTrajectory's result; 0 where the controller is not to blame.

    """

    code: int
    text: str
    via_point: int = -1
    controller_code: int = 0


CANCELED = MotionEnd(EndCode.PREEMPTED, 'canceled')


class Progress(NamedTuple):
    """
    Where a motion is.

    Attributes
    ----------
    time, duration : float
        Since its begin, and of the whole motion [s].
    next_via_point : int
        Index of the via point that is reached next; the last one's at the end.
    joint_names : list of str
        The controller's joints.
    tracking_error : list of float
        Commanded minus measured position of each of them [rad].
    via_times_left : list of float
        Until each via point from `next_via_point` on is reached [s].

    """

    time: float
    duration: float
    next_via_point: int
    joint_names: list[str]
    tracking_error: list[float]
    via_times_left: list[float]


def _ignored(_: Any) -> None:
    pass


@dataclass(frozen=True)
class Watch:
    """
    What is called, in the executor's thread, as a motion goes on.

    Attributes
    ----------
    planned : callable
        Gets the motion with its plan, before it is sent; again if it is planned again.
    progress : callable
        Gets the progress, as often as the controller gives feedback.
    ended : callable
        Gets the end.

    """

    planned: Callable[[Motion], None] = _ignored
    progress: Callable[[Progress], None] = _ignored
    ended: Callable[[MotionEnd], None] = _ignored


@dataclass(eq=False)
class Motion:
    """
    One motion.

    Attributes
    ----------
    request : PlanTrajectory.Request
        Without start state, which is where the arm is.
    watch : Watch
        Who is told.
    sends : bool
        Whether the plan is run.
    since : float
        When it was asked for [s], of `time.monotonic`.
    response : PlanTrajectory.Response, optional
        The planner's.
    trajectory : JointTrajectory, optional
        What is sent to the controller, with its stamp.
    begins : int
        When the plan begins [ns], by the node's clock.
    goal : ClientGoalHandle, optional
        The controller's goal, accepted.
    canceled : bool
        Whether its end is asked for.
    end : MotionEnd, optional
        None before.

    """

    request: PlanTrajectory.Request
    watch: Watch
    sends: bool = True
    since: float = field(default_factory=monotonic)
    response: Any = None
    trajectory: JointTrajectory | None = None
    begins: int = 0
    goal: Any = None
    canceled: bool = False
    end: MotionEnd | None = None

    def finish(self, end: MotionEnd) -> None:
        """
        End the motion, unless it has ended, and tell so.

        Parameters
        ----------
        end : MotionEnd
            How it ends.

        """
        if self.end is None:
            self.end = end
            self.watch.ended(end)
