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

# Part of the largest velocity of a motion up to which a velocity is rounding: the joint rests.
# Chosen: some hundred times the rounding of a sum of velocities near singular positions.
AT_REST = 1e-12


def motor_torque(model: RobotModel, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike) -> Array:
    """
    Return the motors' torques: M qdd + C qd + g + viscous qd + coulomb sign(qd).

    A joint at rest (qd exactly 0) has no Coulomb friction: what friction would help to hold is
    left to the motor.

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
    torque, coulomb = smooth_motor_torque(model, q, qd, qdd), model.friction.coulomb
    return torque + coulomb * np.sign(np.asarray(qd, dtype=float)) if coulomb.any() else torque


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


def direction_of(qd: Array) -> Array:
    """
    Return the directions in which joints move.

    Parameters
    ----------
    qd : ndarray, shape (..., 3)
        Velocities of one motion [rad/s].

    Returns
    -------
    ndarray, shape (..., 3)
        1, -1, or 0 where the velocity is zero up to rounding.

    """
    speed = np.abs(qd)
    return np.where(speed > AT_REST * speed.max(initial=0.0), np.sign(qd), 0.0)
