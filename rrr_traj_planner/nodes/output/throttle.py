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

"""Lines of the log that would come again and again, once in a while."""

from __future__ import annotations

from collections.abc import Hashable
from time import monotonic

PERIOD = 2.0  # s


class Throttle:
    """
    Lets a message of each kind pass once in a period of steady time.

    Parameters
    ----------
    period : float
        [s].

    """

    def __init__(self, period: float = PERIOD) -> None:
        self._period = period
        self._passed: dict[Hashable, float] = {}
        self._held: dict[Hashable, int] = {}

    def passes(self, *kinds: Hashable) -> bool:
        """
        Return whether a message may pass now: if any of the kinds that it is of may.

        Parameters
        ----------
        *kinds : hashable
            What it is about, such as what is wrong and with which joint.

        Returns
        -------
        bool
            If so, all of them have passed.

        """
        now = monotonic()
        if all(now - self._passed.get(kind, -self._period) < self._period for kind in kinds):
            for kind in kinds:
                self._held[kind] = self._held.get(kind, 0) + 1
            return False
        self._passed.update((kind, now) for kind in kinds)
        return True

    def held(self, kind: Hashable) -> int:
        """
        Return how many messages of a kind were held back since this was asked last.

        Parameters
        ----------
        kind : hashable
            The kind.

        Returns
        -------
        int
            How many.

        """
        return self._held.pop(kind, 0)
