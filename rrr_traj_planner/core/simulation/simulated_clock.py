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

"""Simulated time against wall time."""

from __future__ import annotations


class SimulatedClock:
    """
    Simulated time against steady wall time: at a rate, as fast as possible, or paused.

    Parameters
    ----------
    factor : float
        Simulated time over wall time; 0: as fast as possible.
    now : int
        Steady wall time [ns].

    Attributes
    ----------
    factor : float
        As given, or as last changed.
    paused : bool
        Whether simulated time is paused.

    """

    def __init__(self, factor: float, now: int) -> None:
        self.paused = False
        self.factor = factor
        self._reached, self._since = 0, now

    def due(self, now: int, reached: int, most: int) -> int:
        """
        Return the time to which the simulation should advance now.

        Parameters
        ----------
        now : int
            Steady wall time [ns].
        reached : int
            Simulated time that has been reached [ns].
        most : int
            Largest advance at once without a rate [ns].

        Returns
        -------
        int
            Simulated time [ns].

        """
        if self.paused:
            return reached
        if self.factor == 0.0:
            return reached + most
        return self._reached + int(self.factor * (now - self._since))

    def restart(self, now: int, reached: int, factor: float | None = None,
                paused: bool | None = None) -> None:
        """
        Continue from here with another rate, or to or from a pause; missed time is dropped.

        Parameters
        ----------
        now : int
            Steady wall time [ns].
        reached : int
            Simulated time that has been reached [ns].
        factor : float, optional
            The new rate.
        paused : bool, optional
            Whether time is paused from now on.

        """
        self._reached, self._since = reached, now
        self.factor = self.factor if factor is None else factor
        self.paused = self.paused if paused is None else paused
