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

"""Joint axes 1 and 2 with their common normal, and the tip relative to them."""

from __future__ import annotations

import ctypes
from ctypes import c_double
from functools import lru_cache

import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kernels import same_size_as

# Part of the arm's size up to which the tip counts as on joint axis 1, so that it is on neither
# side, and of a unit vector up to which a component counts as none: descriptions from CAD are
# rounded to 1e-4 rad at worst.
CAD_ROUNDING = 1e-4


@same_size_as('size_of_common_normal')
class CommonNormal(ctypes.Structure):  # as in native/inverse.h
    """
    The common normal of joint axes 1 and 2, and the tip x as joint 3 alone turns.

    It leads from c1 on axis 1 to c2 = c1 + a n on axis 2 [m]; c and s are the cosine and the sine
    (positive) of the angle of the axes, z the direction of axis 1, n = z x z2 / s and m = z x n.
    By coefficients of 1, cos q3, sin q3: u, v, k, the components of x - c2 along n, z2 x n and z2
    [m], and Q, its square [m^2]. No tip is further from axis 1 than size [m].
    """

    _fields_ = [*((name, c_double) for name in ('size', 'a', 'c', 's')),
                *((name, c_double * 3) for name in ('c1', 'n', 'm', 'z', 'u', 'v', 'k', 'Q'))]


@lru_cache(maxsize=16)
def common_normal(model: RobotModel) -> CommonNormal:
    """
    Return an arm's common normal of joint axes 1 and 2, made once.

    Parameters
    ----------
    model : RobotModel
        The arm; a model never changes. Of it, the chain and the tip's table are used.

    Returns
    -------
    CommonNormal
        For the kernels: a, c1, c2 = c1 + a n in metres; u, v, k [m] and Q = u^2 + v^2 + k^2
        [m^2] by coefficients of 1, cos q3, sin q3.

    """
    (z1, z2, _), (p1, p2, _) = model.chain.axis, model.chain.point
    across = np.cross(z1, z2)
    s = float(np.linalg.norm(across))
    n = across / s
    c1 = p1 + z1 * (np.cross(p2 - p1, z2) @ n / s)
    c2 = p2 + z2 * (np.cross(p2 - p1, z1) @ n / s)
    at_zero = model.tables.tip[:, :2, :2].sum(axis=(1, 2))  # q1 = q2 = 0: coordinate, function
    at_zero[:, 0] -= c2
    of_1, of_cos, of_sin = at_zero.T
    Q = (of_1 @ of_1 + 0.5 * (of_cos @ of_cos + of_sin @ of_sin), 2.0 * of_1 @ of_cos,
         2.0 * of_1 @ of_sin)
    return CommonNormal(
        model.chain.size, (p2 - p1) @ n, z1 @ z2, s, *(
            tuple(x) for x in (c1, n, np.cross(z1, n), z1, n @ at_zero,
                               np.cross(z2, n) @ at_zero, z2 @ at_zero, Q)))


def front_sign(model: RobotModel) -> float:
    """
    Return on which side of joint axis 1 the tip is with all joints at zero.

    Parameters
    ----------
    model : RobotModel
        The arm.

    Returns
    -------
    float
        1 on the side to which the common normal n points, else -1. Of a tip on the axis, on the
        side towards the base frame's x axis, or y, or z where these are at right angles to n.

    """
    g = common_normal(model)
    r = g.a + g.u[0] + g.u[1]
    if abs(r) <= CAD_ROUNDING * g.size:
        return leading_sign(np.array(g.n))
    return -1.0 if r < 0.0 else 1.0


def leading_sign(v: Array) -> float:
    """
    Return the sign of a vector's first component that is not zero.

    Parameters
    ----------
    v : ndarray, shape (3,)
        A unit vector.

    Returns
    -------
    float
        1 or -1. Components up to `CAD_ROUNDING` count as zero.

    """
    return float(np.sign(v[np.abs(v) > CAD_ROUNDING][0]))
