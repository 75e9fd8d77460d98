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
Forward kinematics by the arm's table: the tip, its Jacobian and the Jacobian's time derivative.

For the thesis's arm they equal (5.3)-(5.7) and (5.18).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arm.compiled_arm import compiled, KERNELS
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, joint_states, joint_values


def forward_kinematics(model: RobotModel, q: ArrayLike) -> Array:
    """
    Return the tip's position in the base frame.

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
    q, arm = np.ascontiguousarray(joint_values('q', q)), compiled(model)
    tip = np.empty(q.shape)
    KERNELS.arm_tip(arm.address, q.size // 3, q.ctypes.data, tip.ctypes.data)
    return tip


def jacobian(model: RobotModel, q: ArrayLike) -> Array:
    """
    Return the Jacobian of the tip's position.

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
    q, arm = np.ascontiguousarray(joint_values('q', q)), compiled(model)
    J = np.empty((*q.shape, 3))
    KERNELS.arm_jacobian(arm.address, q.size // 3, q.ctypes.data, J.ctypes.data)
    return J


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
    q, qd = (np.ascontiguousarray(x) for x in np.broadcast_arrays(*joint_states(q=q, qd=qd)))
    rate, arm = np.empty((*q.shape, 3)), compiled(model)
    KERNELS.arm_jacobian_rate(arm.address, q.size // 3, *(
        x.ctypes.data for x in (q, qd, rate)))
    return rate
