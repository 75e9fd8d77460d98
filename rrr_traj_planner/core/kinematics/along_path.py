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
Inverse kinematics along a path: joint positions and three derivatives by arc length.

Joint positions by Newton's method on the tip's position, from near ones; the derivatives by
differentiating p(s) = tip(q(s)) three times (Bobrow, Dubowsky and Gibson 1985, appendix). In C.
"""

from __future__ import annotations

from ctypes import c_int32, c_void_p
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.compiled_arm import compiled
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kernels import contiguous, declared

KERNELS = declared({
    'arm_joint_path': (c_int32, [c_void_p, c_int32, *[c_void_p] * 5]),
    'arm_follow_path': (c_int32, [c_void_p, c_int32, *[c_void_p] * 9]),
})

DETERMINANT, FIRST, SECOND, SINGULAR_VALUE = range(4)  # columns, as in native/joint_path.c
REGULARITY = 4


class JointPath(NamedTuple):
    """Joint positions and their first three derivatives by arc length, shape (n, 3) each."""

    q: Array     # [rad]
    dq: Array    # [rad/m]
    ddq: Array   # [rad/m^2]
    dddq: Array  # [rad/m^3]


class PathPoints(NamedTuple):
    """
    Positions of the tip and their first three derivatives by arc length, shape (n, 3).

    For a piece of the path in a plane through joint axis 1 the plane's normal is given too: joint
    1 is constant there, also where the piece meets the axis.
    """

    p: Array     # [m]
    dp: Array    # [1]
    ddp: Array   # [1/m]
    dddp: Array  # [1/m^2]
    normal: Array | None = None  # unit vectors, shape (n, 3); NaN elsewhere


class FollowedPoints(NamedTuple):
    """Joint positions at points of a path, from the first to the last that was reached."""

    q: Array           # [rad], shape (m, 3)
    rates: Array       # (2, m, 3) [rad/m]: as the path leaves and as it reaches each point
    regularity: Array  # (2, m, 4): as of `joint_path_near`; likewise
    error: Array       # (m - 1,) [rad]: of each position predicted from the one before


def joint_path_near(model: RobotModel, points: PathPoints,
                    guess: Array) -> tuple[JointPath, Array]:
    """
    Return joint positions at points of a path, the nearest to given ones.

    Parameters
    ----------
    model : RobotModel
        The arm.
    points : PathPoints
        In any order, none singular.
    guess : ndarray, shape (n, 3)
        Positions near those sought [rad].

    Returns
    -------
    JointPath
        Joint positions and derivatives.
    ndarray, shape (n, 4)
        Determinant of the Jacobian and two derivatives by arc length [m^3, m^2, m], and a lower
        bound on its least singular value [m/rad].

    Raises
    ------
    RuntimeError
        If there is no solution near a guess: guesses between known positions are near enough.

    """
    n, arm = len(guess), compiled(model)
    path, normal, q = contiguous(np.array(points[:4])), points.normal, np.array(guess, dtype=float)
    normals = None if normal is None else contiguous(normal)
    derivatives, regularity = np.empty((n, 3, 3)), np.empty((n, REGULARITY))
    done = KERNELS.arm_joint_path(
        arm.address, n, path.ctypes.data, _address(normals), q.ctypes.data,
        derivatives.ctypes.data, regularity.ctypes.data)
    if done < n:
        raise RuntimeError(f'no joint positions at point {done} of a path near {guess[done]} rad')
    return JointPath(q, *np.moveaxis(derivatives, 1, 0)), regularity


def follow_points(model: RobotModel, s: Array, leaving: PathPoints, reaching: PathPoints,
                  first: Array) -> FollowedPoints:
    """
    Return joint positions along a path by continuation from its first point.

    Each position is predicted by a Taylor polynomial from the one before, then corrected
    (predictor-corrector: Allgower and Georg, Introduction to Numerical Continuation Methods,
    2003, chapter 2).

    Parameters
    ----------
    model : RobotModel
        The arm.
    s : ndarray, shape (n,)
        Path coordinates [m], ascending.
    leaving, reaching : PathPoints
        The path there, after and before each point.
    first : ndarray, shape (3,)
        Joint positions near those at the first point [rad].

    Returns
    -------
    FollowedPoints
        Up to the last point that was reached before a singular one.

    """
    n, arm = len(s), compiled(model)
    q, rates = np.empty((n, 3)), np.empty((2, n, 3, 3))
    regularity, error = np.empty((2, n, REGULARITY)), np.empty(n - 1)
    q[0] = first
    s = contiguous(s)
    of_sides = [contiguous(np.array(side[:4])) for side in (leaving, reaching)]
    normals = [None if side.normal is None else contiguous(side.normal)
               for side in (leaving, reaching)]
    done = KERNELS.arm_follow_path(
        arm.address, n, s.ctypes.data, *(address for side, normal in zip(of_sides, normals)
                                         for address in (side.ctypes.data, _address(normal))),
        q.ctypes.data, rates.ctypes.data, regularity.ctypes.data, error.ctypes.data)
    return FollowedPoints(q[:done], rates[:, :done, 0], regularity[:, :done],
                          error[:max(done - 1, 0)])


def singular_distance(regularity: Array) -> Array:
    """
    Return the distances to the nearest singular positions along a path, in the complex plane.

    A singular position is a branch point of the joint positions as functions of the path
    coordinate, so that Taylor polynomials converge up to the nearest one (Ahlfors, Complex
    Analysis, 1979, chapters 5 and 8). The squared determinant is analytic there too: of its Taylor
    polynomial of degree 2, the root nearest to 0.

    Parameters
    ----------
    regularity : ndarray, shape (..., 4)
        As returned by `joint_path_near`.

    Returns
    -------
    ndarray, shape (...)
        [m], infinite where there is none.

    """
    det, first, second = np.moveaxis(regularity[..., :SINGULAR_VALUE], -1, 0)
    a, b, c = first ** 2 + det * second, det * first, det ** 2  # of a x^2 + 2 b x + c
    farther = np.abs(np.abs(b) + np.sqrt(b * b - a * c + 0j))   # a times the other root
    with np.errstate(divide='ignore', invalid='ignore'):
        return np.asarray(np.where(c > 0.0, c / farther, 0.0))


def _address(array: Array | None) -> int | None:
    return None if array is None else int(array.ctypes.data)
