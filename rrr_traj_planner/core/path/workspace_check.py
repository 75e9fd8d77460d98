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

"""Check of a whole path against the workspace and the joint ranges, between points too."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.cancellation import never, ShouldStop
from rrr_traj_planner.core.errors import (
    format_distinct,
    LimitViolationError,
    StartStateError,
    UnreachableError,
)
from rrr_traj_planner.core.kinematics.along_path import unlimited_joint_path
from rrr_traj_planner.core.kinematics.joint_ranges import (
    nearest_turns,
    range_error,
    TURN,
    whole_turns,
)
from rrr_traj_planner.core.kinematics.postures import Posture
from rrr_traj_planner.core.path.axis_planes import axis_planes, AxisPlanes
from rrr_traj_planner.core.path.cartesian_path import CartesianPath
from rrr_traj_planner.core.rounding import JOINT_ROUNDING, TIP_ROUNDING

# Intervals that may contain an excursion are halved: largest number of rounds, shortest interval;
# chosen: 1e-12 of the first, and less than the tip is told apart by.
BISECTIONS = 40
SHORTEST_STEP = 1e-9  # m

# Least distance from joint axis 1 at which the tip may pass it: nearer, joint 1 would have to turn
# with practically unbounded velocity. Chosen.
AXIS_CLEARANCE = 1e-6   # m

# Largest excursions that may be missed, chosen so that what is missed is rounding to later checks:
FINEST = 1e-8           # m^2, of a squared distance
COARSE_ANGLE = 1e-8     # rad, of a joint
FINEST_ANGLE = 0.01 * JOINT_ROUNDING  # rad, of a joint within NEAR_END of an end of its range
NEAR_END = 1e-6         # rad
# Bound on a second derivative between two samples, over the larger of theirs; chosen.
SAFETY = 2.0

# Values and a bound on the magnitude of their second derivatives by s, shape (m,) each.
Quantity = Callable[[Array], tuple[Array, Array]]


class JointRange(NamedTuple):
    """Joint positions at the start of a path, and their extremes along it [rad]."""

    start: Array  # shape (3,); with the whole turns that keep each joint in its range
    least: Array
    most: Array


def check_workspace(model: RobotModel, limits: JointLimits, path: CartesianPath,
                    posture: Posture, start: Array | None = None,
                    should_stop: ShouldStop = never) -> JointRange:
    """
    Raise if a path leaves the workspace or a joint's range anywhere, between points too.

    Every interval in which a bound on the second derivative allows an excursion is
    halved until none is left.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Ranges of the joints.
    path : CartesianPath
        The path.
    posture : Posture
        The posture; where the path crosses joint axis 1 in a plane with it, at its beginning.
    start : ndarray, shape (3,), optional
        Joint positions in which the path is to begin [rad]; None: in any whole turns.
    should_stop : callable
        Polled in every round; called for its exceptions; the return value is ignored.

    Returns
    -------
    JointRange
        Joint positions at the start, and their extremes along the path.

    Raises
    ------
    UnreachableError
        If the path leaves the workspace: with the path coordinate of the largest violation and
        the nearest via point's number.
    LimitViolationError
        If the path crosses joint axis 1 where joint 1 would have to turn, or a joint leaves its
        range; likewise.
    StartStateError
        If the path does not begin in the given joint positions.

    """
    planes = axis_planes(path, posture, _free_angle(limits, start))
    _check_reach(model, path)
    _check_axis(model, path, planes)
    grid = path.grid
    for _ in range(BISECTIONS):
        should_stop()
        joints = unlimited_joint_path(model, planes.points(path, grid), posture)
        from_left = unlimited_joint_path(model, planes.points(path, grid, left=True), posture)
        h = np.diff(grid)[:, np.newaxis]
        second_derivative = np.maximum(np.abs(joints.ddq[:-1]), np.abs(from_left.ddq[1:]))
        excursion = 0.125 * SAFETY * h ** 2 * second_derivative
        low = np.minimum(joints.q[:-1], joints.q[1:]) - excursion
        high = np.maximum(joints.q[:-1], joints.q[1:]) + excursion
        least, most = joints.q.min(axis=0), joints.q.max(axis=0)
        # Only where an extreme may be higher than the highest sample is a finer grid needed.
        open_ = ((low < least - _resolution(least, limits.min_position))
                 | (high > most + _resolution(most, limits.max_position))).any(axis=1)
        open_ &= h[:, 0] > SHORTEST_STEP
        if not open_.any():
            break
        grid = np.sort(np.concatenate((grid, 0.5 * (grid[:-1] + grid[1:])[open_])))
    q = joints.q + whole_turns(joints.q, limits, start)
    if start is not None:
        _check_start(model, start, q[0])
    _check_ranges(model, limits, path, posture, grid, q)
    return JointRange(q[0], q.min(axis=0), q.max(axis=0))


def place_on_path(path: CartesianPath, s: float) -> tuple[str, int]:
    """
    Return a text for a path coordinate, and the nearest via point.

    Parameters
    ----------
    path : CartesianPath
        The path.
    s : float
        The path coordinate [m].

    Returns
    -------
    tuple of str and int
        The text, and the number of the via point that is nearest along the path.

    """
    nearest = int(np.abs(path.via_s - s).argmin())
    before = int(np.clip(np.searchsorted(path.via_s, s, side='right') - 1, 0,
                         len(path.via_s) - 2))
    return (f'at {s:.6g} m along the path, between via points {before} and {before + 1} '
            f'(nearest: {nearest})', nearest)


def _free_angle(limits: JointLimits, start: Array | None) -> float:
    """Return the position of joint 1 where any is possible [rad]."""
    low, high = limits.min_position[0], limits.max_position[0]
    return float(np.clip(0.0, low, high) if start is None else start[0])


def _check_start(model: RobotModel, start: Array, q: Array) -> None:
    """Raise if a path begins in joint positions other than those of the arm."""
    gap = np.abs(start - q)
    if gap.max() > JOINT_ROUNDING:
        j = int(gap.argmax())
        at, wanted = format_distinct(start[j], q[j])
        raise StartStateError(
            f'start state: {model.joint_names[j]} is at {at} rad with the tip on joint axis 1 '
            f'(singularity): it would need unbounded velocity to reach {wanted} rad, where the '
            'path leaves the axis')


def _peak(quantity: Quantity, grid: Array) -> tuple[float, float]:
    """Return the largest value, to FINEST where it is positive, and its path coordinate."""
    for _ in range(BISECTIONS):
        value, second_derivative = quantity(grid)
        h = np.diff(grid)
        bound = np.maximum(value[:-1], value[1:]) + (
            0.125 * SAFETY * h ** 2 * np.maximum(second_derivative[:-1], second_derivative[1:]))
        open_ = (bound > max(float(value.max()), 0.0) + 1e-3 * FINEST) & (h > SHORTEST_STEP)
        if not open_.any():
            break
        grid = np.sort(np.concatenate((grid, 0.5 * (grid[:-1] + grid[1:])[open_])))
    return float(value.max()), float(grid[value.argmax()])


def _squared_distance(p: Array, dp: Array, ddp: Array) -> tuple[Array, Array]:
    """Return squares of lengths, and bounds on the magnitudes of their second derivatives."""
    return (p * p).sum(axis=1), 2.0 * ((dp * dp).sum(axis=1) + np.linalg.norm(
        p, axis=1) * np.linalg.norm(ddp, axis=1))


def _two_sided(path: CartesianPath, s: Array, origin: tuple[float, float, float],
               axes: slice) -> tuple[Array, Array]:
    """Return the squared distance from a point or an axis, and bounds on its second derivative."""
    value, of_sides = np.zeros(0), []
    for left in (False, True):
        p, dp, ddp, _ = path(s, left)
        value, second_derivative = _squared_distance(
            (p - origin)[:, axes], dp[:, axes], ddp[:, axes])
        of_sides.append(second_derivative)
    return value, np.maximum(*of_sides)


def _check_reach(model: RobotModel, path: CartesianPath) -> None:
    """Raise if a path leaves the spherical shell that the tip can reach."""
    least, most = model.reach
    shoulder = (0.0, 0.0, model.d1)

    def beyond(s: Array) -> tuple[Array, Array]:
        squared, second_derivative = _two_sided(path, s, shoulder, slice(3))
        return squared - (most - TIP_ROUNDING) ** 2, second_derivative

    def inside(s: Array) -> tuple[Array, Array]:
        squared, second_derivative = _two_sided(path, s, shoulder, slice(3))
        return (least + TIP_ROUNDING) ** 2 - squared, second_derivative

    for quantity, bound, what in ((beyond, most, "beyond the arm's reach of"),
                                  (inside, least, 'nearer than the arm can fold,')):
        excess, s = _peak(quantity, path.grid)
        if excess > 0.0:
            W = float(np.linalg.norm(path(s)[0] - shoulder))
            place, nearest = place_on_path(path, s)
            miss = max(W - most, least - W)
            distance, limit = format_distinct(W, bound)
            where = (f'{what} {limit} m' if miss > 0.0 else
                     'on the edge of the workspace (singularity: would need unbounded velocity)')
            raise UnreachableError(
                f'{place}: the tip would be {distance} m from the shoulder, {where}',
                distance=max(miss, 0.0), via_point=nearest)


def _check_axis(model: RobotModel, path: CartesianPath, planes: AxisPlanes) -> None:
    """Raise if a path crosses joint axis 1 outside the planes through it."""
    grid = path.grid
    grid = grid[(grid >= planes.before) & (grid <= planes.after)]
    if not len(grid):
        return

    def near(s: Array) -> tuple[Array, Array]:
        squared, second_derivative = _two_sided(path, s, (0.0, 0.0, 0.0), slice(2))
        return AXIS_CLEARANCE ** 2 - squared, second_derivative

    excess, s = _peak(near, grid)
    if excess > 0.0:
        place, nearest = place_on_path(path, s)
        distance = float(np.hypot(*path(s)[0][:2]))
        passed, bound = format_distinct(distance, AXIS_CLEARANCE, digits=3)
        raise LimitViolationError(
            f'{place}: the tip would pass joint axis 1 (singularity) at {passed} m, where '
            f'{model.joint_names[0]} would need unbounded velocity; least {bound} m',
            model.joint_names[0], distance, AXIS_CLEARANCE, via_point=nearest)


def _resolution(extreme: Array, end: Array) -> Array:
    """Return the resolution of joints' extremes: fine where they are near the range's end."""
    with np.errstate(invalid='ignore'):  # infinite ends
        beyond = extreme - end
        is_near = np.abs(beyond - TURN * nearest_turns(beyond)) < NEAR_END
    return np.where(is_near, FINEST_ANGLE, COARSE_ANGLE)


def _check_ranges(model: RobotModel, limits: JointLimits, path: CartesianPath,
                  posture: Posture, s: Array, q: Array) -> None:
    """Raise if joint positions are out of range, reporting the largest violation."""
    excess = np.maximum(limits.min_position - q, q - limits.max_position)
    if (excess <= JOINT_ROUNDING - FINEST_ANGLE).all():
        return
    i, j = (int(k) for k in np.unravel_index(excess.argmax(), excess.shape))
    place, nearest = place_on_path(path, float(s[i]))
    raise range_error(model, limits, place, j, float(q[i, j]), posture, nearest)
