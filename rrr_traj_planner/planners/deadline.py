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

"""Deadline: after 80 % of the limit, stop improving; after the limit plus 0.2 s, abort."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter

from rrr_traj_planner.core.cancellation import never, ShouldStop
from rrr_traj_planner.core.errors import TimeLimitError

IMPROVING = 0.8  # part of the limit after which a motion is not improved any more; chosen
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

    def __call__(self) -> bool:
        """
        Return whether planning is to end with the best motion so far.

        Raises
        ------
        TimeLimitError
            If the limit is exceeded by more than GRACE.

        """
        return self._after(IMPROVING)

    def part(self, share: float) -> ShouldStop:
        """
        Return a callback for a share of the time; it raises as the deadline itself does.

        Parameters
        ----------
        share : float
            Of the time after which this one returns True, in [0, 1].

        Returns
        -------
        callable
            See `core.cancellation.ShouldStop`.

        """
        return lambda: self._after(IMPROVING * share)

    def _after(self, share: float) -> bool:
        elapsed = self._clock() - self._begun
        if elapsed > self._limit + GRACE or self._is_over():
            raise TimeLimitError(self._limit, elapsed)
        return elapsed > share * self._limit


def part_of(should_stop: ShouldStop, share: float) -> ShouldStop:
    """
    Return a cancellation callback for a share of the time, if the given one is a `Deadline`.

    Parameters
    ----------
    should_stop : callable
        For the whole time.
    share : float
        Of its time, in [0, 1].

    Returns
    -------
    callable
        The deadline's part; the same callback where it is not a `Deadline`.

    """
    return should_stop.part(share) if isinstance(should_stop, Deadline) else should_stop
