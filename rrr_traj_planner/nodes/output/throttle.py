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

"""Throttling of repeated log messages by kind."""

from __future__ import annotations

from collections.abc import Hashable
from time import monotonic

PERIOD = 2.0  # s between messages of a kind


class Throttle:
    """
    Lets one message of each kind pass per period of steady time.

    Parameters
    ----------
    period : float
        Period [s].

    """

    def __init__(self, period: float = PERIOD) -> None:
        self._period = period
        self._passed: dict[Hashable, float] = {}
        self._suppressed: dict[Hashable, int] = {}

    def passes(self, *kinds: Hashable) -> bool:
        """
        Return whether a message of one or several kinds may be logged now.

        Parameters
        ----------
        *kinds : hashable
            Kinds of the message, such as pairs of problem and joint.

        Returns
        -------
        bool
            True if at least one kind has not passed within the period; then all kinds count as
            passed now.

        """
        now = monotonic()
        if all(now - self._passed.get(kind, -self._period) < self._period for kind in kinds):
            for kind in kinds:
                self._suppressed[kind] = self._suppressed.get(kind, 0) + 1
            return False
        self._passed.update((kind, now) for kind in kinds)
        return True

    def suppressed(self, kind: Hashable) -> int:
        """
        Return the number of messages of a kind that were suppressed since the last call.

        Parameters
        ----------
        kind : hashable
            The kind.

        Returns
        -------
        int
            Number of messages.

        """
        return self._suppressed.pop(kind, 0)
