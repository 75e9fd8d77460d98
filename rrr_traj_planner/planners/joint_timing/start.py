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
from rrr_traj_planner.planners.solver.splines import Mesh, Variables, with_stops
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.tolerances import HOLDING_MARGIN, START_SCALING

# Chosen: on 28 random tasks half and twice of LEAST_INTERVALS and SLOW change a duration by 0.2 %.
LEAST_INTERVALS = 4    # of a motion from rest to rest: one in which jerk rises or falls, each
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
    mesh = constraints.mesh
    jerks, T = _fastest_paths(task, constraints)
    if np.isinf(T).any():
        return None
    m = with_durations(with_stops(jerks, np.ones(len(jerks))), T)
    return mesh.restored(task.points, m)


def _fastest_paths(task: JointTask, constraints: JointConstraints) -> tuple[Array, Array]:
    """Return inner jerks for durations of 1 s, and least durations, of all segments."""
    mesh = constraints.mesh
    jerks = rest_to_rest_shapes(mesh, task.points)
    T, without_torque = _least_durations(task, constraints, jerks)
    for k in np.flatnonzero(T > SLOW * without_torque):
        task.should_stop()
        corners = statically_feasible_path(task, task.points[k], task.points[k + 1],
                                           mesh.n // LEAST_INTERVALS)
        if corners is None:
            continue
        detoured = jerks.copy()
        detoured[k] = rest_to_rest_legs(mesh.parts[k], corners)
        duration = _least_durations(task, constraints, detoured)[0][k]
        if duration < T[k]:
            jerks[k], T[k] = detoured[k], duration
    return jerks, T


def _least_durations(task: JointTask, constraints: JointConstraints,
                     jerks: Array) -> tuple[Array, Array]:
    """
    Return the least durations by all limits, and by all but torque's, each (N,), plus a margin.

    Infinite where gravity blocks the path. Inner jerks are those of segments of 1 s.
    """
    limits, mesh = task.limits, constraints.mesh
    at = mesh.states(task.points, with_stops(jerks, np.ones(len(jerks))))
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


def rest_to_rest_shapes(mesh: Mesh, points: Array) -> Array:
    """
    Return inner jerks, those of the septic, of straight motions of 1 s from rest to rest.

    Parameters
    ----------
    mesh : Mesh
        Its n intervals in each segment.
    points : ndarray, shape (N + 1, 3)
        Via points [rad].

    Returns
    -------
    ndarray, shape (N, n - 1, 3)
        [rad/s^3]; those of a motion of T seconds are 1 / T^3 as large.

    """
    s = mesh.starts[:, 1:-1, np.newaxis]
    septic = 840.0 * s * (1.0 - s * (6.0 - s * (10.0 - 5.0 * s)))
    motion = with_stops(septic * np.diff(points, axis=0)[:, np.newaxis], np.ones(len(s)))
    return mesh.restored(points, motion).inner


def with_durations(m: Variables, T: Array) -> Variables:
    """
    Return a motion that rests at every via point along the same path in other durations.

    Parameters
    ----------
    m : Variables
        The motion.
    T : ndarray, shape (N,)
        The durations [s].

    Returns
    -------
    Variables
        Each segment scaled in time by itself.

    """
    return m._replace(inner=m.inner * ((m.T / T) ** 3)[:, np.newaxis, np.newaxis], T=T)


def rest_to_rest_legs(parts: Array, points: Array) -> Array:
    """
    Return inner jerks of a segment of 1 s that stops at the corners of its path.

    Parameters
    ----------
    parts : ndarray, shape (n,)
        Durations of the segment's intervals [s].
    points : ndarray, shape (legs + 1, 3)
        The start, the corners and the end [rad]; longer legs have more of the n intervals.

    Returns
    -------
    ndarray, shape (n - 1, 3)
        [rad/s^3].

    """
    n, legs = len(parts), len(points) - 1
    long = np.cbrt(np.abs(np.diff(points, axis=0)).max(axis=1))
    spare = (n - LEAST_INTERVALS * legs) * np.cumsum(long) / long.sum()
    ends = np.concatenate(([0], LEAST_INTERVALS * np.arange(1, legs + 1)
                           + np.round(spare).astype(int)))
    jerks = np.zeros((n + 1, 3))
    for leg, (first, last) in enumerate(zip(ends[:-1], ends[1:])):
        T = parts[first:last].sum()
        own = Mesh(parts[np.newaxis, first:last] / T)
        jerks[first + 1:last] = rest_to_rest_shapes(own, points[leg:leg + 2])[0] / T ** 3
    return jerks[1:-1]


def cannot_be_held(task: JointTask, intervals: int) -> LimitViolationError:
    """
    Return the error of a segment without a path along which the motors can hold the arm.

    Parameters
    ----------
    task : JointTask
        The arm, its limits and the via points.
    intervals : int
        In each segment.

    Returns
    -------
    LimitViolationError
        With the first such segment, and the torque along its straight path.

    """
    ends = zip(task.points[:-1], task.points[1:])
    straight = np.array([np.linspace(start, end, 100) for start, end in ends])
    needs = np.abs(gravity_torque(task.model, straight)).max(axis=1) + task.model.friction.coulomb
    blocked = (k for k, (start, end) in enumerate(zip(task.points[:-1], task.points[1:]))
               if statically_feasible_path(task, start, end, intervals // LEAST_INTERVALS) is None)
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
