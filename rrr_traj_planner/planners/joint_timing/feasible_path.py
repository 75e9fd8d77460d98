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
A statically feasible path in joint space: the motors can hold the arm everywhere along it.

The path is the shortest one on a grid of the joints on which gravity's torques depend: joints 2
and 3 where joint axis 1 is vertical, else all (Dijkstra; Cormen et al., Introduction to
Algorithms, chapter on single-source shortest paths), with lengths weighted by the torque that is
left, then shortened by leaving out corners (shortcuts: Geraerts & Overmars, Creating high-quality
paths for motion planning, IJRR 26, 2007). A feasible path that is wider than a cell of the grid is
found.
"""

from __future__ import annotations

from itertools import product

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, IntArray
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque
from rrr_traj_planner.planners.effort_limits import effort_less_friction
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.tolerances import HOLDING_MARGIN
from scipy import sparse
from scipy.sparse import csgraph

RANGE_MARGIN = 4e-10  # rad, for the rounding of points at the end of a range: less than EDGE
# Chosen values.
# By the number of joints on which gravity depends, cells of each of them: the finer grid where the
# coarser has no path. Of three joints, as many as take a second.
CELLS = {2: (48, 400), 3: (20, 40)}
BEYOND = np.pi        # rad, reach of the grid beyond start and end where a joint has no range
SAMPLES = 40          # of a leg, at which gravity's torque is checked


def gravity_ratio(model: RobotModel, limits: JointLimits, q: Array) -> Array:
    """
    Return the largest ratio of gravity's torque to its effort limit less Coulomb friction.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Its limits.
    q : ndarray, shape (..., 3)
        Joint positions [rad].

    Returns
    -------
    ndarray, shape (...)
        Infinite outside the joints' ranges.

    """
    ratio = (np.abs(gravity_torque(model, q)) / effort_less_friction(model, limits)).max(axis=-1)
    inside = ((q >= limits.min_position - RANGE_MARGIN)
              & (q <= limits.max_position + RANGE_MARGIN)).all(axis=-1)
    return np.where(inside, ratio, np.inf)


def statically_feasible_path(task: JointTask, start: Array, end: Array,
                             most_legs: int) -> Array | None:
    """
    Return the corners of a path, straight between them, along which the motors can hold the arm.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    start, end : ndarray, shape (3,)
        Poses that can be held [rad].
    most_legs : int
        Greatest number of straight legs.

    Returns
    -------
    ndarray, shape (legs + 1, 3), or None
        From start to end; None where no such path is found.

    """
    for cells in CELLS[len(_joints_of_gravity(task.model))]:
        path = _grid_path(task, start, end, cells)
        if path is None:
            continue
        for retained in (0.7, 0.3, 0.0):  # part of the torque margin that a shortcut must retain
            corners = _shortcut(task, path, retained)
            if corners is not None and len(corners) <= most_legs + 1:
                return path[corners]
    return None


def _joints_of_gravity(model: RobotModel) -> list[int]:
    """Return the indices of the joints on which gravity's torques depend."""
    return [0, 1, 2] if model.tables.potential[1:].any() else [1, 2]


def _grid_path(task: JointTask, start: Array, end: Array, cells: int) -> Array | None:
    """Return the shortest path on a grid that has both poses as nodes, (m, 3)."""
    joints = _joints_of_gravity(task.model)
    if (start[joints] == end[joints]).all():
        return np.stack((start, end))
    axes = [_axis(task.limits, start[j], end[j], cells, j) for j in joints]
    q = np.tile(start, (*map(len, axes), 1))
    q[..., joints] = np.stack(np.meshgrid(*axes, indexing='ij'), axis=-1)
    ratio = gravity_ratio(task.model, task.limits, q)
    first, last = (int(np.ravel_multi_index(
        [int(np.searchsorted(axis, pose[j])) for j, axis in zip(joints, axes)], ratio.shape))
        for pose in (start, end))
    _, before = csgraph.dijkstra(
        _graph(q, ratio), directed=False, indices=first, return_predecessors=True)
    if last != first and before[last] < 0:
        return None
    nodes = [last]
    while nodes[-1] != first:
        nodes.append(int(before[nodes[-1]]))
    path = q.reshape(-1, 3)[nodes[::-1]]
    length = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(path, axis=0)).max(axis=1))))
    part = length / length[-1] if length[-1] > 0.0 else np.linspace(0.0, 1.0, len(path))
    for j in {0, 1, 2} - set(joints):
        path[:, j] = start[j] + part * (end[j] - start[j])
    path[0], path[-1] = start, end
    return path


def _axis(limits: JointLimits, start: float, end: float, cells: int, joint: int) -> Array:
    """Return the grid's positions of a joint, start and end among them [rad]."""
    least, most = limits.min_position[joint], limits.max_position[joint]
    least = least if np.isfinite(least) else min(start, end) - BEYOND
    most = most if np.isfinite(most) else max(start, end) + BEYOND
    return np.unique(np.concatenate((np.linspace(least, most, cells), [start, end])))


def _graph(q: Array, ratio: Array) -> sparse.csr_array:
    """Return weighted lengths between neighbours that can be held, larger at small margins."""
    number = np.arange(ratio.size).reshape(ratio.shape)
    weight = 1.0 / np.sqrt(np.maximum(1.0 - ratio, HOLDING_MARGIN))
    open_ = ratio < 1.0 - HOLDING_MARGIN
    ends, lengths = [], []
    # Half of a node's neighbours: the others have it as theirs.
    offsets = list(product((1, 0, -1), repeat=ratio.ndim))
    for offset in offsets[:len(offsets) // 2]:
        here, there = _pairs(offset)
        both = open_[here] & open_[there]
        step = np.linalg.norm(q[there] - q[here], axis=-1)
        ends.append(np.stack((number[here][both], number[there][both])))
        lengths.append((step * (weight[here] + weight[there]))[both])
    i, j = np.concatenate(ends, axis=1)
    return sparse.csr_array((np.concatenate(lengths), (i, j)), shape=(ratio.size, ratio.size))


def _pairs(offset: tuple[int, ...]) -> tuple[tuple[slice, ...], tuple[slice, ...]]:
    """Return the slices of a grid with the first and the second nodes of neighbours."""
    slices = {0: (slice(None), slice(None)), 1: (slice(None, -1), slice(1, None)),
              -1: (slice(1, None), slice(None, -1))}
    here, there = zip(*(slices[k] for k in offset))
    return here, there


def _shortcut(task: JointTask, path: Array, retained: float) -> IntArray | None:
    """Return the corners that remain after greedy shortcuts by the longest feasible legs."""
    ratio = gravity_ratio(task.model, task.limits, path)
    corners = [0]
    while corners[-1] < len(path) - 1:
        here = corners[-1]
        ahead = np.arange(here + 1, len(path))
        legs = path[here] + np.linspace(0.0, 1.0, SAMPLES)[:, np.newaxis, np.newaxis] * (
            path[ahead] - path[here])
        most = gravity_ratio(task.model, task.limits, legs).max(axis=0)
        along = np.maximum.accumulate(np.maximum(ratio[here], ratio[ahead]))
        good = np.flatnonzero(most < 1.0 - np.maximum(retained * (1.0 - along), HOLDING_MARGIN))
        if len(good) == 0:
            return None
        corners.append(int(ahead[good[-1]]))
    return np.array(corners)
