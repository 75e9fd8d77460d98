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
Residual vibration: what a motion leaves in a flexible structure after its end.

A structure that the joint carries, such as a slender link or a load on a belt, is taken as one
mode of vibration with natural frequency w and damping ratio z, at rest before the motion:

    y'' + 2 z w y' + w^2 y = -qdd.

After the end T of the motion it rings freely (Duhamel's integral: Clough & Penzien, Dynamics of
Structures, chapter 6):

    y(T + x) = -Im(exp(r x) c) / (w sqrt(1 - z^2)),  r = (i sqrt(1 - z^2) - z) w,
    c = integral of qdd(t) exp(r (T - t)) dt.

Given here is w^2 max |y|: the constant acceleration that would bend the mode as far.
"""

from __future__ import annotations

from collections.abc import Callable
from math import log, pi, sqrt
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from rrr_traj_planner.core.arrays import Array, finite_array
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.scalars import not_negative

Complex = NDArray[np.complexfloating[Any, Any]]
Motion = Callable[[Array], tuple[Array, Array, Array, Array]]

DAMPING = 0.01  # damping ratio of a lightly damped mode; chosen

# Gauss's rule in each step of at most an eighth of the shortest period, at least four between two
# knots: in error by less than 1e-6 of the largest acceleration, also where jerk bends in between.
NODES, WEIGHTS = np.polynomial.legendre.leggauss(5)
STEPS_OF_A_PERIOD = 8
LEAST_STEPS = 4

# Of what began earlier than that, damping has left less than the rounding of a float.
FORGOTTEN = -log(np.finfo(float).eps)  # in units of 1 / (z w)


def residual_vibration(motion: Motion, knots: ArrayLike, frequencies: ArrayLike,
                       damping: float = DAMPING) -> Array:
    """
    Return the residual vibration of flexible modes after a motion, as acceleration.

    Parameters
    ----------
    motion : callable
        A `Trajectory`, or a `QuinticSpline`'s `at`: position, velocity, acceleration and jerk,
        each of shape (n, joints), at n times.
    knots : array_like, shape (k,)
        Times between which the motion is smooth, from its start to its end, never decreasing [s].
    frequencies : array_like, shape (m,)
        Undamped natural frequencies of the modes, positive [Hz].
    damping : float
        Damping ratio of each, from 0 to below 1.

    Returns
    -------
    ndarray, shape (m, joints)
        Largest deflection from the end on, times w^2 [rad/s^2].

    Raises
    ------
    InvalidInputError
        If an argument is not as above.

    """
    knots = finite_array('knots', knots, (-1,))
    frequencies = finite_array('frequencies', frequencies, (-1,))
    z = not_negative('damping', damping)
    _check(knots, frequencies, z)
    w, damped = 2.0 * pi * frequencies, sqrt(1.0 - z * z)
    rate = (1j * damped - z) * w
    t, weights = _quadrature(_felt(knots, w, z), 1.0 / (STEPS_OF_A_PERIOD * frequencies.max()))
    weighted = (weights[:, np.newaxis] * motion(t)[2]).astype(complex)
    left = knots[-1] - t
    # One mode at a time: memory is that of the motion, however many modes.
    c = np.array([np.exp(one * left) @ weighted for one in rate])
    largest = _largest_imaginary(c, rate[:, np.newaxis])
    return np.asarray(w[:, np.newaxis] / damped * largest)


def _largest_imaginary(c: Complex, rate: Complex) -> Array:
    """Return the largest |Im(exp(rate x) c)| of x >= 0: at 0, or at the first extremum."""
    x = np.mod(-np.angle(rate * c), pi) / rate.imag  # there Im(rate exp(rate x) c) = 0
    return np.asarray(np.maximum(np.abs(c.imag), np.abs((np.exp(rate * x) * c).imag)))


def _check(knots: Array, frequencies: Array, damping: float) -> None:
    """Raise if knots decrease, frequencies are not positive, or a mode does not vibrate."""
    if len(knots) == 0 or (np.diff(knots) < 0.0).any():
        raise InvalidInputError('knots must be at least one and never decrease')
    if len(frequencies) == 0 or (frequencies <= 0.0).any():
        raise InvalidInputError('frequencies must be at least one, and positive [Hz]')
    if damping >= 1.0:
        raise InvalidInputError(f'damping is {damping:g}, must be below 1: at 1 and above, '
                                'a mode does not vibrate')


def _felt(knots: Array, w: Array, damping: float) -> Array:
    """Return the knots from the earliest time on that some mode still feels at the end."""
    if damping == 0.0:
        return knots
    return np.unique(np.maximum(knots, knots[-1] - FORGOTTEN / (damping * w.min())))


def _quadrature(knots: Array, spacing: float) -> tuple[Array, Array]:
    """Return times [s] and weights [s] of Gauss's rule, in steps no longer than the spacing."""
    widths = np.diff(knots)
    steps = np.maximum(np.ceil(widths / spacing), LEAST_STEPS).astype(int)
    within = np.arange(steps.sum()) - np.repeat(np.cumsum(steps) - steps, steps)
    half = np.repeat(0.5 * widths / steps, steps)
    middle = np.repeat(knots[:-1], steps) + half * (2.0 * within + 1.0)
    return ((middle[:, np.newaxis] + half[:, np.newaxis] * NODES).ravel(),
            (half[:, np.newaxis] * WEIGHTS).ravel())
