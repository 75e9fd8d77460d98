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
The 4-3-4 law: a quartic lift-off, a cubic cruise and a quartic set-down, from rest to rest.

After Lin et al. (thesis, sections 2.2.2 and 4.2, c; [30] in a list of references that we do not
have). The 14 conditions are those of the textbook: Fu, Gonzalez & Lee, Robotics, McGraw-Hill 1987,
section 4.3 (joint-interpolated trajectories). Over a normalised time u in [0, 1] a normalised
position goes from 0 to 1. The three polynomials have 14 coefficients; 14 conditions give them:
rest at both ends (position, velocity, acceleration: 6), both joins' positions from either side
(4), velocity and acceleration continuous at both joins (4).
Lin prescribes the joins' times and positions. Here the accelerations at the joins are prescribed
instead of the positions, with which they are in one-to-one relation; the conditions then have a
closed-form solution:

    lift-off, x = u / first        a(x) =  a1 x + k1 x (1 - x),  k1 = 6 v1 / first - 3 a1
    cruise, x from 0 to 1          a(x) =  a1 + (a2 - a1) x
    set-down, x = (1 - u) / last   a(x) =  a2 x - k2 x (1 - x),  k2 = 6 v2 / last + 3 a2

Position, velocity and acceleration are continuous; jerk, linear in lift-off and set-down, constant
in the cruise, steps at both ends and at both joins.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.motion_laws.polynomial_piece import PolynomialPiece


class Lin434(NamedTuple):
    """
    One law, or several at once; time in durations, position in displacements.

    Fields are floats or arrays that broadcast. `first` and `last` are positive, their sum below 1.
    """

    first: Any  # fraction of the duration for the lift-off
    last: Any   # for the set-down
    a1: Any     # acceleration at the end of lift-off
    a2: Any     # at the start of set-down, mostly negative

    @property
    def cruise(self) -> Any:
        """Fraction of the duration for the cruise."""
        return 1.0 - self.first - self.last

    @property
    def v1(self) -> Any:
        """Velocity at the end of lift-off, for which the total displacement is 1."""
        first, last, cruise = self.first, self.last, self.cruise
        by_acceleration = (self.a1 * (4.0 * cruise ** 2 - first ** 2)
                           + self.a2 * (2.0 * cruise ** 2 + last ** 2)
                           + 3.0 * (self.a1 + self.a2) * cruise * last)
        return (12.0 - by_acceleration) / (6.0 * (first + 2.0 * cruise + last))

    @property
    def v2(self) -> Any:
        """Velocity at the start of set-down."""
        return self.v1 + 0.5 * self.cruise * (self.a1 + self.a2)

    @property
    def k1(self) -> Any:
        """Coefficient k1 of the lift-off's acceleration."""
        return _quadratic_coefficient(self.first, self.a1, self.v1)

    @property
    def k2(self) -> Any:
        """Coefficient k2 of the set-down's acceleration."""
        return _quadratic_coefficient(self.last, -self.a2, self.v2)

    @property
    def lift_off(self) -> Any:
        """Position at the end of lift-off, Lin's lift-off point."""
        return self.first * (6.0 * self.v1 - self.first * self.a1) / 12.0

    @property
    def set_down(self) -> Any:
        """Displacement from the start of set-down, Lin's set-down point, to the end."""
        return self.last * (6.0 * self.v2 + self.last * self.a2) / 12.0

    @property
    def backwards(self) -> Lin434:
        """Return the law reversed in time."""
        return Lin434(self.last, self.first, -self.a2, -self.a1)

    def velocities(self) -> Array:
        """
        Return candidates for the largest velocity.

        Returns
        -------
        ndarray, shape (3,) + that of the fields
            At the zero of the acceleration in lift-off, cruise and set-down, or at an end.

        """
        turn = -self.a1 / _nonzero(self.a2 - self.a1)
        x = np.clip(turn, 0.0, 1.0)
        level = self.v1 + self.cruise * x * (self.a1 + 0.5 * (self.a2 - self.a1) * x)
        return np.stack((_velocity(self.first, self.a1, self.v1), level + 0.0 * self.v1,
                         _velocity(self.last, -self.a2, self.v2)))

    def accelerations(self) -> Array:
        """
        Return candidates for the acceleration of largest magnitude.

        Returns
        -------
        ndarray, shape (4,) + that of the fields
            The extremes within lift-off and set-down, and at both joins.

        """
        return np.stack(np.broadcast_arrays(
            _extreme(self.first, self.a1, self.v1), self.a1, self.a2,
            -_extreme(self.last, -self.a2, self.v2)))

    def jerks(self) -> Array:
        """
        Return candidates for the jerk of largest magnitude.

        Returns
        -------
        ndarray, shape (5,) + that of the fields
            At both ends of lift-off, in the cruise, at both ends of set-down.

        """
        k1, k2 = self.k1, self.k2
        return np.stack(np.broadcast_arrays(
            (self.a1 + k1) / self.first, (self.a1 - k1) / self.first,
            (self.a2 - self.a1) / self.cruise,
            -(self.a2 + k2) / self.last, (k2 - self.a2) / self.last))

    def pieces(self, duration: Any, start: Any, displacement: Any) -> tuple[
            PolynomialPiece, PolynomialPiece, PolynomialPiece]:
        """
        Return motions by this law.

        Parameters
        ----------
        duration : float or ndarray
            [s].
        start, displacement : float or ndarray
            [rad]; values broadcast with the law's fields.

        Returns
        -------
        tuple of PolynomialPiece
            Lift-off, cruise, set-down.

        """
        T, D, zero = duration, displacement, 0.0 * displacement
        first, last, cruise, k1, k2 = self.first, self.last, self.cruise, self.k1, self.k2
        velocity, acceleration, jerk, snap = D / T, D / T ** 2, D / T ** 3, D / T ** 4
        return (
            PolynomialPiece(first * T, start, zero, zero, (self.a1 + k1) / first * jerk,
                            -2.0 * k1 / first ** 2 * snap),
            PolynomialPiece(cruise * T, start + D * self.lift_off, self.v1 * velocity,
                            self.a1 * acceleration, (self.a2 - self.a1) / cruise * jerk, zero),
            PolynomialPiece(last * T, start + D * (1.0 - self.set_down), self.v2 * velocity,
                            self.a2 * acceleration, -(self.a2 + k2) / last * jerk,
                            2.0 * k2 / last ** 2 * snap))


def _quadratic_coefficient(part: Any, a: Any, v: Any) -> Any:
    """Return k of a lift-off over a fraction of the duration, with a and v at its end."""
    return 6.0 * v / part - 3.0 * a


def _extreme(part: Any, a: Any, v: Any) -> Array:
    """Return the extreme of a x + k x (1 - x) in [0, 1]; at x = 1 where there is none between."""
    k = _quadratic_coefficient(part, a, v)
    x = (a + k) / _nonzero(2.0 * k)
    x = np.where((x > 0.0) & (x < 1.0), x, 1.0)
    return np.asarray(x * (a + k * (1.0 - x)))


def _velocity(part: Any, a: Any, v: Any) -> Array:
    """Return the velocity where a x + k x (1 - x) is 0 in (0, 1]; at x = 1 where it is not."""
    k = _quadratic_coefficient(part, a, v)
    x = 1.0 + a / _nonzero(k)
    x = np.where((x > 0.0) & (x < 1.0), x, 1.0)
    return np.asarray(part * x * x * (0.5 * (a + k) - k * x / 3.0))


def _nonzero(value: Any) -> Array:
    """Return a divisor, infinite instead of 0 (the quotient is then not used)."""
    return np.where(value == 0.0, np.inf, value)
