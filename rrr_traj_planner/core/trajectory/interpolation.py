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

"""Interpolation of trajectory points as in joint_trajectory_controller: degree 1, 3 or 5."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array, finite_array, IntArray, parameter_values
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.read_only import ReadOnlyArrays


@dataclass(frozen=True, eq=False)
class TrajectoryPoints(ReadOnlyArrays):
    """
    Points of a motion, as a trajectory_msgs/JointTrajectory carries them.

    Parameters
    ----------
    times : array_like, shape (n,)
        Strictly increasing [s].
    positions : array_like, shape (n, 3)
        [rad].
    velocities, accelerations : array_like, shape (n, 3), optional
        [rad/s], [rad/s^2]; accelerations need velocities to be of use.

    Raises
    ------
    InvalidInputError
        If there is no point, times do not increase, or shapes differ.

    """

    times: Array
    positions: Array
    velocities: Array | None = None
    accelerations: Array | None = None

    def __post_init__(self) -> None:
        """Check shapes and order and make the arrays read-only."""
        object.__setattr__(self, 'times', finite_array('times', self.times, (-1,)))
        n = len(self.times)
        if n == 0 or (np.diff(self.times) <= 0.0).any():
            raise InvalidInputError('times must be strictly increasing, and at least one')
        for name in ('positions', 'velocities', 'accelerations'):
            if name == 'positions' or getattr(self, name) is not None:
                object.__setattr__(
                    self, name, finite_array(name, getattr(self, name), (n, 3)))

    @property
    def duration(self) -> float:
        """Time of the last point [s]."""
        return float(self.times[-1])


class Interpolant:
    """
    Piecewise polynomial through points: linear, cubic or quintic by the derivatives given.

    Parameters
    ----------
    points : TrajectoryPoints
        The points.

    """

    def __init__(self, points: TrajectoryPoints) -> None:
        self.points = points
        self.coefficients = _coefficients(points)  # (order + 1, segments, 3), in time since knot

    def __call__(self, t: ArrayLike) -> tuple[Array, Array, Array]:
        """
        Return position, velocity and acceleration.

        Parameters
        ----------
        t : array_like, shape (n,) or ()
            Times [s]; outside the points' times the nearest end position is held.

        Returns
        -------
        tuple of ndarray, shape (n, 3) or (3,)
            [rad], [rad/s], [rad/s^2].

        """
        times = parameter_values('t', t)
        knots = self.points.times
        clipped = np.clip(times, knots[0], knots[-1])
        index = np.clip(np.searchsorted(knots, clipped, side='right') - 1, 0, len(knots) - 2)
        c = self.coefficients[:, index]
        x = (clipped - knots[index])[..., np.newaxis]
        resting = ((times < knots[0]) | (times > knots[-1]))[..., np.newaxis]
        return (polynomial(c, x, 0), np.where(resting, 0.0, polynomial(c, x, 1)),
                np.where(resting, 0.0, polynomial(c, x, 2)))

    def within(self, shares: ArrayLike,
               segments: IntArray | slice = slice(None)) -> tuple[Array, Array, Array]:
        """
        Return position, velocity and acceleration at the same fractions of several segments.

        Parameters
        ----------
        shares : array_like, shape (m,)
            Fractions of the time from a point to the next, from 0 to 1.
        segments : ndarray or slice
            Indices of k of the n - 1 segments.

        Returns
        -------
        tuple of ndarray, shape (m, k, 3)
            [rad], [rad/s], [rad/s^2].

        """
        c = self.coefficients[:, segments]
        widths = np.diff(self.points.times)[segments]
        x = np.asarray(shares, dtype=float)[:, np.newaxis, np.newaxis] * widths[:, np.newaxis]
        return polynomial(c, x, 0), polynomial(c, x, 1), polynomial(c, x, 2)

    def peaks(self, per_segment: int = 16) -> tuple[Array, Array]:
        """
        Return the largest velocity and acceleration of each joint.

        Parameters
        ----------
        per_segment : int
            Sampling steps between two points for the velocity; accelerations are exact.

        Returns
        -------
        tuple of ndarray, shape (3,)
            [rad/s], [rad/s^2].

        """
        widths = np.diff(self.points.times)[:, np.newaxis]
        if len(widths) == 0:  # a single point rests
            return np.zeros(3), np.zeros(3)
        velocity = self.within(np.linspace(0.0, 1.0, per_segment + 1))[1]
        accelerations = [polynomial(self.coefficients, x, 2)
                         for x in (0.0 * widths, widths, *self._zeros_of_jerk(widths))]
        return np.abs(velocity).max(axis=(0, 1)), np.abs(accelerations).max(axis=(0, 1))

    def peak_jerks(self) -> Array:
        """
        Return the largest jerk of each joint between each two points, exactly.

        Returns
        -------
        ndarray, shape (n - 1, 3)
            [rad/s^3].

        """
        widths = np.diff(self.points.times)[:, np.newaxis]
        places = [0.0 * widths, widths]
        if len(self.coefficients) == 6:  # jerk is a parabola; its vertex may be within
            with np.errstate(divide='ignore', invalid='ignore'):
                top = -0.2 * self.coefficients[4] / self.coefficients[5]
            places.append(np.clip(np.nan_to_num(top), 0.0, widths))
        return np.asarray(np.abs(
            [polynomial(self.coefficients, x, 3) for x in places]).max(axis=0))

    def _zeros_of_jerk(self, widths: Array) -> tuple[Array, ...]:
        """Return times since each knot, within its segment, at which the jerk is zero."""
        c = self.coefficients
        if len(c) < 6:  # acceleration is largest at the ends
            return ()
        A, B, C = 60.0 * c[5], 24.0 * c[4], 6.0 * c[3]
        with np.errstate(divide='ignore', invalid='ignore'):
            half = -0.5 * (B + np.copysign(np.sqrt(np.maximum(B * B - 4.0 * A * C, 0.0)), B))
            return tuple(np.clip(np.nan_to_num(x), 0.0, widths) for x in (half / A, C / half))


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


def _coefficients(points: TrajectoryPoints) -> Array:
    states = [points.positions]
    if points.velocities is not None:
        states.append(points.velocities)
        if points.accelerations is not None:
            states.append(points.accelerations)
    if len(points.times) == 1:
        return np.stack([points.positions, np.zeros((1, 3))])
    T = np.diff(points.times)[:, np.newaxis]
    return np.stack(hermite(T, tuple(s[:-1] for s in states), tuple(s[1:] for s in states)))


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
