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
Dynamics of the arm for one state (shape (3,)) or many (shape (..., 3)).

Thesis (5.36)-(5.54) corrected. One state is computed with Python floats, ten times as fast as
NumPy with single numbers.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, joint_states
from rrr_traj_planner.core.dynamics import equations


def inertia_matrix(model: RobotModel, q: ArrayLike) -> Array:
    """
    Return the joint-space inertia matrix M (5.40-5.48 corrected).

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
    t = _terms(model, *_split(q=q))
    M = np.zeros(np.shape(q) + (3,))
    M[..., 0, 0] = t.M11
    M[..., 1, 1] = t.M22
    M[..., 1, 2] = M[..., 2, 1] = t.M23
    M[..., 2, 2] = t.M33
    return M


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
    at, rates = _split(q=q, qd=qd)
    return _joined(*equations.coriolis_torques(_terms(model, at), *rates))


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
    t = _terms(model, *_split(q=q))
    return _joined(0.0, t.g2, t.g3)


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
    at, rates, accelerations = _split(q=q, qd=qd, qdd=qdd)
    return _joined(*equations.torques(_terms(model, at), *rates, *accelerations))


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
    at, rates, torques = _split(q=q, qd=qd, tau=tau)
    return _joined(*equations.accelerations(_terms(model, at), *rates, *torques))


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
    at, (qd1, qd2, qd3) = _split(q=q, qd=qd)
    t = _terms(model, at)
    return np.asarray(0.5 * (t.M11 * (qd1 * qd1) + t.M22 * (qd2 * qd2) + t.M33 * (qd3 * qd3))
                      + t.M23 * qd2 * qd3)


def potential_energy(model: RobotModel, q: ArrayLike) -> Array:
    """
    Return the potential energy, zero with both links at the shoulder's height (5.37 corrected).

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
    k = equations.constants(model)
    _, q2, q3 = _split(q=q)[0]
    return np.asarray(k.upper_weight * np.sin(q2) - k.fore_weight * np.cos(q2 + q3))


def _split(**values: ArrayLike) -> list[tuple[Any, Any, Any]]:
    """Return the values joint by joint: floats of one state, arrays of many."""
    found: list[tuple[Any, Any, Any]] = []
    for value in values.values():
        if type(value) is not np.ndarray or value.shape != (3,) or value.dtype != np.float64:
            break
        x1, x2, x3 = value.tolist()
        if not math.isfinite(x1 + x2 + x3):
            break
        found.append((x1, x2, x3))
    else:  # one state, checked without NumPy: the case of a control loop
        return found
    return [tuple(array.tolist()) if array.ndim == 1 else (
        array[..., 0], array[..., 1], array[..., 2]) for array in joint_states(**values)]


def _joined(a: Any, b: Any, c: Any) -> Array:
    """Return the values of three joints, floats or arrays that broadcast, as one array."""
    if type(a) is type(b) is type(c) is float:
        return np.array((a, b, c))
    a, b, c = np.broadcast_arrays(a, b, c)
    out = np.empty(a.shape + (3,))
    out[..., 0], out[..., 1], out[..., 2] = a, b, c
    return out


def _terms(model: RobotModel, q: tuple[Any, Any, Any]) -> equations.Terms:
    _, q2, q3 = q
    sin, cos = (math.sin, math.cos) if type(q2) is float else (np.sin, np.cos)
    return equations.terms(equations.constants(model), q2, q3, sin, cos)
