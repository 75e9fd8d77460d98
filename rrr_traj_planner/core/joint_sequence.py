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
Joint positions at consecutive via points: whole turns and free angles chosen for all together.

A joint that turns to the nearest solution from each point to the next has the least way. Where
that takes it out of its range, the turns are those of least estimated time: a shortest path
through the solutions of all points, by dynamic programming. On joint axis 1, where any theta_1
will do, joint 1 is on its way from the point before to the point after.
"""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import UnreachableError
from rrr_traj_planner.core.inverse_kinematics import inverse_kinematics
from rrr_traj_planner.core.joint_ranges import out_of_range, RANGE_TOLERANCE, TURN, whole_turns
from rrr_traj_planner.core.limits import JointLimits
from rrr_traj_planner.core.model import RobotModel
from rrr_traj_planner.core.postures import EDGE_TOLERANCE, Posture

# Of solutions that take equally long the one of least travel is taken, then the one that begins
# nearest to 0: what a radian counts beside a second.
TRAVEL, BEGINNING = 1e-6, 1e-9  # s/rad


def joint_sequence(model: RobotModel, limits: JointLimits, points: Array, posture: Posture,
                   start: Array | None = None) -> Array:
    """
    Return joint positions at consecutive via points, all in one posture.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Ranges; velocities and accelerations for the estimate of time.
    points : ndarray, shape (n, 3)
        Tip positions [m].
    posture : Posture
        The posture.
    start : ndarray, shape (3,), optional
        Joint positions before the first point [rad].

    Returns
    -------
    ndarray, shape (n, 3)
        Joint positions [rad]. A joint that no turn brings into its range at some point is as near
        to it there as turns bring it.

    Raises
    ------
    UnreachableError
        If a point is outside the workspace; with its number.

    """
    q = _solutions(model, points, posture)
    free = np.hypot(points[:, 0], points[:, 1]) <= EDGE_TOLERANCE
    if start is not None:
        q, free = np.vstack((start, q)), np.concatenate(([False], free))
    if free.all():
        q[:, 0] = np.clip(0.0, limits.min_position[0], limits.max_position[0])
    elif free.any():  # for now as at the point before, or at the first that is not free
        q[:, 0] = q[np.maximum.accumulate(np.where(free, free.argmin(), np.arange(len(q)))), 0]
    q[1:] -= TURN * np.cumsum(np.round(np.diff(q, axis=0) / TURN), axis=0)
    q += whole_turns(q, limits, start)
    for j in np.flatnonzero(out_of_range(q, limits).any(axis=0))[::-1].tolist():
        at = np.flatnonzero(~free) if j == 0 else np.arange(len(q))
        q[at, j] = _in_range(limits, j, q[at, j], np.diff(_elapsed(limits, q, j)[at]),
                             start is not None)
    if free.any() and not free.all():
        elapsed = _elapsed(limits, q, 0)
        q[free, 0] = np.interp(elapsed[free], elapsed[~free], q[~free, 0])
    q = np.where(out_of_range(q, limits), q,
                 np.clip(q, limits.min_position, limits.max_position))
    return q if start is None else q[1:]


def estimated_time(limits: JointLimits, q: Array) -> float:
    """
    Return how long a motion through joint positions takes if it rests at each.

    Parameters
    ----------
    limits : JointLimits
        Velocities and accelerations; infinite ones do not bind.
    q : ndarray, shape (n, 3)
        Joint positions [rad].

    Returns
    -------
    float
        [s].

    """
    return float(_rest_to_rest(limits, slice(None), np.diff(q, axis=0)).max(axis=1).sum())


def _solutions(model: RobotModel, points: Array, posture: Posture) -> Array:
    """Return joint positions at each point, of each as many whole turns as it happens."""
    q = np.empty((len(points), 3))
    for i, point in enumerate(points):
        try:
            q[i] = inverse_kinematics(model, point, posture.elbow, shoulder=posture.shoulder)
        except UnreachableError as error:
            raise UnreachableError(f'via point {i}: {error}', error.distance, i) from None
    return q


def _rest_to_rest(limits: JointLimits, joint: int | slice | list[int], ways: Array) -> Array:
    """Return times of ways from rest to rest [s]: velocities over time are trapezia."""
    velocity, acceleration = limits.max_velocity[joint], limits.max_acceleration[joint]
    ways = np.abs(ways)
    with np.errstate(invalid='ignore'):
        ramp = np.where(np.isinf(acceleration), 0.0, velocity / acceleration)
        return np.where(ways >= velocity * ramp, ways / velocity + ramp,
                        2.0 * np.sqrt(ways / acceleration))


def _elapsed(limits: JointLimits, q: Array, joint: int) -> Array:
    """Return the cost at each point that the other joints' ways have had by then, shape (n,)."""
    others = [j for j in range(3) if j != joint]
    ways = np.diff(q, axis=0)[:, others]
    costs = (_rest_to_rest(limits, others, ways) + TRAVEL * np.abs(ways)).max(axis=1)
    return np.concatenate(([0.0], np.cumsum(costs)))


def _in_range(limits: JointLimits, joint: int, q: Array, others: Array, begun: bool) -> Array:
    """
    Return one joint's positions with turns that keep its range and are passed in least time.

    The others' times between the points, (m - 1,), are the least that a way takes. Linear in the
    number of points: for each point and each of its turns the best way there is kept.
    """
    low, high = limits.min_position[joint], limits.max_position[joint]
    most = np.ceil(np.ptp(q) / TURN) + 1.0  # no more turns are of use, however wide the range
    first = np.ceil(np.maximum((low - q - RANGE_TOLERANCE) / TURN, -most))
    last = np.floor(np.minimum((high - q + RANGE_TOLERANCE) / TURN, most))
    none = first > last
    first[none] = last[none] = np.round((0.5 * (low + high) - q[none]) / TURN)
    if begun:
        first[0] = last[0] = 0.0
    turns = first[:, np.newaxis] + np.arange(int((last - first).max()) + 1)
    values = q[:, np.newaxis] + TURN * turns
    refused = np.where(turns <= last[:, np.newaxis], 0.0, np.inf)
    cost, best = refused[0] + BEGINNING * np.abs(values[0]), []
    for i, least in enumerate(others):
        ways = np.abs(values[i + 1] - values[i][:, np.newaxis])
        total = cost[:, np.newaxis] + refused[i + 1] + TRAVEL * ways + np.maximum(
            _rest_to_rest(limits, joint, ways), least)
        best.append(total.argmin(axis=0))
        cost = total.min(axis=0)
    chosen = [int(cost.argmin())]
    for step in reversed(best):
        chosen.append(int(step[chosen[-1]]))
    return np.asarray(values[np.arange(len(q)), chosen[::-1]])
