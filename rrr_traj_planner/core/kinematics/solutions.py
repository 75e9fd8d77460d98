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
All inverse solutions of any arm of three revolute joints: at most four, but for whole turns.

Pieper, The kinematics of manipulators under computer control, 1968: the equations are in
native/inverse.c.
"""

from __future__ import annotations

import ctypes
from ctypes import c_double, c_int32, c_void_p
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arm.compiled_arm import compiled
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, finite_array, IntArray
from rrr_traj_planner.core.kernels import declared
from rrr_traj_planner.core.kinematics.common_normal import common_normal
from rrr_traj_planner.core.rounding import TIP_ROUNDING
from rrr_traj_planner.core.scalars import positive

KERNELS = declared({'arm_inverse': (
    None, [c_void_p, c_void_p, c_int32, c_void_p, c_void_p, c_double, c_double, *[c_void_p] * 3])})

MOST = 4  # solutions of a point, but for whole turns


class Solutions(NamedTuple):
    """
    The joint positions that bring the tip to a point.

    Parameters
    ----------
    q : ndarray, shape (k, 3)
        At most four, each position in (-pi, pi] [rad], in ascending order of joint 1, then 2,
        then 3; empty if the point is out of reach.
    nearest : float
        Where there is none, the distance from the point to the nearest one that the tip reaches
        [m]; else 0.

    """

    q: Array
    nearest: float


def solutions(model: RobotModel, point: ArrayLike, tolerance: float = TIP_ROUNDING,
              previous: ArrayLike | None = None) -> Solutions:
    """
    Return all joint positions that bring the tip to a point.

    At a point of joint axis 1, theta_1 is arbitrary: it keeps its previous value. So does theta_2
    where joint 3 brings the tip to joint axis 2. Where two solutions coincide, one is returned.

    Parameters
    ----------
    model : RobotModel
        The arm.
    point : array_like, shape (3,)
        Tip position in the base frame [m].
    tolerance : float
        Distance by which the point may be out of reach [m].
    previous : array_like, shape (3,), optional
        Joint positions [rad] of the point before; without them, 0.

    Returns
    -------
    Solutions
        Positions and distance.

    Raises
    ------
    InvalidInputError
        If an argument is malformed.

    """
    points = finite_array('point', point, (3,))[np.newaxis]
    q, count, miss = _solved(model, points, positive('tolerance', tolerance, 'm'), previous)
    return Solutions(q[0, :count[0]], float(miss[0]))


def all_solutions(model: RobotModel, points: ArrayLike,
                  previous: ArrayLike | None = None) -> tuple[Array, IntArray]:
    """
    Return all joint positions for each of many points, as `solutions` does.

    Parameters
    ----------
    model : RobotModel
        The arm.
    points : array_like, shape (n, 3)
        Tip positions in the base frame [m].
    previous : array_like, shape (3,), optional
        Values of angles that are arbitrary [rad]; without them, 0.

    Returns
    -------
    q : ndarray, shape (n, 4, 3)
        Of each point its solutions [rad], then NaN.
    count : ndarray of int, shape (n,)
        Numbers of them.

    Raises
    ------
    InvalidInputError
        If an argument is malformed.

    """
    q, count, _ = _solved(model, finite_array('points', points, (-1, 3)), TIP_ROUNDING, previous)
    return q, count


def distances_out_of_reach(model: RobotModel, points: ArrayLike) -> Array:
    """
    Return by how far points are out of reach.

    Parameters
    ----------
    model : RobotModel
        The arm.
    points : array_like, shape (n, 3)
        Tip positions in the base frame [m].

    Returns
    -------
    ndarray, shape (n,)
        Distances to the nearest point that the tip reaches [m], 0 within `TIP_ROUNDING`.

    Raises
    ------
    InvalidInputError
        If an argument is malformed.

    """
    return _solved(model, finite_array('points', points, (-1, 3)), TIP_ROUNDING, None)[2]


def _solved(model: RobotModel, points: Array, tolerance: float,
            previous: ArrayLike | None) -> tuple[Array, IntArray, Array]:
    """Return joint positions (n, 4, 3), their counts (n), and misses (n) [m]."""
    before = np.zeros(3) if previous is None else finite_array('previous', previous, (3,))
    n, arm = len(points), compiled(model)
    q, count, miss = np.full((n, MOST, 3), np.nan), np.zeros(n, dtype=np.int32), np.zeros(n)
    KERNELS.arm_inverse(arm.address, ctypes.addressof(common_normal(model)), n,
                        points.ctypes.data, before.ctypes.data, tolerance, TIP_ROUNDING,
                        q.ctypes.data, count.ctypes.data, miss.ctypes.data)
    # Of points so far away that their squares overflow, the arm is at the origin.
    away = np.hypot(np.hypot(points[:, 0], points[:, 1]), points[:, 2])
    return q, count.astype(np.intp), np.where(np.isinf(miss), away, miss)
