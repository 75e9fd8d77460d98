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

With time scaled by a factor f, viscous friction falls with f, the torque of inertia with f^2, and
gravity and Coulomb friction remain (Hollerbach, Dynamic scaling of manipulator trajectories, ASME
J. Dynamic Systems 106, 1984): torque is constant + viscous / f + inertial / f^2.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics.motor_torque import direction_of
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque, inverse_dynamics

# Relative rounding of a torque just at its limit; chosen, a thousandth of what is promised.
TORQUE_ROUNDING = 1e-9


class TorqueParts(NamedTuple):
    """The parts of motors' torques by how they change with a time scaling [N m]."""

    constant: Array  # of gravity and Coulomb friction
    viscous: Array   # falls with the factor
    inertial: Array  # of M qdd + C qd, falls with the factor's square

    @property
    def torque(self) -> Array:
        """Return the whole torques."""
        return self.constant + self.viscous + self.inertial

    def scaled(self, factor: float) -> TorqueParts:
        """
        Return the parts for time scaled by a factor.

        Parameters
        ----------
        factor : float
            New over old duration.

        Returns
        -------
        TorqueParts
            Of the same shapes.

        """
        return TorqueParts(self.constant, self.viscous / factor, self.inertial / factor ** 2)


def torque_parts(model: RobotModel, q: Array, qd: Array, qdd: Array,
                 direction: Array | None = None) -> TorqueParts:
    """
    Return the parts of the motors' torques of a motion.

    Parameters
    ----------
    model : RobotModel
        The arm.
    q, qd, qdd : ndarray, shape (..., 3)
        Positions, velocities and accelerations [rad, rad/s, rad/s^2].
    direction : ndarray, shape (..., 3), optional
        Directions of motion, 1, -1 or 0; by default, as of `direction_of`.

    Returns
    -------
    TorqueParts
        Shape (..., 3) each.

    """
    friction, gravity = model.friction, gravity_torque(model, q)
    inertial = inverse_dynamics(model, q, qd, qdd) - gravity
    if friction.coulomb.any():
        gravity = gravity + friction.coulomb * (
            direction_of(qd) if direction is None else direction)
    return TorqueParts(gravity, friction.viscous * qd, inertial)


def squared_time_scale(model: RobotModel, limits: JointLimits, q: Array, qd: Array,
                       qdd: Array) -> Array:
    """
    Return the square of the time-scaling factor that torque limits require at given states.

    Infinite where the torque of gravity and Coulomb friction alone exceeds its limit.

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
    return squared_scaling_if_held(limits.max_effort, torque_parts(model, q, qd, qdd))


def squared_scaling(max_effort: Array, parts: TorqueParts, all_slower: bool = False) -> Array:
    """
    Return the square of the least time-scaling factor at which torques are within their limits.

    Of a torque within its limit: the least factor down to which it remains so. Of another: the
    least one above 1 at which it is.

    Parameters
    ----------
    max_effort : ndarray, shape (..., 3)
        Limits on magnitudes, infinite where there is none [N m].
    parts : TorqueParts
        Of the torques.
    all_slower : bool
        Return the least factor instead at which, and at every larger one, torques are within.

    Returns
    -------
    ndarray, shape (..., 3)
        Infinite where no factor is large enough.

    """
    constant, viscous, inertial = parts
    if viscous.any():
        return np.asarray(np.maximum(
            _least_factor(max_effort - constant, viscous, inertial, all_slower),
            _least_factor(max_effort + constant, -viscous, -inertial, all_slower)) ** 2)
    # The torque is bounded in the direction of the only part that time scaling changes.
    margin = max_effort - np.sign(inertial) * constant
    with np.errstate(divide='ignore', invalid='ignore'):
        return np.where(margin > 0.0, np.abs(inertial) / margin, np.inf)


def _least_factor(margin: Array, viscous: Array, inertial: Array, all_slower: bool) -> Array:
    """
    Return the least factor f, at an upper limit: margin f^2 - viscous f - inertial >= 0.

    The larger zero of this parabola; where it is satisfied left of its vertex at f = 1, it is for
    all smaller factors too.
    """
    with np.errstate(divide='ignore', invalid='ignore', over='ignore'):
        root = np.sqrt(viscous * viscous + 4.0 * margin * inertial)  # NaN: satisfied everywhere
        zero = np.where(viscous >= 0.0, (viscous + root) / (2.0 * margin),
                        2.0 * inertial / (root - viscous))
    satisfied = margin - viscous - inertial >= 0.0
    needless = np.isnan(root) | (satisfied & (viscous > 2.0 * margin) & (not all_slower))
    factor = np.where(needless, 0.0, np.maximum(np.nan_to_num(zero, nan=np.inf), 0.0))
    factor = np.where((viscous <= 0.0) & (inertial <= 0.0), 0.0, factor)
    factor = np.where(np.isinf(margin), 0.0, factor)
    beyond = margin < 0.0  # the constant part alone exceeds the limit
    return np.where(beyond, np.where(satisfied & (not all_slower), 0.0, np.inf), factor)


def squared_scaling_if_held(max_effort: Array, parts: TorqueParts) -> Array:
    """
    Return the same, infinite too where the constant torque alone exceeds its limit.

    Parameters
    ----------
    max_effort, parts
        As in `squared_scaling`.

    Returns
    -------
    ndarray, shape (..., 3)
        Infinite where the arm cannot be held at rest, or not moved slowly against friction.

    """
    held = np.abs(parts.constant) <= max_effort * (1.0 + TORQUE_ROUNDING)
    return np.where(held, squared_scaling(max_effort, parts), np.inf)
