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

"""Tracking errors of a motion, for a chart that does not grow with its duration."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from rrr_traj_planner.core.arrays import Array

PERIOD = 0.2       # s between two pictures of the chart
MOST_POINTS = 400  # of the chart; when there are so many, every second one is dropped


class Tracking:
    """
    The joints' tracking errors since the start of a motion.

    Attributes
    ----------
    last, largest : float
        The largest of the newest errors, and of all [rad].

    """

    def __init__(self) -> None:
        self.last = self.largest = 0.0
        self._times: list[float] = []
        self._errors: list[Sequence[float]] = []
        self._begin, self._shown = 0.0, -np.inf

    def __bool__(self) -> bool:
        """Return whether an error is known."""
        return bool(self._times)

    def add(self, now: float, errors: Sequence[float]) -> bool:
        """
        Add errors.

        Parameters
        ----------
        now : float
            Any steady time [s].
        errors : sequence of float
            Of the joints [rad].

        Returns
        -------
        bool
            Whether the chart is to be drawn again.

        """
        if not self._times:
            self._begin = now
        elif len(self._times) == MOST_POINTS:
            del self._times[1::2], self._errors[1::2]
        self._times.append(now - self._begin)
        self._errors.append(errors)
        self.last = max(map(abs, errors), default=0.0)
        self.largest = max(self.largest, self.last)
        is_due = now - self._shown >= PERIOD
        if is_due:
            self._shown = now
        return is_due

    def curves(self) -> tuple[Array, Array]:
        """
        Return what to draw.

        Returns
        -------
        times : ndarray, shape (n,)
            Since the first errors [s].
        errors : ndarray, shape (n, 3)
            [rad].

        """
        return np.array(self._times), np.array(self._errors)
