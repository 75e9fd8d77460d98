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

"""Polynomial pieces of a joint's motion, of fourth degree in time at most."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array


class PolynomialPiece(NamedTuple):
    """One piece, or several; implements `Pieces`. Derivatives by time at the piece's start."""

    duration: Any      # [s]
    position: Any      # [rad]
    velocity: Any      # [rad/s]
    acceleration: Any  # [rad/s^2]
    jerk: Any          # [rad/s^3]
    snap: Any          # constant [rad/s^4], 0 for a cubic

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
        _, p, v, a, j, n = self
        t = self.duration * s
        return (p + t * (v + t * (a / 2.0 + t * (j / 6.0 + t * n / 24.0))),
                v + t * (a + t * (j / 2.0 + t * n / 6.0)),
                a + t * (j + t * n / 2.0), j + t * n)

    def parameters(self) -> dict[str, Any]:
        """Return every value by its name; see `Pieces`."""
        return self._asdict()

    def with_parameters(self, parameters: Iterable[Any]) -> PolynomialPiece:
        """
        Return pieces of the same type with other values; see `Pieces`.

        Parameters
        ----------
        parameters : iterable
            The values, in the order of the fields.

        Returns
        -------
        PolynomialPiece
            The pieces.

        """
        return PolynomialPiece(*parameters)

    def time_scaled(self, factor: float) -> PolynomialPiece:
        """
        Return the pieces with time scaled by a factor, positions unchanged; see `Pieces`.

        Parameters
        ----------
        factor : float
            New over old duration, positive.

        Returns
        -------
        PolynomialPiece
            The pieces.

        """
        duration, position, *rates = self
        return PolynomialPiece(duration * factor, position, *(
            rate / factor ** order for order, rate in enumerate(rates, 1)))

    def turning_points(self) -> Array:
        """Return the ends and the zeros of the acceleration, shape (n, 4); see `Pieces`."""
        # Roots of a + j T s + n (T s)^2 / 2, the one without cancellation first.
        T, half = self.duration, 0.5 * self.snap * self.duration ** 2
        slope = self.jerk * T
        root = np.sqrt(np.maximum(slope ** 2 - 4.0 * half * self.acceleration, 0.0))
        large = -0.5 * (slope + np.where(slope < 0.0, -root, root))
        with np.errstate(divide='ignore', invalid='ignore'):
            zeros = np.stack((large / half, self.acceleration / large), axis=-1)
        zeros = np.sort(np.clip(np.where(np.isfinite(zeros), zeros, 0.0), 0.0, 1.0), axis=-1)
        start = np.zeros(zeros.shape[:-1] + (1,))
        return np.concatenate((start, zeros, start + 1.0), axis=-1)

    def peaks(self) -> tuple[Array, Array]:
        """Return the largest magnitudes of acceleration and of jerk; see `Pieces`."""
        T, _, _, a, j, n = self
        end = j + T * n
        with np.errstate(divide='ignore', invalid='ignore'):
            turning = np.where(j * end < 0.0, a - 0.5 * j * j / n, a)  # where jerk is zero
        return (np.abs([a, turning, a + 0.5 * T * (j + end)]).max(axis=0),
                np.abs([j, end]).max(axis=0))
