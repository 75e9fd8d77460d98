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

"""Evaluation of a piecewise quintic at consecutive instants, in floats: for a control loop."""

from __future__ import annotations

from bisect import bisect_right

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array, finite_array
from rrr_traj_planner.core.states import Desired


class QuinticCursor:
    """
    Evaluates a piecewise quintic, and remembers the interval used last.

    Parameters
    ----------
    knots : ndarray, shape (n,)
        Strictly increasing times [s] since the origin.
    knots_ns : list of n int
        The same [ns].
    coefficients : ndarray, shape (n - 1, 3, 6)
        For each interval and joint, of 1, x, ..., x^5 with x the time since its knot [s].
    final : ndarray, shape (3,)
        Positions at rest, from the last knot on [rad].

    """

    def __init__(self, knots: Array, knots_ns: list[int], coefficients: Array,
                 final: Array) -> None:
        self._knots, self._knots_ns, self._coefficients = knots, knots_ns, coefficients
        # A single knot means rest at all times.
        self._rests_from = knots_ns[-1] if len(knots) > 1 else -np.inf
        self._rest = rest(final)
        # The interval found last [ns], its beginning [s], and its coefficients.
        self._low = self._high = 0
        self._begin = 0.0
        self._current: list[float] = []

    def elapsed(self, n: int, t: float) -> Desired:
        """
        Return the desired state after a time since the origin.

        Parameters
        ----------
        n : int
            The time that selects the interval [ns].
        t : float
            The same time, for the evaluation [s].

        Returns
        -------
        tuple of 9 floats
            Positions [rad], velocities [rad/s], accelerations [rad/s^2]; before the first knot as
            at that knot, after the last at rest.

        """
        if n >= self._rests_from:
            return self._rest
        if not self._low <= n < self._high:
            t = self._find(n, t)
        x = t - self._begin
        a0, a1, a2, a3, a4, a5, b0, b1, b2, b3, b4, b5, c0, c1, c2, c3, c4, c5 = self._current
        return (
            a0 + x * (a1 + x * (a2 + x * (a3 + x * (a4 + x * a5)))),
            b0 + x * (b1 + x * (b2 + x * (b3 + x * (b4 + x * b5)))),
            c0 + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * c5)))),
            a1 + x * (2.0 * a2 + x * (3.0 * a3 + x * (4.0 * a4 + x * (5.0 * a5)))),
            b1 + x * (2.0 * b2 + x * (3.0 * b3 + x * (4.0 * b4 + x * (5.0 * b5)))),
            c1 + x * (2.0 * c2 + x * (3.0 * c3 + x * (4.0 * c4 + x * (5.0 * c5)))),
            2.0 * a2 + x * (6.0 * a3 + x * (12.0 * a4 + x * (20.0 * a5))),
            2.0 * b2 + x * (6.0 * b3 + x * (12.0 * b4 + x * (20.0 * b5))),
            2.0 * c2 + x * (6.0 * c3 + x * (12.0 * c4 + x * (20.0 * c5))))

    def _find(self, n: int, t: float) -> float:
        """Select the interval of a time, and return the time, at least that of the first knot."""
        knots = self._knots_ns
        i = max(bisect_right(knots, n) - 1, 0)
        self._low, self._high = knots[i], knots[i + 1]
        self._begin = float(self._knots[i])
        self._current = self._coefficients[i].ravel().tolist()
        return max(t, float(self._knots[0]))


def rest(q: ArrayLike) -> Desired:
    """
    Return the desired state of an arm at rest.

    Parameters
    ----------
    q : array_like, shape (3,)
        Positions [rad].

    Returns
    -------
    tuple of 9 floats
        The positions, then zeros.

    """
    q1, q2, q3 = finite_array('q', q, (3,)).tolist()
    return q1, q2, q3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
