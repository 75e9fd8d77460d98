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

"""A feasible first iterate: a motion with stops at every via point, as slow as limits require."""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque
from rrr_traj_planner.core.errors import LimitViolationError
from rrr_traj_planner.core.trajectory.time_scaling import squared_scaling_any_slower, torque_parts
from rrr_traj_planner.planners.effort_errors import torque_texts
from rrr_traj_planner.planners.joint_timing.constraints import JointConstraints
from rrr_traj_planner.planners.joint_timing.feasible_path import (
    gravity_ratio,
    statically_feasible_path,
)
from rrr_traj_planner.planners.solver.ramps import Grid, Variables, with_durations
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.tolerances import HOLDING_MARGIN, START_SCALING

# Chosen: on 28 random tasks half and twice of LEAST_RAMPS and SLOW change a duration by 0.2 %.
LEAST_RAMPS = 4        # of a motion from rest to rest: two up, two down
SLOW = 3.0             # factor by which torque slows a straight path before another is sought


def rest_to_rest(task: JointTask, constraints: JointConstraints) -> Variables | None:
    """
    Return a motion with a stop at every via point, strictly within all limits.

    Straight in joint space, or with further stops along a path on which gravity leaves more
    torque, where that is faster.

    Parameters
    ----------
    task : JointTask
        The arm, its limits and the via points.
    constraints : JointConstraints
        The same limits, less margins.

    Returns
    -------
    Variables or None
        None where no path is found along which the motors can hold the arm.

    """
    grid = constraints.grid
    nodes, T = _fastest_paths(task, constraints)
    if np.isinf(T).any():
        return None
    rest = np.zeros((len(nodes) - 1, 3))
    m = Variables(nodes[:, 1:-1], rest, rest, np.ones(len(nodes)))
    return grid.restored(task.points, with_durations(m, T))


def _fastest_paths(task: JointTask, constraints: JointConstraints) -> tuple[Array, Array]:
    """Return node accelerations for durations of 1 s, and least durations, of all segments."""
    grid = constraints.grid
    nodes = rest_to_rest_shapes(grid, task.points)
    T, without_torque = _least_durations(task, constraints, nodes)
    for k in np.flatnonzero(T > SLOW * without_torque):
        task.should_stop()
        corners = statically_feasible_path(task, task.points[k], task.points[k + 1],
                                           grid.n // LEAST_RAMPS)
        if corners is None:
            continue
        detoured = nodes.copy()
        detoured[k] = rest_to_rest_legs(grid, corners)
        duration = _least_durations(task, constraints, detoured)[0][k]
        if duration < T[k]:
            nodes[k], T[k] = detoured[k], duration
    return nodes, T


def _least_durations(task: JointTask, constraints: JointConstraints,
                     nodes: Array) -> tuple[Array, Array]:
    """
    Return the least durations by all limits, and by all but torque's, each (N,), plus a margin.

    Infinite where gravity blocks the path. Node accelerations are those of segments of 1 s.
    """
    limits, grid, rest = task.limits, constraints.grid, np.zeros((len(nodes) - 1, 3))
    at = grid.states(task.points, Variables(nodes[:, 1:-1], rest, rest, np.ones(len(nodes))))
    T = np.max([(np.abs(at.qd) / limits.max_velocity).max(axis=(1, 2)),
                np.sqrt((np.abs(at.qdd) / limits.max_acceleration).max(axis=(1, 2))),
                np.cbrt((np.abs(at.jerk) / limits.max_jerk).max(axis=(1, 2)))], axis=0)
    # Where nothing moves, accelerations are finite too.
    T = np.maximum(START_SCALING * T, 1e-4)
    if constraints.least_T is not None:
        T = np.maximum(T, START_SCALING * constraints.least_T)
    if not constraints.with_torque:
        return T, T
    # Without Coulomb friction, which is off the limits already.
    parts = torque_parts(task.model, at.q[:, 1:], at.qd[:, 1:], at.qdd[:, 1:])
    by_torque = np.sqrt(squared_scaling_any_slower(constraints.effort, parts).max(axis=(1, 2)))
    blocked = (gravity_ratio(task.model, limits, at.q) >= 1.0 - HOLDING_MARGIN)[:, 1:-1]
    by_torque[blocked.any(axis=1)] = np.inf
    return np.maximum(T, START_SCALING * by_torque), T


def rest_to_rest_shapes(grid: Grid, points: Array) -> Array:
    """
    Return node accelerations, a full sine, of straight motions of 1 s from rest to rest.

    Parameters
    ----------
    grid : Grid
        Discretisation: n ramps per segment.
    points : ndarray, shape (N + 1, 3)
        Via points [rad].

    Returns
    -------
    ndarray, shape (N, n + 1, 3)
        [rad/s^2]; those of a motion of T seconds are 1 / T^2 as large.

    """
    shape = np.sin(2.0 * np.pi * np.arange(grid.n + 1) / grid.n)
    shape *= grid.n ** 2 / (grid.displacement @ shape[1:-1])
    return shape[:, np.newaxis] * np.diff(points, axis=0)[:, np.newaxis]


def rest_to_rest_legs(grid: Grid, points: Array) -> Array:
    """
    Return node accelerations of a segment of 1 s that stops at the corners of its path.

    Parameters
    ----------
    grid : Grid
        Discretisation: n ramps per segment.
    points : ndarray, shape (legs + 1, 3)
        The start, the corners and the end [rad]; longer legs have more of the n ramps.

    Returns
    -------
    ndarray, shape (n + 1, 3)
        [rad/s^2].

    """
    legs = len(points) - 1
    long = np.sqrt(np.abs(np.diff(points, axis=0)).max(axis=1))
    spare = (grid.n - LEAST_RAMPS * legs) * np.cumsum(long) / long.sum()
    ends = np.concatenate(([0], LEAST_RAMPS * np.arange(1, legs + 1)
                           + np.round(spare).astype(int)))
    nodes = np.zeros((grid.n + 1, 3))
    for leg, (first, last) in enumerate(zip(ends[:-1], ends[1:])):
        part = rest_to_rest_shapes(Grid(last - first), points[leg:leg + 2])[0]
        nodes[first:last + 1] += part * (grid.n / (last - first)) ** 2
    return nodes


def cannot_be_held(task: JointTask, grid: Grid) -> LimitViolationError:
    """
    Return the error of a segment without a path along which the motors can hold the arm.

    Parameters
    ----------
    task : JointTask
        The arm, its limits and the via points.
    grid : Grid
        Discretisation: n ramps per segment.

    Returns
    -------
    LimitViolationError
        With the first such segment, and the torque along its straight path.

    """
    ends = zip(task.points[:-1], task.points[1:])
    straight = np.array([np.linspace(start, end, 100) for start, end in ends])
    needs = np.abs(gravity_torque(task.model, straight)).max(axis=1) + task.model.friction.coulomb
    blocked = (k for k, (start, end) in enumerate(zip(task.points[:-1], task.points[1:]))
               if statically_feasible_path(task, start, end, grid.n // LEAST_RAMPS) is None)
    k = next(blocked, int((needs / task.limits.max_effort).max(axis=1).argmax()))
    torque = needs[k]
    joint = int((torque / task.limits.max_effort).argmax())
    name = task.model.joint_names[joint]
    needed, limit = float(torque[joint]), float(task.limits.max_effort[joint])
    shown, most = torque_texts(needed, limit)
    return LimitViolationError(
        f'segment {task.segment_number(k)}: no path found along which the motors can hold the '
        f'arm; the straight line in joint space needs {shown} N m at {name}, limit {most} N m',
        name, needed, limit)
