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

"""A joint's motion in consecutive pieces, with its extremes."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, finite_array, IntArray
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.read_only import make_read_only, ReadOnlyArrays
from rrr_traj_planner.core.trajectory.pieces import Pieces
from rrr_traj_planner.core.trajectory.trajectory import time_factor

# Safeguarded Newton iteration for zeros in [0, 1] (Press et al., Numerical Recipes, section 9.4):
# a step that leaves the bracket is replaced by a bisection. At a zero of velocity an error e of
# the normalised time changes the position by O(e^2).
MOST_STEPS = 60        # chosen: bisections alone would reach 1e-18
ZERO_TOLERANCE = 1e-9  # of the normalised time

# Part of a joint's largest velocity that is rounding where it rests; chosen: some hundred times
# the rounding of a sum of velocities. In a second a joint so fast moves by less than 1e-12 rad.
AT_REST = 1e-13


class JointProfile(ReadOnlyArrays):
    """
    One joint's motion: consecutive pieces, all of one function.

    Parameters
    ----------
    pieces : Pieces
        Values of shape (n,), in order of time; pieces of no duration are dropped.

    Raises
    ------
    InvalidInputError
        If a value is not finite, a duration is negative or there is no piece.

    """

    def __init__(self, pieces: Pieces) -> None:
        parameters = list(pieces.parameters().values())
        fields = np.empty((len(parameters), *np.broadcast(*parameters).shape))
        for field, values in zip(fields, parameters):
            field[...] = values
        if not np.isfinite(fields).all():
            for name, value in pieces.parameters().items():
                finite_array(name, value)
        lasting = fields[0] > 0.0
        if fields.ndim != 2 or (fields[0] < 0.0).any() or not lasting.any():
            raise InvalidInputError(
                f'piece durations are {fields[0]} s, must not be negative, nor all zero')
        fields = fields[:, lasting]
        self.knots = np.concatenate(([0.0], np.cumsum(fields[0])))
        make_read_only((fields, self.knots))
        self.pieces = pieces.with_parameters(fields)

    @property
    def duration(self) -> float:
        """Length of the motion [s]."""
        return float(self.knots[-1])

    def __call__(self, t: Array) -> tuple[Array, Array, Array, Array]:
        """Return position, velocity, acceleration and jerk at times of shape (n,)."""
        index = np.searchsorted(self.knots[1:-1], t, side='right')
        piece = self._at(index)
        s = np.clip((t - self.knots[index]) / piece.duration, 0.0, 1.0)
        return piece.at(s)

    @cached_property
    def extremes(self) -> Extremes:
        """Where velocity turns, and the peaks; see `extremes_of`."""
        return extremes_of([self])[0]

    @property
    def begins(self) -> Array:
        """Return the positions at the beginnings of the pieces, shape (n,) [rad]."""
        return self.extremes.position[:, 0]

    def position_range(self) -> tuple[float, float]:
        """Return the least and the largest position [rad]."""
        least, most = self.piece_ranges
        return float(least.min()), float(most.max())

    @cached_property
    def piece_ranges(self) -> tuple[Array, Array]:
        """Least and largest position within each piece, shape (n,) [rad]."""
        s, position, velocity, _ = self.extremes
        least, most = position.min(axis=1), position.max(axis=1)
        speed = np.abs(velocity)
        sign = np.where(speed > AT_REST * speed.max(), np.sign(velocity), 0.0)
        row, col = np.nonzero(sign[:, :-1] * sign[:, 1:] < 0.0)
        if len(row):
            turning = self._zero_of_velocity(row, s[row, col], s[row, col + 1])
            np.minimum.at(least, row, turning)
            np.maximum.at(most, row, turning)
        make_read_only((least, most))
        return least, most

    def passed(self, positions: Array) -> Array:
        """
        Return the times at which positions are passed by a monotone motion.

        Parameters
        ----------
        positions : ndarray, shape (n,)
            Between the first and the last [rad].

        Returns
        -------
        ndarray, shape (n,)
            Times [s].

        """
        ends = np.append(self.begins, self.pieces.at(1.0)[0][-1])
        index = np.clip(np.searchsorted(ends, positions) - 1, 0, len(ends) - 2)
        piece, rise = self._at(index), np.diff(ends)[index]
        s = np.clip((positions - ends[index]) / np.where(rise > 0.0, rise, 1.0), 0.0, 1.0)
        low, high = np.zeros_like(s), np.ones_like(s)
        for _ in range(MOST_STEPS):
            position, velocity, _, _ = piece.at(s)
            low = np.where(position <= positions, s, low)
            high = np.where(position >= positions, s, high)
            with np.errstate(divide='ignore', invalid='ignore'):
                found = s - (position - positions) / (velocity * piece.duration)
            found = np.where((found >= low) & (found <= high), found, 0.5 * (low + high))
            moved, s = float(np.abs(found - s).max(initial=0.0)), found
            if moved < ZERO_TOLERANCE:
                break
        return np.asarray(self.knots[index] + s * piece.duration)

    def time_scaled(self, factor: float) -> JointProfile:
        """
        Return the profile with time scaled by a factor, positions unchanged.

        Parameters
        ----------
        factor : float
            New over old duration, positive.

        Returns
        -------
        JointProfile
            The slower or faster motion.

        Raises
        ------
        InvalidInputError
            If the factor is not within 1e-30 and 1e30.

        """
        return JointProfile(self.pieces.time_scaled(time_factor(factor)))

    def _at(self, index: Any) -> Pieces:
        return _selected(self.pieces, index)

    def _zero_of_velocity(self, row: IntArray, low: Array, high: Array) -> Array:
        """Return the positions at the zeros of velocity, monotone in each bracket."""
        piece = self._at(row)
        sign_low, s = np.sign(piece.at(low)[1]), 0.5 * (low + high)
        for _ in range(MOST_STEPS):
            _, velocity, acceleration, _ = piece.at(s)
            same = np.sign(velocity) == sign_low
            low, high = np.where(same, s, low), np.where(same, high, s)
            with np.errstate(divide='ignore', invalid='ignore'):
                found = s - velocity / (acceleration * piece.duration)
            found = np.where((found >= low) & (found <= high), found, 0.5 * (low + high))
            moved, s = float(np.abs(found - s).max()), found
            if moved < ZERO_TOLERANCE:
                break
        return piece.at(s)[0]


class Extremes(NamedTuple):
    """Where a profile's velocity turns, in each of n pieces, and its peaks."""

    s: Array         # `Pieces.turning_points`, shape (n, k)
    position: Array  # there [rad], likewise
    velocity: Array  # there [rad/s]
    peaks: tuple[float, float, float]  # velocity, acceleration, jerk [rad/s, rad/s^2, rad/s^3]


def extremes_of(profiles: Sequence[JointProfile]) -> list[Extremes]:
    """
    Return the exact extremes of profiles, where all have one function in one go: calls take time.

    Parameters
    ----------
    profiles : sequence of JointProfile
        At least one.

    Returns
    -------
    list of Extremes
        Of each.

    """
    pieces = profiles[0].pieces
    if any(type(p.pieces) is not type(pieces) for p in profiles):
        return [p.extremes for p in profiles]
    if len(profiles) > 1:
        pieces = pieces.with_parameters(
            np.concatenate(f) for f in zip(*(p.pieces.parameters().values() for p in profiles)))
    s = pieces.turning_points()
    position, velocity = _selected(pieces, (slice(None), np.newaxis)).at(s)[:2]
    make_read_only((s, position, velocity))
    begins = np.cumsum([0] + [len(p.knots) - 1 for p in profiles])
    peaks = (np.maximum.reduceat(peak, begins[:-1]).tolist() for peak in (
        np.abs(velocity).max(axis=1), *pieces.peaks()))
    return [Extremes(s[i:k], position[i:k], velocity[i:k], peak)
            for i, k, peak in zip(begins, begins[1:], zip(*peaks))]


def _selected(pieces: Pieces, index: Any) -> Pieces:
    return pieces.with_parameters(f[index] for f in pieces.parameters().values())
