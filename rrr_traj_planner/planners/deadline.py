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
Deadline: after 80 % of the limit, stop improving; after the limit plus 0.2 s, abort.

Improving stops sooner where points and checks of the answer are expected to take longer than the
other 20 %.
"""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from time import perf_counter

from rrr_traj_planner.core.cancellation import never, ShouldStop
from rrr_traj_planner.core.errors import TimeLimitError

IMPROVING = 0.8  # part of the limit after which a motion is not improved any more,
LEAST = 0.3      # and where its answer takes so long that more must be kept, at least; chosen
GRACE = 0.2      # s after the limit until which points and checks of the answer may take; chosen


class Deadline:
    """
    A `should_stop` that limits the time from when it is made.

    Parameters
    ----------
    limit : float
        Planning time [s]. After a part of it, IMPROVING, the callback returns True: the best
        motion so far is to be the answer.
    clock : callable, optional
        Returns the time [s].
    is_over : callable, optional
        Returns whether the request has been abandoned.

    """

    def __init__(self, limit: float, clock: Callable[[], float] = perf_counter,
                 is_over: ShouldStop = never) -> None:
        self._limit, self._clock, self._is_over = limit, clock, is_over
        self._begun = clock()
        self._improving = IMPROVING
        self._window = (0.0, 1.0)  # of the time: in which this callback's part is done

    def __call__(self) -> bool:
        """
        Return whether planning is to end with the best motion so far.

        Raises
        ------
        TimeLimitError
            If the limit is exceeded by more than GRACE.

        """
        elapsed = self._clock() - self._begun
        if elapsed > self._limit + GRACE or self._is_over():
            raise TimeLimitError(self._limit, elapsed)
        return elapsed > self._improving * self._window[1] * self._limit

    def keeping(self, seconds: float) -> Deadline:
        """
        Return a callback that keeps time for the answer.

        Parameters
        ----------
        seconds : float
            That the answer's points and checks are expected to take [s].

        Returns
        -------
        Deadline
            It returns True so long before the limit, but not before LEAST of it.

        """
        found = copy(self)
        found._improving = max(LEAST, min(IMPROVING, 1.0 - seconds / self._limit))
        return found

    def duration_of(self, work: Callable[[], object]) -> float:
        """
        Return how long something takes.

        Parameters
        ----------
        work : callable
            It is called once.

        Returns
        -------
        float
            By the deadline's clock [s].

        """
        begun = self._clock()
        work()
        return self._clock() - begun

    def window(self, begin: float, end: float) -> Deadline:
        """
        Return a callback for a window of the time; it raises as the deadline itself does.

        Parameters
        ----------
        begin, end : float
            Shares of the time in [0, 1]. The callback returns True after the latter; windows of
            the window are parts of what is in between.

        Returns
        -------
        Deadline
            See `core.cancellation.ShouldStop`.

        """
        found, (first, last) = copy(self), self._window
        found._window = (first + begin * (last - first), first + end * (last - first))
        return found


def part_of(should_stop: ShouldStop, share: float, begin: float = 0.0) -> ShouldStop:
    """
    Return a cancellation callback for a share of the time, if the given one is a `Deadline`.

    Parameters
    ----------
    should_stop : callable
        For the whole time.
    share : float
        Of its time after which this one returns True, in [0, 1].
    begin : float
        Share of its time after which work begins, for parts of the part.

    Returns
    -------
    callable
        The deadline's part; the same callback where it is not a `Deadline`.

    """
    return should_stop.window(begin, share) if isinstance(should_stop, Deadline) else should_stop
