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

"""Transitions defined by an acceleration over normalised time and its closed-form integrals."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array

Curve = Callable[[Any], Any]  # of floats or arrays


class TransitionShape(NamedTuple):
    """
    A normalised transition: duration 1, change of velocity 1; implements `TransitionFunction`.

    Its acceleration is 0 at both ends of [0, 1], symmetric, never negative, and of integral 1.
    """

    name: str
    acceleration: Curve
    velocity: Curve           # integral of the acceleration: from 0 to 1
    position: Curve           # integral of the velocity: from 0 to 1/2
    jerk: Curve               # derivative of the acceleration
    peak_acceleration: float  # half-way
    peak_jerk: float

    def transition(self, duration: Any, position: Any, velocity: Any,
                   end_velocity: Any) -> ShapedPiece:
        """
        Return a transition of this shape.

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
        ShapedPiece
            Displacement duration * (velocity + end_velocity) / 2.

        """
        return ShapedPiece(duration, position, velocity, end_velocity - velocity, self)

    def cruise(self, duration: Any, position: Any, velocity: Any) -> ShapedPiece:
        """
        Return a piece at constant velocity.

        Parameters
        ----------
        duration, position, velocity : float or ndarray
            [s], and at the start [rad, rad/s].

        Returns
        -------
        ShapedPiece
            The piece.

        """
        return ShapedPiece(duration, position, velocity, 0.0 * velocity, self)


class ShapedPiece(NamedTuple):
    """A transition or a cruise, or several; implements `Pieces`."""

    duration: Any   # [s]
    position: Any   # at s = 0 [rad]
    velocity: Any   # at s = 0 [rad/s]
    change: Any     # of velocity, over the whole piece [rad/s]
    shape: TransitionShape

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
        T, change, shape = self.duration, self.change, self.shape
        position = self.position + T * (self.velocity * s + change * shape.position(s))
        velocity = self.velocity + change * shape.velocity(s)
        mean = change / T
        return position, velocity, mean * shape.acceleration(s), mean / T * shape.jerk(s)

    def parameters(self) -> dict[str, Any]:
        """Return every value by its name; see `Pieces`."""
        return {'duration': self.duration, 'position': self.position, 'velocity': self.velocity,
                'change': self.change}

    def with_parameters(self, parameters: Iterable[Any]) -> ShapedPiece:
        """
        Return pieces of the same type with other values; see `Pieces`.

        Parameters
        ----------
        parameters : iterable
            Durations, positions, velocities and changes of velocity.

        Returns
        -------
        ShapedPiece
            The pieces.

        """
        duration, position, velocity, change = parameters
        return ShapedPiece(duration, position, velocity, change, self.shape)

    def time_scaled(self, factor: float) -> ShapedPiece:
        """
        Return the pieces with time scaled by a factor, positions unchanged; see `Pieces`.

        Parameters
        ----------
        factor : float
            New over old duration, positive.

        Returns
        -------
        ShapedPiece
            The pieces.

        """
        return ShapedPiece(self.duration * factor, self.position, self.velocity / factor,
                           self.change / factor, self.shape)

    def turning_points(self) -> Array:
        """Return both ends: between them velocity is monotone; see `Pieces`."""
        start = np.zeros_like(self.duration)
        return np.stack((start, start + 1.0), axis=-1)

    def peaks(self) -> tuple[Array, Array]:
        """Return the largest magnitudes of acceleration and of jerk; see `Pieces`."""
        mean = np.abs(self.change) / self.duration
        return mean * self.shape.peak_acceleration, mean / self.duration * self.shape.peak_jerk
