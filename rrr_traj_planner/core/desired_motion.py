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

"""What the arm's controller follows: polynomials in time, evaluated one instant at a time."""

from __future__ import annotations

from bisect import bisect_right

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.control import Desired
from rrr_traj_planner.core.motion_points import MotionPoints, segment_coefficients, segment_orders
from rrr_traj_planner.core.nanoseconds import nanoseconds, SECOND


class DesiredMotion:
    """
    A motion of polynomials, one after another, that rests where it ends.

    Which of them is in force is decided in whole nanoseconds, as in joint_trajectory_controller:
    exactly at a knot it is the one that begins there.

    Parameters
    ----------
    knots : ndarray, shape (n,)
        Strictly increasing times [s] since the origin.
    coefficients : ndarray, shape (n - 1, 3, 6)
        For each interval and joint, of 1, x, ..., x^5 with x the time since its knot [s].
    final : ndarray, shape (3,)
        Position at the last knot [rad], which is held.
    origin_ns : int
        What the knots are counted from [ns].

    """

    def __init__(self, knots: Array, coefficients: Array, final: Array,
                 origin_ns: int = 0) -> None:
        self.knots, self.coefficients, self.final = knots, coefficients, final
        self.origin_ns = origin_ns
        self._knots_ns = [nanoseconds(knot) for knot in knots.tolist()]
        # One knot alone is a rest that has no beginning.
        self._rests_from = self._knots_ns[-1] if len(knots) > 1 else -np.inf
        self._rest = rest(final)
        # The interval found last [ns], its beginning [s], and its coefficients.
        self._low = self._high = 0
        self._begin = 0.0
        self._current: list[float] = []

    @property
    def origin(self) -> float:
        """Return what the knots are counted from [s]."""
        return self.origin_ns / SECOND

    @property
    def start(self) -> float:
        """When the motion begins [s]."""
        return self.origin + float(self.knots[0])

    @property
    def end(self) -> float:
        """When the motion comes to rest [s]."""
        return self.origin + float(self.knots[-1])

    def __call__(self, t: float) -> Desired:
        """
        Return the desired state at a time.

        Parameters
        ----------
        t : float
            [s]; before the first knot the motion is as at that knot, after the last it rests.

        Returns
        -------
        tuple of 9 floats
            Positions [rad], velocities [rad/s], accelerations [rad/s^2].

        """
        t -= self.origin
        return self.elapsed(nanoseconds(t), t)

    def command(self, now: int) -> Desired:
        """
        Return the desired state at a time of a clock.

        Parameters
        ----------
        now : int
            [ns].

        Returns
        -------
        tuple of 9 floats
            As `__call__`.

        """
        n = now - self.origin_ns
        return self.elapsed(n, n / SECOND)

    def elapsed(self, n: int, t: float) -> Desired:
        """
        Return the desired state after a time since the origin.

        Parameters
        ----------
        n : int
            The time, to choose a polynomial by [ns].
        t : float
            The same time, to evaluate it at [s].

        Returns
        -------
        tuple of 9 floats
            As `__call__`.

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

    def states(self) -> tuple[Array, Array, Array]:
        """
        Return the state with which the motion goes on from each knot, and rests at the last.

        Returns
        -------
        tuple of ndarray, shape (n, 3)
            Positions [rad], velocities [rad/s], accelerations [rad/s^2].

        """
        c, zero = self.coefficients, np.zeros((1, 3))
        return (np.vstack((c[:, :, 0], self.final)), np.vstack((c[:, :, 1], zero)),
                np.vstack((2.0 * c[:, :, 2], zero)))

    def _find(self, n: int, t: float) -> float:
        """Make the interval around a time the current one, and return the time, not before all."""
        knots = self._knots_ns
        i = max(bisect_right(knots, n) - 1, 0)
        self._low, self._high = knots[i], knots[i + 1]
        self._begin = float(self.knots[i])
        self._current = self.coefficients[i].ravel().tolist()
        return max(t, float(self.knots[0]))


def through(points: MotionPoints, origin_ns: int = 0) -> DesiredMotion:
    """
    Return the motion through points.

    Parameters
    ----------
    points : MotionPoints
        The points.
    origin_ns : int
        What their times are counted from [ns].

    Returns
    -------
    DesiredMotion
        Lines, cubics and quintics between them.

    """
    coefficients = segment_coefficients(points, segment_orders(points))
    return DesiredMotion(points.times, coefficients, points.positions[-1], origin_ns)


def holding(q: ArrayLike, now: int = 0) -> DesiredMotion:
    """
    Return the motion that stays where it is.

    Parameters
    ----------
    q : array_like, shape (3,)
        Positions [rad].
    now : int
        When it begins [ns].

    Returns
    -------
    DesiredMotion
        A motion of one knot.

    """
    return DesiredMotion(np.zeros(1), np.zeros((0, 3, 6)), np.array(q, dtype=float), now)


def rest(q: ArrayLike) -> Desired:
    """
    Return the desired state of an arm that rests.

    Parameters
    ----------
    q : array_like, shape (3,)
        Positions [rad].

    Returns
    -------
    tuple of 9 floats
        The positions, then zeros.

    """
    q1, q2, q3 = np.asarray(q, dtype=float).tolist()
    return q1, q2, q3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
