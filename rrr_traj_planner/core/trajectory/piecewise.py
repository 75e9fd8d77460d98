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

"""Piecewise trajectories: each joint has a profile of consecutive pieces."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array, finite_array, IntArray, parameter_values
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.read_only import make_read_only, ReadOnlyArrays
from rrr_traj_planner.core.rounding import TIME_ROUNDING
from rrr_traj_planner.core.trajectory.pieces import Pieces
from rrr_traj_planner.core.trajectory.trajectory import (
    ending_at_duration,
    Peaks,
    time_factor,
    Trajectory,
)

# Safeguarded Newton iteration for zeros in [0, 1] (Press et al., Numerical Recipes, section 9.4):
# a step that leaves the bracket is replaced by a bisection. At a zero of velocity an error e of
# the normalised time changes the position by O(e^2).
MOST_STEPS = 60        # chosen: bisections alone would reach 1e-18
ZERO_TOLERANCE = 1e-9  # of the normalised time

# Part of a joint's largest velocity that is rounding where it rests; chosen: some hundred times
# the rounding of a sum of velocities. In a second a joint so fast moves by less than 1e-12 rad.
AT_REST = 1e-13

# Difference of the joints' durations, and of a via time beyond the end, that is accepted [s, and
# relative to longer durations]; chosen: a nanosecond, the resolution of messages.
DURATION_ROUNDING = 1e-9


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
        fields = np.array(np.broadcast_arrays(*pieces.parameters().values()), dtype=float)
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
    def peak_velocity(self) -> float:
        """Largest magnitude of velocity [rad/s]."""
        _, _, velocity = self._turning_points
        return float(np.abs(velocity).max())

    @cached_property
    def begins(self) -> Array:
        """Return the positions at the beginnings of the pieces, shape (n,) [rad]."""
        return np.asarray(self.pieces.at(0.0)[0])

    def position_range(self) -> tuple[float, float]:
        """Return the least and the largest position [rad]."""
        least, most = self.piece_ranges
        return float(least.min()), float(most.max())

    @cached_property
    def piece_ranges(self) -> tuple[Array, Array]:
        """Least and largest position within each piece, shape (n,) [rad]."""
        s, position, velocity = self._turning_points
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

    @cached_property
    def _turning_points(self) -> tuple[Array, Array, Array]:
        """Return `Pieces.turning_points`, and the positions and velocities there, (n, k) each."""
        s = self.pieces.turning_points()
        position, velocity = self._columns().at(s)[:2]
        make_read_only((s, position, velocity))
        return s, position, velocity

    def _at(self, index: Any) -> Pieces:
        return self.pieces.with_parameters(f[index] for f in self.pieces.parameters().values())

    def _columns(self) -> Pieces:
        return self._at((slice(None), np.newaxis))

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


class PiecewiseTrajectory(Trajectory):
    """
    A trajectory of joint profiles of equal duration.

    Parameters
    ----------
    profiles : sequence of JointProfile
        One for each joint.
    via_times : array_like
        When each via point is passed [s].
    note : str
        See `Trajectory`.

    Raises
    ------
    InvalidInputError
        If the profiles' lengths differ by more than rounding, or via times do not rise
        within the motion.

    """

    def __init__(self, profiles: Sequence[JointProfile], via_times: ArrayLike,
                 note: str = '') -> None:
        self.profiles, self.note = tuple(profiles), note
        self.duration = self.profiles[0].duration
        self.via_times = ending_at_duration(
            finite_array('via_times', via_times, (-1,)), self.duration)
        lengths = np.array([p.duration for p in self.profiles])
        if np.ptp(lengths) > DURATION_ROUNDING * max(1.0, self.duration):
            raise InvalidInputError(f'joints move for {lengths} s, must be in step')
        if (np.diff(self.via_times) < 0.0).any() or (self.via_times < 0.0).any() or (
                self.via_times > self.duration + DURATION_ROUNDING).any():
            raise InvalidInputError(f'via_times {self.via_times} s must rise within the motion')

    @cached_property
    def _end(self) -> Array:
        """Return the positions at the end, shape (3,) [rad]."""
        return np.array([p(np.array([p.duration]))[0][0] for p in self.profiles])

    def __call__(self, t: ArrayLike) -> tuple[Array, Array, Array, Array]:
        """Return position, velocity, acceleration and jerk; see `Trajectory`."""
        times = parameter_values('t', t)
        flat = np.atleast_1d(times)
        resting = (flat < 0.0) | (flat >= self.duration)
        q, qd, qdd, qddd = np.moveaxis(np.array([p(flat) for p in self.profiles]), 0, -1)
        for derivative in (qd, qdd, qddd):
            derivative[resting] = 0.0
        q[flat >= self.duration] = self._end
        return tuple(v[0] for v in (q, qd, qdd, qddd)) if times.ndim == 0 else (q, qd, qdd, qddd)

    @property
    def knots(self) -> Array:
        """Return the ends of all joints' pieces; see `Trajectory`."""
        joined = np.sort(np.concatenate([p.knots for p in self.profiles]))
        joined = np.minimum(joined, self.duration)
        apart = np.diff(joined) > TIME_ROUNDING * max(1.0, self.duration)
        knots = np.concatenate((joined[:1], joined[1:][apart]))
        knots[-1] = self.duration
        return knots

    def peaks(self) -> Peaks:
        """Return the exact extremes over the continuous motion."""
        profiles = self.profiles
        ranges = np.array([p.position_range() for p in profiles])
        acceleration, jerk = np.array([
            [v.max() for v in p.pieces.peaks()] for p in profiles]).T
        return Peaks(
            velocity=np.array([p.peak_velocity for p in profiles]),
            acceleration=acceleration, jerk=jerk,
            min_position=ranges[:, 0], max_position=ranges[:, 1])

    def time_scaled(self, factor: float) -> PiecewiseTrajectory:
        """Return the same path with time scaled by a factor; see `Trajectory`."""
        factor = time_factor(factor)
        slower = PiecewiseTrajectory([p.time_scaled(factor) for p in self.profiles],
                                     self.via_times * factor, self.note)
        self.pass_cache(slower, factor)
        return slower
