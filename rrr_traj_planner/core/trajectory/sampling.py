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

"""Sampling of a motion into points that a controller can interpolate within the limits."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, IntArray
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.scalars import positive, whole_number
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints

NANOSECOND = 1e-9  # s

LEAST_GAP = 0.1  # of the period, between a regular sample and a via point's; chosen
# The same [s], up to half a period: a via point's time is rounded to a nanosecond, which changes
# the acceleration of a quintic beside it by 1 / gap times as much as velocity. Chosen.
SHORTEST_GAP = 5e-4

# The quintic of an interval in which acceleration steps has the same mean and first moment of
# acceleration as the motion, and overshoots. With the step at one end of the interval, it
# overshoots at the other end by 37 % of the step, and its jerk is 9 times the step over the
# interval; with the step at a sixth of the interval (STEP_FRACTION) the overshoot is least, 5 % of
# the step.
STEP_FRACTION, STEP_OVERSHOOT = 1.0 / 6.0, 0.0501
# Least time between a step and a regular point, over the period: bounds the quintic's jerk.
# Chosen.
STEP_GAP = 0.3

# Time [s] from a via point to the next below which rounding of both times to nanoseconds matters:
# at 1 rad/s it would change acceleration by 5e-4 rad/s^2 and more; chosen.
SOON = 3e-3

# Time [s] from the start to a via point below which that has no point of its own: over its square,
# rounding of positions would be an acceleration of 1e-4 rad/s^2 and more. No jerk that a joint can
# have makes it miss such a via point by more than rounding. Chosen.
AT_ONCE = 1e-5

# Default limit on the number of points, which bounds the memory used; chosen.
MOST_POINTS = 200_000


class SampleTimes(NamedTuple):
    """Sampling times of a motion, shape (n,) each."""

    exact: Array   # [s]
    stamps: Array  # the same in whole nanoseconds, strictly increasing

    def divided(self, index: IntArray, times: Array) -> tuple[SampleTimes, SampleTimes]:
        """
        Return these times with some intervals divided in two, and the further times alone.

        Parameters
        ----------
        index : ndarray of int, shape (k,)
            Increasing indices of intervals between these times.
        times : ndarray, shape (k,)
            One within each of these intervals [s], two nanoseconds or more from its ends.

        Returns
        -------
        tuple of SampleTimes
            All of them, in order, and the k further ones.

        """
        stamps = np.round(times / NANOSECOND)
        exact = np.interp(stamps, self.stamps, self.exact)  # see `sample_times` on rounding
        return (SampleTimes(np.insert(self.exact, index + 1, exact),
                            np.insert(self.stamps, index + 1, stamps)),
                SampleTimes(exact, stamps))


def sample(trajectory: Trajectory, period: float,
           most_points: int = MOST_POINTS) -> TrajectoryPoints:
    """
    Return points at every period, at every via time and at the end.

    Parameters
    ----------
    trajectory : Trajectory
        The motion.
    period : float
        Time between points [s], positive.
    most_points : int
        Largest number of points.

    Returns
    -------
    TrajectoryPoints
        At `sample_times`; the first and the last point exactly at rest.

    Raises
    ------
    InvalidInputError
        If the period is not positive, or there would be too many points.

    """
    return points_at(trajectory, sample_times(trajectory, period, most_points))


def points_at(trajectory: Trajectory, times: SampleTimes,
              from_rest: bool = True) -> TrajectoryPoints:
    """
    Return the states of a motion as points.

    Parameters
    ----------
    trajectory : Trajectory
        The motion.
    times : SampleTimes
        Sampling times, from start to end.
    from_rest : bool
        Whether the motion starts at rest.

    Returns
    -------
    TrajectoryPoints
        Times in whole nanoseconds; the last point exactly at rest, the first one from rest.

    """
    q, qd, qdd, _ = trajectory(times.exact)
    for derivative in (qd, qdd):
        derivative[[0, -1] if from_rest else -1] = 0.0
    return TrajectoryPoints(times.stamps * NANOSECOND, q, qd, qdd)


def with_states_at(points: TrajectoryPoints, trajectory: Trajectory, times: SampleTimes,
                   before: IntArray) -> TrajectoryPoints:
    """
    Return the points of a motion with further ones between them; the others remain as they are.

    Parameters
    ----------
    points : TrajectoryPoints
        Of the motion, as from `points_at`.
    trajectory : Trajectory
        The motion.
    times : SampleTimes
        Of the k further points.
    before : ndarray of int, shape (k,)
        Increasing indices of the points before which they come.

    Returns
    -------
    TrajectoryPoints
        All of them, in order.

    """
    q, qd, qdd, _ = trajectory(times.exact)
    return TrajectoryPoints(
        np.insert(points.times, before, times.stamps * NANOSECOND),
        np.insert(points.positions, before, q, axis=0),
        np.insert(points.velocities, before, qd, axis=0),
        np.insert(points.accelerations, before, qdd, axis=0))


def sample_times(trajectory: Trajectory, period: float,
                 most_points: int = MOST_POINTS) -> SampleTimes:
    """
    Return the sampling times of a motion: every period, every via time from AT_ONCE on, the end.

    Also where jerk steps: a quintic across a step of jerk in its interval overshoots it by up to
    37 % of it, however short the interval is, one that begins or ends there not at all. A regular
    point nearer than `_least_gap` to one of these is dropped. One nearer than three tenths
    to a step of acceleration is replaced by points half a period before and after the step.
    See `STEP_FRACTION` for quintics across steps.

    Parameters
    ----------
    trajectory : Trajectory
        The motion.
    period : float
        Time between points [s], positive.
    most_points : int
        Largest number of points.

    Returns
    -------
    SampleTimes
        Times and stamps.

    Raises
    ------
    InvalidInputError
        If the period is not positive, or there would be too many points.

    """
    period = positive('period', period, 's')
    most_points = whole_number('most_points', most_points, least=1)
    check_size(trajectory.duration, period, most_points)
    fixed = np.sort(np.concatenate(([0.0], trajectory.via_times, [trajectory.duration])))
    fixed = fixed[np.concatenate(([True], np.diff(fixed) >= 1.5 * NANOSECOND))
                  & ((fixed == 0.0) | (fixed >= AT_ONCE) | (fixed == trajectory.duration))]
    fixed[-1] = trajectory.duration
    regular: Array = period * np.arange(1.0, int(trajectory.duration / period) + 1)
    gap, steps = _least_gap(period), trajectory.step_times
    beside = _beside_steps(steps, regular, period)
    bends = _apart(trajectory.jerk_step_times, beside, steps, period)
    retained = regular[(_distance(regular, steps) >= STEP_GAP * period)
                       & (_distance(regular, bends) >= gap)]
    between = np.round(np.sort(np.concatenate((retained, beside, bends))) / NANOSECOND)
    between *= NANOSECOND
    between = between[(_distance(between, fixed) >= gap) & (between > 0.0)
                      & (between < trajectory.duration)]
    # Regular points share the rounding of the via points' stamps, which a controller would
    # otherwise see as a step of velocity in the short gap between the two.
    fixed_stamps = np.round(fixed / NANOSECOND)
    fixed = _in_step(fixed, fixed_stamps * NANOSECOND)
    exact = np.concatenate((fixed, np.interp(between, fixed_stamps * NANOSECOND, fixed)))
    stamps = np.concatenate((fixed_stamps, np.round(between / NANOSECOND)))
    check_size(trajectory.duration, period, most_points, len(stamps))
    return SampleTimes(np.sort(exact), np.sort(stamps))


def _in_step(times: Array, rounded: Array) -> Array:
    """
    Return times of which those that soon follow others are as long after them as they are rounded.

    Of two via points T apart, half a nanosecond of rounding changes the acceleration of the
    quintic between them by some 10 v / T^2 times as much.
    """
    found = times.copy()
    for k in np.flatnonzero(np.diff(times) < SOON).tolist():
        if k + 2 < len(times):  # the motion rests at the last one
            found[k + 1] = found[k] + rounded[k + 1] - rounded[k]
    return found


def _least_gap(period: float) -> float:
    """Return the least time between a regular sample and a via point's [s]."""
    return max(LEAST_GAP * period, min(0.5 * period, SHORTEST_GAP))


def _beside_steps(steps: Array, regular: Array, period: float) -> Array:
    """Return times half a period from the steps that displace a regular point."""
    near = steps[_distance(steps, regular) < STEP_GAP * period]
    beside = np.sort(np.concatenate((near - 0.5 * period, near + 0.5 * period)))
    beside = beside[_distance(beside, steps) >= LEAST_GAP * period]
    return beside[np.diff(beside, prepend=-np.inf) >= LEAST_GAP * period]


def _apart(bends: Array, beside: Array, steps: Array, period: float) -> Array:
    """Return those steps of jerk that are away from each other and from steps of acceleration."""
    gap = LEAST_GAP * period
    bends = bends[(_distance(bends, beside) >= gap)
                  & (_distance(bends, steps) >= STEP_GAP * period)]
    return bends[np.diff(bends, prepend=-np.inf) >= gap]


def _distance(times: Array, others: Array) -> Array:
    """Return the distance of each time from the nearest of others, which increase [s]."""
    if not len(others):
        return np.full(len(times), np.inf)
    after = np.searchsorted(others, times)
    return np.minimum(np.abs(times - others[np.maximum(after - 1, 0)]),
                      np.abs(others[np.minimum(after, len(others) - 1)] - times))


def check_size(duration: float, period: float, most_points: int = MOST_POINTS,
               points: float | None = None) -> None:
    """
    Raise if a motion has too many points.

    Parameters
    ----------
    duration : float
        Duration, or a lower bound of it [s].
    period : float
        Time between points [s], positive.
    most_points : int
        Largest number of points.
    points : float, optional
        Number of points; None: one for each period, and one more.

    Raises
    ------
    InvalidInputError
        If there are more.

    """
    points = duration / period + 1.0 if points is None else points
    if not points < most_points + 1:
        raise InvalidInputError(
            f'a motion of {duration:.6g} s with a point every {period:.6g} s has more than '
            f'{most_points} points')
