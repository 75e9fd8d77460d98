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
The cycloid: pieces whose acceleration is c - b cos(w s), s in [0, 1] (3.4-3.7, 4.3-4.5).

Full-period transitions, general ones between non-zero accelerations, half-period ramps and
cruises are all such pieces. Fields of a piece may be floats or arrays of one shape.
`general_transition` is part of the library; no planner calls it.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import acos, pi
from typing import Any, NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import InvalidInputError


class CycloidPiece(NamedTuple):
    """
    One piece of a joint's motion over a normalised time s = t / duration in [0, 1].

    The thesis's a is 1 / w; its b and c are these times the duration squared: here they are
    accelerations.
    """

    duration: Any   # [s]
    position: Any   # at s = 0 [rad]
    velocity: Any   # at s = 0 [rad/s]
    c: Any          # mean acceleration of a full period [rad/s^2]
    b: Any          # amplitude [rad/s^2]
    w: Any          # phase that the piece runs through [rad]

    def at(self, s: Any) -> tuple[Array, Array, Array, Array]:
        """
        Return position, velocity, acceleration and jerk (4.3-4.5).

        Parameters
        ----------
        s : array_like
            Normalised times in [0, 1], of a shape that broadcasts with the fields.

        Returns
        -------
        tuple of ndarray
            Position [rad], velocity [rad/s], acceleration [rad/s^2], jerk [rad/s^3].

        """
        T, w, phase = self.duration, self.w, self.w * s
        sine, versine = np.sin(phase), _versine(phase)
        velocity = self.velocity + T * (self.c * s - self.b / w * sine)
        position = self.position + T * (
            self.velocity * s + T * (0.5 * self.c * s * s - self.b / w ** 2 * versine))
        return position, velocity, self._acceleration(versine), self._peak_jerk * sine

    def _acceleration(self, versine: Any) -> Any:
        return (self.c - self.b) + self.b * versine

    @property
    def _peak_jerk(self) -> Any:
        """Of a full period [rad/s^3]."""
        return self.b * self.w / self.duration

    def parameters(self) -> dict[str, Any]:
        """Return every value by its name; see `Pieces`."""
        return self._asdict()

    def with_parameters(self, parameters: Iterable[Any]) -> CycloidPiece:
        """
        Return pieces of the same type with other values; see `Pieces`.

        Parameters
        ----------
        parameters : iterable
            The values, in the order of the fields.

        Returns
        -------
        CycloidPiece
            The pieces.

        """
        return CycloidPiece(*parameters)

    def time_scaled(self, factor: float) -> CycloidPiece:
        """
        Return the pieces with time scaled by a factor, positions unchanged; see `Pieces`.

        Parameters
        ----------
        factor : float
            New over old duration, positive.

        Returns
        -------
        CycloidPiece
            The pieces.

        """
        return CycloidPiece(self.duration * factor, self.position, self.velocity / factor,
                            self.c / factor ** 2, self.b / factor ** 2, self.w)

    def turning_points(self) -> Array:
        """Return the ends and the zeros of the acceleration, shape (n, 4); see `Pieces`."""
        ratio = np.divide(self.c, self.b, out=np.full(np.shape(self.b), 2.0),
                          where=self.b != 0.0)
        phase = np.arccos(np.clip(ratio, -1.0, 1.0))
        first = np.minimum(phase / self.w, 1.0)
        second = np.minimum((2.0 * pi - phase) / self.w, 1.0)
        return np.stack((np.zeros_like(first), first, second, np.ones_like(first)), axis=-1)

    def peaks(self) -> tuple[Array, Array]:
        """Return the largest magnitudes of acceleration and of jerk; see `Pieces`."""
        w, jerk = self.w, self._peak_jerk
        return (_largest(self._acceleration(_versine(phase))
                         for phase in (0.0, np.minimum(pi, w), w)),
                _largest(jerk * np.sin(np.minimum(phase, w)) for phase in (0.5 * pi, 1.5 * pi)))


def transition(duration: Any, position: Any, velocity: Any, end_velocity: Any) -> CycloidPiece:
    """
    Return a full-period transition: zero acceleration and jerk at both ends (4.7-4.9).

    Parameters
    ----------
    duration : float or ndarray
        [s].
    position, velocity : float or ndarray
        At the start [rad, rad/s].
    end_velocity : float or ndarray
        [rad/s].

    Returns
    -------
    CycloidPiece
        Displacement duration * (velocity + end_velocity) / 2; peak acceleration
        2 |change of velocity| / duration; peak jerk 2 pi |change of velocity| / duration^2.

    """
    mean = (end_velocity - velocity) / duration
    return CycloidPiece(duration, position, velocity, mean, mean, 2.0 * pi + 0.0 * mean)


def cruise(duration: Any, position: Any, velocity: Any) -> CycloidPiece:
    """
    Return a piece at constant velocity (4.11-4.13).

    Parameters
    ----------
    duration, position, velocity : float or ndarray
        [s], and at the start [rad, rad/s].

    Returns
    -------
    CycloidPiece
        The piece.

    """
    zero = 0.0 * (duration + position + velocity)
    return CycloidPiece(duration, position, velocity, zero, zero, 2.0 * pi + zero)


def ramp(duration: Any, position: Any, velocity: Any, start_acceleration: Any,
         end_acceleration: Any) -> CycloidPiece:
    """
    Return a half-period ramp from one acceleration to another, jerk zero at both ends.

    Parameters
    ----------
    duration, position, velocity : float or ndarray
        [s], and at the start [rad, rad/s].
    start_acceleration, end_acceleration : float or ndarray
        [rad/s^2].

    Returns
    -------
    CycloidPiece
        Peak jerk pi |change of acceleration| / (2 duration).

    """
    half_rise = 0.5 * (end_acceleration - start_acceleration)
    return CycloidPiece(duration, position, velocity, start_acceleration + half_rise, half_rise,
                        pi + 0.0 * half_rise)


def general_transition(position: float, velocity: float, end_velocity: float,
                       start_acceleration: float, end_acceleration: float,
                       peak_acceleration: float) -> CycloidPiece:
    """
    Return a transition between given accelerations through a given peak (4.6 corrected).

    Parameters
    ----------
    position, velocity : float
        At the start [rad, rad/s].
    end_velocity : float
        [rad/s].
    start_acceleration, end_acceleration : float
        [rad/s^2].
    peak_acceleration : float
        The acceleration at the peak [rad/s^2], signed. Within one period the acceleration is
        never on the other side of its start value.

    Returns
    -------
    CycloidPiece
        With cos(1/a) = 1 - 2 (end - start) / (peak - start); the change of velocity determines
        its duration.

    Raises
    ------
    InvalidInputError
        If the end acceleration does not lie between start and peak, or no positive duration
        gives the change of velocity.

    """
    rise, change = peak_acceleration - start_acceleration, end_velocity - velocity
    fraction = (end_acceleration - start_acceleration) / rise if rise != 0.0 else -1.0
    if not 0.0 <= fraction <= 1.0:
        raise InvalidInputError(
            f'end acceleration {end_acceleration} rad/s^2 must lie between the start, '
            f'{start_acceleration} rad/s^2, and the peak beyond it, {peak_acceleration} rad/s^2')
    w = 2.0 * pi - acos(1.0 - 2.0 * fraction)
    b, c = 0.5 * rise, start_acceleration + 0.5 * rise
    mean = c - b * float(np.sin(w)) / w
    if change * mean <= 0.0:
        raise InvalidInputError(
            f'a change of velocity of {change} rad/s has no transition of mean acceleration '
            f'{mean} rad/s^2')
    return CycloidPiece(change / mean, position, velocity, c, b, w)


def _versine(phase: Any) -> Any:
    """Return 1 - cos, exact near 0."""
    return 2.0 * np.sin(0.5 * phase) ** 2


def _largest(values: Any) -> Array:
    return np.asarray(np.max(np.abs(np.stack(list(values))), axis=0))
