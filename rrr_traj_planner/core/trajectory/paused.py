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

"""A motion that rests at some of its via points, with rests of given durations there."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import (
    Array,
    BoolArray,
    finite_array,
    IntArray,
    parameter_values,
    truth_array,
)
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.read_only import make_read_only
from rrr_traj_planner.core.rounding import TIME_ROUNDING
from rrr_traj_planner.core.trajectory.joined import JoinedTrajectory
from rrr_traj_planner.core.trajectory.trajectory import ending_at_duration, Peaks, Trajectory


class PausedTrajectory(Trajectory):
    """
    A motion with pauses at via points where it is at rest.

    Parameters
    ----------
    moving : Trajectory
        The motion without pauses.
    via_index : ndarray of int, shape (n,)
        The index of each via point's time in the motion's via times, never decreasing: a via point
        may be passed several times without moving.
    at_rest : array_like of bool, shape (n,)
        Whether the motion is at rest at each via point: there velocity and acceleration are
        exactly zero.
    pauses : array_like, shape (n,)
        For how long the arm then rests there [s].

    Attributes
    ----------
    via_times : ndarray, shape (n,)
        When each via point is reached [s].

    Raises
    ------
    InvalidInputError
        If a pause is negative, or at a via point at which the motion does not rest.

    """

    def __init__(self, moving: Trajectory, via_index: IntArray, at_rest: ArrayLike,
                 pauses: ArrayLike) -> None:
        self.moving, self.via_index, self.note = moving, via_index.copy(), moving.note
        number = len(via_index)
        self.at_rest: BoolArray = truth_array('at_rest', at_rest, (number,))
        self.pauses = finite_array('pauses', pauses, (number,))
        if (self.pauses < 0.0).any() or (self.pauses[~self.at_rest] > 0.0).any():
            raise InvalidInputError(
                f'pauses are {self.pauses.tolist()} s, must not be negative, and 0 where the '
                'motion does not rest')
        before = np.concatenate(([0.0], np.cumsum(self.pauses)))
        self._places = np.array(moving.via_times[via_index])  # without pauses [s]
        self.duration = moving.duration + float(before[-1])
        self.via_times = ending_at_duration(self._places + before[:-1], self.duration)
        make_read_only((self._places, self.via_index))

    def __call__(self, t: ArrayLike) -> tuple[Array, Array, Array, Array]:
        """Return position, velocity, acceleration and jerk; see `Trajectory`."""
        times = parameter_values('t', t)
        flat, rounding = np.atleast_1d(times), TIME_ROUNDING * max(1.0, self.duration)
        reached = np.searchsorted(self.via_times, flat + rounding, side='right') - 1
        last = np.maximum(reached, 0)  # via point
        since, pause = flat - self.via_times[last], self.pauses[last]
        rests = (reached >= 0) & self.at_rest[last] & (since <= pause + rounding)
        before = np.where(reached >= 0, np.cumsum(self.pauses)[last], 0.0)
        q, qd, qdd, qddd = self.moving(np.where(rests, self._places[last], flat - before))
        for derivative in (qd, qdd):
            derivative[rests] = 0.0
        qddd[rests & (since < pause - rounding)] = 0.0
        return (q[0], qd[0], qdd[0], qddd[0]) if times.ndim == 0 else (q, qd, qdd, qddd)

    @property
    def knots(self) -> Array:
        """Return the knots of the motion, and the beginnings and ends of the pauses."""
        moving = self.moving.knots
        knots = np.union1d(self._with_pauses(moving, 'left'), self._with_pauses(moving, 'right'))
        apart = np.diff(knots) > TIME_ROUNDING * max(1.0, self.duration)
        knots = np.concatenate((knots[:1], knots[1:][apart]))
        knots[0], knots[-1] = 0.0, self.duration
        return knots

    @property
    def step_times(self) -> Array:
        """Return when acceleration steps; see `Trajectory`."""
        return self._with_pauses(self.moving.step_times, 'right')

    @property
    def jerk_step_times(self) -> Array:
        """Return when jerk steps, and when the arm moves on after a pause."""
        ends = (self.via_times + self.pauses)[self.pauses > 0.0]
        return np.union1d(ends, self._with_pauses(self.moving.jerk_step_times, 'right'))

    def _with_pauses(self, t: Array, side: Literal['left', 'right']) -> Array:
        """Return times of the motion without pauses, with those before; 'right': and at them."""
        rounding = TIME_ROUNDING * max(1.0, self.duration)
        k = np.searchsorted(self._places, t + (rounding if side == 'right' else -rounding), side)
        return np.asarray(t + np.concatenate(([0.0], np.cumsum(self.pauses)))[k])

    def peaks(self) -> Peaks:
        """Return the exact extremes over the continuous motion."""
        return self.moving.peaks()

    def time_scaled(self, factor: float) -> PausedTrajectory:
        """
        Return the same path with the time of the motion scaled by a factor; pauses remain.

        Parameters
        ----------
        factor : float
            New over old duration of the motion, positive.

        Returns
        -------
        PausedTrajectory
            With velocities divided by the factor, accelerations by its square.

        Raises
        ------
        InvalidInputError
            If the factor is not within 1e-30 and 1e30.

        """
        return PausedTrajectory(
            self.moving.time_scaled(factor), self.via_index, self.at_rest, self.pauses)


def motions_of(trajectory: Trajectory) -> tuple[Trajectory, ...]:
    """
    Return the motions of which a trajectory consists, without pauses.

    Parameters
    ----------
    trajectory : Trajectory
        With pauses or without.

    Returns
    -------
    tuple of Trajectory
        One after another; the trajectory itself, where it is neither paused nor joined.

    """
    if isinstance(trajectory, PausedTrajectory):
        return motions_of(trajectory.moving)
    return trajectory.parts if isinstance(trajectory, JoinedTrajectory) else (trajectory,)
