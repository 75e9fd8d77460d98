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
When joints move in which direction, for Coulomb friction.

Where a joint turns, Coulomb friction steps from one side to the other; a turning point is found as
a zero of velocity (safeguarded Newton iteration: Press et al., Numerical Recipes, section 9.4).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.dynamics.motor_torque import direction_of, rest_speed_of
from rrr_traj_planner.core.trajectory.trajectory import ONE_SIDED, Trajectory

MOST_STEPS = 60          # of the iteration; chosen: bisections alone would reach rounding
ZERO_TOLERANCE = 1e-12   # s; chosen: a thousandth of ONE_SIDED


class Directions(NamedTuple):
    """
    The directions of motion, for each joint constant between its changes of direction.

    A joint that rests over an interval has direction 0 there: resting and moving on are changes.
    Attributes hold arrays for joints 1 to 3; joint j changes k_j times, and stops m_j times.

    Attributes
    ----------
    times : tuple of ndarray, shape (k_j,)
        Changes of direction [s], increasing.
    signs : tuple of ndarray, shape (k_j + 1,)
        1, -1 or 0: before the first change, between each two, and after the last.
    stops : tuple of ndarray, shape (m_j,)
        Instants [s] at which a joint rests that moves before or after, or both; increasing.

    """

    times: tuple[Array, Array, Array]
    signs: tuple[Array, Array, Array]
    stops: tuple[Array, Array, Array]

    def at(self, t: Array) -> Array:
        """
        Return the directions at given times; at a change, that which begins; 0 at a stop.

        Parameters
        ----------
        t : ndarray, shape (n,)
            Times [s].

        Returns
        -------
        ndarray, shape (n, 3)
            1, -1 or 0.

        """
        return np.stack([np.where(
            np.isin(t, stops), 0.0, signs[np.searchsorted(times, t, side='right')])
            for times, signs, stops in zip(*self)], axis=1)

    def steps(self) -> Array:
        """
        Return the times on either side of which friction differs, and those sides.

        Returns
        -------
        ndarray, shape (n,)
            Increasing [s]; some before the start or after the end.

        """
        turning, stops = np.concatenate(self.times), np.concatenate(self.stops)
        return np.unique(np.concatenate((
            turning, turning - ONE_SIDED, stops, stops - ONE_SIDED, stops + ONE_SIDED)))

    def scaled(self, factor: float) -> Directions:
        """
        Return the directions of the motion with time scaled by a factor.

        Parameters
        ----------
        factor : float
            New over old duration.

        Returns
        -------
        Directions
            Converted, not searched again.

        """
        (t1, t2, t3), (s1, s2, s3) = self.times, self.stops
        return Directions((t1 * factor, t2 * factor, t3 * factor), self.signs,
                          (s1 * factor, s2 * factor, s3 * factor))


def directions(trajectory: Trajectory, grid: Array) -> Directions:
    """
    Return the directions of a motion, cached with it (`Trajectory.cache`).

    Parameters
    ----------
    trajectory : Trajectory
        The motion.
    grid : ndarray, shape (n,)
        Increasing times [s] that meet every knot, between which a joint's acceleration changes
        sign at most once.

    Returns
    -------
    Directions
        Of all joints.

    """
    found = trajectory.cache.get('directions')
    if not isinstance(found, Directions):
        velocity, slowest = _functions(trajectory)
        qd = trajectory(grid)[1]
        at_grid = direction_of(qd, rest_speed_of(qd)).T
        (t1, s1), (t2, s2), (t3, s3) = (
            _of_joint(velocity, slowest, grid, direction, j)
            for j, direction in enumerate(at_grid))
        stop1, stop2, stop3 = (grid[_alone(direction == 0.0)] for direction in at_grid)
        found = trajectory.cache['directions'] = Directions(
            (t1, t2, t3), (s1, s2, s3), (stop1, stop2, stop3))
    return found


def _alone(resting: BoolArray) -> BoolArray:
    """Return which points of a grid rest without their neighbours: instants, not intervals."""
    found = resting.copy()
    found[1:] &= ~resting[:-1]
    found[:-1] &= ~resting[1:]
    return found


_Function = Callable[[Array, int], tuple[Array, Array]]


def _functions(trajectory: Trajectory) -> tuple[_Function, _Function]:
    """Return a joint's velocity and acceleration with their derivatives, as functions of time."""
    def velocity(t: Array, joint: int) -> tuple[Array, Array]:
        _, qd, qdd, _ = trajectory(t)
        return qd[:, joint], qdd[:, joint]

    def acceleration(t: Array, joint: int) -> tuple[Array, Array]:
        _, _, qdd, qddd = trajectory(t)
        return qdd[:, joint], qddd[:, joint]

    return velocity, acceleration


def _of_joint(velocity: _Function, acceleration: _Function, grid: Array, direction: Array,
              joint: int) -> tuple[Array, Array]:
    """Return the times at which a joint changes direction, and the directions between them."""
    if not direction.any():
        return np.zeros(0), np.zeros(1)
    qd, qdd = velocity(grid, joint)
    # Between two points it may turn twice where its speed has a minimum.
    slowest = np.flatnonzero((direction[:-1] * direction[1:] > 0.0)
                             & (qd[:-1] * qdd[:-1] < 0.0) & (qd[1:] * qdd[1:] > 0.0))
    if len(slowest):
        times = _zeros(acceleration, joint, grid[slowest], grid[slowest + 1])
        through = np.sign(velocity(times, joint)[0]) == -direction[slowest]
        grid = np.insert(grid, slowest[through] + 1, times[through])
        direction = np.insert(direction, slowest[through] + 1, -direction[slowest[through]])
    before, after = direction[:-1], direction[1:]
    turning = np.flatnonzero(before * after < 0.0)
    zeros = _zeros(velocity, joint, grid[turning], grid[turning + 1])
    of_intervals = np.where(before != 0.0, before, after)
    # An interval that the joint turns in counts as two.
    starts = np.insert(grid[:-1], turning + 1, zeros)
    signs = np.insert(of_intervals, turning + 1, after[turning])
    changes = np.flatnonzero(np.diff(signs)) + 1
    return starts[changes], signs[np.concatenate(([0], changes))]


def _zeros(function: _Function, joint: int, low: Array, high: Array) -> Array:
    """Return zeros of a function that changes sign between low and high, shape (n,)."""
    if not len(low):
        return low
    sign_low, t = np.sign(function(low, joint)[0]), 0.5 * (low + high)
    for _ in range(MOST_STEPS):
        value, slope = function(t, joint)
        same = np.sign(value) == sign_low
        low, high = np.where(same, t, low), np.where(same, high, t)
        with np.errstate(divide='ignore', invalid='ignore'):
            found = t - value / slope
        found = np.where((found >= low) & (found <= high), found, 0.5 * (low + high))
        moved, t = float(np.abs(found - t).max()), found
        if moved < ZERO_TOLERANCE:
            break
    return t
