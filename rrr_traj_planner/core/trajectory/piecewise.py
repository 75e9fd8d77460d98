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

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array, finite_array, parameter_values
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.rounding import TIME_ROUNDING
from rrr_traj_planner.core.trajectory.joint_profile import extremes_of, JointProfile
from rrr_traj_planner.core.trajectory.trajectory import (
    ending_at_duration,
    Peaks,
    time_factor,
    Trajectory,
)

# Difference of the joints' durations, and of a via time beyond the end, that is accepted [s, and
# relative to longer durations]; chosen: a nanosecond, the resolution of messages.
DURATION_ROUNDING = 1e-9


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
    jerk_step_times : array_like
        See `Trajectory`.

    Raises
    ------
    InvalidInputError
        If the profiles' lengths differ by more than rounding, or via times do not rise
        within the motion.

    """

    def __init__(self, profiles: Sequence[JointProfile], via_times: ArrayLike,
                 note: str = '', jerk_step_times: ArrayLike = ()) -> None:
        self.profiles, self.note = tuple(profiles), note
        self.duration = self.profiles[0].duration
        self._jerk_steps = np.asarray(jerk_step_times, dtype=float)
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
    def jerk_step_times(self) -> Array:
        """Return the times at which jerk steps; see `Trajectory`."""
        return self._jerk_steps

    @property
    def knots(self) -> Array:
        """Return the ends of all joints' pieces; see `Trajectory`."""
        joined = np.sort(np.concatenate([p.knots for p in self.profiles]))
        joined = np.minimum(joined, self.duration)
        apart = np.diff(joined) > TIME_ROUNDING * max(1.0, self.duration)
        knots = np.concatenate((joined[:1], joined[1:][apart]))
        knots[-1] = self.duration
        return knots

    @cached_property
    def peak_rates(self) -> tuple[Array, Array, Array]:
        """Peak velocity [rad/s], acceleration [rad/s^2] and jerk [rad/s^3] of each joint, (3,)."""
        for profile, found in zip(self.profiles, extremes_of(self.profiles)):
            profile.extremes = found
        velocity, acceleration, jerk = np.array([p.extremes.peaks for p in self.profiles]).T
        return velocity, acceleration, jerk

    def peaks(self) -> Peaks:
        """Return the exact extremes over the continuous motion."""
        velocity, acceleration, jerk = self.peak_rates
        ranges = np.array([p.position_range() for p in self.profiles])
        return Peaks(velocity=velocity, acceleration=acceleration, jerk=jerk,
                     min_position=ranges[:, 0], max_position=ranges[:, 1])

    def time_scaled(self, factor: float) -> PiecewiseTrajectory:
        """Return the same path with time scaled by a factor; see `Trajectory`."""
        factor = time_factor(factor)
        slower = PiecewiseTrajectory([p.time_scaled(factor) for p in self.profiles],
                                     self.via_times * factor, self.note,
                                     self._jerk_steps * factor)
        self.pass_cache(slower, factor)
        return slower
