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
Inverse kinematics at consecutive via points: solutions and whole turns chosen jointly.

First one of the solutions at each point is chosen (`least_time_chain`), in one posture or in any.
Then whole turns: the nearest solution at every point gives the least travel. If it leaves a
joint's range, or if the other direction might avoid a reversal, the turns of all points are chosen
together for the least estimated time (`least_time_turns`). On joint axis 1, where theta_1 is free,
it is interpolated between the point before and the point after.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeAlias

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, BoolArray, IntArray
from rrr_traj_planner.core.errors import UnreachableError
from rrr_traj_planner.core.kinematics.axis_frame import axis_frame
from rrr_traj_planner.core.kinematics.inverse import point_text, reachable
from rrr_traj_planner.core.kinematics.joint_ranges import (
    nearest_turns,
    out_of_range,
    TURN,
    whole_turns,
)
from rrr_traj_planner.core.kinematics.least_time_chain import least_time_chain
from rrr_traj_planner.core.kinematics.least_time_turns import least_time_turns, TRAVEL
from rrr_traj_planner.core.kinematics.postures import (
    ALL_POSTURES,
    ANY_POSTURE,
    in_posture,
    Posture,
)
from rrr_traj_planner.core.kinematics.solutions import all_solutions
from rrr_traj_planner.core.kinematics.travel_time import (
    THROUGH,
    travel_time,
    travel_times,
    ViaPointBehaviour,
)
from rrr_traj_planner.core.rounding import JOINT_ROUNDING, TIP_ROUNDING

CanHold: TypeAlias = Callable[[Array], BoolArray]


class _Options(NamedTuple):
    """Solutions to choose from: positions (m, 3), the point of each (m,), the number of points."""

    q: Array
    of_point: IntArray
    points: int

    @property
    def lacking(self) -> int | None:
        """Return the first point without a solution."""
        numbers = np.bincount(self.of_point, minlength=self.points)
        return None if numbers.all() else int(numbers.argmin())

    def only(self, wanted: BoolArray) -> _Options:
        """Return some of them."""
        return _Options(self.q[wanted], self.of_point[wanted], self.points)

    def at_each_point(self) -> list[Array]:
        """Return the positions at each point."""
        return np.split(self.q, np.searchsorted(self.of_point, np.arange(1, self.points)))


def joint_sequence(model: RobotModel, limits: JointLimits, points: Array,
                   posture: Posture = ANY_POSTURE, start: Array | None = None,
                   passing: ViaPointBehaviour = THROUGH,
                   can_hold: CanHold | None = None) -> Array:
    """
    Return joint positions at consecutive via points.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Ranges; velocities and accelerations for the estimate of time.
    points : ndarray, shape (n, 3)
        Tip positions [m].
    posture : Posture
        Of all points, so far as it is asked for.
    start : ndarray, shape (3,), optional
        Joint positions before the first point [rad].
    passing : ViaPointBehaviour
        How the motion passes the points, for the estimate of time.
    can_hold : callable, optional
        Which of joint positions (m, 3) the arm can hold at rest, (m,); others are avoided. None:
        all.

    Returns
    -------
    ndarray, shape (n, 3)
        Joint positions [rad]. If no whole turn brings a joint into its range, the nearest one.

    Raises
    ------
    UnreachableError
        If a point is outside the workspace, or out of reach in the posture; with its number.

    """
    free = np.hypot(*axis_frame(model).coordinates(points)[:, :2].T) <= TIP_ROUNDING
    options = _options(model, limits, points, posture, free, can_hold)
    chosen = _chosen(limits, options, free, start, passing)
    q, turns_matter = _with_turns(limits, options.q[chosen], free, start, passing)
    if not turns_matter or None not in posture:
        return q
    # Which solutions are best was found without regard to the ends of wide ranges.
    every = [q]
    for alone in filter(posture.includes, ALL_POSTURES):
        fits = in_posture(model, options.q, alone)
        some = options.only(fits)
        if some.lacking is None and not fits[chosen].all():
            q = some.q[_chosen(limits, some, free, start, passing)]
            every.append(_with_turns(limits, q, free, start, passing)[0])
    return min(every, key=lambda x: _estimate(limits, x, start, passing))


def _estimate(limits: JointLimits, q: Array, start: Array | None,
              passing: ViaPointBehaviour) -> tuple[bool, float]:
    """Return whether a joint leaves its range, and the estimated time [s]."""
    whole = q if start is None else np.vstack((start, q))
    return bool(out_of_range(q, limits).any()), travel_time(limits, whole, passing)


def _with_turns(limits: JointLimits, q: Array, free: BoolArray, start: Array | None,
                passing: ViaPointBehaviour) -> tuple[Array, bool]:
    """Return positions with whole turns and free angles, and whether turns had to be sought."""
    if start is not None:
        q, free = np.vstack((start, q)), np.concatenate(([False], free))
    if free.all():
        q[:, 0] = np.clip(0.0, limits.min_position[0], limits.max_position[0])
    elif free.any():  # preliminary: as at the point before, or at the first that is not free
        q[:, 0] = q[np.maximum.accumulate(np.where(free, free.argmin(), np.arange(len(q)))), 0]
    q[1:] -= TURN * np.cumsum(nearest_turns(np.diff(q, axis=0)), axis=0)
    q += whole_turns(q, limits, start)
    sought = _needs_search(limits, q, passing)
    for j in np.flatnonzero(sought)[::-1].tolist():
        at = np.flatnonzero(~free) if j == 0 else np.arange(len(q))
        q[at, j] = least_time_turns(
            limits, j, q[at, j], np.diff(_elapsed(limits, q, j, passing)[at]), start is not None,
            passing)
    if free.any() and not free.all():
        elapsed = _elapsed(limits, q, 0, passing)
        q[free, 0] = np.clip(np.interp(elapsed[free], elapsed[~free], q[~free, 0]),
                             limits.min_position[0], limits.max_position[0])
    q = np.where(out_of_range(q, limits), q,
                 np.clip(q, limits.min_position, limits.max_position))
    return q if start is None else q[1:], bool(sought.any())


def _options(model: RobotModel, limits: JointLimits, points: Array, posture: Posture,
             free: BoolArray, can_hold: CanHold | None) -> _Options:
    """Return the solutions at each point; only those in range that can be held, if there are."""
    found, count = all_solutions(model, points)
    of_point = np.repeat(np.arange(len(points)), count)
    q = found[np.arange(found.shape[1]) < count[:, np.newaxis]]
    options = _Options(q, of_point, len(points)).only(in_posture(model, q, posture))
    if options.lacking is not None:
        raise _unreachable(model, points[options.lacking], posture, options.lacking)
    options = options._replace(q=_within_ranges(options.q, limits))
    outside = out_of_range(options.q, limits) & ~_full_range(limits)
    outside[free[options.of_point], 0] = False
    faults = 2 * outside.any(axis=1) + (0 if can_hold is None else ~can_hold(options.q))
    least = np.full(len(points), 4)
    np.minimum.at(least, options.of_point, faults)
    return options.only(faults == least[options.of_point])


def _chosen(limits: JointLimits, options: _Options, free: BoolArray, start: Array | None,
            passing: ViaPointBehaviour) -> IntArray:
    """Return which of the solutions is the one at each point, whole turns aside."""
    if len(options.q) == options.points:
        return np.arange(options.points)
    q = options.q.copy()
    q[free[options.of_point], 0] = np.nan
    compared = options._replace(q=q).at_each_point()
    if start is not None:
        compared = [start[np.newaxis], *compared]
    chosen = least_time_chain(limits, compared, passing, _full_range(limits))[-options.points:]
    first = np.searchsorted(options.of_point, np.arange(options.points))
    return np.asarray(first + chosen)


def _full_range(limits: JointLimits) -> BoolArray:
    """Return which joints can be in any position, whole turns aside: these are chosen later."""
    return np.asarray(limits.max_position - limits.min_position >= TURN)


def _unreachable(model: RobotModel, point: Array, posture: Posture, i: int) -> UnreachableError:
    """Return the error of a via point without a solution in the posture."""
    try:
        reachable(model, point)
    except UnreachableError as error:
        return UnreachableError(f'via point {i}: {error}', error.distance, i)
    return UnreachableError(
        f'via point {i}: {point_text(point)} is out of reach with {posture}', 0.0, i)


def _within_ranges(q: Array, limits: JointLimits) -> Array:
    """Return solutions with the whole turns that bring joints into their ranges, or near them."""
    with np.errstate(invalid='ignore'):  # infinite ends
        low, high = limits.min_position, limits.max_position
        inside = q + TURN * np.ceil((low - JOINT_ROUNDING - q) / TURN)
        middle = q + TURN * np.round((0.5 * (low + high) - q) / TURN)
    found = np.where(inside <= high + JOINT_ROUNDING, inside, middle)
    return np.where(_full_range(limits), q, found)


def _needs_search(limits: JointLimits, q: Array, passing: ViaPointBehaviour) -> BoolArray:
    """
    Return for which joints the nearest turns are out of range or may not be optimal, shape (3,).

    Going round the other way takes 2 (pi - |travel|) / v longer; avoiding a reversal at both ends
    saves at most the time of a ramp down and a ramp up at each.
    """
    travel = np.diff(q, axis=0)
    with np.errstate(invalid='ignore'):
        saved = 2.0 * limits.max_velocity ** 2 / (
            passing.mean_acceleration * limits.max_acceleration)
    long = (travel != 0.0) & (2.0 * (np.pi - np.abs(travel)) < saved)
    sought = out_of_range(q, limits).any(axis=0)
    if long.any():
        other = TURN * np.sign(travel)
        possible = (~out_of_range(q[:-1] + other, limits)
                    | ~out_of_range(q[1:] - other, limits))
        sought |= (long & possible).any(axis=0)
    return np.asarray(sought)


def _elapsed(limits: JointLimits, q: Array, joint: int, passing: ViaPointBehaviour) -> Array:
    """Return the times of arrival [s] at each point by the estimate for the other joints, (n,)."""
    others = [j for j in range(3) if j != joint]
    times = travel_times(limits, q, passing) + TRAVEL * np.abs(np.diff(q, axis=0))
    return np.concatenate(([0.0], np.cumsum(times[:, others].max(axis=1))))
