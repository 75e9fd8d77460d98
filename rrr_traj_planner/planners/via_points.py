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

"""Via points in joint space: the elbow branch that keeps the limits, and holding torques."""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics import gravity_torque
from rrr_traj_planner.core.errors import (
    LimitViolationError,
    StartStateError,
    UnreachableError,
)
from rrr_traj_planner.core.inverse_kinematics import (
    Elbow,
    ELBOWS,
    inverse_kinematics,
    RANGE_TOLERANCE,
    wrap_into_limits,
)
from rrr_traj_planner.core.limits import JointLimits
from rrr_traj_planner.core.model import RobotModel

HOLDING_TOLERANCE = 1e-9  # relative


def joint_via_points(model: RobotModel, limits: JointLimits, points: Array,
                     start: Array | None, elbow: Elbow | None) -> Array:
    """
    Return joint positions of via points, all on one elbow branch.

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
    elbow : {'up', 'down'}, optional
        The branch; None: the first on which every point keeps the limits.

    Returns
    -------
    ndarray, shape (n, 3)
        Joint positions [rad].

    Raises
    ------
    UnreachableError
        If a point is outside the workspace.
    LimitViolationError
        If no branch keeps the limits; told of the branch that gets furthest.

    """
    failures: list[tuple[int, LimitViolationError]] = []
    for branch in (elbow,) if elbow else ELBOWS:
        q = _on_branch(model, limits, points, start, branch)
        failure = _position_failure(model, limits, q, branch)
        if failure is None:
            holding = holding_failure(model, limits, q)
            if holding is None:
                return q
            failures.append((0, holding))
        else:
            failures.append((1, failure))
    raise min(failures, key=lambda f: f[0])[1]


def check_start(model: RobotModel, limits: JointLimits, start: Array) -> Array:
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

    Returns
    -------
    ndarray, shape (3,)
        The same, moved into range where rounding put it outside.

    Raises
    ------
    StartStateError
        If a joint is out of its range or cannot be held there.

    """
    low, high = limits.min_position, limits.max_position
    outside = (start < low - RANGE_TOLERANCE) | (start > high + RANGE_TOLERANCE)
    if outside.any():
        j = int(outside.argmax())
        raise StartStateError(
            f'start state: {model.joint_names[j]} is at {start[j]:.6g} rad, '
            f'limits {low[j]:.6g} to {high[j]:.6g} rad')
    start = np.clip(start, low, high)
    failure = holding_failure(model, limits, start[np.newaxis])
    if failure is not None:
        raise StartStateError(str(failure).replace('via point 0', 'start state'))
    return start


def holding_failure(model: RobotModel, limits: JointLimits,
                    q: Array) -> LimitViolationError | None:
    """
    Return the error of the first via point that the motors cannot hold against gravity.

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
    LimitViolationError or None
        None where all can be held.

    """
    torque = np.abs(gravity_torque(model, q))
    broken = np.argwhere(torque > limits.max_effort * (1.0 + HOLDING_TOLERANCE))
    if not len(broken):
        return None
    i, j = map(int, broken[0])
    needed, limit = float(torque[i, j]), float(limits.max_effort[j])
    return LimitViolationError(
        f'via point {i}: {model.joint_names[j]} needs {needed:.1f} N m to hold, '
        f'limit {limit:g} N m', model.joint_names[j], needed, limit, via_point=i)


def _on_branch(model: RobotModel, limits: JointLimits, points: Array, start: Array | None,
               elbow: Elbow) -> Array:
    """Return joint positions on a branch, each joint wrapped into its range if it can be."""
    q, previous = np.empty((len(points), 3)), start
    for i, point in enumerate(points):
        try:
            q[i] = wrap_into_limits(
                inverse_kinematics(model, point, elbow, previous), limits, previous)
        except UnreachableError as error:
            raise UnreachableError(f'via point {i}: {error}', error.distance, i) from None
        previous = q[i]
    return q


def _position_failure(model: RobotModel, limits: JointLimits, q: Array,
                      elbow: Elbow) -> LimitViolationError | None:
    """Return the error of the first via point out of a joint's range."""
    low, high = limits.min_position, limits.max_position
    broken = np.argwhere((q < low) | (q > high))
    if not len(broken):
        return None
    i, j = map(int, broken[0])
    value = float(q[i, j])
    return LimitViolationError(
        f'via point {i}: {model.joint_names[j]} would be at {value:.6g} rad (elbow {elbow}), '
        f'limits {low[j]:.6g} to {high[j]:.6g} rad', model.joint_names[j], value,
        float(low[j] if value < low[j] else high[j]), via_point=i)
