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
Least radius of an arc at a given tip speed, and largest speed on it (thesis 5.4.1).

Part of the library; no planner calls it: planners time the whole path.
"""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, finite_array
from rrr_traj_planner.core.dynamics.rigid_body import (
    coriolis_torque,
    gravity_torque,
    inertia_matrix,
)
from rrr_traj_planner.core.errors import format_distinct, InvalidInputError, LimitViolationError
from rrr_traj_planner.core.kinematics.forward import jacobian, jacobian_rate
from rrr_traj_planner.core.scalars import not_negative, positive

Floats: TypeAlias = NDArray[np.floating[Any]]

# Chosen values, without unit: many times the rounding of the quantities, far below any effect.
UNIT_TOLERANCE = 1e-9     # of the directions' lengths and of their right angle
SINGULAR = 1e-9           # of the Jacobian's least singular value, over the arm's size
INTERVAL_ROUNDING = 1e-12  # relative, for a limit that is just met


class Bound(NamedTuple):
    """Extreme value of a radius or a speed, and the limit that determines it."""

    value: float
    joint: int     # -1 if none does
    quantity: str  # 'effort', 'acceleration', 'velocity', or empty


class _Row(NamedTuple):
    """A quantity of one joint that is affine in x and must stay within its limit."""

    joint: int
    quantity: str
    unit: str
    base: float
    slope: float
    limit: float


def least_radius(model: RobotModel, limits: JointLimits, q: ArrayLike, tangent: ArrayLike,
                 normal: ArrayLike, speed: float) -> Bound:
    """
    Return the least radius of curvature that the arm can pass at a constant tip speed.

    The problem of 5.56-5.62: minimise rho (5.55) with the tip's velocity v T, its acceleration
    (v^2 / rho) N and every torque within its limit. Torques and joint accelerations are affine in
    1 / rho, so the result has a closed form. Joint velocity and acceleration limits are
    satisfied too. Larger radii are feasible too wherever the straight line is.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Its limits.
    q : array_like, shape (3,)
        Joint positions at the via point [rad].
    tangent, normal : array_like, shape (3,)
        Unit vectors of the path there, at a right angle.
    speed : float
        Of the tip, constant [m/s].

    Returns
    -------
    Bound
        Radius [m], 0 where nothing limits it, and which limit of which joint is met there.

    Raises
    ------
    InvalidInputError
        If an argument is malformed.
    LimitViolationError
        If no radius is feasible at this speed, or the pose is singular.

    """
    q, T, N = _checked(q, tangent, normal)
    speed = not_negative('speed', speed, 'm/s')
    J = _regular_jacobian(model, q)
    qd = speed * np.linalg.solve(J, T)
    straight = np.linalg.solve(J, -jacobian_rate(model, q, qd) @ qd)
    by_turning = speed ** 2 * np.linalg.solve(J, N)
    M = inertia_matrix(model, q)
    torque = M @ straight + coriolis_torque(model, q, qd) + gravity_torque(model, q)
    rows = (_rows('velocity', 'rad/s', qd, np.zeros(3), limits.max_velocity)
            + _rows('acceleration', 'rad/s^2', straight, by_turning, limits.max_acceleration)
            + _rows('effort', 'N m', torque, M @ by_turning, limits.max_effort))
    most = _largest(model, rows, f'at {speed:.6g} m/s')
    return most._replace(value=1.0 / most.value if most.value > 0.0 else np.inf)


def largest_speed(model: RobotModel, limits: JointLimits, q: ArrayLike, tangent: ArrayLike,
                  normal: ArrayLike, radius: float) -> Bound:
    """
    Return the largest constant tip speed at which the arm can pass an arc.

    Torques and joint accelerations are affine in the square of the speed. Lower speeds are
    feasible too wherever the pose can be held at rest.

    Parameters
    ----------
    model, limits, q, tangent, normal
        As in `least_radius`.
    radius : float
        Of the arc [m]; infinite for a straight line.

    Returns
    -------
    Bound
        Speed [m/s], infinite where nothing limits it, and which limit is met there.

    Raises
    ------
    InvalidInputError
        If an argument is malformed.
    LimitViolationError
        If no speed is feasible, or the pose is singular.

    """
    q, T, N = _checked(q, tangent, normal)
    radius = positive('radius', radius, 'm', may_be_infinite=True)
    J = _regular_jacobian(model, q)
    rate = np.linalg.solve(J, T)  # qd for 1 m/s
    change = np.linalg.solve(J, N / radius - jacobian_rate(model, q, rate) @ rate)
    torque = inertia_matrix(model, q) @ change + coriolis_torque(model, q, rate)
    rows = (_rows('velocity', 'rad^2/s^2', np.zeros(3), rate ** 2, limits.max_velocity ** 2)
            + _rows('acceleration', 'rad/s^2', np.zeros(3), change, limits.max_acceleration)
            + _rows('effort', 'N m', gravity_torque(model, q), torque, limits.max_effort))
    most = _largest(model, rows, f'on a radius of {radius:.6g} m')
    return most._replace(value=float(np.sqrt(most.value)))


def _rows(quantity: str, unit: str, base: Floats, slope: Floats, limit: Floats) -> list[_Row]:
    """Return a row for each joint that has a limit."""
    return [_Row(j, quantity, unit, float(base[j]), float(slope[j]), float(limit[j]))
            for j in range(3) if np.isfinite(limit[j])]


def _largest(model: RobotModel, rows: list[_Row], where: str) -> Bound:
    """Return the largest x >= 0 at which |base + slope x| <= limit in every row."""
    least, most = Bound(0.0, -1, ''), Bound(np.inf, -1, '')
    first = None
    for row in rows:
        low, high = _interval(row)
        if low > high or high < 0.0:
            raise _violation(model, row, max(least.value, 0.0), where)
        if low > least.value:
            least, first = Bound(low, row.joint, row.quantity), row
        if high < most.value:
            most = Bound(high, row.joint, row.quantity)
    if first is not None and least.value > most.value * (1.0 + INTERVAL_ROUNDING):
        raise _violation(model, first, most.value, where)
    return most


def _interval(row: _Row) -> tuple[float, float]:
    """Return the interval of x in which a row satisfies its limit; empty if it never does."""
    most = row.limit * (1.0 + INTERVAL_ROUNDING)
    if row.slope == 0.0:
        return (-np.inf, np.inf) if abs(row.base) <= most else (np.inf, -np.inf)
    ends = (-most - row.base) / row.slope, (most - row.base) / row.slope
    return min(ends), max(ends)


def _violation(model: RobotModel, row: _Row, x: float, where: str) -> LimitViolationError:
    """Return the error of a joint that cannot satisfy its limit."""
    value, limit, unit = abs(row.base + row.slope * x), row.limit, row.unit
    name = model.joint_names[row.joint]
    needed, most = format_distinct(value, limit)
    return LimitViolationError(
        f'{where} {name} would need {row.quantity} {needed} {unit} at the least, limit '
        f'{most} {unit}', name, value, limit)


def _checked(q: ArrayLike, tangent: ArrayLike, normal: ArrayLike) -> tuple[Array, Array, Array]:
    """Return the pose and the directions, checked."""
    q = finite_array('q', q, (3,))
    T, N = finite_array('tangent', tangent, (3,)), finite_array('normal', normal, (3,))
    for name, vector in (('tangent', T), ('normal', N)):
        length = float(np.linalg.norm(vector))
        if abs(length - 1.0) > UNIT_TOLERANCE:
            raise InvalidInputError(f'{name} has length {length:.12g}, must have 1')
    if abs(float(T @ N)) > UNIT_TOLERANCE:
        raise InvalidInputError(
            f'tangent and normal are not at a right angle: their product is {T @ N:.3g}')
    return q, T, N


def _regular_jacobian(model: RobotModel, q: Array) -> Array:
    """Return the Jacobian of a pose that is not singular."""
    J = jacobian(model, q)
    _, size, directions = np.linalg.svd(J)
    least = float(size[2] / model.chain.size)
    if least <= SINGULAR:
        name = model.joint_names[int(np.abs(directions[2]).argmax())]
        pose = ', '.join(f'{x:.6g}' for x in q.tolist())
        raise LimitViolationError(
            f'the arm is singular at ({pose}) rad, where {name} would need unbounded velocity',
            name, least, SINGULAR)
    return J
