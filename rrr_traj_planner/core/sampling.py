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

"""The points of a message: a motion sampled so that controllers rebuild it within its limits."""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.interpolation import TrajectoryPoints
from rrr_traj_planner.core.trajectory import Trajectory

NANOSECOND = 1e-9

# No regular sample is nearer to a via point's than this part of the period.
LEAST_GAP = 0.1

# More points than this, where nothing else is said, are refused: they would fill the memory.
MOST_POINTS = 200_000


def sample(trajectory: Trajectory, period: float,
           most_points: int = MOST_POINTS) -> TrajectoryPoints:
    """
    Return points at every period, at every via time, where acceleration steps, and at the end.

    Parameters
    ----------
    trajectory : Trajectory
        The motion.
    period : float
        Time between points [s], positive.
    most_points : int
        How many points there may be.

    Returns
    -------
    TrajectoryPoints
        Times in whole nanoseconds; no regular point nearer than a tenth of a period to a via
        point's; the first and the last point exactly at rest.

    Raises
    ------
    InvalidInputError
        If the period is not positive, or there would be too many points.

    """
    exact, stamps = sample_times(trajectory, period, most_points)
    q, qd, qdd, _ = trajectory(exact)
    for derivative in (qd, qdd):
        derivative[[0, -1]] = 0.0
    return TrajectoryPoints(stamps * NANOSECOND, q, qd, qdd)


def sample_times(trajectory: Trajectory, period: float,
                 most_points: int = MOST_POINTS) -> tuple[Array, Array]:
    """
    Return when a motion is sampled.

    Parameters
    ----------
    trajectory : Trajectory
        The motion.
    period : float
        Time between points [s], positive.
    most_points : int
        How many points there may be.

    Returns
    -------
    tuple of ndarray
        The exact times [s] and the same as whole nanoseconds, strictly increasing.

    Raises
    ------
    InvalidInputError
        If the period is not positive, or there would be too many points.

    """
    if not (np.isfinite(period) and period > 0.0):
        raise InvalidInputError(f'sample_period is {period} s, must be positive')
    check_size(trajectory.duration, period, most_points)
    vias = np.concatenate(([0.0], trajectory.via_times, [trajectory.duration]))
    steps = trajectory.step_times
    after = np.clip(np.searchsorted(vias, steps), 1, len(vias) - 1)
    apart = np.minimum(steps - vias[after - 1], vias[after] - steps) >= LEAST_GAP * period
    apart[1:] &= np.diff(steps) >= LEAST_GAP * period
    # A quintic that ends at a step swings beyond what comes before it: for a short time only.
    steps = steps[apart]
    before = steps - LEAST_GAP * period
    others = np.sort(np.concatenate((vias, steps)))
    below = np.clip(np.searchsorted(others, before, side='right') - 1, 0, None)
    before = before[before - others[below] >= LEAST_GAP * period]
    fixed = np.sort(np.concatenate((vias, steps, before)))
    fixed = fixed[np.concatenate(([True], np.diff(fixed) >= 1.5 * NANOSECOND))]
    fixed[-1] = trajectory.duration
    regular = period * np.arange(1, int(trajectory.duration / period) + 1)
    regular = np.round(regular / NANOSECOND) * NANOSECOND
    after = np.searchsorted(fixed, regular)
    gap = np.minimum(regular - fixed[np.maximum(after - 1, 0)],
                     np.abs(fixed[np.minimum(after, len(fixed) - 1)] - regular))
    regular = regular[(gap >= LEAST_GAP * period) & (regular < trajectory.duration)]
    # Regular points share the rounding of the via points' stamps, which a controller would
    # otherwise see as a step of velocity in the short gap between the two.
    fixed_stamps = np.round(fixed / NANOSECOND)
    exact = np.concatenate((fixed, np.interp(regular, fixed_stamps * NANOSECOND, fixed)))
    stamps = np.concatenate((fixed_stamps, np.round(regular / NANOSECOND)))
    check_size(trajectory.duration, period, most_points, len(stamps))
    return np.sort(exact), np.sort(stamps)


def check_size(duration: float, period: float, most_points: int = MOST_POINTS,
               points: float | None = None) -> None:
    """
    Refuse a motion that has too many points.

    Parameters
    ----------
    duration : float
        How long it lasts, or the least that it can [s].
    period : float
        Time between points [s], positive.
    most_points : int
        How many points there may be.
    points : float, optional
        How many it has; None: as many as there are periods, and one.

    Raises
    ------
    InvalidInputError
        If there are more.

    """
    points = duration / period + 1.0 if points is None else points
    if not points < most_points + 1.0:
        raise InvalidInputError(
            f'a motion of {duration:.6g} s with a point every {period:.6g} s has more than '
            f'{most_points} points')
