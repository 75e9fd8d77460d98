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

"""The polynomial curved zone (3.18): curvature zero at both ends, greatest at the via point."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array, finite_array, IntArray
from rrr_traj_planner.core.errors import ConvergenceError
from rrr_traj_planner.core.read_only import ReadOnlyArrays

# The zone is a quintic in u, -1 <= u <= 1, symmetric about the via point. Its six control points
# lie on the two lines, three on each, so that curvature is zero at both ends for any choice of
# alpha and beta: the distances of the three from the corner are 1 (the end), alpha and beta, in
# units of the first. Alpha and beta were chosen for the least peak curvature between the same two
# ends, among zones whose curvature changes along half the zone by at most 4 times the peak at its
# steepest: a steeper rise saves a few per cent of radius and costs any multiple of jerk. As
# functions of c = cos(half the turn) they are 1 - c A(c) and 1 - c B(c), with polynomials (ALPHA,
# BETA) fitted to within 3 % of the best peak, and such that the peak is at the via point for every
# turn below half a revolution: so the least radius is known in closed form.
ALPHA = (0.7477, -0.7612, 0.6555, -0.3403, 0.0630)
BETA = (1.9301, -2.9182, 3.3966, -2.3619, 0.7009)

# Coefficients of u, u^3, u^5 along the tangent and of u^2, u^4 along the normal; a row for each
# pair of control points.
ALONG = np.array([[5.0, 10.0, 1.0], [15.0, -10.0, -5.0], [10.0, -20.0, 10.0]]) / 16.0
ACROSS = np.array([[10.0, 5.0], [10.0, -15.0], [-20.0, 10.0]]) / 16.0

# Terms of the series of the zone's length: exact to rounding up to turns of 179 degrees.
LENGTH_TERMS = 30

# Chosen: largest number of Halley steps from length to parameter; two are taken, up to 179.9
# degrees.
INVERSIONS = 30
LAST_STEP = 1e-5  # of the parameter: the error after a step is of the order of its cube


class _Quintic(NamedTuple):
    """Coefficients of zones with least radius 1, a row for each power, a column for each zone."""

    along: Array   # of u, u^3, u^5
    across: Array  # of u^2, u^4


class PolynomialZones(ReadOnlyArrays):
    """
    Polynomial zones of least radius 1, each in a plane of its own.

    The origin of each plane is the via point, x the tangent of the path there, y the normal.

    Parameters
    ----------
    angle : array_like, shape (k,)
        Half the angle by which the path turns in each zone [rad], in (0, pi/2).

    Raises
    ------
    InvalidInputError
        If an angle is not finite.

    """

    def __init__(self, angle: ArrayLike) -> None:
        angle = finite_array('angle', angle, (-1,))
        self._quintic = _quintic(angle)
        nodes = 0.5 * (1.0 + chebyshev.chebpts1(LENGTH_TERMS))
        x, y = _derivative(self._quintic, 1, nodes[:, np.newaxis])
        series = np.linalg.solve(chebyshev.chebvander(2.0 * nodes - 1.0, LENGTH_TERMS - 1),
                                 np.hypot(x, y))
        self._length: Array = np.asarray(chebyshev.chebint(series, lbnd=-1.0, scl=0.5))
        self.before: Array = np.asarray(chebyshev.chebval(1.0, self._length))
        self.after = self.before

    @staticmethod
    def ends(angle: Array) -> tuple[Array, Array]:
        """
        Return the tangent point of a zone and the line after it.

        Parameters
        ----------
        angle : ndarray
            Half the angle by which the path turns [rad].

        Returns
        -------
        tuple of ndarray
            x and y, in least radii.

        """
        zone = _quintic(angle)
        return zone.along.sum(axis=0), zone.across.sum(axis=0)

    def outline(self, zone: IntArray, part: Array) -> tuple[Array, Array]:
        """
        Return points of zones, see `cartesian_path.Zones`.

        Parameters
        ----------
        zone : ndarray of int, shape (m,)
            Indices of the zones.
        part : ndarray, shape (m,)
            The quintic's parameter u.

        Returns
        -------
        tuple of ndarray, shape (m,)
            x and y, in least radii.

        """
        return _derivative(_Quintic(*(c[:, zone] for c in self._quintic)), 0, part)

    def at(self, zone: IntArray, sigma: Array) -> Array:
        """
        Return points of zones and their derivatives by arc length.

        Parameters
        ----------
        zone : ndarray of int, shape (m,)
            Indices of the zones.
        sigma : ndarray, shape (m,)
            Length from the via point, in least radii.

        Returns
        -------
        ndarray, shape (4, 2, m)
            x and y, and their first to third derivatives by sigma.

        Raises
        ------
        ConvergenceError
            If a length could not be inverted.

        """
        quintic = _Quintic(*(c[:, zone] for c in self._quintic))
        u = np.sign(sigma) * self._parameter(zone, quintic, np.abs(sigma))
        r0, r1, r2, r3 = (np.array(_derivative(quintic, order, u)) for order in range(4))
        rate = np.hypot(*r1)
        rate1 = (r1 * r2).sum(axis=0) / rate
        rate2 = ((r2 * r2).sum(axis=0) + (r1 * r3).sum(axis=0) - rate1 ** 2) / rate
        first = r1 / rate
        second = (r2 - first * rate1) / rate ** 2
        third = (r3 - 3.0 * second * rate * rate1 - first * rate2) / (rate * rate ** 2)
        return np.array([r0, first, second, third])

    def _parameter(self, zone: IntArray, quintic: _Quintic, sigma: Array) -> Array:
        """Return u at lengths that are not negative: Halley's method."""
        length, whole = self._length[:, zone], self.after[zone]
        u = np.minimum(sigma / whole, 1.0)
        for _ in range(INVERSIONS):
            miss = chebyshev.chebval(2.0 * u - 1.0, length, tensor=False) - sigma
            (x1, y1), (x2, y2) = (_derivative(quintic, order, u) for order in (1, 2))
            squared = x1 * x1 + y1 * y1  # of the rate of length
            part = miss / np.sqrt(squared)
            step = part / (1.0 - 0.5 * part * (x1 * x2 + y1 * y2) / squared)
            u = np.clip(u - step, 0.0, 1.0)
            if (np.abs(step) <= LAST_STEP).all():
                return u
        worst = float(np.abs(miss / whole).max())
        raise ConvergenceError(f'length along a polynomial zone is off by {worst:.3g} of it after '
                               f'{INVERSIONS} steps')


def _quintic(angle: Array) -> _Quintic:
    """Return the zone of least radius 1 for each half turn."""
    angle = np.maximum(angle, 1e-60)  # a straight zone has no length
    c, s = np.cos(angle), np.sin(angle)
    alpha = 1.0 - c * np.polynomial.polynomial.polyval(c, ALPHA)
    beta = 1.0 - c * np.polynomial.polynomial.polyval(c, BETA)
    # The curvature at u = 0 with the end at distance 1 from the corner.
    leg = 12.8 * s * (1.0 + alpha - 2.0 * beta) / (c * (1.0 + 3.0 * alpha + 2.0 * beta)) ** 2
    shape = np.stack((np.ones_like(c), alpha, beta))
    return _Quintic(leg * c * np.tensordot(ALONG.T, shape, 1),
                    leg * s * np.tensordot(ACROSS.T, shape, 1))


def _derivative(zone: _Quintic, order: int, u: Array) -> tuple[Array, Array]:
    """Return x and y, or one of their derivatives, at values of u."""
    a1, a3, a5 = zone.along
    b2, b4 = zone.across
    v = u * u
    if order == 0:
        return u * (a1 + v * (a3 + v * a5)), v * (b2 + v * b4)
    if order == 1:
        return a1 + v * (3.0 * a3 + v * 5.0 * a5), u * (2.0 * b2 + v * 4.0 * b4)
    if order == 2:
        return u * (6.0 * a3 + v * 20.0 * a5), 2.0 * b2 + 12.0 * v * b4
    return 6.0 * a3 + 60.0 * v * a5, 24.0 * u * b4
