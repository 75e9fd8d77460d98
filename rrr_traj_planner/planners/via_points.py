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

"""Via points in joint space, checked against ranges and holding torques."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from rrr_traj_planner.core.arm.degrees import explained_by_degrees, HINT
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque
from rrr_traj_planner.core.errors import (
    format_distinct,
    JointRangeError,
    LimitViolationError,
    StartStateError,
)
from rrr_traj_planner.core.kinematics.joint_ranges import out_of_range, range_error
from rrr_traj_planner.core.kinematics.joint_sequence import joint_sequence
from rrr_traj_planner.core.kinematics.postures import ANY_POSTURE, Posture
from rrr_traj_planner.core.kinematics.travel_time import THROUGH, ViaPointBehaviour
from rrr_traj_planner.core.rounding import JOINT_ROUNDING
from rrr_traj_planner.core.trajectory.time_scaling import TORQUE_ROUNDING
from rrr_traj_planner.planners.effort_errors import holding_error


def joint_via_points(model: RobotModel, limits: JointLimits, points: Array,
                     start: Array | None, posture: Posture = ANY_POSTURE,
                     passing: ViaPointBehaviour = THROUGH) -> Array:
    """
    Return joint positions of via points.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Positions and holding torques must be within.
    points : ndarray, shape (n, 3)
        Tip positions [m].
    start : ndarray, shape (3,), optional
        Joint positions [rad] before the first via point.
    posture : Posture
        Of all points, so far as it is asked for.
    passing : ViaPointBehaviour
        How the motion passes via points, for the choice of solutions and whole turns.

    Returns
    -------
    ndarray, shape (n, 3)
        Joint positions [rad].

    Raises
    ------
    UnreachableError
        If a point is outside the workspace, or out of reach in the posture.
    JointRangeError
        If a joint would be out of its range.
    LimitViolationError
        If the motors cannot hold the arm at a point.

    """
    q = joint_sequence(model, limits, points, posture, start, passing,
                       lambda x: can_hold(model, limits, x))
    for i, j in np.argwhere(out_of_range(q, limits)).tolist():
        raise range_error(model, limits, f'via point {i}', j, q[i], i)
    failure = holding_failure(model, limits, q)
    if failure is not None:
        raise failure
    return q


def checked_joint_positions(model: RobotModel, limits: JointLimits, q: Array) -> Array:
    """
    Return joint positions that are given for via points, checked.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Positions and holding torques must be within.
    q : ndarray, shape (n, 3)
        Joint positions [rad].

    Returns
    -------
    ndarray, shape (n, 3)
        The same; a joint beyond the end of its range by no more than rounding is on its end.

    Raises
    ------
    JointRangeError
        If a joint is out of its range; it asks whether positions are in degrees, where those
        explain one.
    LimitViolationError
        If the motors cannot hold the arm at a point.

    """
    low, high = limits.min_position, limits.max_position
    for i, j in np.argwhere(out_of_range(q, limits)).tolist():
        at, lowest, highest = format_distinct(q[i, j], low[j], high[j])
        hint = HINT if any(map(explained_by_degrees, q[i], low, high)) else ''
        raise JointRangeError(
            f'via point {i}: {model.joint_names[j]} is at {at} rad, limits {lowest} to {highest} '
            f'rad{hint}', model.joint_names[j], float(q[i, j]),
            float(low[j] if q[i, j] < low[j] else high[j]), i)
    q = np.clip(q, low, high)
    failure = holding_failure(model, limits, q)
    if failure is not None:
        raise failure
    return q


def check_start(model: RobotModel, limits: JointLimits, start: Array,
                tolerance: float = JOINT_ROUNDING, rests: bool = True) -> Array:
    """
    Return a start state, checked.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Its limits.
    start : ndarray, shape (3,)
        Joint positions [rad].
    tolerance : float
        Start state tolerance, for measurement noise: by how much a joint may be outside its
        range [rad].
    rests : bool
        Whether the arm must be able to rest there.

    Returns
    -------
    ndarray, shape (3,)
        The same; a joint outside its range by no more than the tolerance is on its end.

    Raises
    ------
    StartStateError
        If a joint is out of its range or cannot be held there; it asks whether positions are in
        degrees, where those explain one.

    """
    low, high = limits.min_position, limits.max_position
    allowance = max(tolerance, JOINT_ROUNDING)
    for j in np.flatnonzero((start < low - allowance) | (start > high + allowance)).tolist():
        at, lowest, highest, *_ = format_distinct(
            start[j], low[j], high[j], low[j] - allowance, high[j] + allowance)
        allowed = (f', start_state_tolerance {allowance:g} rad'
                   if allowance > JOINT_ROUNDING else '')
        hint = HINT if any(map(explained_by_degrees, start, low, high)) else ''
        raise StartStateError(f'start state: {model.joint_names[j]} is at {at} rad, limits '
                              f'{lowest} to {highest} rad{allowed}{hint}')
    start = np.clip(start, low, high)
    failure = holding_failure(model, limits, start[np.newaxis], ['start state'])
    if rests and failure is not None:
        raise StartStateError(str(failure))
    return start


def can_hold(model: RobotModel, limits: JointLimits, q: Array) -> BoolArray:
    """
    Return in which poses the motors can hold the arm against gravity.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Effort limits.
    q : ndarray, shape (n, 3)
        Joint positions [rad].

    Returns
    -------
    ndarray of bool, shape (n,)
        Which.

    """
    most = limits.max_effort * (1.0 + TORQUE_ROUNDING)
    if np.isinf(most).all():
        return np.ones(len(q), dtype=bool)
    return np.asarray((np.abs(gravity_torque(model, q)) <= most).all(axis=1))


def holding_failure(model: RobotModel, limits: JointLimits, q: Array,
                    names: Sequence[str] = ()) -> LimitViolationError | None:
    """
    Return the error of the first pose that the motors cannot hold against gravity.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Effort limits.
    q : ndarray, shape (n, 3)
        Joint positions [rad].
    names : sequence of str, optional
        What the poses are, for the message; by default via points.

    Returns
    -------
    LimitViolationError or None
        None where all can be held.

    """
    unheld = np.flatnonzero(~can_hold(model, limits, q))
    if not len(unheld):
        return None
    i, torque = int(unheld[0]), np.abs(gravity_torque(model, q))
    j = int((torque[i] / limits.max_effort).argmax())
    where = names[i] if names else f'via point {i}'
    return holding_error(f'{where}:', model.joint_names[j], float(torque[i, j]),
                         float(limits.max_effort[j]), i)
