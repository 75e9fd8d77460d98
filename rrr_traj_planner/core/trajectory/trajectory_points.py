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
Points of a commanded trajectory, and the polynomials of joint_trajectory_controller between them.

Two points are joined by a line, a cubic or a quintic, by the derivatives that both have.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from rrr_traj_planner.core.arrays import Array, finite_array, truth_array
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.read_only import ReadOnlyArrays
from rrr_traj_planner.core.trajectory.interpolation import hermite

ORDERS = (1, 3, 5)  # degrees of the polynomials

# std::numeric_limits<float>::epsilon(): the controller treats smaller velocities as zero [rad/s].
FLOAT_EPSILON = float(np.finfo(np.float32).eps)


@dataclass(frozen=True, eq=False)
class CommandedPoints(ReadOnlyArrays):
    """
    Points of a commanded trajectory, each with or without velocity and acceleration.

    Parameters
    ----------
    times : array_like, shape (n,)
        Strictly increasing [s].
    positions, velocities, accelerations : array_like, shape (n, 3)
        [rad], [rad/s], [rad/s^2]; zero where a point has none.
    has_velocity, has_acceleration : array_like, shape (n,)
        Whether a point has them.

    Raises
    ------
    InvalidInputError
        If there is no point, times do not increase, or shapes differ.

    """

    times: Array
    positions: Array
    velocities: Array
    accelerations: Array
    has_velocity: NDArray[np.bool_]
    has_acceleration: NDArray[np.bool_]

    def __post_init__(self) -> None:
        """Check shapes and order and make the arrays read-only."""
        object.__setattr__(self, 'times', finite_array('times', self.times, (-1,)))
        n = len(self.times)
        if n == 0 or (np.diff(self.times) <= 0.0).any():
            raise InvalidInputError('times must be strictly increasing, and at least one')
        for name in ('positions', 'velocities', 'accelerations'):
            object.__setattr__(self, name, finite_array(name, getattr(self, name), (n, 3)))
        for name in ('has_velocity', 'has_acceleration'):
            object.__setattr__(self, name, truth_array(name, getattr(self, name), (n,)))


def with_start_state(points: CommandedPoints, time: float,
                     state: tuple[Array, Array, Array]) -> CommandedPoints:
    """
    Return points preceded by a state, from which a segment leads to the first one.

    Parameters
    ----------
    points : CommandedPoints
        The points.
    time : float
        Time of the state, on the points' clock; before the first of them [s].
    state : tuple of ndarray, shape (3,)
        Position [rad], velocity [rad/s], acceleration [rad/s^2].

    Returns
    -------
    CommandedPoints
        With one point more, which has velocity and acceleration.

    """
    q, qd, qdd = state
    return CommandedPoints(
        np.append(time, points.times), np.vstack((q, points.positions)),
        np.vstack((qd, points.velocities)), np.vstack((qdd, points.accelerations)),
        np.append(True, points.has_velocity), np.append(True, points.has_acceleration))


def segment_orders(points: CommandedPoints) -> NDArray[np.int_]:
    """
    Return the degree of the polynomial between each two points.

    Velocities and accelerations are used where both points have them; accelerations without
    velocities are not (joint_trajectory_controller then commands zero positions, which is not
    reproduced).

    Parameters
    ----------
    points : CommandedPoints
        The points.

    Returns
    -------
    ndarray of int, shape (n - 1,)
        1, 3 or 5.

    """
    velocity = points.has_velocity[:-1] & points.has_velocity[1:]
    acceleration = velocity & points.has_acceleration[:-1] & points.has_acceleration[1:]
    orders: NDArray[np.int_] = 1 + 2 * velocity.astype(int) + 2 * acceleration.astype(int)
    return orders


def segment_coefficients(points: CommandedPoints, orders: NDArray[np.int_]) -> Array:
    """
    Return the polynomials between points.

    Parameters
    ----------
    points : CommandedPoints
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
    coefficients = np.zeros((len(orders), 3, 6))
    T = np.diff(points.times)[:, np.newaxis]
    for known, order in enumerate(ORDERS, start=1):
        i = np.flatnonzero(orders == order)
        polynomial = hermite(T[i], tuple(s[i] for s in states[:known]),
                             tuple(s[i + 1] for s in states[:known]))
        coefficients[i, :, :order + 1] = np.stack(polynomial, axis=-1)
    return coefficients
