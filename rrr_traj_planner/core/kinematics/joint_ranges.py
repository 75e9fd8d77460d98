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

"""Joint ranges: whole turns that bring joints into range, and the error if none does."""

from __future__ import annotations

from math import pi

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.errors import format_distinct, JointRangeError
from rrr_traj_planner.core.kinematics.postures import posture_of
from rrr_traj_planner.core.rounding import JOINT_ROUNDING

TURN = 2.0 * pi  # rad


def nearest_turns(angle: Array) -> Array:
    """
    Return the numbers of whole turns nearest to angles.

    Parameters
    ----------
    angle : ndarray
        [rad].

    Returns
    -------
    ndarray
        Whole numbers; times `TURN`, the multiples of 2 pi nearest to the angles.

    """
    return np.asarray(np.round(angle / TURN))


def whole_turns(q: Array, limits: JointLimits, start: Array | None = None) -> Array:
    """
    Return the whole turns that bring each joint of a motion into its range.

    Parameters
    ----------
    q : ndarray, shape (n, 3)
        Joint positions [rad], each at most half a turn from the one before.
    limits : JointLimits
        The ranges.
    start : ndarray, shape (3,), optional
        Where the motion begins [rad]; its turns are taken, in range or not. None: of the turns
        within the range, those with which the motion begins nearest to 0.

    Returns
    -------
    ndarray, shape (3,)
        Multiples of 2 pi to add [rad]; where none fits, the one that brings the middle of the
        motion nearest to the middle of the range.

    """
    if start is not None:
        return np.asarray(TURN * nearest_turns(start - q[0]))
    lowest, highest = q.min(axis=0), q.max(axis=0)
    least = np.ceil((limits.min_position - lowest - JOINT_ROUNDING) / TURN)
    most = np.floor((limits.max_position - highest + JOINT_ROUNDING) / TURN)
    turns = np.clip(nearest_turns(-q[0]), least, most)
    if (least > most).any():
        with np.errstate(invalid='ignore'):  # infinite ends
            centre = 0.5 * (limits.min_position + limits.max_position - lowest - highest)
        centred = nearest_turns(np.where(np.isfinite(centre), centre, -q[0]))
        turns = np.where(least <= most, turns, centred)
    return np.asarray(TURN * turns)


def out_of_range(q: Array, limits: JointLimits) -> BoolArray:
    """
    Return which joint positions are out of range by more than rounding.

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
    outside: BoolArray = ((q < limits.min_position - JOINT_ROUNDING)
                          | (q > limits.max_position + JOINT_ROUNDING))
    return outside


def range_error(model: RobotModel, limits: JointLimits, where: str, joint: int, q: Array,
                via_point: int = -1) -> JointRangeError:
    """
    Return the error for a joint out of its range.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        The ranges.
    where : str
        Location in the plan, for the message.
    joint : int
        Index of the joint.
    q : ndarray, shape (3,)
        Joint positions there [rad].
    via_point : int
        Index of the via point at fault, -1 if there is none.

    Returns
    -------
    JointRangeError
        To be raised.

    """
    name, value = model.joint_names[joint], float(q[joint])
    low, high = float(limits.min_position[joint]), float(limits.max_position[joint])
    at, lowest, highest = format_distinct(value, low, high)
    posture = posture_of(model, q)
    named = '' if posture is None else f' ({posture})'
    return JointRangeError(
        f'{where}: {name} would be at {at} rad{named}, limits {lowest} to {highest} rad',
        name, value, low if value < low else high, via_point)
