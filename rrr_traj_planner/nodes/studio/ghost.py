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

"""Which moment of a plan is shown by the arm's ghost: playing, chosen, or none."""

from __future__ import annotations

PAUSE = 0.7  # s at the end of the motion, before it begins again


class Ghost:
    """The moment; none at first."""

    def __init__(self) -> None:
        self._since: float | None = None  # when the playing began [s]
        self._share: float | None = None

    def play(self, plays: bool, now: float) -> None:
        """
        Begin to play, from the start, or end it, and show nothing.

        Parameters
        ----------
        plays : bool
            Whether to play.
        now : float
            Any steady time [s].

        """
        self._since, self._share = now if plays else None, None

    def go_to(self, share: float) -> None:
        """
        Show one moment.

        Parameters
        ----------
        share : float
            Of the duration, 0 to 1.

        """
        self._since, self._share = None, share

    def time(self, now: float, duration: float) -> float | None:
        """
        Return the moment.

        Parameters
        ----------
        now : float
            The same steady time [s].
        duration : float
            Of the plan, which may have changed meanwhile [s].

        Returns
        -------
        float or None
            Since the start of the motion [s]; None: no ghost is shown.

        """
        if self._since is not None:
            return min((now - self._since) % (duration + PAUSE), duration)
        return None if self._share is None else self._share * duration
