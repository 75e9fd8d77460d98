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

"""Interfaces: pieces of one joint's motion, and transition functions that make them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Protocol

from rrr_traj_planner.core.arrays import Array


class Pieces(Protocol):
    """
    One piece of a joint's motion, or several at once, over a normalised time s in [0, 1].

    Values are floats or arrays of one shape.
    """

    @property
    def duration(self) -> Any:
        """Length of time [s]."""

    def at(self, s: Any) -> tuple[Array, Array, Array, Array]:
        """
        Return position, velocity, acceleration and jerk at normalised times.

        Parameters
        ----------
        s : array_like
            In [0, 1], of a shape that broadcasts with the values.

        Returns
        -------
        tuple of ndarray
            [rad], [rad/s], [rad/s^2], [rad/s^3].

        """

    def parameters(self) -> dict[str, Any]:
        """Return the parameters of the pieces by name."""

    def with_parameters(self, parameters: Iterable[Any]) -> Pieces:
        """
        Return pieces of the same type with other values.

        Parameters
        ----------
        parameters : iterable
            Their values, in the order of `parameters`.

        Returns
        -------
        Pieces
            The pieces.

        """

    def time_scaled(self, factor: float) -> Pieces:
        """
        Return the pieces with time scaled by a factor, positions unchanged.

        Parameters
        ----------
        factor : float
            New over old duration, positive.

        Returns
        -------
        Pieces
            The pieces.

        """

    def turning_points(self) -> Array:
        """Return the normalised times from 0 to 1, (n, m), between which velocity is monotone."""

    def peaks(self) -> tuple[Array, Array]:
        """Return the largest magnitudes of acceleration and of jerk, exactly, shape (n,)."""


class TransitionFunction(Protocol):
    """
    A law of motion from one velocity to another, with zero acceleration at both ends.

    Acceleration is symmetric in time, so that the displacement is duration * (velocity +
    end_velocity) / 2, and does not change sign, so that velocity is monotone.
    """

    @property
    def name(self) -> str:
        """Return the name of the function."""

    @property
    def peak_acceleration(self) -> float:
        """Peak acceleration in units of change of velocity / duration."""

    @property
    def peak_jerk(self) -> float:
        """Peak jerk in units of change of velocity / duration squared."""

    def transition(self, duration: Any, position: Any, velocity: Any,
                   end_velocity: Any) -> Pieces:
        """
        Return a transition.

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
        Pieces
            Displacement duration * (velocity + end_velocity) / 2.

        """

    def cruise(self, duration: Any, position: Any, velocity: Any) -> Pieces:
        """
        Return a piece at constant velocity, of the same kind as transitions.

        Parameters
        ----------
        duration : float or ndarray
            [s].
        position, velocity : float or ndarray
            At the start [rad, rad/s].

        Returns
        -------
        Pieces
            The piece.

        """
