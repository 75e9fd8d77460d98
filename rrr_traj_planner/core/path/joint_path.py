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
Joint positions along a path of the tip, with their derivatives by arc length.

`joint_path` is part of the library; no planner calls it: `workspace_check` and `ArmPath`
evaluate `unlimited_joint_path` themselves.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, finite_array, joint_values
from rrr_traj_planner.core.errors import format_distinct, LimitViolationError, UnreachableError
from rrr_traj_planner.core.kinematics.along_path import JointPath, PathPoints, unlimited_joint_path
from rrr_traj_planner.core.kinematics.joint_ranges import out_of_range, range_error, whole_turns
from rrr_traj_planner.core.kinematics.postures import Posture
from rrr_traj_planner.core.rounding import TIP_ROUNDING


def joint_path(model: RobotModel, limits: JointLimits,
               derivatives: tuple[Array, Array, Array, Array], posture: Posture,
               start: ArrayLike | None = None) -> JointPath:
    """
    Return continuous joint positions along a path, in one posture.

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
    posture : Posture
        The posture.
    start : array_like, shape (3,), optional
        As in `whole_turns`.

    Returns
    -------
    JointPath
        Joint positions and derivatives.

    Raises
    ------
    InvalidInputError
        If a shape is wrong.
    UnreachableError
        If a sample is outside the workspace, or on its edge.
    LimitViolationError
        If a sample is on joint axis 1, or a joint leaves its range; with the sample's number.

    """
    points = PathPoints(*(joint_values(n, v) for n, v in zip(PathPoints._fields, derivatives)))
    _refuse_singular(model, points.p)
    path = unlimited_joint_path(model, points, posture)
    start_q = None if start is None else finite_array('start', start, (3,))
    path = path._replace(q=path.q + whole_turns(path.q, limits, start_q))
    for i, j in np.argwhere(out_of_range(path.q, limits)).tolist():
        raise range_error(model, limits, f'sample {i}', j, float(path.q[i, j]), posture)
    return path


def _refuse_singular(model: RobotModel, p: Array) -> None:
    """
    Raise if samples are unreachable or singular.

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
    miss = np.maximum(W - most, least - W) + TIP_ROUNDING
    for i in np.flatnonzero(miss > 0.0):
        distance, lowest, highest = format_distinct(W[i], least, most)
        raise UnreachableError(
            f'sample {i} is {distance} m from the shoulder, must be within {lowest} to '
            f'{highest} m', distance=max(float(miss[i]) - TIP_ROUNDING, 0.0))
    r = np.hypot(p[:, 0], p[:, 1])
    for i in np.flatnonzero(r < TIP_ROUNDING):
        raise LimitViolationError(
            f'sample {i} is on joint axis 1 (singularity): {model.joint_names[0]} would need '
            'unbounded velocity',
            model.joint_names[0], float(r[i]), TIP_ROUNDING)
