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
Dynamics of the arm for one state (shape (3,)) or many (shape (..., 3)), by its tables.

tau = M(q) qdd + C(q, qd) qd + g(q): thesis (5.39), where H stands for the inertia matrix M and h
for the Coriolis and centrifugal torques C qd. `forward_dynamics` is part of the library; no
planner calls it, and the simulated arm has the same equations in floats.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arm.compiled_arm import compiled, KERNELS
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.tables import ELEMENTS
from rrr_traj_planner.core.arrays import Array, joint_states
from rrr_traj_planner.core.kernels import addresses

AT_REST = np.zeros(3)  # rad/s


def inertia_matrix(model: RobotModel, q: ArrayLike) -> Array:
    """
    Return the joint-space inertia matrix M (thesis 5.40-5.48).

    Parameters
    ----------
    model : RobotModel
        The arm.
    q : array_like, shape (..., 3)
        Joint positions [rad].

    Returns
    -------
    ndarray, shape (..., 3, 3)
        Symmetric, positive definite [kg m^2].

    Raises
    ------
    InvalidInputError
        If the shape is wrong, or a value not finite.

    """
    return _inertia_and_bias(model, _states(q=q, qd=AT_REST))[0]


def coriolis_torque(model: RobotModel, q: ArrayLike, qd: ArrayLike) -> Array:
    """
    Return C(q, qd) qd, the Coriolis and centrifugal torques (5.49-5.51 corrected).

    Parameters
    ----------
    model : RobotModel
        The arm.
    q, qd : array_like, shape (..., 3)
        Joint positions [rad] and velocities [rad/s].

    Returns
    -------
    ndarray, shape (..., 3)
        Joint torques [N m].

    Raises
    ------
    InvalidInputError
        If a shape is wrong, or a value not finite.

    """
    at = _states(q=q, qd=qd)
    return _inertia_and_bias(model, at)[1] - gravity_torque(model, at[0])


def gravity_torque(model: RobotModel, q: ArrayLike) -> Array:
    """
    Return g(q), the torques that hold the arm against gravity (5.52-5.54 corrected).

    Parameters
    ----------
    model : RobotModel
        The arm.
    q : array_like, shape (..., 3)
        Joint positions [rad].

    Returns
    -------
    ndarray, shape (..., 3)
        Joint torques [N m].

    Raises
    ------
    InvalidInputError
        If the shape is wrong, or a value not finite.

    """
    at, arm = _states(q=q), compiled(model)
    torque = np.empty(at.shape[1:])
    KERNELS.arm_gravity_torque(arm.address, torque.size // 3, at.ctypes.data, torque.ctypes.data)
    return torque


def inverse_dynamics(model: RobotModel, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike) -> Array:
    """
    Return the joint torques that produce a motion: M qdd + C qd + g (5.39).

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
    at, arm = _states(q=q, qd=qd, qdd=qdd), compiled(model)
    tau = np.empty(at.shape[1:])
    KERNELS.arm_inverse_dynamics(arm.address, tau.size // 3, *addresses(at), tau.ctypes.data)
    return tau


def path_torque_terms(model: RobotModel, q: Array, dq: Array,
                      ddq: Array) -> tuple[Array, Array, Array]:
    """
    Return the terms m, c and g of the torque along a path: m sdd + c sd^2 + g.

    Bobrow, Dubowsky & Gibson, Time-optimal control of robotic manipulators along specified paths,
    IJRR 4, 1985.

    Parameters
    ----------
    model : RobotModel
        The arm.
    q, dq, ddq : ndarray, shape (..., 3)
        Joint positions [rad] and their derivatives by path length [rad/m], [rad/m^2].

    Returns
    -------
    tuple of three ndarray, shape (..., 3)
        [N m s^2/m], [N m s^2/m^2], [N m].

    Raises
    ------
    InvalidInputError
        If a shape is wrong, or a value not finite.

    """
    at, arm = _states(q=q, dq=dq, ddq=ddq), compiled(model)
    m, c, g = found = np.empty(at.shape)
    KERNELS.arm_path_terms(arm.address, m.size // 3, *addresses(at), *addresses(found))
    return m, c, g


def forward_dynamics(model: RobotModel, q: ArrayLike, qd: ArrayLike, tau: ArrayLike) -> Array:
    """
    Return the joint accelerations that torques cause (5.39 solved for qdd).

    Parameters
    ----------
    model : RobotModel
        The arm.
    q, qd, tau : array_like, shape (..., 3)
        Joint positions [rad], velocities [rad/s] and torques [N m].

    Returns
    -------
    ndarray, shape (..., 3)
        Joint accelerations [rad/s^2].

    Raises
    ------
    InvalidInputError
        If a shape is wrong, or a value not finite.

    """
    at = _states(q=q, qd=qd, tau=tau)
    M, bias = _inertia_and_bias(model, at)
    return np.asarray(np.linalg.solve(M, (at[2] - bias)[..., np.newaxis])[..., 0])


def kinetic_energy(model: RobotModel, q: ArrayLike, qd: ArrayLike) -> Array:
    """
    Return the kinetic energy (5.36 corrected).

    Parameters
    ----------
    model : RobotModel
        The arm.
    q, qd : array_like, shape (..., 3)
        Joint positions [rad] and velocities [rad/s].

    Returns
    -------
    ndarray, shape (...)
        Energy [J].

    Raises
    ------
    InvalidInputError
        If a shape is wrong, or a value not finite.

    """
    at = _states(q=q, qd=qd)
    M, _ = _inertia_and_bias(model, at)
    return np.asarray(0.5 * np.einsum('...i,...ij,...j->...', at[1], M, at[1]))


def potential_energy(model: RobotModel, q: ArrayLike) -> Array:
    """
    Return the potential energy, whose mean over all positions is zero (5.37).

    Parameters
    ----------
    model : RobotModel
        The arm.
    q : array_like, shape (..., 3)
        Joint positions [rad].

    Returns
    -------
    ndarray, shape (...)
        Energy [J].

    Raises
    ------
    InvalidInputError
        If the shape is wrong, or a value not finite.

    """
    at, arm = _states(q=q), compiled(model)
    energy = np.empty(at.shape[1:-1])
    KERNELS.arm_potential_energy(arm.address, energy.size, at.ctypes.data, energy.ctypes.data)
    return energy


def _states(**values: ArrayLike) -> Array:
    """Return checked values as rows of one array, as the kernels read them."""
    arrays = joint_states(**values)
    at = np.empty((len(arrays), *np.broadcast_shapes(*(x.shape for x in arrays))))
    for row, x in zip(at, arrays):
        row[...] = x
    return at


def _inertia_and_bias(model: RobotModel, at: Array) -> tuple[Array, Array]:
    """Return M (..., 3, 3) and the torques of velocity and gravity (..., 3); at: q, qd, ..."""
    q, arm = at[0], compiled(model)
    elements, bias = np.empty((*q.shape[:-1], 6)), np.empty(q.shape)
    KERNELS.arm_inertia_and_bias(arm.address, q.size // 3, *addresses(at[:2]),
                                 elements.ctypes.data, bias.ctypes.data)
    M = np.empty((*q.shape, 3))
    for k, (i, j) in enumerate(ELEMENTS):
        M[..., i, j] = M[..., j, i] = elements[..., k]
    return M, bias
