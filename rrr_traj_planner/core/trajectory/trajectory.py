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

"""Interface of trajectories: joint positions and derivatives as functions of time."""

from __future__ import annotations

from abc import ABC, abstractmethod
from copy import copy
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.read_only import ReadOnlyArrays
from rrr_traj_planner.core.rounding import TIME_ROUNDING
from rrr_traj_planner.core.scalars import positive

Same = TypeVar('Same', bound='Trajectory')


# Range of time-scaling factors, chosen so that the factor's fourth power is a normal float.
LEAST_FACTOR, MOST_FACTOR = 1e-30, 1e30

# By how much a time comes before a knot to give the limit from the left there: many times the
# rounding of a time, in which no quantity changes by a part that is checked. Chosen.
ONE_SIDED = 1e-9  # s


@dataclass(frozen=True, eq=False)
class Peaks(ReadOnlyArrays):
    """Extremes of each joint over a whole motion, shape (3,) each."""

    velocity: Array      # largest magnitude [rad/s]
    acceleration: Array  # [rad/s^2]
    jerk: Array          # [rad/s^3]
    min_position: Array  # [rad]
    max_position: Array  # [rad]


class Scalable(Protocol):
    """A result about a motion that can be converted for the time-scaled motion."""

    def scaled(self, factor: float) -> Scalable:
        """
        Return the result for the motion with time scaled by a factor.

        Parameters
        ----------
        factor : float
            New over old duration.

        Returns
        -------
        Scalable
            The same kind of result.

        """


class Trajectory(ReadOnlyArrays, ABC):
    """
    A motion in joint space that can be evaluated at any time.

    Attributes
    ----------
    duration : float
        [s].
    via_times : ndarray
        When each via point is reached [s], never decreasing; at the end the duration exactly.
    note : str
        Remark on how the motion was planned; usually empty.

    """

    duration: float
    via_times: Array
    note: str = ''

    @property
    def cache(self) -> dict[str, Scalable]:
        """Results about the motion that may be needed again; not pickled."""
        cache: dict[str, Scalable] = vars(self).setdefault('_cache', {})
        return cache

    def pass_cache(self, slower: Trajectory, factor: float) -> None:
        """
        Copy cached results to the time-scaled motion.

        Parameters
        ----------
        slower : Trajectory
            That motion.
        factor : float
            New over old duration.

        """
        slower.cache.update((name, of.scaled(factor)) for name, of in self.cache.items())

    def noted(self: Same, note: str) -> Same:
        """
        Return the same motion with a note.

        Parameters
        ----------
        note : str
            Remark.

        Returns
        -------
        Trajectory
            Otherwise the same.

        """
        found = copy(self)
        self.pass_cache(found, 1.0)
        found.note = note
        return found

    def __getstate__(self) -> dict[str, object]:
        """Return what is pickled or copied."""
        return {name: value for name, value in vars(self).items() if name != '_cache'}

    @abstractmethod
    def __call__(self, t: ArrayLike) -> tuple[Array, Array, Array, Array]:
        """
        Return position, velocity, acceleration and jerk at given times.

        Parameters
        ----------
        t : array_like, shape (n,) or ()
            Times [s]; before 0 and after the duration the arm rests.

        Returns
        -------
        tuple of ndarray, shape (n, 3) or (3,)
            In rad and s. At a knot, the values of the piece that begins there.

        """

    @property
    @abstractmethod
    def knots(self) -> Array:
        """Return the times between which the motion is analytic, from 0 to the duration."""

    @property
    def step_times(self) -> Array:
        """Return the times [s] at which acceleration steps, increasing; usually none."""
        return np.zeros(0)

    @property
    def jerk_step_times(self) -> Array:
        """Return times [s] at which jerk steps that want a point, increasing; usually none."""
        return np.zeros(0)

    @abstractmethod
    def peaks(self) -> Peaks:
        """Return the exact extremes over the continuous motion."""

    @abstractmethod
    def time_scaled(self, factor: float) -> Trajectory:
        """
        Return the same path with time scaled by a factor.

        Parameters
        ----------
        factor : float
            New over old duration, positive.

        Returns
        -------
        Trajectory
            With velocities divided by the factor, accelerations by its square.

        Raises
        ------
        InvalidInputError
            If the factor is not within 1e-30 and 1e30 (`time_factor`).

        """


def time_factor(factor: Any) -> float:
    """
    Return a factor by which the times of a motion can be multiplied.

    Parameters
    ----------
    factor : float
        The factor.

    Returns
    -------
    float
        The factor.

    Raises
    ------
    InvalidInputError
        If it is not within 1e-30 and 1e30: powers of it that divide derivatives would overflow.

    """
    number = positive('factor', factor)
    if not LEAST_FACTOR <= number <= MOST_FACTOR:
        raise InvalidInputError(
            f'factor is {number}, must be in [{LEAST_FACTOR}, {MOST_FACTOR}]')
    return number


def ending_at_duration(times: Array, duration: float) -> Array:
    """
    Return times, those equal to the duration up to rounding replaced by it.

    Parameters
    ----------
    times : ndarray, shape (n,)
        [s].
    duration : float
        Of the motion [s].

    Returns
    -------
    ndarray, shape (n,)
        Read-only. In a motion of a week rounding exceeds a nanosecond.

    """
    found = np.where(np.abs(times - duration) <= TIME_ROUNDING * duration, duration, times)
    found.setflags(write=False)
    return found


def times_within(trajectory: Trajectory, per_interval: int, spacing: float = np.inf,
                 most: int | None = None) -> Array:
    """
    Return a grid of times that meets every knot.

    Parameters
    ----------
    trajectory : Trajectory
        The motion.
    per_interval : int
        Least number of steps between two knots.
    spacing : float
        Largest step [s].
    most : int, optional
        Largest number of steps between two knots, whatever the spacing.

    Returns
    -------
    ndarray
        Increasing times from 0 to the duration.

    """
    knots = trajectory.knots
    widths = np.diff(knots)
    steps = np.clip(np.ceil(widths / spacing), per_interval, most).astype(int)
    ends = np.cumsum(steps)
    within = np.arange(1, ends[-1] + 1) - np.repeat(ends - steps, steps)
    grid = np.repeat(knots[:-1], steps) + np.repeat(widths / steps, steps) * within
    grid[ends - 1] = knots[1:]  # exactly, without rounding
    return np.concatenate((knots[:1], grid))
