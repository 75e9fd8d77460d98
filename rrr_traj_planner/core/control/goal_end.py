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
How a goal of the arm's action ends: codes and texts of joint_trajectory_controller.

The codes are those of control_msgs/action/FollowJointTrajectory; the texts begin with those of
the controller (ros2_controllers, Jazzy), and say more where there is more to say.
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum
from typing import NamedTuple

from rrr_traj_planner.core.control.tolerances import Exceeded, Outcome, Verdict
from rrr_traj_planner.core.control.trajectory_validation import JointNamesError, PastEndError
from rrr_traj_planner.core.errors import format_distinct, RrrPlannerError


class ResultCode(IntEnum):
    """The action's result codes."""

    SUCCESSFUL = 0
    INVALID_GOAL = -1
    INVALID_JOINTS = -2
    OLD_HEADER_TIMESTAMP = -3
    PATH_TOLERANCE_VIOLATED = -4
    GOAL_TOLERANCE_VIOLATED = -5


class GoalEnd(NamedTuple):
    """A result."""

    code: ResultCode
    text: str


PREEMPTED, HELD, RESET, OUT_OF_RANGE, SHUT_DOWN = (
    GoalEnd(ResultCode.INVALID_GOAL, f'Current goal {text}') for text in (
        'preempted by new incoming action.', 'aborted: the arm is told to hold its position.',
        'aborted: the arm is reset.', 'aborted: the motion leaves the new joint ranges.',
        'aborted: the arm shuts down.'))

UNITS = {'Position': 'rad', 'Velocity': 'rad/s'}


def refusal(error: RrrPlannerError) -> GoalEnd:
    """
    Return why a trajectory is refused.

    Parameters
    ----------
    error : RrrPlannerError
        Raised by the validation of the trajectory.

    Returns
    -------
    GoalEnd
        INVALID_JOINTS, OLD_HEADER_TIMESTAMP or INVALID_GOAL, and the error's text.

    """
    code = ResultCode.INVALID_GOAL
    if isinstance(error, JointNamesError):
        code = ResultCode.INVALID_JOINTS
    elif isinstance(error, PastEndError):
        code = ResultCode.OLD_HEADER_TIMESTAMP
    return GoalEnd(code, str(error))


def not_followed(reasons: Sequence[str]) -> GoalEnd:
    """
    Return the end of a goal whose trajectory the arm stopped instead of following it.

    Parameters
    ----------
    reasons : sequence of str
        Why it stopped.

    Returns
    -------
    GoalEnd
        INVALID_GOAL.

    """
    return GoalEnd(ResultCode.INVALID_GOAL, 'Aborted: ' + '; '.join(reasons))


def end_of(verdict: Verdict, joint_names: Sequence[str]) -> GoalEnd:
    """
    Return how a goal ends by a verdict on its tolerances.

    Parameters
    ----------
    verdict : Verdict
        The verdict.
    joint_names : sequence of str
        The arm's joints.

    Returns
    -------
    GoalEnd
        With each joint's error and tolerance.

    """
    found = '; '.join(_text(x, joint_names) for x in verdict.exceeded)
    if verdict.outcome is Outcome.REACHED:
        return GoalEnd(ResultCode.SUCCESSFUL, 'Goal successfully reached!')
    if verdict.outcome is Outcome.PATH_VIOLATED:
        return GoalEnd(ResultCode.PATH_TOLERANCE_VIOLATED,
                       f'Aborted due to path tolerance violation: {found}')
    if verdict.outcome is Outcome.GOAL_VIOLATED:
        return GoalEnd(ResultCode.GOAL_TOLERANCE_VIOLATED,
                       'Aborted due to goal_time_tolerance exceeding by '
                       f'{verdict.since_end:f} seconds: {found}')
    return GoalEnd(ResultCode.GOAL_TOLERANCE_VIOLATED, verdict.outcome.value)


def _text(exceeded: Exceeded, joint_names: Sequence[str]) -> str:
    joint, kind, error, tolerance = exceeded
    size, largest = format_distinct(error, tolerance)
    return f'{joint_names[joint]} {kind} Error {size} {UNITS[kind]}, Tolerance {largest}'
