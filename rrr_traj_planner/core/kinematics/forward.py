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
Forward kinematics: the tip's position, its Jacobian and the Jacobian's time derivative.

Thesis (5.3)-(5.7) corrected, (5.18).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, joint_states, joint_values


def forward_kinematics(model: RobotModel, q: ArrayLike) -> Array:
    """
    Return the tip's position in the base frame (5.3-5.7 corrected).

    Parameters
    ----------
    model : RobotModel
        The arm.
    q : array_like, shape (..., 3)
        Joint positions [rad].

    Returns
    -------
    ndarray, shape (..., 3)
        Tip position [m].

    Raises
    ------
    InvalidInputError
        If the shape is wrong, or a value not finite.

    """
    q = joint_values('q', q)
    r, h = _reach_and_height(model, q)
    return np.stack((np.cos(q[..., 0]) * r, np.sin(q[..., 0]) * r, model.d1 + h), axis=-1)


def radial_distance(model: RobotModel, q: ArrayLike) -> Array:
    """
    Return the tip's signed distance from joint axis 1, in the arm's vertical plane.

    Parameters
    ----------
    model : RobotModel
        The arm.
    q : array_like, shape (..., 3)
        Joint positions [rad].

    Returns
    -------
    ndarray, shape (...)
        Distance [m], negative where the arm reaches over its shoulder.

    Raises
    ------
    InvalidInputError
        If the shape is wrong, or a value not finite.

    """
    return _reach_and_height(model, joint_values('q', q))[0]


def jacobian(model: RobotModel, q: ArrayLike) -> Array:
    """
    Return the Jacobian of the tip's position (5.18).

    Parameters
    ----------
    model : RobotModel
        The arm.
    q : array_like, shape (..., 3)
        Joint positions [rad].

    Returns
    -------
    ndarray, shape (..., 3, 3)
        d(tip) / d(q), base frame [m/rad].

    Raises
    ------
    InvalidInputError
        If the shape is wrong, or a value not finite.

    """
    q = joint_values('q', q)
    s1, c1 = np.sin(q[..., 0]), np.cos(q[..., 0])
    Z1, Z2, Z3, Z4 = _z_terms(model, q)
    zero = np.zeros_like(s1)
    return matrix((-Z3 * s1, Z4 * c1, Z1 * c1),
                  (Z3 * c1, Z4 * s1, Z1 * s1),
                  (zero, Z3, Z2))


def jacobian_rate(model: RobotModel, q: ArrayLike, qd: ArrayLike) -> Array:
    """
    Return the time derivative of the Jacobian: tip acceleration = J qdd + (dJ/dt) qd.

    Parameters
    ----------
    model : RobotModel
        The arm.
    q, qd : array_like, shape (..., 3)
        Joint positions [rad] and velocities [rad/s].

    Returns
    -------
    ndarray, shape (..., 3, 3)
        dJ/dt, base frame [m/(rad s)].

    Raises
    ------
    InvalidInputError
        If a shape is wrong, or a value not finite.

    """
    q, qd = np.broadcast_arrays(*joint_states(q=q, qd=qd))
    s1, c1 = np.sin(q[..., 0]), np.cos(q[..., 0])
    qd1, qd2, qd23 = qd[..., 0], qd[..., 1], qd[..., 1] + qd[..., 2]
    Z1, Z2, Z3, Z4 = _z_terms(model, q)
    Z1_rate, Z2_rate = -Z2 * qd23, Z1 * qd23
    Z3_rate = Z2_rate - model.a2 * np.sin(q[..., 1]) * qd2
    Z4_rate = -Z2 * qd23 - model.a2 * np.cos(q[..., 1]) * qd2
    return matrix(
        (-Z3_rate * s1 - Z3 * c1 * qd1, Z4_rate * c1 - Z4 * s1 * qd1,
         Z1_rate * c1 - Z1 * s1 * qd1),
        (Z3_rate * c1 - Z3 * s1 * qd1, Z4_rate * s1 + Z4 * c1 * qd1, Z1_rate * s1 + Z1 * c1 * qd1),
        (np.zeros_like(s1), Z3_rate, Z2_rate))


def _reach_and_height(model: RobotModel, q: Array) -> tuple[Array, Array]:
    """Return the tip's signed distance from joint axis 1 and height above the shoulder [m]."""
    q23 = q[..., 1] + q[..., 2]
    return (model.a2 * np.cos(q[..., 1]) + model.d4 * np.sin(q23),
            model.a2 * np.sin(q[..., 1]) - model.d4 * np.cos(q23))


def _z_terms(model: RobotModel, q: Array) -> tuple[Array, Array, Array, Array]:
    """Return Z1 to Z4 of equation 5.18."""
    q23 = q[..., 1] + q[..., 2]
    Z1, Z2 = model.d4 * np.cos(q23), model.d4 * np.sin(q23)
    return (Z1, Z2, Z2 + model.a2 * np.cos(q[..., 1]), Z1 - model.a2 * np.sin(q[..., 1]))


def matrix(*rows: tuple[Array, Array, Array]) -> Array:
    """
    Return 3 x 3 matrices from their elements.

    Parameters
    ----------
    *rows : tuple of three ndarrays, shape (...)
        The elements of each row.

    Returns
    -------
    ndarray, shape (..., 3, 3)
        The matrices.

    """
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
