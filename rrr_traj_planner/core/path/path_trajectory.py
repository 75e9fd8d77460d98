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
Motion along a path of the tip: the path's geometry, and the path coordinate over time.

Bobrow, Dubowsky and Gibson, Time-optimal control of robotic manipulators along specified paths,
Int. J. Robotics Research 4(3), 1985.
"""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array, parameter_values
from rrr_traj_planner.core.path.arm_path import ArmPath
from rrr_traj_planner.core.read_only import make_read_only
from rrr_traj_planner.core.trajectory.joint_profile import JointProfile
from rrr_traj_planner.core.trajectory.maximum import maximum_over_time
from rrr_traj_planner.core.trajectory.trajectory import (
    ending_at_duration,
    ONE_SIDED,
    Peaks,
    time_factor,
    times_within,
    Trajectory,
)

STEPS_PER_KNOT = 6       # of the time between knots, in the search for extremes; chosen
# rad, makes positions positive, as `maximum_over_time` requires: above all ranges but of 16 turns.
POSITION_OFFSET = 1e2
LEAST_STEP = 1e-6        # rad/s^2; acceleration steps below this are rounding; chosen


class PathPeaks(NamedTuple):
    """Extremes of a motion along a path."""

    peaks: Peaks   # of the joints
    speed: float   # of the tip [m/s]

    def scaled(self, factor: float) -> PathPeaks:
        """
        Return the extremes of the time-scaled motion.

        Parameters
        ----------
        factor : float
            New over old duration.

        Returns
        -------
        PathPeaks
            Converted, not searched again.

        """
        p = self.peaks
        return PathPeaks(
            Peaks(p.velocity / factor, p.acceleration / factor ** 2, p.jerk / factor ** 3,
                  p.min_position, p.max_position), self.speed / factor)


class PathTrajectory(Trajectory):
    """
    A motion of the tip along a path.

    Parameters
    ----------
    arm_path : ArmPath
        The path in joint space.
    progress : JointProfile
        Path coordinate [m] over time, from 0 to the path's length.
    via_times : ndarray
        When each via point is passed [s].
    join_times : ndarray
        When each join of the path is passed [s].
    note : str
        See `Trajectory`.

    """

    def __init__(self, arm_path: ArmPath, progress: JointProfile, via_times: Array,
                 join_times: Array, note: str = '') -> None:
        self.arm_path, self.progress, self.note = arm_path, progress, note
        self.duration = progress.duration
        self.via_times = ending_at_duration(via_times, self.duration)
        self.join_times = _at_knots(progress, join_times)
        make_read_only((self.via_times, self.join_times))

    def __call__(self, t: ArrayLike) -> tuple[Array, Array, Array, Array]:
        """Return position, velocity, acceleration and jerk; see `Trajectory`."""
        times = parameter_values('t', t)
        found = self._with_speed(np.atleast_1d(times))[1:]
        return tuple(v[0] for v in found) if times.ndim == 0 else found

    def _with_speed(self, t: Array) -> tuple[Array, Array, Array, Array, Array]:
        """Return the tip's speed [m/s], (n, 1), then what a call returns, at n times."""
        s, sd, sdd, sddd = (
            f[:, np.newaxis] for f in self.progress(np.clip(t, 0.0, self.duration)))
        length = self.arm_path.path.length
        q, dq, ddq, dddq = self.arm_path(np.clip(s[:, 0], 0.0, length))
        qd = dq * sd
        qdd = ddq * sd ** 2 + dq * sdd
        qddd = sd * (dddq * sd ** 2 + 3.0 * ddq * sdd) + dq * sddd
        resting = (t < 0.0) | (t >= self.duration)
        for derivative in (qd, qdd, qddd):
            derivative[resting] = 0.0
        return sd, q, qd, qdd, qddd

    @property
    def knots(self) -> Array:
        """Return the ends of the pieces of progress; see `Trajectory`."""
        return self.progress.knots

    @cached_property
    def step_times(self) -> Array:
        """Return when joins with a step of curvature are passed [s]; see `Trajectory`."""
        stepping = self.acceleration_steps().max(axis=1, initial=0.0) > LEAST_STEP
        found = np.asarray(self.join_times[stepping])
        make_read_only((found,))
        return found

    @property
    def jerk_step_times(self) -> Array:
        """Return when joins are passed at which acceleration does not step [s]."""
        return np.setdiff1d(self.join_times, self.step_times)

    def peaks(self) -> Peaks:
        """Return the extremes over the continuous motion, including one-sided limits at knots."""
        return self._measured().peaks

    @property
    def peak_speed(self) -> float:
        """Return the tip's largest speed over the continuous motion [m/s]."""
        return self._measured().speed

    def _measured(self) -> PathPeaks:
        found = self.cache.get('path_peaks')
        if not isinstance(found, PathPeaks):
            found = self.cache['path_peaks'] = self._measure()
        return found

    def _measure(self) -> PathPeaks:
        grid = times_within(self, STEPS_PER_KNOT)
        grid = np.unique(np.concatenate((grid, self.knots[1:] - ONE_SIDED)))

        def values(t: Array) -> Array:
            sd, q, qd, qdd, qddd = self._with_speed(t)
            return np.concatenate((np.abs(qd), np.abs(qdd), np.abs(qddd), POSITION_OFFSET - q,
                                   POSITION_OFFSET + q, sd), axis=1)

        *found, speed = maximum_over_time(values, grid).value
        velocity, acceleration, jerk, least, most = np.reshape(found, (5, 3))
        return PathPeaks(Peaks(
            velocity=velocity, acceleration=acceleration, jerk=jerk,
            min_position=POSITION_OFFSET - least, max_position=most - POSITION_OFFSET),
            float(speed))

    def time_scaled(self, factor: float) -> PathTrajectory:
        """Return the time-scaled motion; see `Trajectory`."""
        factor = time_factor(factor)
        slower = PathTrajectory(self.arm_path, self.progress.time_scaled(factor),
                                self.via_times * factor, self.join_times * factor, self.note)
        self.pass_cache(slower, factor)
        return slower

    def acceleration_steps(self) -> Array:
        """Return the steps of joint acceleration at the joins [rad/s^2], (joins, 3)."""
        joins, speed = self.arm_path.path.joins, self.progress(self.join_times)[1]
        change = self.arm_path(joins).ddq - self.arm_path(joins, left=True).ddq
        return np.asarray(np.abs(change) * speed[:, np.newaxis] ** 2)


def _at_knots(progress: JointProfile, times: Array) -> Array:
    """Return the knots nearest to times, which rounding may have put before their knots."""
    knots = progress.knots
    after = np.clip(np.searchsorted(knots, times), 1, len(knots) - 1)
    before = times - knots[after - 1] <= knots[after] - times
    return np.asarray(knots[after - before])
