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

"""A trajectory controller's action: one motion in progress, and one that is being sent."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from time import monotonic
from typing import Any

from control_msgs.action import FollowJointTrajectory
from rclpy.action import ActionClient
from rclpy.node import Node
from rclpy.task import Future
from rrr_traj_planner.nodes.motion.controller_goal import (
    end_of_goal,
    progress_by_clock,
    progress_of,
)
from rrr_traj_planner.nodes.motion.motion import CANCELED, EndCode, Motion, MotionEnd
from rrr_traj_planner.nodes.motion.options import ACTION

ANSWER_TIME = 5.0    # s for the controller to accept or reject a goal
FEEDBACK_TIME = 0.5  # s for the first feedback; then it is taken that there will be none

REPLACED = MotionEnd(EndCode.PREEMPTED, 'replaced by a newer goal')
SILENT = 'the controller (action {}) does not answer any more'

Rejected = Callable[[MotionEnd], None]


class Controller:
    """
    Sends motions to a controller, and tells how they end.

    Parameters
    ----------
    node : Node
        The node.
    controller : str
        The controller's name.
    changed : callable
        Called when a motion that was sent is accepted or rejected: another one may be sent.

    Attributes
    ----------
    action : str
        Name of its action.
    running : Motion, optional
        The motion in progress.

    """

    def __init__(self, node: Node, controller: str, changed: Callable[[], None]) -> None:
        self.action = node.resolve_service_name(f'{controller}{ACTION}')
        self._client = ActionClient(node, FollowJointTrajectory, self.action)
        self._changed = changed
        self.running: Motion | None = None
        self._sent: Motion | None = None  # whose goal is neither accepted nor rejected yet
        self._sent_at = 0.0               # s, of `monotonic`
        self._early: Future | None = None  # result of the goal in progress while one is sent
        self._accepted_at = 0.0            # s, of `monotonic`, the motion in progress
        self._gives_feedback = False       # as far as is known

    @property
    def is_sending(self) -> bool:
        """Return whether a motion is neither accepted nor rejected yet."""
        return self._sent is not None

    def is_there(self) -> bool:
        """Return whether the controller serves its action."""
        return bool(self._client.server_is_ready())

    def send(self, motion: Motion, rejected: Rejected) -> None:
        """
        Send a motion's trajectory; it replaces the one in progress if it is accepted.

        Parameters
        ----------
        motion : Motion
            Has a trajectory; no other one is being sent.
        rejected : callable
            Gets the end of the motion if the controller rejects it; ends it, or tries again.

        """
        self._sent, self._sent_at = motion, monotonic()
        self._client.send_goal_async(
            FollowJointTrajectory.Goal(trajectory=motion.trajectory),
            partial(self._progress, motion)).add_done_callback(
                partial(self._answered, motion, rejected))

    def cancel(self, motion: Motion) -> None:
        """
        Have the controller stop the arm, if a motion is in progress.

        Parameters
        ----------
        motion : Motion
            Any; if it is being sent, it is stopped as soon as it is accepted.

        """
        motion.canceled = True
        if motion is self.running:
            motion.goal.cancel_goal_async()

    def check(self) -> None:
        """End motions of a controller that has gone or does not answer."""
        if self.is_there() and (
                self._sent is None or monotonic() < self._sent_at + ANSWER_TIME):
            return
        gone, self._sent, self.running = (self._sent, self.running), None, None
        for motion in gone:
            if motion is not None:
                motion.finish(MotionEnd(
                    EndCode.COMMUNICATION_FAILURE, SILENT.format(self.action)))

    def estimate(self, now: int) -> None:
        """
        Tell where the motion in progress is by the clock, if the controller never tells.

        Parameters
        ----------
        now : int
            [ns].

        """
        motion = self.running
        if motion is not None and not self._gives_feedback and (
                monotonic() > self._accepted_at + FEEDBACK_TIME):
            motion.watch.progress(progress_by_clock(motion, now))

    def close(self) -> None:
        """Release the client, which would keep the node alive."""
        self._client.destroy()

    def _answered(self, motion: Motion, rejected: Rejected, answer: Future) -> None:
        """Take over from the motion in progress, if the controller accepts the goal."""
        goal = answer.result()
        if motion is not self._sent:  # given up
            if goal.accepted:
                goal.cancel_goal_async()
        elif goal.accepted:
            self._sent = self._early = None
            replaced, self.running = self.running, motion
            motion.goal, self._accepted_at = goal, monotonic()
            if replaced is not None:
                replaced.finish(REPLACED)
            goal.get_result_async().add_done_callback(partial(self._ended, motion))
            if motion.canceled:
                self.cancel(motion)
            self._changed()
        else:  # the result has the reason, from controllers that say it
            goal.get_result_async().add_done_callback(
                partial(self._rejected, motion, rejected))

    def _rejected(self, motion: Motion, rejected: Rejected, answer: Future) -> None:
        """Tell why the controller has rejected a goal; what is in progress goes on."""
        if motion is not self._sent:
            return
        early, self._sent, self._early = self._early, None, None
        rejected(end_of_goal(answer.result(), rejected=True))
        if early is not None and self.running is not None:
            self._ended(self.running, early)
        self._changed()

    def _ended(self, motion: Motion, answer: Future) -> None:
        """Tell how the goal in progress has ended."""
        if motion is not self.running:
            return  # replaced
        if self._sent is not None:  # perhaps replaced by what is sent
            self._early = answer
            return
        self.running = None
        end = CANCELED if motion.canceled else end_of_goal(answer.result())
        success = end.code == EndCode.SUCCESS
        motion.finish(end._replace(text=motion.response.message) if success else end)

    def _progress(self, motion: Motion, message: Any) -> None:
        """Tell where the motion in progress is."""
        self._gives_feedback = True
        if motion is self.running:
            motion.watch.progress(progress_of(message.feedback, motion))
