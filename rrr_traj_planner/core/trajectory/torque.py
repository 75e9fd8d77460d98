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

"""Motor torques along a motion: their peaks, and the rate at which they fit their limits."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, IntArray
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque, inverse_dynamics
from rrr_traj_planner.core.trajectory.trajectory import times_within, Trajectory

# Torque is analytic between knots. So many steps there, none longer than LONGEST_STEP unless the
# motion is so slow that MOST_STEPS are enough, put every high peak in a bracket of its own.
STEPS_PER_INTERVAL = 10
MOST_STEPS = 400
LONGEST_STEP = 0.012  # s

# A peak is looked for around the top of a parabola through three points, at these parts of the way
# to the outer two: a bracket narrows to a 64th where the parabola is good, at worst to a half. The
# value of a smooth peak stands to the square of that.
ZOOM_ROUNDS = 12
OFFSETS = np.array([-32.0, -8.0, -1.0, 0.0, 1.0, 8.0, 32.0]) / 64.0
# A local maximum is followed where it might be the highest of all by more than this part: between
# equal steps a smooth quantity rises by an eighth of its second difference, one with corners by
# half; beside a step of a seventh of the other's size, by seven quarters.
RISE, ZOOMED_RISE, NEGLIGIBLE = 0.5, 2.0, 1e-8
# Points no further apart are the two sides of a knot: there is nothing between them.
SAME_TIME = 1e-8  # s

TORQUE_TOLERANCE = 1e-9  # relative, for the rounding of a torque that is just at its limit


class Extreme(NamedTuple):
    """The largest value of a quantity over a motion, for each joint."""

    value: Array  # shape (3,)
    time: Array   # when [s], shape (3,)


def peak_torque(model: RobotModel, trajectory: Trajectory) -> Extreme:
    """
    Return the largest magnitude of each joint's torque over the continuous motion (5.39).

    Parameters
    ----------
    model : RobotModel
        The arm.
    trajectory : Trajectory
        The motion.

    Returns
    -------
    Extreme
        Torques [N m] and their times.

    """
    def magnitude(t: Array) -> Array:
        q, qd, qdd, _ = trajectory(t)
        return np.abs(inverse_dynamics(model, q, qd, qdd))

    return maximum_over_time(magnitude, torque_grid(trajectory))


def peak_holding_torque(model: RobotModel, trajectory: Trajectory) -> Extreme:
    """
    Return the largest torque that gravity alone asks of each joint along a path.

    Parameters
    ----------
    model : RobotModel
        The arm.
    trajectory : Trajectory
        The motion.

    Returns
    -------
    Extreme
        Torques [N m] and their times.

    """
    return maximum_over_time(lambda t: np.abs(gravity_torque(model, trajectory(t)[0])),
                             torque_grid(trajectory))


def stretch_for_torque(model: RobotModel, limits: JointLimits, trajectory: Trajectory) -> Extreme:
    """
    Return by how much each joint's torque limit asks a motion to be slowed down.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Effort limits, infinite where there is none.
    trajectory : Trajectory
        The motion.

    Returns
    -------
    Extreme
        Least factors at which each joint's torque keeps its limit; below 1 the motion has torque
        to spare. And where the factor comes from.

    """
    if not np.isfinite(limits.max_effort).any():
        return Extreme(np.zeros(3), np.zeros(3))
    squared = maximum_over_time(
        lambda t: squared_stretch(model, limits, *trajectory(t)[:3]), torque_grid(trajectory))
    return Extreme(np.sqrt(squared.value), squared.time)


def squared_stretch(model: RobotModel, limits: JointLimits, q: Array, qd: Array,
                    qdd: Array) -> Array:
    """
    Return the square of the factor by which a motion must be slowed down, where it is so.

    Run through more slowly by a factor f, the part of the torque that is not gravity falls
    with f squared. Limits below what gravity takes give an infinite factor.

    Parameters
    ----------
    model, limits
        As in `stretch_for_torque`.
    q, qd, qdd : ndarray, shape (..., 3)
        Positions, velocities and accelerations [rad, rad/s, rad/s^2].

    Returns
    -------
    ndarray, shape (..., 3)
        For each joint, 0 where it has no effort limit.

    """
    rest = np.zeros_like(q)
    gravity, torque = inverse_dynamics(  # of terms at q that are there once
        model, q, np.stack((rest, qd)), np.stack((rest, qdd)))
    motion = torque - gravity
    room = limits.max_effort - np.sign(motion) * gravity
    holds = np.abs(gravity) <= limits.max_effort * (1.0 + TORQUE_TOLERANCE)
    with np.errstate(divide='ignore', invalid='ignore'):
        factor = np.where(holds & (room > 0.0), np.abs(motion) / room, np.inf)
    return np.where(np.isinf(limits.max_effort), 0.0, factor)


def maximum_over_time(quantity: Callable[[Array], Array], grid: Array) -> Extreme:
    """
    Return the maxima of a piecewise smooth quantity, refined between the points of a grid.

    Parameters
    ----------
    quantity : callable
        Values of shape (n, K) at times of shape (n,).
    grid : ndarray
        Increasing times [s], fine enough for each high local maximum to show.

    Returns
    -------
    Extreme
        For each column.

    """
    values = quantity(grid)
    best = values.argmax(axis=0)
    value, time = values[best, np.arange(len(best))], grid[best]
    t, f, column = _brackets(values, grid)
    at_end = np.zeros(len(column), bool)
    for _ in range(ZOOM_ROUNDS if np.isfinite(value).all() else 0):
        if not len(column):
            break
        inner = _around_tops(t, f)
        at = quantity(inner.ravel()).reshape(*inner.shape, -1)
        own = np.take_along_axis(at, column[:, np.newaxis, np.newaxis], axis=2)[..., 0]
        t = np.concatenate((t[:, :1], inner, t[:, 2:]), axis=1)
        f = np.concatenate((f[:, :1], own, f[:, 2:]), axis=1)
        rows, top = np.arange(len(t)), f.argmax(axis=1)
        highest = f[rows, top]
        rising = np.argsort(highest)  # the last of a column is its highest
        rising = rising[highest[rising] > value[column[rising]]]
        value[column[rising]], time[column[rising]] = highest[rising], t[rising, top[rising]]
        beside = np.clip(top[:, np.newaxis] + (-1, 0, 1), 0, t.shape[1] - 1)
        t, f = t[rows[:, np.newaxis], beside], f[rows[:, np.newaxis], beside]
        fall = 2.0 * highest - f[:, 0] - f[:, 2]
        promising = highest + ZOOMED_RISE * fall > value[column] * (1.0 + NEGLIGIBLE)
        was, at_end = at_end, (t[:, 1] == t[:, 0]) | (t[:, 1] == t[:, 2])
        promising &= ~(was & at_end)  # twice the highest: the top is the bracket's end
        t, f, column, at_end = t[promising], f[promising], column[promising], at_end[promising]
    return Extreme(value, time)


def _brackets(values: Array, grid: Array) -> tuple[Array, Array, IntArray]:
    """Return points around local maxima that may hide a column's highest value: t, f, column."""
    local = values > 0.0
    local[1:] &= values[1:] >= values[:-1]
    local[:-1] &= values[:-1] >= values[1:]
    with np.errstate(invalid='ignore'):
        local &= values + RISE * _bends(values) > values.max(axis=0) * (1.0 + NEGLIGIBLE)
    column, row = np.nonzero(local.T)
    apart = np.diff(grid, prepend=grid[0], append=grid[-1]) > SAME_TIME
    beside = np.stack((row - apart[row], row, row + apart[row + 1]), axis=1)
    return grid[beside], values[beside, column[:, np.newaxis]], column


def _around_tops(t: Array, f: Array) -> Array:
    """Return times around the tops of parabolas through three points each, (k, len(OFFSETS))."""
    before, after = t[:, 1] - t[:, 0], t[:, 2] - t[:, 1]
    rise, fall = f[:, 1] - f[:, 0], f[:, 1] - f[:, 2]
    with np.errstate(divide='ignore', invalid='ignore'):
        shift = 0.5 * (rise * after ** 2 - fall * before ** 2) / (rise * after + fall * before)
    top = np.clip(t[:, 1] + np.where(np.isfinite(shift), shift, 0.0), t[:, 0], t[:, 2])
    reach = np.maximum(top - t[:, 0], t[:, 2] - top)
    return np.clip(top[:, np.newaxis] + reach[:, np.newaxis] * OFFSETS, t[:, :1], t[:, 2:])


def _bends(values: Array) -> Array:
    """Return the largest second difference beside each point; a peak between rises an eighth."""
    if len(values) < 3:
        return np.full(values.shape, np.inf)
    bends = np.pad(np.abs(np.diff(values, 2, axis=0)), ((2, 2), (0, 0)), mode='edge')
    return np.asarray(np.max([bends[k:k + len(values)] for k in range(3)], axis=0))


def torque_grid(trajectory: Trajectory) -> Array:
    """
    Return times close enough for every high peak of the torque to show.

    Parameters
    ----------
    trajectory : Trajectory
        The motion.

    Returns
    -------
    ndarray
        Increasing times [s] that meet every knot.

    """
    return times_within(trajectory, STEPS_PER_INTERVAL, LONGEST_STEP, MOST_STEPS)
