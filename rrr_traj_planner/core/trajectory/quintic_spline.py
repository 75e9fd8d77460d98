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

"""
Piecewise polynomials of up to fifth degree in time, as joint_trajectory_controller uses them.

Two points are joined by a line, a cubic or a quintic, by the derivatives that both have.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array, bound_array, IntArray
from rrr_traj_planner.core.trajectory.trajectory_points import segment_orders, TrajectoryPoints


class QuinticSpline:
    """
    Piecewise polynomials in time.

    Parameters
    ----------
    knots : ndarray, shape (n,)
        Strictly increasing times [s].
    coefficients : ndarray, shape (n - 1, 3, 6)
        For each interval and joint, of 1, x, ..., x^5 with x the time since its knot [s].
    final : ndarray, shape (3,)
        Positions at the last knot [rad].

    """

    def __init__(self, knots: Array, coefficients: Array, final: Array) -> None:
        self.knots, self.coefficients, self.final = knots, coefficients, final

    def at(self, t: ArrayLike) -> tuple[Array, Array, Array, Array]:
        """
        Return the motion at many times.

        Parameters
        ----------
        t : array_like, shape (...)
            Times [s]; before the first knot its state applies, after the last one the last.

        Returns
        -------
        tuple of ndarray, shape (..., 3)
            Position [rad], velocity [rad/s], acceleration [rad/s^2], jerk [rad/s^3].

        """
        t = np.clip(bound_array('t', t), self.knots[0], self.knots[-1])
        if len(self.coefficients) == 0:
            still = np.zeros(t.shape + (3,))
            return still + self.final, still, still, still
        i = np.clip(np.searchsorted(self.knots, t, side='right') - 1, 0,
                    len(self.coefficients) - 1)
        c, x = np.moveaxis(self.coefficients[i], -1, 0), (t - self.knots[i])[..., np.newaxis]
        q, qd, qdd, qddd = (polynomial(c, x, derivative) for derivative in range(4))
        return q, qd, qdd, qddd

    def within(self, fractions: ArrayLike,
               segments: IntArray | slice = slice(None)) -> tuple[Array, Array, Array]:
        """
        Return position, velocity and acceleration at the same fractions of several segments.

        Parameters
        ----------
        fractions : array_like, shape (m,)
            Fractions of the time from a point to the next, from 0 to 1.
        segments : ndarray or slice
            Indices of k of the n - 1 segments.

        Returns
        -------
        tuple of ndarray, shape (m, k, 3)
            [rad], [rad/s], [rad/s^2].

        """
        c = np.moveaxis(self.coefficients, -1, 0)[:, segments]
        widths = self.widths(segments)[:, np.newaxis]
        x = np.asarray(fractions, dtype=float)[:, np.newaxis, np.newaxis] * widths
        return polynomial(c, x, 0), polynomial(c, x, 1), polynomial(c, x, 2)

    @property
    def velocities(self) -> Array:
        """Return velocities at the knots but the last, and means, (2, n - 1, 3) [rad/s]."""
        q = np.concatenate((self.coefficients[..., 0], self.final[np.newaxis]))
        mean = np.diff(q, axis=0) / self.widths()[:, np.newaxis]
        return np.stack((self.coefficients[..., 1], mean))

    def widths(self, segments: IntArray | slice = slice(None)) -> Array:
        """
        Return durations of segments.

        Parameters
        ----------
        segments : ndarray or slice
            Indices of k of the n - 1 segments.

        Returns
        -------
        ndarray, shape (k,)
            [s].

        """
        return np.asarray(self.knots[1:][segments] - self.knots[:-1][segments])

    def peak_jerks(self, segments: IntArray | slice = slice(None)) -> Array:
        """
        Return the largest jerk of each joint between each two points, exactly.

        Parameters
        ----------
        segments : ndarray or slice
            Indices of k of the n - 1 segments.

        Returns
        -------
        ndarray, shape (k, 3)
            [rad/s^3].

        """
        widths = self.widths(segments)[:, np.newaxis]
        c = np.moveaxis(self.coefficients[segments], -1, 0)
        with np.errstate(divide='ignore', invalid='ignore'):
            vertex = -0.2 * c[4] / c[5]  # jerk is a parabola in time
        times = (0.0 * widths, widths, np.clip(np.nan_to_num(vertex), 0.0, widths))
        return np.asarray(np.abs([polynomial(c, x, 3) for x in times]).max(axis=0))


def spline_through(points: TrajectoryPoints) -> QuinticSpline:
    """
    Return the spline that joint_trajectory_controller interpolates through points.

    Parameters
    ----------
    points : TrajectoryPoints
        The points.

    Returns
    -------
    QuinticSpline
        Lines, cubics and quintics between them.

    """
    coefficients = _segment_coefficients(points, segment_orders(points))
    return QuinticSpline(points.times, coefficients, points.positions[-1])


def spline_where_divided(before: QuinticSpline, points: TrajectoryPoints,
                         divided: IntArray) -> QuinticSpline:
    """
    Return the spline through points of which some are new: only the polynomials beside them are.

    Parameters
    ----------
    before : QuinticSpline
        Through the others.
    points : TrajectoryPoints
        All points, each with velocity and acceleration.
    divided : ndarray of int
        Increasing indices of the intervals between the others that contain a new point, each one.

    Returns
    -------
    QuinticSpline
        As of `spline_through`.

    """
    copies = np.ones(len(before.coefficients), dtype=int)
    copies[divided] = 2
    coefficients = before.coefficients.repeat(copies, axis=0)
    first = divided + np.arange(len(divided))
    parts = np.stack((first, first + 1), axis=1).ravel()
    states = points.positions, points.velocities, points.accelerations
    coefficients[parts] = np.stack(hermite(
        (points.times[parts + 1] - points.times[parts])[:, np.newaxis],
        tuple(s[parts] for s in states), tuple(s[parts + 1] for s in states)), axis=-1)
    return QuinticSpline(points.times, coefficients, points.positions[-1])


def hermite(T: float | Array, start: tuple[Array, ...], end: tuple[Array, ...]) -> list[Array]:
    """
    Return the Hermite polynomial between two states: degree 1, 3 or 5.

    Parameters
    ----------
    T : float or ndarray
        Time between them [s].
    start, end : tuple of ndarray
        Position, and velocity and acceleration if given, as many in both.

    Returns
    -------
    list of ndarray
        Coefficients of 1, x, x^2, ... with x the time since the start [s].

    """
    p0, p1 = start[0], end[0]
    if len(start) == 1:
        return [p0, (p1 - p0) / T]
    v0, v1 = start[1], end[1]
    d = (p1 - p0) / T  # mean velocity
    if len(start) == 2:
        return [p0, v0, (3.0 * d - 2.0 * v0 - v1) / T, (v0 + v1 - 2.0 * d) / T ** 2]
    a0, a1 = start[2], end[2]
    return [p0, v0, 0.5 * a0,
            (20.0 * d - 12.0 * v0 - 8.0 * v1 - (3.0 * a0 - a1) * T) / (2.0 * T ** 2),
            (-30.0 * d + 16.0 * v0 + 14.0 * v1 + (3.0 * a0 - 2.0 * a1) * T) / (2.0 * T ** 3),
            (12.0 * d - 6.0 * (v0 + v1) - (a0 - a1) * T) / (2.0 * T ** 4)]


def _segment_coefficients(points: TrajectoryPoints, orders: IntArray) -> Array:
    """
    Return the polynomials between points.

    Parameters
    ----------
    points : TrajectoryPoints
        The points.
    orders : ndarray of int, shape (n - 1,)
        As from `segment_orders`.

    Returns
    -------
    ndarray, shape (n - 1, 3, 6)
        For each segment and joint, coefficients of 1, x, ..., x^5 with x the time since the
        segment's start [s].

    """
    states = (points.positions, points.velocities, points.accelerations)
    coefficients = np.zeros((6, len(orders), 3))
    T = np.diff(points.times)[:, np.newaxis]
    for known, order in enumerate((1, 3, 5), start=1):  # degrees of the polynomials
        i = np.flatnonzero(orders == order)
        coefficients[:order + 1, i] = hermite(
            T[i], tuple(s[i] for s in states[:known]), tuple(s[i + 1] for s in states[:known]))
    return np.moveaxis(coefficients, 0, -1)


def polynomial(c: Array, x: Array, derivative: int) -> Array:
    """
    Return a derivative of the polynomials c[0] + c[1] x + c[2] x^2 + ...

    Parameters
    ----------
    c : ndarray, shape (m + 1, ...)
        Coefficients.
    x : ndarray
        Of a shape that broadcasts with a coefficient's.
    derivative : int
        0: the value itself.

    Returns
    -------
    ndarray
        Of the common shape.

    """
    value = np.zeros(np.broadcast_shapes(c.shape[1:], x.shape))
    for n in range(len(c) - 1, derivative - 1, -1):
        factor = 1.0
        for k in range(derivative):
            factor *= n - k
        value = value * x + factor * c[n]
    return value
