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

"""A motion of the arm: sent, followed, and planned anew while the user drags its via points."""

from __future__ import annotations

from time import monotonic
from typing import Protocol

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.nodes.studio.execution.progress import Progress
from rrr_traj_planner.nodes.studio.execution.tracking import Tracking
from rrr_traj_planner.nodes.studio.figures import status_html
from rrr_traj_planner.nodes.studio.goals import rest_goal
from rrr_traj_planner.nodes.studio.ros_client import StudioClient
from rrr_traj_planner.nodes.studio.wanted import Wanted
from rrr_traj_planner_interfaces.action import MoveThrough

# A via point that is reached within so many leads of the motion server's is passed as it was: the
# new motion begins after one lead, or after two where planning takes longer than one.
LEADS = 2.0
TRIES = 2  # of the same again, after one that came too late

STOPPING = 'stopping'
TAKEN_OVER = 'the arm moves: time_optimal takes over'
STOPPED = 'stopped'
GOES_ON = 'the motion in progress goes on'
SILENCE = 2.0  # s without feedback, after which the page says so
SILENT = ('no news of the motion for {:.0f} s: has the controller or the motion server ended? The '
          'arm may move')
DETACHED = 'these are other via points than those of the motion: Run takes over'


class Display(Protocol):
    """What shows the motion."""

    def show_status(self, text: str, share: float) -> None:
        """Show a text about the motion, and the share of it that is done."""

    def show_tracking(self, times: Array, errors: Array) -> None:
        """Show the joints' tracking errors [rad], shape (n, 3), over time [s]."""


class Execution:
    """
    The arm's motion; every method is called in the executor's thread.

    One goal is in progress, one at most is to take over from it, and of what the user drags
    meanwhile the newest waits.

    Parameters
    ----------
    client : StudioClient
        Connected.
    joint_names : tuple of str
        The arm's joints.
    display : Display
        What shows the motion.

    """

    def __init__(self, client: StudioClient, joint_names: tuple[str, ...],
                 display: Display) -> None:
        self._client, self._names, self._display = client, joint_names, display
        self._running: Progress | None = None  # the newest goal that has given feedback
        self._sent: Progress | None = None     # the newest one, if it has not
        self._wanted: Wanted | None = None  # what the motion leads through, as it is by now
        self._dragged: set[int] = set()     # via points, since the newest goal was sent
        self._tries = 0                     # of the same again
        self._done = 0.0                    # of the goals before the one in progress [s]
        self._tracking = Tracking()
        self._refusal = ''
        self._stops = False                 # whether the user has asked for the end,
        self._tells_end = True              # and whether it is told here;
        self._silence = 0.0                 # s without news by then: perhaps nobody has heard it

    @property
    def is_moving(self) -> bool:
        """Return whether a motion is in progress, or about to be."""
        return self._running is not None or self._sent is not None

    def start(self, goal: MoveThrough.Goal, wanted: Wanted, takes_over: bool) -> None:
        """
        Send a goal.

        Parameters
        ----------
        goal : MoveThrough.Goal
            Leads through the last via points of what is wanted, perhaps all.
        wanted : Wanted
            What is planned.
        takes_over : bool
            Whether the arm moves.

        """
        if self._running is None and self._sent is not None and (
                self._sent.wanted is wanted and not self._stops):
            return  # asked for twice
        if not takes_over:
            self._running, self._tracking, self._done = None, Tracking(), 0.0
        self._wanted, self._refusal, self._stops, self._tells_end = wanted, '', False, True
        count = len(goal.via_points.poses) + len(goal.joint_via_points)
        self._display.show_status(status_html(TAKEN_OVER if takes_over else 'planning'), 0.0)
        self._send(goal, wanted, len(wanted.points) - count)

    def changed(self, before: Wanted, after: Wanted) -> None:
        """
        Have the motion in progress follow a change of what is wanted.

        If one via point is elsewhere, and yet to come, the arm goes there. If they are others, the
        motion goes on as it is, and follows no longer.

        Parameters
        ----------
        before, after : Wanted
            What was wanted, and is.

        """
        if self._wanted is not before:
            return
        moved = moved_points(before, after)
        self._wanted = after if moved is not None and len(moved) <= 1 else None
        if moved and self._wanted is not None:
            self._dragged.update(moved)
            self._tries = 0
            self._replan()

    def check(self) -> None:
        """Say so where nothing is heard of the motion in progress; called again and again."""
        if self._running is not None and self._running.silence > SILENCE:
            self._display.show_status(status_html(
                SILENT.format(self._running.silence), is_error=True), 0.0)

    def stop(self, is_told: bool) -> bool:
        """
        End the motion before its time, and what is to take over from it.

        Parameters
        ----------
        is_told : bool
            Whether the page is to say that it has ended; else somebody else does.

        Returns
        -------
        bool
            Whether there was one.

        """
        self._wanted, self._stops, self._tells_end = None, True, is_told
        silence = 0.0 if self._running is None else self._running.silence
        self._silence = silence if silence > SILENCE else 0.0
        found = [sent for sent in (self._sent, self._running) if sent is not None]
        for sent in found:
            sent.sent.cancel()
        if found and is_told:
            self._display.show_status(status_html(STOPPING), 0.0)
        return bool(found)

    def _send(self, goal: MoveThrough.Goal, wanted: Wanted, first: int) -> None:
        self._sent = sent = Progress(wanted, first, moved=self._dragged)
        self._dragged = set()
        sent.sent = self._client.move(goal, lambda feedback: self._progress(sent, feedback),
                                      lambda result: self._ended(sent, result))

    def _replan(self) -> None:
        """Send a goal through what is to come, if that has changed, and none is on its way."""
        running, wanted = self._running, self._wanted
        if running is None or wanted is None or self._sent is not None or not self._dragged:
            return
        first = min(running.first_after(LEADS * self._client.replanning_lead),
                    len(wanted.points) - 1)  # the last one is where the arm is to be in the end
        if max(self._dragged) >= first:
            self._send(rest_goal(wanted, first), wanted, first)

    def _progress(self, sent: Progress, feedback: MoveThrough.Feedback) -> None:
        if sent is self._sent:
            self._leave()
            self._running, self._sent, self._refusal = sent, None, ''
        elif sent is not self._running:
            return
        sent.take(feedback)
        errors = dict(zip(feedback.joint_names, feedback.tracking_error))
        if errors and self._tracking.add(
                monotonic(), [errors.get(name, 0.0) for name in self._names]):
            self._display.show_tracking(*self._tracking.curves())
        self._show(sent)
        self._replan()

    def _leave(self) -> None:
        """Take note that the goal in progress is no longer that."""
        if self._running is not None:
            self._done += self._running.duration - self._running.left
            self._running = None

    def _show(self, sent: Progress) -> None:
        if self._stops:
            return
        error = f', tracking error {self._tracking.last:.1e} rad, at most ' \
            f'{self._tracking.largest:.1e} rad' if self._tracking else ''
        text = status_html(f'{sent.left:.2f} s left{error}')
        if self._refusal:
            text += status_html(f'{self._refusal}; {GOES_ON}', is_error=True)
        elif self._wanted is None:
            text += status_html(DETACHED)
        done = self._done + sent.duration - sent.left
        self._display.show_status(text, done / max(done + sent.left, 1e-9))

    def _ended(self, sent: Progress, result: MoveThrough.Result) -> None:
        if sent is self._sent:
            self._sent = None
            if self._running is not None and result.error_code != result.SUCCESS:
                self._refuse(self._running, sent, result)
                return
        elif sent is not self._running:
            return  # another one has taken over
        self._leave()
        if self._sent is not None:
            return  # it is to take over, or tells why it does not
        self._wanted = None
        if self._tracking:
            self._display.show_tracking(*self._tracking.curves())
        self._show_end(sent, result)

    def _refuse(self, running: Progress, sent: Progress, result: MoveThrough.Result) -> None:
        """
        Show why a goal does not take over, and try what the user has dragged meanwhile.

        One that came too late for the controller, or not where the arm was, is tried again.
        """
        self._refusal = '' if result.error_code == result.PREEMPTED else sent.text_of(result)
        if result.error_code in (result.CONTROL_FAILED, result.START_STATE_INVALID) and (
                self._tries < TRIES):
            self._tries += 1
            self._dragged |= sent.moved
        self._show(running)
        self._replan()

    def _show_end(self, sent: Progress, result: MoveThrough.Result) -> None:
        if not self._tells_end:
            return
        if result.error_code == result.PREEMPTED and self._stops:
            self._display.show_status(status_html(
                SILENT.format(self._silence) if self._silence else STOPPED,
                is_error=self._silence > 0.0), 0.0)
            return
        if result.error_code != result.SUCCESS:
            self._display.show_status(status_html(sent.text_of(result), is_error=True), 0.0)
            return
        error = f', tracking error at most {self._tracking.largest:.1e} rad' if (
            self._tracking) else ''
        text = status_html(f'reached the last via point{error}')
        if self._refusal:
            text = status_html(
                f'{self._refusal}; the arm is at the last via point of the motion before',
                is_error=True)
        self._display.show_status(text, 1.0)


def moved_points(before: Wanted, after: Wanted) -> list[int] | None:
    """
    Return which via points are elsewhere.

    Parameters
    ----------
    before, after : Wanted
        What was wanted, and is.

    Returns
    -------
    list of int or None
        Indices; None: there are more or fewer of them.

    """
    if before.points.shape != after.points.shape:
        return None
    found: list[int] = np.flatnonzero((before.points != after.points).any(axis=1)).tolist()
    return found
