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
The time scaling that torque limits require.

With time scaled by a factor f, the part of the torque that is not gravity falls with f^2
(Hollerbach, Dynamic scaling of manipulator trajectories, ASME J. Dynamic Systems 106, 1984).
"""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque, inverse_dynamics

# Relative rounding of a torque just at its limit; chosen, a thousandth of what is promised.
TORQUE_ROUNDING = 1e-9


def squared_time_scale(model: RobotModel, limits: JointLimits, q: Array, qd: Array,
                       qdd: Array) -> Array:
    """
    Return the square of the time-scaling factor that torque limits require at given states.

    Infinite where the torque of gravity alone exceeds its limit.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Effort limits, infinite where there is none.
    q, qd, qdd : ndarray, shape (..., 3)
        Positions, velocities and accelerations [rad, rad/s, rad/s^2].

    Returns
    -------
    ndarray, shape (..., 3)
        For each joint, 0 where it has no effort limit.

    """
    return squared_scaling_if_held(
        limits.max_effort, *gravity_and_torque(model, q, qd, qdd))


def squared_scaling(max_effort: Array, gravity: Array, torque: Array) -> Array:
    """
    Return the square of the least time-scaling factor at which torques are within their limits.

    It bounds the torque in the direction of the part that is not gravity, the only part that time
    scaling changes.

    Parameters
    ----------
    max_effort : ndarray, shape (..., 3)
        Limits on magnitudes, infinite where there is none [N m].
    gravity, torque : ndarray, shape (..., 3)
        Of gravity alone, and of the motion [N m].

    Returns
    -------
    ndarray, shape (..., 3)
        Infinite where no factor is large enough.

    """
    motion = torque - gravity
    margin = max_effort - np.sign(motion) * gravity
    with np.errstate(divide='ignore', invalid='ignore'):
        return np.where(margin > 0.0, np.abs(motion) / margin, np.inf)


def squared_scaling_if_held(max_effort: Array, gravity: Array, torque: Array) -> Array:
    """
    Return the same, infinite too where the torque of gravity alone exceeds its limit.

    Parameters
    ----------
    max_effort, gravity, torque
        As in `squared_scaling`.

    Returns
    -------
    ndarray, shape (..., 3)
        Infinite where the arm cannot be held at rest.

    """
    held = np.abs(gravity) <= max_effort * (1.0 + TORQUE_ROUNDING)
    return np.where(held, squared_scaling(max_effort, gravity, torque), np.inf)


def gravity_and_torque(model: RobotModel, q: Array, qd: Array,
                       qdd: Array) -> tuple[Array, Array]:
    """
    Return the torques of gravity alone and of a motion.

    Parameters
    ----------
    model : RobotModel
        The arm.
    q, qd, qdd : ndarray, shape (..., 3)
        Positions, velocities and accelerations [rad, rad/s, rad/s^2].

    Returns
    -------
    tuple of two ndarray, shape (..., 3)
        [N m].

    """
    return gravity_torque(model, q), inverse_dynamics(model, q, qd, qdd)
