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

"""Ends and feedback of a controller's goal, as those of a motion."""

from __future__ import annotations

from bisect import bisect_right
from typing import Any

from action_msgs.msg import GoalStatus
from control_msgs.action import FollowJointTrajectory
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.nodes.motion.departure import duration_of, elapsed
from rrr_traj_planner.nodes.motion.motion import (
    CANCELED,
    EndCode,
    Motion,
    MotionEnd,
    Progress,
)
from rrr_traj_planner.nodes.output.message_times import nanoseconds

Result = FollowJointTrajectory.Result
NAMES = {getattr(Result, name): name for name in (
    'INVALID_GOAL', 'INVALID_JOINTS', 'OLD_HEADER_TIMESTAMP', 'PATH_TOLERANCE_VIOLATED',
    'GOAL_TOLERANCE_VIOLATED')}


def end_of_goal(response: Any, rejected: bool = False) -> MotionEnd:
    """
    Return how a motion has ended with its goal.

    Parameters
    ----------
    response : FollowJointTrajectory.Impl.GetResultService.Response
        Status and result of the goal.
    rejected : bool
        Whether the controller has not accepted it; some say why.

    Returns
    -------
    MotionEnd
        Success, canceled, or with the controller's code and text.

    """
    result = response.result
    if response.status == GoalStatus.STATUS_SUCCEEDED and not rejected:
        return MotionEnd(EndCode.SUCCESS, '')
    if response.status == GoalStatus.STATUS_CANCELED:
        return CANCELED
    what = 'rejected' if rejected else 'aborted'
    code = NAMES.get(result.error_code, '')
    text = f'the controller has {what} the trajectory'
    text += f' ({code})' if code else ''
    text += f': {result.error_string}' if result.error_string else (
        '; its log says why' if rejected else '')
    return MotionEnd(EndCode.CONTROL_FAILED, text, controller_code=result.error_code)


def progress_of(feedback: FollowJointTrajectory.Feedback, motion: Motion) -> Progress:
    """
    Return where a motion is.

    Parameters
    ----------
    feedback : FollowJointTrajectory.Feedback
        The controller's.
    motion : Motion
        In progress.

    Returns
    -------
    Progress
        Before its plan begins, at time 0.

    """
    return _progress(motion, nanoseconds(feedback.header.stamp), list(feedback.joint_names),
                     list(feedback.error.positions))


def progress_by_clock(motion: Motion, now: int) -> Progress:
    """
    Return where a motion is if the controller keeps its time.

    Parameters
    ----------
    motion : Motion
        In progress.
    now : int
        [ns].

    Returns
    -------
    Progress
        Without joints and tracking errors, which are not known.

    """
    return _progress(motion, now, [], [])


def _progress(motion: Motion, stamp: int, joint_names: list[str], errors: list[float]) -> Progress:
    duration, via_times = duration_of(motion.response.trajectory), motion.response.via_times
    time = elapsed(motion.begins, duration, stamp)
    wait = max(motion.begins - stamp, 0) / SECOND if stamp else 0.0  # on the motion before
    following = min(bisect_right(via_times, time), len(via_times) - 1)
    return Progress(time, duration / SECOND, following, joint_names, errors,
                    [max(t - time, 0.0) + wait for t in via_times[following:]])
