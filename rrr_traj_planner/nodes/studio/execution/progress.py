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

"""A goal of the motion server's, and how far it is."""

from __future__ import annotations

from dataclasses import dataclass, field
import re
from time import monotonic

from rrr_traj_planner.nodes.studio.planned import in_words_of_the_page
from rrr_traj_planner.nodes.studio.sent_goal import SentGoal
from rrr_traj_planner.nodes.studio.wanted import Wanted
from rrr_traj_planner_interfaces.action import MoveThrough

VIA_POINT = re.compile(r'(?<=\bvia point )\d+')


@dataclass(eq=False)
class Progress:
    """
    A goal, and how far it is.

    Attributes
    ----------
    wanted : Wanted
        What it is of.
    first : int
        Index in `wanted` of the goal's first via point.
    sent : SentGoal
        To end it before its time.
    moved : set of int
        Via points for whose sake it was sent.
    duration, left : float
        Of the motion, and until its end [s].

    """

    wanted: Wanted
    first: int
    sent: SentGoal = field(default_factory=SentGoal)
    moved: set[int] = field(default_factory=set)
    duration: float = 0.0
    left: float = 0.0
    _heard: float = 0.0  # when the last feedback came [s]
    _following: int = 0  # index in `wanted` of the via point that comes next
    _times_left: list[float] = field(default_factory=list)  # [s] until it and those after it

    def take(self, feedback: MoveThrough.Feedback) -> None:
        """
        Take a feedback.

        Parameters
        ----------
        feedback : MoveThrough.Feedback
            Of this goal.

        """
        self._heard, self.left = monotonic(), feedback.time_left
        self.duration = max(self.duration, self.left)
        self._following = self.first + feedback.next_via_point
        self._times_left = list(feedback.via_times_left)

    @property
    def silence(self) -> float:
        """Return how long ago the last feedback came [s]."""
        return monotonic() - self._heard

    def first_after(self, time: float) -> int:
        """
        Return the first via point that is reached later.

        Parameters
        ----------
        time : float
            From now on [s].

        Returns
        -------
        int
            Index in `wanted`; the number of via points if there is none.

        """
        return self._following + sum(t - self.silence <= time for t in self._times_left)

    def text_of(self, result: MoveThrough.Result) -> str:
        """
        Return why it has failed.

        Parameters
        ----------
        result : MoveThrough.Result
            Of this goal.

        Returns
        -------
        str
            Its message, in the panel's words and with its numbers of via points.

        """
        message = VIA_POINT.sub(lambda found: str(int(found[0]) + self.first), result.message)
        return in_words_of_the_page(message, self.first, self.first)
