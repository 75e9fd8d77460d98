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

"""Joint positions along a path of the tip, with their derivatives by arc length."""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array, BoolArray, joint_values
from rrr_traj_planner.core.errors import (
    InvalidInputError,
    LimitViolationError,
    UnreachableError,
)
from rrr_traj_planner.core.inverse_kinematics import (
    EDGE_TOLERANCE,
    Elbow,
    ELBOWS,
    RANGE_TOLERANCE,
)
from rrr_traj_planner.core.limits import JointLimits
from rrr_traj_planner.core.model import RobotModel
from rrr_traj_planner.core.path_kinematics import JointPath, PathPoints, unlimited_joint_path

# A tip this near to joint axis 1 or to an edge of the workspace would need joints that turn at
# once for the tip to move on.
LEAST_CLEARANCE = EDGE_TOLERANCE  # m


def joint_path(model: RobotModel, limits: JointLimits,
               derivatives: tuple[Array, Array, Array, Array], elbow: Elbow,
               previous: ArrayLike | None = None) -> JointPath:
    """
    Return joint positions along a path, on one elbow branch and without a jump.

    Whole turns are added to each joint for the path as a whole, so that it is in its range.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Ranges of the joints.
    derivatives : tuple of ndarray, shape (n, 3)
        Position of the tip and three derivatives by arc length, in the path's order, no two
        samples half a revolution of joint 1 apart.
    elbow : {'up', 'down'}
        The branch.
    previous : array_like, shape (3,), optional
        Where several turns fit, those that bring the first sample nearest to this; without
        it, those of least magnitude.

    Returns
    -------
    JointPath
        Joint positions and derivatives.

    Raises
    ------
    InvalidInputError
        If a shape is wrong or the elbow unknown.
    UnreachableError
        If a sample is outside the workspace, or on its edge.
    LimitViolationError
        If a sample is on joint axis 1, or a joint leaves its range; with the sample's number.

    """
    if elbow not in ELBOWS:
        raise InvalidInputError(f"elbow is '{elbow}', must be 'up' or 'down'")
    points = PathPoints(*(joint_values(n, v) for n, v in zip(PathPoints._fields, derivatives)))
    refuse_singular(model, points.p)
    path = unlimited_joint_path(model, points, elbow)
    turns = whole_turns(path.q, limits, previous)
    path = path._replace(q=path.q + turns)
    low, high = limits.min_position, limits.max_position
    for i, j in np.argwhere(out_of_range(path.q, limits)):
        value = float(path.q[i, j])
        raise LimitViolationError(
            f'sample {i}: {model.joint_names[j]} would be at {value:.6g} rad (elbow {elbow}), '
            f'limits {low[j]:.6g} to {high[j]:.6g} rad', model.joint_names[j], value,
            float(low[j] if value < low[j] else high[j]))
    return path


def whole_turns(q: Array, limits: JointLimits, previous: ArrayLike | None = None) -> Array:
    """
    Return what whole turns are to be added to each joint for a path to be in its range.

    Parameters
    ----------
    q : ndarray, shape (n, 3)
        Joint positions [rad].
    limits : JointLimits
        The ranges.
    previous : array_like, shape (3,), optional
        As in `joint_path`.

    Returns
    -------
    ndarray, shape (3,)
        Angles [rad]; where none fits, the one that brings the path's middle nearest to the
        range's.

    """
    turn = 2.0 * pi
    near = np.zeros(3) if previous is None else np.asarray(previous, dtype=float)
    least = np.ceil((limits.min_position - q.min(axis=0) - RANGE_TOLERANCE) / turn)
    most = np.floor((limits.max_position - q.max(axis=0) + RANGE_TOLERANCE) / turn)
    with np.errstate(invalid='ignore'):
        middle = 0.5 * (limits.min_position + limits.max_position)
        centred = np.round((middle - 0.5 * (q.min(axis=0) + q.max(axis=0))) / turn)
    wanted = np.round((near - q[0]) / turn)
    fallback = np.where(np.isfinite(centred), centred, wanted)
    return np.asarray(turn * np.where(least <= most, np.clip(wanted, least, most), fallback))


def out_of_range(q: Array, limits: JointLimits) -> BoolArray:
    """
    Return where joints are out of their ranges by more than rounding.

    Parameters
    ----------
    q : ndarray, shape (n, 3)
        Joint positions [rad].
    limits : JointLimits
        The ranges.

    Returns
    -------
    ndarray of bool, shape (n, 3)
        True where a joint is out of its range.

    """
    outside: BoolArray = ((q < limits.min_position - RANGE_TOLERANCE)
                          | (q > limits.max_position + RANGE_TOLERANCE))
    return outside


def refuse_singular(model: RobotModel, p: Array) -> None:
    """
    Refuse samples from which the arm could not move the tip on.

    Parameters
    ----------
    model : RobotModel
        The arm.
    p : ndarray, shape (n, 3)
        Positions of the tip [m].

    Raises
    ------
    UnreachableError
        If a sample is outside the workspace, or on its edge.
    LimitViolationError
        If a sample is on joint axis 1.

    """
    W = np.linalg.norm(p - (0.0, 0.0, model.d1), axis=1)
    least, most = model.reach
    miss = np.maximum(W - most, least - W) + LEAST_CLEARANCE
    for i in np.flatnonzero(miss > 0.0):
        raise UnreachableError(
            f'sample {i} is {W[i]:.6g} m from the shoulder, must be within {least:.6g} to '
            f'{most:.6g} m', distance=max(float(miss[i]) - LEAST_CLEARANCE, 0.0))
    r = np.hypot(p[:, 0], p[:, 1])
    for i in np.flatnonzero(r < LEAST_CLEARANCE):
        raise LimitViolationError(
            f'sample {i} is on joint axis 1: {model.joint_names[0]} would have to turn at once',
            model.joint_names[0], float(r[i]), LEAST_CLEARANCE)
