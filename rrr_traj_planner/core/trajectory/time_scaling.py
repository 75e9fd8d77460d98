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

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.dynamics.motor_torque import direction_of
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque, inverse_dynamics

# Relative rounding of a torque just at its limit; chosen, a thousandth of what is promised.
TORQUE_ROUNDING = 1e-9


class TorqueParts(NamedTuple):
    """
    The parts of motors' torques by how they change with a time scaling [N m].

    Attributes
    ----------
    constant : ndarray, shape (..., 3)
        Of gravity and Coulomb friction; remains.
    viscous : ndarray, shape (..., 3)
        Of viscous friction; falls with the factor.
    inertial : ndarray, shape (..., 3)
        Of M qdd + C qd; falls with the factor's square.

    """

    constant: Array
    viscous: Array
    inertial: Array

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
        Directions of motion, 1, -1 or 0; by default Coulomb friction is left out.

    Returns
    -------
    TorqueParts
        Shape (..., 3) each.

    """
    friction, gravity = model.friction, gravity_torque(model, q)
    inertial = inverse_dynamics(model, q, qd, qdd) - gravity
    if direction is not None:
        gravity = gravity + friction.coulomb * direction
    return TorqueParts(gravity, friction.viscous * qd, inertial)


def squared_time_scale(model: RobotModel, limits: JointLimits, q: Array, qd: Array, qdd: Array,
                       rest_speed: float) -> Array:
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
    rest_speed : float
        Speed up to which a joint is at rest [rad/s], without Coulomb friction.

    Returns
    -------
    ndarray, shape (..., 3)
        For each joint, 0 where it has no effort limit.

    """
    direction = direction_of(qd, rest_speed) if model.friction.coulomb.any() else None
    return squared_scaling_if_held(
        limits.max_effort, torque_parts(model, q, qd, qdd, direction))


def squared_scaling(max_effort: Array, parts: TorqueParts) -> Array:
    """
    Return the square of the nearest time-scaling factor at which torques just keep their limits.

    Of a torque within its limit: the least factor down to which it remains so. Of another: the
    least one above 1 at which it is; at still larger ones it may exceed the limit again.

    Parameters
    ----------
    max_effort : ndarray, shape (..., 3)
        Limits on magnitudes, infinite where there is none [N m].
    parts : TorqueParts
        Of the torques.

    Returns
    -------
    ndarray, shape (..., 3)
        Infinite where no factor is large enough.

    """
    constant, viscous, inertial = parts
    if viscous.any():
        return _square_of_larger(*(_nearest_factor(*side) for side in _sides(max_effort, parts)))
    needs_less_time = np.sign(constant) * (constant + inertial) > max_effort
    return np.where(_exceeded(max_effort, constant) & needs_less_time, np.inf,
                    _squared_of_inertia(max_effort, constant, inertial))


def squared_scaling_any_slower(max_effort: Array, parts: TorqueParts) -> Array:
    """
    Return the square of the time-scaling factor from which on torques keep their limits.

    They do at this factor and at every larger one, and not at those just below it.

    Parameters
    ----------
    max_effort : ndarray, shape (..., 3)
        Limits on magnitudes, infinite where there is none [N m].
    parts : TorqueParts
        Of the torques.

    Returns
    -------
    ndarray, shape (..., 3)
        Infinite where the constant torque alone exceeds its limit.

    """
    constant, viscous, inertial = parts
    if viscous.any():
        return _square_of_larger(*(_last_factor(*side) for side in _sides(max_effort, parts)))
    return np.where(_exceeded(max_effort, constant), np.inf,
                    _squared_of_inertia(max_effort, constant, inertial))


def squared_scaling_if_held(max_effort: Array, parts: TorqueParts) -> Array:
    """
    Return the square of the nearest time-scaling factor; infinite where slow motion has none.

    The nearest factor is that of `squared_scaling`. Where the constant torque alone, of gravity
    and Coulomb friction, exceeds its limit, inertia or viscous friction may leave the torque
    within it, but not in a slow motion.

    Parameters
    ----------
    max_effort : ndarray, shape (..., 3)
        Limits on magnitudes, infinite where there is none [N m].
    parts : TorqueParts
        Of the torques.

    Returns
    -------
    ndarray, shape (..., 3)
        Infinite where the arm cannot be held at rest, or not moved slowly against friction.

    """
    if not parts.viscous.any():  # inertia alone: what is within remains so
        return squared_scaling_any_slower(max_effort, parts)
    return np.where(_exceeded(max_effort, parts.constant), np.inf,
                    squared_scaling(max_effort, parts))


def _exceeded(max_effort: Array, constant: Array) -> BoolArray:
    """Return where the constant torque alone exceeds its limit, but for rounding."""
    return np.abs(constant) > max_effort * (1.0 + TORQUE_ROUNDING)


def _squared_of_inertia(max_effort: Array, constant: Array, inertial: Array) -> Array:
    """Return the square at which |constant| + |inertial| / square is the limit, or the reverse."""
    # The torque is bounded in the direction of the only part that time scaling changes.
    margin = max_effort - np.sign(inertial) * constant
    with np.errstate(divide='ignore', invalid='ignore'):
        return np.where(margin > 0.0, np.abs(inertial) / margin, np.inf)


def _sides(max_effort: Array, parts: TorqueParts) -> Iterator[tuple[Array, Array, Array]]:
    """
    Yield margin, viscous and inertial torque by the upper limit, and by the lower one.

    A factor f keeps it if margin f^2 - viscous f - inertial >= 0.
    """
    for sign in (1.0, -1.0):
        margin = max_effort - sign * parts.constant
        rounding = (margin < 0.0) & (margin >= -TORQUE_ROUNDING * max_effort)
        yield np.where(rounding, 0.0, margin), sign * parts.viscous, sign * parts.inertial


def _zero(margin: Array, viscous: Array, inertial: Array) -> Array:
    """
    Return the parabola's larger zero; the smaller one of one that opens downwards.

    NaN where there is none, and where all three are zero; infinite where only the margin is.
    """
    with np.errstate(divide='ignore', invalid='ignore', over='ignore'):
        root = np.sqrt(viscous * viscous + 4.0 * margin * inertial)
        return np.where(viscous >= 0.0, (viscous + root) / (2.0 * margin),
                        2.0 * inertial / (root - viscous))


def _last_factor(margin: Array, viscous: Array, inertial: Array) -> Array:
    """Return the factor from which on a limit is kept, 0 where it is at all, at one side."""
    zero = _zero(margin, viscous, inertial)
    needless = (inertial <= 0.0) & ((viscous <= 0.0) | np.isnan(zero)) | np.isinf(margin)
    factor = np.where(needless, 0.0, np.maximum(np.where(np.isnan(zero), np.inf, zero), 0.0))
    return np.where(margin < 0.0, np.inf, factor)


def _nearest_factor(margin: Array, viscous: Array, inertial: Array) -> Array:
    """Return the nearest factor at which a limit is just kept, at one side (`squared_scaling`)."""
    satisfied = margin - viscous - inertial >= 0.0
    # Satisfied left of the vertex it is for all smaller factors too.
    falling = satisfied & (viscous > 2.0 * margin)
    factor = np.where(falling, 0.0, _last_factor(margin, viscous, inertial))
    if not (margin < 0.0).any():
        return factor
    # Beyond the limit at rest: only between two factors, or below one.
    first = np.where((viscous < 0.0) & (inertial > 0.0), _zero(margin, viscous, inertial), 0.0)
    return np.where(margin < 0.0, np.where(satisfied | (first > 1.0), first, np.inf), factor)


def _square_of_larger(first: Array, second: Array) -> Array:
    with np.errstate(over='ignore'):  # as good as infinite
        return np.asarray(np.maximum(first, second) ** 2)
