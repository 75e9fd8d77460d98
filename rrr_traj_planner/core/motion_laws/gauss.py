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
Gauss's function as the acceleration of a transition (3.1-3.3, appendix A), with mu = 1/2.

A Gauss function is nowhere 0: its value at the transition's ends, k sigma from the middle, is
subtracted, as by the thesis's constant C0 (A.5), and the result scaled to the change of velocity.
So acceleration is continuous; jerk steps at the ends, less for larger k, for which the transition
takes longer.
"""

from __future__ import annotations

from math import exp, pi, sqrt
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.conversion import float_array
from rrr_traj_planner.core.errors import InvalidInputError, shown
from rrr_traj_planner.core.motion_laws.transition_shape import Curve, TransitionShape
from rrr_traj_planner.core.scalars import positive, whole_number
from scipy.special import erf

# k [sigma], of appendix A: up to it the Maclaurin series needs order 9 for an error below a
# thousandth of the peak, the accuracy required there.
HALF_WIDTH = 2.0

# Range of half widths [sigma] outside which rounding spoils the lowered function or its powers
# overflow, and the highest order, whose last coefficient is 1e-188.
LEAST_WIDTH, MOST_WIDTH, MOST_ORDER = 0.1, 100.0, 100


def maclaurin(u: Any, order: int) -> Array:
    """
    Return the Maclaurin series of exp(-u^2 / 2) (3.3, whose sum starts at n = 0).

    Parameters
    ----------
    u : array_like
        (t - mu) / sigma.
    order : int
        N of the last term, of degree 2 N in u.

    Returns
    -------
    ndarray
        The sum.

    Raises
    ------
    InvalidInputError
        If the order is negative or above 100, or the sum is too large for a float.

    """
    u = float_array('u', u)
    with np.errstate(over='ignore', invalid='ignore'):
        found = np.asarray(_series(order)(u))
    if not np.isfinite(found).all():
        raise InvalidInputError(f'u is {shown(u.tolist())}, must be finite and small enough for '
                                f'a series of order {order}')
    return found


def maclaurin_error(order: int, half_width: float = HALF_WIDTH) -> float:
    """
    Return the largest error of the series, relative to the peak of Gauss's function.

    Parameters
    ----------
    order : int
        N of the last term.
    half_width : float
        Largest |u|, where the error is largest: the rest of the series of exp(-x) grows with x.

    Returns
    -------
    float
        The error.

    Raises
    ------
    InvalidInputError
        If the order is negative or above 100, or the half width not within 0.1 and 100.

    """
    half_width = _width(half_width)
    return float(abs(maclaurin(half_width, order) - exp(-0.5 * half_width ** 2)))


def gauss(half_width: float = HALF_WIDTH, order: int | None = None) -> TransitionShape:
    """
    Return the transition whose acceleration is a Gauss function, lowered to 0 at its ends.

    Parameters
    ----------
    half_width : float
        k, distance of the ends from the middle [sigma].
    order : int, optional
        N of the thesis's series (A.2-A.4), used instead of the function; None: closed form, with
        erf.

    Returns
    -------
    TransitionShape
        With its peak jerk in closed form: at one sigma from the middle.

    Raises
    ------
    InvalidInputError
        If the half width is not within 0.1 and 100, or the series of this order, of at most 100,
        does not fall from its middle to its ends.

    """
    half_width = _width(half_width)
    if order is None:
        steepest = min(1.0, half_width)
        return _truncated('gauss', half_width, steepest, (
            _gauss, _first_integral, _second_integral, _slope))
    series = _series(order)
    slope = series.deriv()
    turns = np.concatenate((_inner_zeros(slope.deriv(), half_width), [half_width]))
    steepest = float(turns[np.abs(slope(turns)).argmax()])
    if order < 1 or slope(half_width) >= 0.0 or len(_inner_zeros(slope, half_width)):
        raise InvalidInputError(
            f'order {order} of the series does not fall up to {half_width} sigma')
    first = series.integ()
    return _truncated(f'gauss of order {order}', half_width, steepest,
                      (series, first, first.integ(), slope))


def _truncated(name: str, k: float, steepest: float,
               curves: tuple[Curve, Curve, Curve, Curve]) -> TransitionShape:
    """Return the shape of an even function of u, its odd and even integrals and its slope."""
    value, slope = curves[0], curves[3]
    truncated = _Truncated(k, *curves)
    return TransitionShape(
        name, truncated.acceleration, truncated.velocity, truncated.position, truncated.jerk,
        peak_acceleration=truncated.width / truncated.area * (float(value(0.0)) - truncated.end),
        peak_jerk=truncated.width ** 2 / truncated.area * abs(float(slope(steepest))))


class _Truncated:
    """An even function of u, less its value at u = -k and k, as a function of s in [0, 1]."""

    def __init__(self, k: float, value: Curve, first: Curve, second: Curve,
                 slope: Curve) -> None:
        self.k, self.width = k, 2.0 * k  # in sigma: u = width (s - 1/2)
        self.value, self.first, self.second, self.slope = value, first, second, slope
        self.end, self.first_end, self.second_end = (
            float(curve(k)) for curve in (value, first, second))
        self.area = float(self.velocity_gain(k))

    def velocity_gain(self, u: Any) -> Any:
        return self.first(u) + self.first_end - self.end * (u + self.k)

    def acceleration(self, s: Any) -> Any:
        return self.width / self.area * (self.value(self.k * (2.0 * s - 1.0)) - self.end)

    def velocity(self, s: Any) -> Any:
        return self.velocity_gain(self.k * (2.0 * s - 1.0)) / self.area

    def position(self, s: Any) -> Any:
        rise = self.second(self.k * (2.0 * s - 1.0)) - self.second_end
        return (rise + self.first_end * self.width * s
                - 0.5 * self.end * (self.width * s) ** 2) / (self.width * self.area)

    def jerk(self, s: Any) -> Any:
        return self.width ** 2 / self.area * self.slope(self.k * (2.0 * s - 1.0))


def _gauss(u: Any) -> Array:
    return np.asarray(np.exp(-0.5 * u * u))


def _slope(u: Any) -> Array:
    return np.asarray(-u * _gauss(u))


def _first_integral(u: Any) -> Array:
    return np.asarray(sqrt(0.5 * pi) * erf(u * sqrt(0.5)))


def _second_integral(u: Any) -> Array:
    return np.asarray(u * _first_integral(u) + _gauss(u))


def _series(order: int) -> Polynomial:
    """Return sum (-1/2)^n u^2n / n! up to n = order."""
    order = whole_number('order', order, least=0)
    if order > MOST_ORDER:
        raise InvalidInputError(f'order is {shown(order)}, must be at most {MOST_ORDER}')
    coefficients, term = np.zeros(2 * order + 1), 1.0
    for n in range(order + 1):
        coefficients[2 * n] = term
        term *= -0.5 / (n + 1)
    return Polynomial(coefficients)


def _width(half_width: Any) -> float:
    """Return a half width if it is in the range in which floats are accurate [sigma]."""
    width = positive('half_width', half_width, 'sigma')
    if LEAST_WIDTH <= width <= MOST_WIDTH:
        return width
    raise InvalidInputError(
        f'half_width is {width} sigma, must be in [{LEAST_WIDTH}, {MOST_WIDTH}] sigma')


def _inner_zeros(polynomial: Polynomial, end: float) -> Array:
    """Return the zeros of a polynomial strictly between 0 and an end."""
    zeros = polynomial.roots()
    # Rounding of zeros: imaginary part of a real one, distance of another from 0.
    real = zeros.real[np.abs(zeros.imag) < 1e-9]
    return np.asarray(real[(real > 1e-6) & (real < end)])


GAUSS = gauss()
