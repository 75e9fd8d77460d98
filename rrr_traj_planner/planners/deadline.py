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

"""A limit on the time of planning: first the best so far is asked for, then it is given up."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter

from rrr_traj_planner.core.cancellation import never, ShouldStop
from rrr_traj_planner.core.errors import TimeLimitError

IMPROVING = 0.8  # of the limit, after which a motion that was found is brought to an answer,
GRACE = 0.25     # s after the limit up to which that may take


class Deadline:
    """
    A `should_stop` that limits the time from when it is made.

    Parameters
    ----------
    limit : float
        How long planning may take [s]. After a part of it, IMPROVING, the answer is True: the
        best motion so far is to be the answer.
    clock : callable, optional
        What the time is taken from [s].
    is_over : callable, optional
        Whether nobody waits for the answer any more.

    """

    def __init__(self, limit: float, clock: Callable[[], float] = perf_counter,
                 is_over: ShouldStop = never) -> None:
        self._limit, self._clock, self._is_over = limit, clock, is_over
        self._begun = clock()

    def __call__(self) -> bool:
        """
        Return whether it is time to end with what there is.

        Raises
        ------
        TimeLimitError
            If it is over by more than GRACE: what is done now would take too long.

        """
        return self._after(IMPROVING)

    def part(self, share: float) -> ShouldStop:
        """
        Return a question whether a share of the time is used up; it raises as the whole does.

        Parameters
        ----------
        share : float
            Of the time up to when this one answers True, in [0, 1].

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
    Return a question that leaves time for what follows, where that can be known.

    Parameters
    ----------
    should_stop : callable
        Of the whole.
    share : float
        Of its time, in [0, 1].

    Returns
    -------
    callable
        The deadline's part; the same question where it is no `Deadline`.

    """
    return should_stop.part(share) if isinstance(should_stop, Deadline) else should_stop
