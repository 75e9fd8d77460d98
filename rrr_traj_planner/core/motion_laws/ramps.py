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
Ramps from one acceleration to another: a half-period cycloid with a phase of constant jerk.

Jerk rises sinusoidally to its peak (first half of 3.4's half-period, 1/a = pi), is constant, and
falls likewise. The longer the constant phase, the better a jerk limit is used; jerk remains
continuous and zero at both ends.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import pi
from typing import Any, NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import InvalidInputError


class RampShape:
    """
    Normalised ramp: acceleration from 0 to 1 over a normalised time from 0 to 1.

    Parameters
    ----------
    constant_jerk_fraction : float
        Fraction of the duration with constant jerk, in [0, 1); 0: a half-period.

    Attributes
    ----------
    peak_jerk : float
        Largest jerk of the normalised ramp: pi / 2 for a half-period, towards 1 for a larger
        fraction of constant jerk.

    Raises
    ------
    InvalidInputError
        If the fraction is not in [0, 1).

    """

    def __init__(self, constant_jerk_fraction: float = 0.0) -> None:
        if not 0.0 <= constant_jerk_fraction < 1.0:
            raise InvalidInputError(
                f'constant_jerk_fraction is {constant_jerk_fraction}, must be in [0, 1)')
        self.constant_jerk_fraction = constant_jerk_fraction
        self._rise = 0.5 * (1.0 - constant_jerk_fraction)
        self._rate = 0.5 * pi / self._rise      # angular frequency while jerk rises
        self.peak_jerk = 1.0 / (constant_jerk_fraction + 4.0 * self._rise / pi)
        # acceleration at the end of the rising jerk, and its integral until then
        self._part = self.peak_jerk / self._rate
        self._first = self._part * (self._rise - 1.0 / self._rate)
        self._half = float(self._early(np.array(0.5))[0])

    def __call__(self, s: Any) -> tuple[Array, Array, Array, Array]:
        """
        Return the normalised acceleration, its integrals and its derivative.

        Parameters
        ----------
        s : array_like
            Normalised time, in [0, 1].

        Returns
        -------
        tuple of ndarray
            Second integral, first integral, acceleration (from 0 to 1), derivative.

        """
        s = np.asarray(s, dtype=float)
        late, beyond = s > 0.5, s - 0.5
        # point symmetry about the middle
        second, first, part, rate = self._early(np.where(late, 1.0 - s, s))
        return (np.where(late, 2.0 * self._half + 0.5 * beyond ** 2 - second, second),
                np.where(late, beyond + first, first), np.where(late, 1.0 - part, part), rate)

    def reached(self, part: Any) -> Array:
        """
        Return the times at which normalised accelerations are reached.

        Parameters
        ----------
        part : array_like
            In [0, 1].

        Returns
        -------
        ndarray
            Normalised times, in [0, 1].

        """
        part = np.asarray(part, dtype=float)
        nearer = np.minimum(part, 1.0 - part)
        cosine = 1.0 - np.minimum(nearer, self._part) / self._part
        s = np.arccos(cosine) / self._rate + np.maximum(nearer - self._part, 0.0) / self.peak_jerk
        return np.asarray(np.where(part > 0.5, 1.0 - s, s))

    def _early(self, s: Array) -> tuple[Array, Array, Array, Array]:
        """Return the four values in the first half."""
        early, w = np.minimum(s, self._rise), np.maximum(s - self._rise, 0.0)  # rising, cruising
        phase = self._rate * early
        sine = np.sin(phase)
        versine = 2.0 * np.sin(0.5 * phase) ** 2  # 1 - cos, exact near 0
        jerk, part = self.peak_jerk, self._part
        return (part * (0.5 * early ** 2 - versine / self._rate ** 2)
                + w * (self._first + w * (0.5 * part + jerk / 6.0 * w)),
                part * (early - sine / self._rate) + w * (part + 0.5 * jerk * w),
                part * versine + jerk * w, jerk * sine)


class Ramps(NamedTuple):
    """One ramp of a joint's motion, or several, all of one shape; implements `Pieces`."""

    duration: Any      # [s]
    position: Any      # at s = 0 [rad]
    velocity: Any      # at s = 0 [rad/s]
    acceleration: Any  # at s = 0 [rad/s^2]
    rise: Any          # of acceleration, until s = 1 [rad/s^2]
    shape: RampShape

    def at(self, s: Any) -> tuple[Array, Array, Array, Array]:
        """
        Return position, velocity, acceleration and jerk; see `Pieces`.

        Parameters
        ----------
        s : array_like
            In [0, 1], of a shape that broadcasts with the values.

        Returns
        -------
        tuple of ndarray
            [rad], [rad/s], [rad/s^2], [rad/s^3].

        """
        T, v, a, rise = self.duration, self.velocity, self.acceleration, self.rise
        second, first, part, rate = self.shape(s)
        return (self.position + T * (v * s + T * (0.5 * a * s * s + rise * second)),
                v + T * (a * s + rise * first), a + rise * part, rise / T * rate)

    def parameters(self) -> dict[str, Any]:
        """Return every value by its name; see `Pieces`."""
        return {'duration': self.duration, 'position': self.position, 'velocity': self.velocity,
                'acceleration': self.acceleration, 'rise': self.rise}

    def with_parameters(self, parameters: Iterable[Any]) -> Ramps:
        """
        Return pieces of the same type with other values; see `Pieces`.

        Parameters
        ----------
        parameters : iterable
            Durations, positions, velocities, accelerations and rises.

        Returns
        -------
        Ramps
            The ramps.

        """
        duration, position, velocity, acceleration, rise = parameters
        return Ramps(duration, position, velocity, acceleration, rise, self.shape)

    def time_scaled(self, factor: float) -> Ramps:
        """
        Return the pieces with time scaled by a factor, positions unchanged; see `Pieces`.

        Parameters
        ----------
        factor : float
            New over old duration, positive.

        Returns
        -------
        Ramps
            The ramps.

        """
        return Ramps(self.duration * factor, self.position, self.velocity / factor,
                     self.acceleration / factor ** 2, self.rise / factor ** 2, self.shape)

    def turning_points(self) -> Array:
        """Return the ends and the zero of the acceleration, shape (n, 3); see `Pieces`."""
        part = np.divide(-self.acceleration, self.rise, out=np.zeros(np.shape(self.rise)),
                         where=self.rise != 0.0)
        zero = self.shape.reached(np.clip(part, 0.0, 1.0))
        return np.stack((np.zeros_like(zero), zero, np.ones_like(zero)), axis=-1)

    def peaks(self) -> tuple[Array, Array]:
        """Return the largest magnitudes of acceleration and of jerk; see `Pieces`."""
        return (np.maximum(np.abs(self.acceleration), np.abs(self.acceleration + self.rise)),
                self.shape.peak_jerk * np.abs(self.rise) / self.duration)
