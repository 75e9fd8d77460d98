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
Turns of several threads at work that Python would do no faster at once: short work goes first.

Multilevel feedback queues (Corbato et al., An Experimental Time-Sharing System, 1962): work that
has taken little time so far is urgent, unless it is expected to take long. It becomes more urgent
as it waits, so that long work gets on whatever else comes.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from math import floor, log2
from threading import Condition
from time import perf_counter

FIRST_LEVEL = 0.1     # s of work that are the most urgent; each further level has twice the time
LEVEL_OF_WAITING = 1.0  # s of waiting by which work becomes more urgent by a level
SHORTEST_TURN = 0.02  # s
PART_OF_WAITING = 0.1   # a turn is at least this part of the time that was waited for it,
LONGEST_CLAIM = 0.3   # s, but no longer than this


class Turn:
    """
    The place of one thread's work among all.

    Parameters
    ----------
    turns : Turns
        All.
    expected : float
        How long the work is thought to take at the least [s]: it is no more urgent than if it had
        taken so long already.

    """

    def __init__(self, turns: Turns, expected: float) -> None:
        self._turns, self._expected = turns, expected
        self._before = 0.0         # time of work before this turn [s]
        self._since = perf_counter()  # of this turn, or of waiting for the next
        self._claim = SHORTEST_TURN

    def used(self) -> float:
        """Return how long the work has taken so far, waiting left out [s]; to be at work."""
        return self._before + perf_counter() - self._since

    def seconds(self) -> float:
        """Return the same, after the turn of whoever is to go first; to be asked often."""
        if self._turns.is_wanted and perf_counter() - self._since > self._claim:
            self._turns.give_way(self)
        return self.used()

    def begin(self) -> None:
        """Note that the turn begins."""
        now = perf_counter()
        waited, self._since = now - self._since, now
        self._claim = max(SHORTEST_TURN, min(PART_OF_WAITING * waited, LONGEST_CLAIM))

    def pause(self) -> None:
        """Note that waiting for the next turn begins."""
        self._before, self._since = self.used(), perf_counter()

    def level(self, at_work: bool, now: float) -> float:
        """Return how little urgent the work is at a time: 0 at first."""
        done = max(self._expected, self.used() if at_work else self._before, 0.5 * FIRST_LEVEL)
        waited = 0.0 if at_work else now - self._since
        return floor(1.0 + log2(done / FIRST_LEVEL)) - waited / LEVEL_OF_WAITING


class Turns:
    """
    Turns of threads, of which one works at a time.

    Attributes
    ----------
    is_wanted : bool
        Whether anyone waits.

    """

    def __init__(self) -> None:
        self.is_wanted = False
        self._changed = Condition()
        self._waiting: list[Turn] = []
        self._taken = self._ended = False

    def queued(self, expected: float = 0.0) -> Turn:
        """
        Return a turn that waits from now on; of equally urgent ones the first goes first.

        Parameters
        ----------
        expected : float
            See `Turn`.

        Returns
        -------
        Turn
            To be taken by a thread.

        """
        with self._changed:
            turn = Turn(self, expected)
            self._waiting.append(turn)
            self.is_wanted = True
        return turn

    def turn(self, expected: float = 0.0) -> AbstractContextManager[Turn]:
        """
        Queue a turn and wait for it; see `taken`.

        Parameters
        ----------
        expected : float
            See `Turn`.

        Returns
        -------
        context manager
            Of the turn.

        """
        return self.taken(self.queued(expected))

    @contextmanager
    def taken(self, turn: Turn) -> Iterator[Turn]:
        """
        Wait for a queued turn, and end it afterwards; once turns are over nobody waits any more.

        Parameters
        ----------
        turn : Turn
            The turn.

        Yields
        ------
        Turn
            The same.

        """
        with self._changed:
            self._wait(turn)
        try:
            yield turn
        finally:
            with self._changed:
                self._taken = False
                self._changed.notify_all()

    def give_way(self, turn: Turn) -> None:
        """
        Let others have their turn before a thread goes on, if they are more urgent by a level.

        Parameters
        ----------
        turn : Turn
            The thread's.

        """
        with self._changed:
            now = perf_counter()
            if self._ended or not any(
                    w.level(False, now) <= turn.level(True, now) - 1.0 for w in self._waiting):
                return
            turn.pause()
            self._waiting.append(turn)
            self.is_wanted = True
            self._taken = False
            self._changed.notify_all()
            self._wait(turn)

    def end(self) -> None:
        """Have nobody wait any more."""
        with self._changed:
            self._ended = True
            self._changed.notify_all()

    def _wait(self, turn: Turn) -> None:
        self._changed.wait_for(
            lambda: self._ended or not self._taken and turn is self._most_urgent())
        self._waiting.remove(turn)
        self.is_wanted = bool(self._waiting)
        self._taken = True
        turn.begin()

    def _most_urgent(self) -> Turn:
        now = perf_counter()
        return min(self._waiting, key=lambda w: w.level(False, now))
