"""A feasible motion to begin with: rest at every via point, slowed until everything fits."""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics import gravity_torque, inverse_dynamics
from rrr_traj_planner.core.errors import LimitViolationError
from rrr_traj_planner.planners.ramp_chain import Grid, Motion
from rrr_traj_planner.planners.ramp_constraints import Constraints
from rrr_traj_planner.planners.request import JointTask

ROOM = 1.02             # durations over the least that fit
LEAST_DURATION = 1e-4   # s
HOLDING_ROOM = 1e-6     # of the effort limit that gravity must leave along the way
RANGE_ROOM = 4e-10      # rad, for the rounding of points at the end of a range
LIFTS = 9               # heights of a detour that are tried


def rest_to_rest(task: JointTask, constraints: Constraints) -> Motion | None:
    """
    Return a motion with a stop at every via point, strictly within all limits.

    Straight in joint space where gravity lets it; else joint 2 is brought towards the vertical,
    where the upper arm's weight takes no torque, the rest of the way is done there, and it is
    brought down again, the forearm keeping its direction meanwhile.

    Parameters
    ----------
    task : JointTask
        The arm, its limits and the via points.
    constraints : Constraints
        The same as the method sees them.

    Returns
    -------
    Motion or None
        None where no way is found along which the motors can hold the arm.

    """
    grid = constraints.grid
    nodes = grid.rest_to_rest(task.points)
    if constraints.with_torque:
        for k in range(len(nodes)):
            way = _holdable_way(task, grid, task.points[k:k + 2])
            if way is None:
                return None
            nodes[k] = way
    rest, one = np.zeros((len(nodes) - 1, 3)), np.ones(len(nodes))
    m = Motion(nodes[:, 1:-1], rest, rest, one)
    T = _least_durations(task, constraints, m)
    return None if T is None else grid.restored(task.points, grid.slowed(m, T))


def _holdable_way(task: JointTask, grid: Grid, ends: Array) -> Array | None:
    """Return node accelerations for a duration of 1 s along which the arm can be held."""
    start, end = ends
    straight: Array = grid.rest_to_rest(ends)[0]
    if _holds(task, grid, ends, straight):
        return straight
    direct = np.clip(0.5 * np.pi, *np.sort((start[1], end[1])))
    for lift in np.linspace(0.0, 1.0, LIFTS):
        height = direct + lift * (0.5 * np.pi - direct)
        up, across = start.copy(), end.copy()
        for pose in (up, across):
            pose[2] += pose[1] - height  # theta_2 + theta_3 stays
            pose[1] = height
        way = grid.rest_to_rest_legs(np.stack((start, up, across, end)))
        if _holds(task, grid, ends, way):
            return way
    return None


def _holds(task: JointTask, grid: Grid, ends: Array, nodes: Array) -> bool:
    """Return whether gravity leaves torque, and ranges are kept, at every point of a way."""
    rest = np.zeros((0, 3))
    q = grid.states(ends, Motion(nodes[np.newaxis, 1:-1], rest, rest, np.ones(1))).q[0, 1:-1]
    limits = task.limits
    torque = np.abs(gravity_torque(task.model, q))
    return bool((torque < limits.max_effort * (1.0 - HOLDING_ROOM)).all()
                and (q >= limits.min_position - RANGE_ROOM).all()
                and (q <= limits.max_position + RANGE_ROOM).all())


def _least_durations(task: JointTask, constraints: Constraints, m: Motion) -> Array | None:
    """Return durations that fit all limits, from a motion of 1 s a segment, shape (N,)."""
    limits, at = task.limits, constraints.grid.states(task.points, m)
    by_limit = [(np.abs(at.qd) / limits.max_velocity).max(axis=(1, 2)),
                np.sqrt((np.abs(at.qdd) / limits.max_acceleration).max(axis=(1, 2))),
                np.cbrt((np.abs(at.jerk) / limits.max_jerk).max(axis=(1, 2)))]
    if constraints.with_torque:
        gravity = gravity_torque(task.model, at.q)
        moving = inverse_dynamics(task.model, at.q, at.qd, at.qdd) - gravity
        room = constraints.effort - (np.sign(moving) * gravity)[:, 1:]
        if (room <= 0.0).any():
            return None
        by_limit.append(np.sqrt((np.abs(moving[:, 1:]) / room).max(axis=(1, 2))))
    if constraints.floor is not None:
        by_limit.append(constraints.floor)
    return np.asarray(np.maximum(ROOM * np.max(by_limit, axis=0), LEAST_DURATION))


def cannot_be_held(task: JointTask, grid: Grid) -> LimitViolationError:
    """
    Return the error of a segment on whose way the motors cannot hold the arm.

    Parameters
    ----------
    task : JointTask
        The arm, its limits and the via points.
    grid : Grid
        The family of motions.

    Returns
    -------
    LimitViolationError
        With the first such segment, and the torque of its straight way.

    """
    for k in range(len(task.points) - 1):
        ends = task.points[k:k + 2]
        if _holdable_way(task, grid, ends) is None:
            break
    rest = np.zeros((0, 3))
    straight = Motion(grid.rest_to_rest(ends)[:, 1:-1], rest, rest, np.ones(1))
    torque = np.abs(gravity_torque(task.model, grid.states(ends, straight).q)).max(axis=(0, 1))
    joint = int((torque / task.limits.max_effort).argmax())
    name = task.model.joint_names[joint]
    needed, limit = float(torque[joint]), float(task.limits.max_effort[joint])
    return LimitViolationError(
        f'segment {task.segment_number(k)}: no way is found on which the motors can hold the '
        f'arm; straight on {name} needs {needed:.1f} N m, limit {limit:g} N m',
        name, needed, limit)
