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

"""Schedules of periodic instants."""

from __future__ import annotations

from rrr_traj_planner.core.nanoseconds import SECOND


class Schedule:
    """
    Periodic instants: the k-th is k / rate after the first, without accumulated rounding.

    Parameters
    ----------
    rate : float
        Instants a second, positive [Hz].
    first : int
        The first instant [ns].

    Attributes
    ----------
    rate : float
        As given.
    next : int
        The next instant [ns].

    """

    def __init__(self, rate: float, first: int) -> None:
        self.rate, self._first, self._count = rate, first, 0
        self.next = first

    def passed(self, now: int) -> bool:
        """
        Return whether an instant has come; if so, advance to the next instant.

        Parameters
        ----------
        now : int
            [ns]; never decreasing.

        Returns
        -------
        bool
            True once for all instants up to now.

        """
        if now < self.next:
            return False
        while self.next <= now:
            self._count += 1
            self.next = self._first + int(self._count * SECOND / self.rate)
        return True
