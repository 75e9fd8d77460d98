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
Inverse kinematics in closed form: one posture, or the solution nearest to a joint state.

Thesis (5.8)-(5.12) corrected.
"""

from __future__ import annotations

from math import atan2, ceil, hypot, pi

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, finite_array
from rrr_traj_planner.core.errors import format_distinct, UnreachableError
from rrr_traj_planner.core.kinematics.joint_ranges import nearest_turns, TURN
from rrr_traj_planner.core.kinematics.postures import (
    Elbow,
    elbow_angles,
    ELBOWS,
    Shoulder,
    SHOULDERS,
)
from rrr_traj_planner.core.rounding import TIP_ROUNDING
from rrr_traj_planner.core.scalars import one_of


def inverse_kinematics(model: RobotModel, position: ArrayLike, elbow: Elbow = 'up',
                       previous: ArrayLike | None = None,
                       shoulder: Shoulder = 'front') -> Array:
    """
    Return joint positions that bring the tip to a point (5.8-5.12 corrected).

    On joint axis 1, where theta_1 is arbitrary, it keeps its previous value, or is 0 without one.

    Parameters
    ----------
    model : RobotModel
        The arm.
    position : array_like, shape (3,)
        Tip position in the base frame [m].
    elbow : {'up', 'down'}
        Branch: theta_3 = gamma - 90 deg, or 270 deg - gamma.
    previous : array_like, shape (3,), optional
        Joint positions [rad] of the point before.
    shoulder : {'front', 'back'}
        Branch: theta_1 = atan2(y, x), or half a turn from it, with the arm over its shoulder.

    Returns
    -------
    ndarray, shape (3,)
        Joint positions [rad], each in (-pi, pi] but for theta_3, in [-pi/2, 3 pi/2].

    Raises
    ------
    InvalidInputError
        If the position is malformed or the posture unknown.
    UnreachableError
        If the point is outside the workspace; with the distance by which it misses.

    """
    x, y, z = finite_array('position', position, (3,)).tolist()
    one_of('elbow', elbow, ELBOWS)
    one_of('shoulder', shoulder, SHOULDERS)
    r, h = hypot(x, y), z - model.d1
    back = shoulder == 'back'
    before = 0.0 if previous is None else float(finite_array('previous', previous, (3,))[0])
    if r <= TIP_ROUNDING:
        theta_1 = before
    else:
        theta_1 = _wrapped(atan2(y, x) + (pi if back else 0.0))
    W = _distance_in_reach(model, (x, y, z), hypot(r, h))
    beta, theta_3 = elbow_angles(model, np.asarray(W), elbow)
    theta_2 = _wrapped(atan2(h, -r if back else r) + float(beta))
    return np.array([theta_1, theta_2, float(theta_3)])


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
        Of all postures and whole turns, the solution of least maximum joint displacement [rad].

    Raises
    ------
    InvalidInputError
        If the position is malformed.
    UnreachableError
        If the point is outside the workspace.

    """
    near = finite_array('q', q, (3,))
    found = [inverse_kinematics(model, position, elbow, near, shoulder)
             for shoulder in SHOULDERS for elbow in ELBOWS]
    turned = [x + TURN * nearest_turns(near - x) for x in found]
    return min(turned, key=lambda x: float(np.abs(x - near).max()))


def _distance_in_reach(model: RobotModel, point: tuple[float, float, float], W: float) -> float:
    """Return W clipped to the workspace's edge, which it may exceed by rounding alone."""
    least, most = model.reach
    if W > most + TIP_ROUNDING or W < least - TIP_ROUNDING:
        far = W > most
        distance, bound = format_distinct(W, most if far else least)
        side = (f"beyond the arm's reach of {bound} m" if far
                else f'nearer than the arm can fold, {bound} m')
        miss = W - most if far else least - W
        raise UnreachableError(
            f'({point[0]:.6g}, {point[1]:.6g}, {point[2]:.6g}) m is {distance} m from the '
            f'shoulder, {side}: it misses by {miss:.6g} m', distance=miss)
    return min(max(W, least), most)


def _wrapped(angle: float) -> float:
    """Return the angle in (-pi, pi]."""
    return angle - 2.0 * pi * ceil((angle - pi) / (2.0 * pi))
