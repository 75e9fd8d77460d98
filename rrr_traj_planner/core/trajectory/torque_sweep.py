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

"""Motor torques on a dense grid of times along a motion, and their peaks between."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.trajectory.directions import Directions, directions
from rrr_traj_planner.core.trajectory.maximum import Extreme, maximum_over_time, SAME_TIME
from rrr_traj_planner.core.trajectory.time_scaling import (
    squared_scaling_if_held,
    torque_parts,
    TORQUE_ROUNDING,
    TorqueParts,
)
from rrr_traj_planner.core.trajectory.trajectory import ONE_SIDED, times_within, Trajectory

# Torque is analytic between knots and turning points, where Coulomb friction steps. With this many
# steps there, none longer than LONGEST_STEP unless MOST_STEPS are reached (slow motions), high
# peaks have brackets of their own. Chosen: none of 265 random motions then has a peak too low by
# 1e-6; with four times the steps' length 18 have.
STEPS_PER_INTERVAL = 10
MOST_STEPS = 400
LONGEST_STEP = 0.012  # s

# Time scaling up to which a peak of torque is sought where it was, by one parabola through torques
# NEIGHBOUR of the grid's mean step apart. Peaks so found are too low by up to 3e-9 on 400 random
# motions (relative; 1e-6 with four times the scaling) and 7e-8 on 40 paths with steps, measured.
SLIGHT = 5e-4
NEIGHBOUR = 0.1


class TorquePeaks(NamedTuple):
    """Extremes of torque over the continuous motion."""

    effort: Extreme   # largest magnitudes of torques [N m]
    scaling: Extreme  # least factors of time at which they keep their limits


class TorqueSweep:
    """
    Torques on a dense grid of times along a motion, evaluated once.

    Parameters
    ----------
    model : RobotModel
        The arm.
    times : ndarray, shape (n,)
        Increasing; dense enough to resolve every high peak [s].
    parts : TorqueParts
        Of the motors' torques, shape (n, 3) each [N m].
    moving : Directions, optional
        Directions of motion; not needed without Coulomb friction.

    """

    def __init__(self, model: RobotModel, times: Array, parts: TorqueParts,
                 moving: Directions | None = None) -> None:
        self.model, self.times, self.parts, self._moving = model, times, parts, moving
        self._peaks: dict[bytes, TorquePeaks] = {}
        self._before: dict[bytes, TorquePeaks] = {}  # of the motion before a slight time scaling
        self._factor = 1.0                           # of that scaling

    def scaled(self, factor: float) -> TorqueSweep:
        """
        Return the torques of the motion with time scaled by a factor.

        Parameters
        ----------
        factor : float
            New over old duration.

        Returns
        -------
        TorqueSweep
            Its peaks are not known yet.

        """
        if factor == 1.0:
            return self
        found = TorqueSweep(self.model, self.times * factor, self.parts.scaled(factor),
                            self._moving and self._moving.scaled(factor))
        if abs(factor - 1.0) <= SLIGHT:
            found._before, found._factor = self._peaks, factor
        return found

    def squared_scaling(self, limits: JointLimits) -> Array:
        """
        Return the square of the factor by which the motion must be slowed down, at the times.

        Parameters
        ----------
        limits : JointLimits
            Effort limits, infinite where there is none.

        Returns
        -------
        ndarray, shape (n, 3)
            As `squared_time_scale`.

        """
        return squared_scaling_if_held(limits.max_effort, self.parts)

    def peaks(self, limits: JointLimits, trajectory: Trajectory) -> TorquePeaks:
        """
        Return the extremes over the continuous motion, found together.

        Parameters
        ----------
        limits : JointLimits
            Effort limits, infinite where there is none.
        trajectory : Trajectory
            The motion of the sweep.

        Returns
        -------
        TorquePeaks
            Of both.

        """
        key = limits.max_effort.tobytes()
        if key not in self._peaks:
            moved = self._moved(self._before[key], trajectory) if key in self._before else None
            # Another peak may be the largest after the scaling.
            if moved is None or (np.abs(self.parts.torque)
                                 > moved.effort.value * (1.0 + TORQUE_ROUNDING)).any():
                moved = self._refined(limits, trajectory)
            self._peaks[key] = moved
        return self._peaks[key]

    def _moved(self, before: TorquePeaks, trajectory: Trajectory) -> TorquePeaks:
        """Return the extremes of a slightly time-scaled motion, from those of the unscaled one."""
        time = before.effort.time * self._factor
        apart = NEIGHBOUR * self.times[-1] / len(self.times)
        times = time + np.multiply.outer((-apart, -SAME_TIME, 0.0, SAME_TIME, apart), np.ones(3))
        values = self._efforts(trajectory, times)
        left, middle, right = values[0], values[2], values[-1]
        with np.errstate(divide='ignore', invalid='ignore'):  # vertex of the parabola
            shift = 0.5 * apart * (right - left) / (2.0 * middle - left - right)
        vertex = time + np.clip(np.nan_to_num(shift), -apart, apart)
        times = np.vstack((times, vertex))
        values = np.vstack((values, self._efforts(trajectory, vertex[np.newaxis])))
        best = values.argmax(axis=0), np.arange(3)
        return TorquePeaks(
            Extreme(values[best], times[best]),
            Extreme(before.scaling.value / self._factor, before.scaling.time * self._factor))

    def _efforts(self, trajectory: Trajectory, times: Array) -> Array:
        """Return magnitudes of torque, each joint's at times of its own, (n, 3) [N m]."""
        torque = self._parts_at(trajectory, times.ravel()).torque
        return np.abs(torque.reshape(-1, 3, 3).diagonal(axis1=1, axis2=2))

    def _parts_at(self, trajectory: Trajectory, times: Array) -> TorqueParts:
        """Return the parts of torques at times (n,); at a turning point, those after it."""
        direction = None if self._moving is None else self._moving.at(times)
        return torque_parts(self.model, *trajectory(times)[:3], direction)

    def _refined(self, limits: JointLimits, trajectory: Trajectory) -> TorquePeaks:
        """Return the extremes, refined between the times of the grid."""
        squared = self.squared_scaling(limits)
        limited = bool(np.isfinite(limits.max_effort).any()) and bool(np.isfinite(squared).all())

        def both(parts: TorqueParts) -> Array:
            magnitude = np.abs(parts.torque)
            if not limited:
                return magnitude
            scaling = squared_scaling_if_held(limits.max_effort, parts)
            return np.concatenate((magnitude, scaling), axis=1)

        value, time = maximum_over_time(
            lambda t: both(self._parts_at(trajectory, t)), self.times, both(self.parts))
        if not limited:  # none, or the constant torque alone exceeds one
            worst = squared.argmax(axis=0)
            return TorquePeaks(Extreme(value, time), Extreme(
                np.sqrt(squared[worst, range(3)]), self.times[worst]))
        return TorquePeaks(Extreme(value[:3], time[:3]), Extreme(np.sqrt(value[3:]), time[3:]))


def torque_sweep(model: RobotModel, trajectory: Trajectory) -> TorqueSweep:
    """
    Return the torques along a motion, cached with it (`Trajectory.cache`).

    Parameters
    ----------
    model : RobotModel
        The arm.
    trajectory : Trajectory
        The motion.

    Returns
    -------
    TorqueSweep
        At times dense enough for every high maximum of torque, before each step too.

    """
    found = trajectory.cache.get('torque_sweep')
    if not isinstance(found, TorqueSweep) or found.model is not model:
        times, moving = torque_grid(trajectory), None
        if model.friction.coulomb.any():
            moving = directions(trajectory, times)
            steps = moving.steps()
            times = np.union1d(times, steps[(steps > 0.0) & (steps < trajectory.duration)])
        parts = torque_parts(model, *trajectory(times)[:3],
                             None if moving is None else moving.at(times))
        found = trajectory.cache['torque_sweep'] = TorqueSweep(model, times, parts, moving)
    return found


def torque_grid(trajectory: Trajectory) -> Array:
    """
    Return times dense enough to resolve every high peak of the torque but for friction's steps.

    Parameters
    ----------
    trajectory : Trajectory
        The motion.

    Returns
    -------
    ndarray
        Increasing times [s] that meet every knot, and come just before every step.

    """
    grid = times_within(trajectory, STEPS_PER_INTERVAL, LONGEST_STEP, MOST_STEPS)
    return np.union1d(grid, trajectory.step_times - ONE_SIDED)
