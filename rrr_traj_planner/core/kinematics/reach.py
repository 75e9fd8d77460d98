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

"""The surface of the space that the tip reaches, to be drawn."""

from __future__ import annotations

from itertools import product
from math import pi
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, IntArray
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.rotations import rotation_z_to

SAMPLES = 500   # positions of joints 2 and 3 each: steps of the tip below a cell's size
CELLS = 56      # along the distance from joint axis 1, and along the axis
SECTORS = 72    # around it
LEVEL = 0.5     # of the means of cells, on the surface: at the outer edge of those reached


class Surface(NamedTuple):
    """A surface of triangles."""

    vertices: Array  # shape (n, 3), base frame [m]
    faces: IntArray  # shape (k, 3): indices of vertices, counterclockwise from outside


class _Grid(NamedTuple):
    """Cells around joint axis 1, and the cells around them, which are never reached."""

    width: float     # of a cell, along the distance from the axis [m]
    height: float    # along the axis [m]
    bottom: float    # of the lowest cell [m]


def reach(model: RobotModel, limits: JointLimits) -> Surface:
    """
    Return the surface of the space that the tip reaches.

    The tip is at every position of joints 2 and 3; each turns about joint axis 1 by the range of
    joint 1. What is reached is found in cells around that axis, and its surface drawn around
    them, a hundredth of the arm's reach off.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Its ranges; a whole turn where there is none.

    Returns
    -------
    Surface
        Closed, also where an arm cannot reach near its own base.

    """
    low, high = _ranges(limits)
    q = np.zeros((SAMPLES, SAMPLES, 3))
    q[..., 1] = np.linspace(low[1], high[1], SAMPLES)[:, None]
    q[..., 2] = np.linspace(low[2], high[2], SAMPLES)
    chain = model.chain
    axes = rotation_z_to(chain.axis[0])
    x, y, z = ((forward_kinematics(model, q.reshape(-1, 3)) - chain.point[0]) @ axes).T
    distance = np.hypot(x, y)
    grid = _Grid(float(distance.max()) / CELLS or 1.0, float(np.ptp(z)) / CELLS or 1.0,
                 float(z.min()))
    cell = (_clipped(distance / grid.width), _clipped((z - grid.bottom) / grid.height))
    is_reached = _turned(cell, np.arctan2(y, x) + low[0], high[0] - low[0])
    vertices, faces = _surface(_smooth(is_reached.astype(float)))
    return Surface(chain.point[0] + _places(vertices, grid) @ axes.T, faces)


def _ranges(limits: JointLimits) -> tuple[Array, Array]:
    """Return the ranges, no wider than a whole turn."""
    low, high = limits.min_position, limits.max_position
    is_turn = ~(high - low < 2.0 * pi)
    return np.where(is_turn, -pi, low), np.where(is_turn, pi, high)


def _clipped(cell: Array) -> IntArray:
    return np.minimum(cell.astype(np.int64), CELLS - 1)


def _turned(cell: tuple[IntArray, IntArray], start: Array, angle: float) -> Array:
    """Return which cells are reached by turning from angles on; shape (CELLS, CELLS, SECTORS)."""
    first = np.floor(start / (2.0 * pi) * SECTORS).astype(np.int64) % SECTORS
    count = min(int(np.ceil(angle / (2.0 * pi) * SECTORS)), SECTORS)
    change = np.zeros((CELLS, CELLS, 2 * SECTORS))
    np.add.at(change, (*cell, first), 1.0)
    np.add.at(change, (*cell, np.minimum(first + count, 2 * SECTORS - 1)), -1.0)
    covers = np.cumsum(change, axis=-1) > 0.0
    return np.asarray(covers[..., :SECTORS] | covers[..., SECTORS:])


def _smooth(values: Array) -> Array:
    """
    Return means of neighbouring cells in each direction, with the cells around.

    Beyond the axis are the values before it; around it the last cell is beside the first.
    """
    padded = np.pad(np.pad(values, ((2, 0), (0, 0), (0, 0)), mode='edge'),
                    ((0, 2), (2, 2), (0, 0)))
    for axis in (0, 1, 0, 1):  # twice, so that steps from cell to cell are not seen
        middle = np.moveaxis(padded, axis, 0)
        middle[1:-1] = (middle[:-2] + middle[1:-1] + middle[2:]) / 3.0
    padded[0] = padded[1]
    around = (np.roll(padded, 1, -1) + padded + np.roll(padded, -1, -1)) / 3.0
    return np.concatenate((around[..., -1:], around, around[..., :1]), axis=-1)


def _surface(values: Array) -> tuple[Array, IntArray]:
    """
    Return the surface on which values of a grid are at `LEVEL`, by surface nets.

    Between eight neighbours that are not all on one side is a vertex, the mean of where the edges
    between them are crossed; around each edge that is crossed are two triangles of such vertices
    (Gibson, Constrained elastic surface nets, 1998).
    """
    above = values - LEVEL
    shape = np.array(values.shape) - 1
    total, count = np.zeros((*shape, 3)), np.zeros(shape, dtype=np.int64)
    for axis, corner in product(range(3), product((0, 1), repeat=3)):
        if corner[axis] == 0:
            a, b = (above[tuple(slice(c, c + n) for c, n in zip(at, shape))] for at in (
                corner, np.array(corner) + np.eye(3, dtype=int)[axis]))
            is_crossed = (a > 0.0) != (b > 0.0)
            place = np.broadcast_to(np.array(corner, dtype=float), total.shape).copy()
            place[..., axis] = a / np.where(is_crossed, a - b, 1.0)
            total += np.where(is_crossed[..., None], place, 0.0)
            count += is_crossed
    used = count > 0
    vertices = np.argwhere(used) + total[used] / count[used][:, None]
    number = np.full(shape, -1)
    number[used] = np.arange(len(vertices))
    return vertices, np.concatenate([_faces(above, number, axis) for axis in range(3)])


def _faces(above: Array, number: IntArray, axis: int) -> IntArray:
    """Return the triangles around the edges along an axis that are crossed."""
    order = (axis, (axis + 1) % 3, (axis + 2) % 3)
    above, number = np.moveaxis(above, order, (0, 1, 2)), np.moveaxis(number, order, (0, 1, 2))
    is_in = above[:, 1:-1, 1:-1] > 0.0
    ends, starts = is_in[:-1] & ~is_in[1:], ~is_in[:-1] & is_in[1:]
    if axis == 2:  # the first edge is the last one again
        ends[-1], starts[-1] = False, False
    a, b, c, d = (number[:, u:number.shape[1] - 1 + u, v:number.shape[2] - 1 + v]
                  for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)))
    quads = np.concatenate((np.stack([x[ends] for x in (d, c, b, a)], axis=-1),
                            np.stack([x[starts] for x in (a, b, c, d)], axis=-1)))
    return np.concatenate((quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]))


def _places(vertices: Array, grid: _Grid) -> Array:
    """Return places in the frame of joint axis 1, of places in the grid of `_smooth`."""
    distance = np.maximum((vertices[:, 0] - 1.5) * grid.width, 0.0)
    angle = (vertices[:, 2] - 0.5) * (2.0 * pi / SECTORS)
    return np.stack((distance * np.cos(angle), distance * np.sin(angle),
                     grid.bottom + (vertices[:, 1] - 1.5) * grid.height), axis=-1)
