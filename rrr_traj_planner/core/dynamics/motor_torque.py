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

"""The torque that the motors must supply: rigid-body dynamics and the joints' friction."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.core.scalars import not_negative

# Part of the largest velocity of a motion up to which a velocity is rounding: the joint rests.
# Chosen: some hundred times the rounding of a sum of velocities near singular positions.
AT_REST = 1e-12


def motor_torque(model: RobotModel, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike,
                 rest_speed: float = 0.0) -> Array:
    """
    Return the motors' torques: M qdd + C qd + g + viscous qd + coulomb direction(qd).

    A joint at rest (`direction_of`) has no Coulomb friction: what friction would help to hold is
    left to the motor.

    Parameters
    ----------
    model : RobotModel
        The arm.
    q, qd, qdd : array_like, shape (..., 3)
        Joint positions [rad], velocities [rad/s] and accelerations [rad/s^2].
    rest_speed : float
        Speed up to which a joint is at rest [rad/s]: for a planned motion, that of
        `rest_speed_of`.

    Returns
    -------
    ndarray, shape (..., 3)
        Joint torques [N m].

    Raises
    ------
    InvalidInputError
        If a shape is wrong, or a value not finite; if the speed is negative.

    """
    not_negative('rest_speed', rest_speed, 'rad/s')
    torque, coulomb = smooth_motor_torque(model, q, qd, qdd), model.friction.coulomb
    if not coulomb.any():
        return torque
    return torque + coulomb * direction_of(np.asarray(qd, dtype=float), rest_speed)


def smooth_motor_torque(model: RobotModel, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike) -> Array:
    """
    Return the motors' torques without Coulomb friction: M qdd + C qd + g + viscous qd.

    Parameters
    ----------
    model : RobotModel
        The arm.
    q, qd, qdd : array_like, shape (..., 3)
        Joint positions [rad], velocities [rad/s] and accelerations [rad/s^2].

    Returns
    -------
    ndarray, shape (..., 3)
        Joint torques [N m].

    Raises
    ------
    InvalidInputError
        If a shape is wrong, or a value not finite.

    """
    torque, viscous = inverse_dynamics(model, q, qd, qdd), model.friction.viscous
    return torque + viscous * np.asarray(qd, dtype=float) if viscous.any() else torque


def direction_of(qd: Array, rest_speed: float) -> Array:
    """
    Return the directions in which joints move, by which Coulomb friction goes.

    Parameters
    ----------
    qd : ndarray, shape (..., 3)
        Velocities [rad/s].
    rest_speed : float
        Speed up to which a joint is at rest [rad/s].

    Returns
    -------
    ndarray, shape (..., 3)
        1, -1, or 0 at rest.

    """
    return np.where(np.abs(qd) > rest_speed, np.sign(qd), 0.0)


def rest_speed_of(qd: Array) -> float:
    """
    Return the speed up to which a motion's velocities are rounding, of joints at rest.

    Parameters
    ----------
    qd : ndarray, shape (..., 3)
        Velocities over the whole motion [rad/s], or derivatives over a whole path.

    Returns
    -------
    float
        `AT_REST` of the largest.

    """
    return AT_REST * float(np.abs(qd).max(initial=0.0))
