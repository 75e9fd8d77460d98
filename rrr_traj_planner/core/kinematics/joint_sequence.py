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
Inverse kinematics at consecutive via points: whole turns and free angles chosen jointly.

The nearest solution at every point gives the least travel. If it leaves a joint's range, or if the
other direction might avoid a reversal, the turns of all points are chosen together for the least
estimated time (`least_time_turns`). On joint axis 1, where theta_1 is free, it is interpolated
between the point before and the point after.
"""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.errors import UnreachableError
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics
from rrr_traj_planner.core.kinematics.joint_ranges import (
    nearest_turns,
    out_of_range,
    TURN,
    whole_turns,
)
from rrr_traj_planner.core.kinematics.least_time_turns import least_time_turns, TRAVEL
from rrr_traj_planner.core.kinematics.postures import Posture
from rrr_traj_planner.core.kinematics.travel_time import THROUGH, travel_times, ViaPointBehaviour
from rrr_traj_planner.core.rounding import TIP_ROUNDING


def joint_sequence(model: RobotModel, limits: JointLimits, points: Array, posture: Posture,
                   start: Array | None = None, passing: ViaPointBehaviour = THROUGH) -> Array:
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
    passing : ViaPointBehaviour
        How the motion passes the points, for the estimate of time.

    Returns
    -------
    ndarray, shape (n, 3)
        Joint positions [rad]. If no whole turn brings a joint into its range, the nearest one.

    Raises
    ------
    UnreachableError
        If a point is outside the workspace; with its number.

    """
    q = _solutions(model, points, posture)
    free = np.hypot(points[:, 0], points[:, 1]) <= TIP_ROUNDING
    if start is not None:
        q, free = np.vstack((start, q)), np.concatenate(([False], free))
    if free.all():
        q[:, 0] = np.clip(0.0, limits.min_position[0], limits.max_position[0])
    elif free.any():  # preliminary: as at the point before, or at the first that is not free
        q[:, 0] = q[np.maximum.accumulate(np.where(free, free.argmin(), np.arange(len(q)))), 0]
    q[1:] -= TURN * np.cumsum(nearest_turns(np.diff(q, axis=0)), axis=0)
    q += whole_turns(q, limits, start)
    for j in np.flatnonzero(_needs_search(limits, q, passing))[::-1].tolist():
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
    return q if start is None else q[1:]


def _solutions(model: RobotModel, points: Array, posture: Posture) -> Array:
    """Return joint positions at each point, each joint up to whole turns."""
    q = np.empty((len(points), 3))
    for i, point in enumerate(points):
        try:
            q[i] = inverse_kinematics(model, point, posture.elbow, shoulder=posture.shoulder)
        except UnreachableError as error:
            raise UnreachableError(f'via point {i}: {error}', error.distance, i) from None
    return q


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
    long = 2.0 * (np.pi - np.abs(travel)) < saved
    other = TURN * np.sign(travel)
    possible = (~out_of_range(q[:-1] + other, limits)) | (~out_of_range(q[1:] - other, limits))
    return np.asarray(out_of_range(q, limits).any(axis=0) | (long & possible).any(axis=0))


def _elapsed(limits: JointLimits, q: Array, joint: int, passing: ViaPointBehaviour) -> Array:
    """Return the times of arrival [s] at each point by the estimate for the other joints, (n,)."""
    others = [j for j in range(3) if j != joint]
    times = travel_times(limits, q, passing) + TRAVEL * np.abs(np.diff(q, axis=0))
    return np.concatenate(([0.0], np.cumsum(times[:, others].max(axis=1))))
