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

"""Inverse kinematics for one point: of a posture, or nearest to a joint state."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, finite_array
from rrr_traj_planner.core.errors import UnreachableError
from rrr_traj_planner.core.kinematics.joint_ranges import nearest_turns, TURN
from rrr_traj_planner.core.kinematics.postures import (
    Elbow,
    ELBOWS,
    in_posture,
    Posture,
    Shoulder,
    SHOULDERS,
)
from rrr_traj_planner.core.kinematics.solutions import solutions
from rrr_traj_planner.core.rounding import TIP_ROUNDING
from rrr_traj_planner.core.scalars import one_of

MILLIMETRES = '; if these are millimetres, divide by 1000'  # appended to an error
FAR = 3.0  # times the arm's size: points that miss by less are not suspected; chosen


def inverse_kinematics(model: RobotModel, position: ArrayLike, elbow: Elbow = 'up',
                       previous: ArrayLike | None = None,
                       shoulder: Shoulder = 'front') -> Array:
    """
    Return joint positions that bring the tip to a point (5.8-5.12, for any arm).

    On joint axis 1, where theta_1 is arbitrary, it keeps its previous value, or is 0 without one.

    Parameters
    ----------
    model : RobotModel
        The arm; its postures have names.
    position : array_like, shape (3,)
        Tip position in the base frame [m].
    elbow : {'up', 'down'}
        Branch.
    previous : array_like, shape (3,), optional
        Joint positions [rad] of the point before.
    shoulder : {'front', 'back'}
        Branch.

    Returns
    -------
    ndarray, shape (3,)
        Joint positions [rad], each in (-pi, pi].

    Raises
    ------
    InvalidInputError
        If the position is malformed or the posture unknown.
    UnreachableError
        If the point is outside the workspace, with the distance by which it misses; or out of
        reach in this posture.

    """
    one_of('elbow', elbow, ELBOWS)
    one_of('shoulder', shoulder, SHOULDERS)
    q = reachable(model, finite_array('position', position, (3,)), previous)
    posture = Posture(elbow, shoulder)
    fits = in_posture(model, q, posture)
    if not fits.any():
        raise UnreachableError(
            f'{point_text(position)} is out of reach with {posture}', distance=0.0)
    return np.asarray(q[fits][0])


def nearest_solution(model: RobotModel, position: ArrayLike, q: ArrayLike) -> Array:
    """
    Return the inverse solution nearest to given joint positions.

    Parameters
    ----------
    model : RobotModel
        The arm.
    position : array_like, shape (3,)
        Tip position in the base frame [m].
    q : array_like, shape (3,)
        Joint positions [rad].

    Returns
    -------
    ndarray, shape (3,)
        Of all solutions and whole turns, the one of least maximum joint displacement [rad].

    Raises
    ------
    InvalidInputError
        If the position is malformed.
    UnreachableError
        If the point is outside the workspace.

    """
    near = finite_array('q', q, (3,))
    found = reachable(model, finite_array('position', position, (3,)), near)
    turned = found + TURN * nearest_turns(near - found)
    return np.asarray(turned[np.abs(turned - near).max(axis=1).argmin()])


def reachable(model: RobotModel, position: ArrayLike, previous: ArrayLike | None = None) -> Array:
    """
    Return all inverse solutions of a point; raise where there is none.

    Parameters
    ----------
    model : RobotModel
        The arm.
    position : array_like, shape (3,)
        Tip position in the base frame [m].
    previous : array_like, shape (3,), optional
        As of `solutions`.

    Returns
    -------
    ndarray, shape (k, 3)
        As of `solutions` [rad].

    Raises
    ------
    UnreachableError
        If the point is outside the workspace; with the distance by which it misses, and a hint if
        it seems to be in millimetres.

    """
    found = solutions(model, position, TIP_ROUNDING, previous)
    if not len(found.q):
        hint = MILLIMETRES if _explained_by_millimetres(model, position, found.nearest) else ''
        raise UnreachableError(
            f"{point_text(position)} is out of the arm's reach: it misses by "
            f'{found.nearest:.6g} m{hint}', distance=found.nearest)
    return found.q


def _explained_by_millimetres(model: RobotModel, position: ArrayLike, miss: float) -> bool:
    """Return whether a point far out of reach is within it if it is in millimetres."""
    metres = 1e-3 * np.asarray(position, dtype=float)
    return miss > FAR * model.chain.size and len(solutions(model, metres, TIP_ROUNDING).q) > 0


def point_text(position: ArrayLike) -> str:
    """
    Return a point for a message.

    Parameters
    ----------
    position : array_like, shape (3,)
        [m].

    Returns
    -------
    str
        With six digits, and its unit.

    """
    x, y, z = np.asarray(position, dtype=float).tolist()
    return f'({x:.6g}, {y:.6g}, {z:.6g}) m'
