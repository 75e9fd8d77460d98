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

"""Derivatives of joint positions along a path, from those of the tip's position."""

from __future__ import annotations

from math import pi
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.inverse_kinematics import Elbow
from rrr_traj_planner.core.model import RobotModel

Complex: TypeAlias = NDArray[np.complex128]


class JointPath(NamedTuple):
    """Joint positions and their first three derivatives by arc length, shape (n, 3) each."""

    q: Array     # [rad]
    dq: Array    # [rad/m]
    ddq: Array   # [rad/m^2]
    dddq: Array  # [rad/m^3]


class PathPoints(NamedTuple):
    """Positions of the tip and their first three derivatives by arc length, shape (n, 3)."""

    p: Array     # [m]
    dp: Array    # [1]
    ddp: Array   # [1/m]
    dddp: Array  # [1/m^2]


def unlimited_joint_path(model: RobotModel, points: PathPoints, elbow: Elbow) -> JointPath:
    """
    Return joint positions along a path wherever joint 1 begins, in no range.

    Parameters
    ----------
    model : RobotModel
        The arm.
    points : PathPoints
        In the path's order, none singular.
    elbow : {'up', 'down'}
        The branch.

    Returns
    -------
    JointPath
        Joint positions and derivatives.

    """
    turn, radial = _about_axis(points)
    height = points.p[:, 2] - model.d1, points.dp[:, 2], points.ddp[:, 2], points.dddp[:, 2]
    upper, fore = _in_plane(model, [r + 1j * h for r, h in zip(radial, height)], elbow)
    # The forearm's direction in the plane is theta_2 + theta_3 - 90 deg.
    third = [f - u for f, u in zip(fore, upper)]
    third[0] = third[0] + pi / 2
    orders = [np.stack(joints, axis=-1) for joints in zip(turn, upper, third)]
    return JointPath(*orders)


def _about_axis(points: PathPoints) -> tuple[list[Array], list[Array]]:
    """Return theta_1 and the distance from joint axis 1, each with three derivatives."""
    theta = np.unwrap(np.arctan2(points.p[:, 1], points.p[:, 0]))
    r = np.hypot(points.p[:, 0], points.p[:, 1])
    c, s = points.p[:, 0] / r, points.p[:, 1] / r
    # Each derivative in the axes that turn with joint 1: outward and around.
    (u1, t1), (u2, t2), (u3, t3) = (
        (c * d[:, 0] + s * d[:, 1], c * d[:, 1] - s * d[:, 0]) for d in points[1:])
    w = t1 / r
    r1 = u1
    w1 = (t2 - 2.0 * r1 * w) / r
    r2 = u2 + r * w ** 2
    w2 = (t3 - 3.0 * r2 * w - 3.0 * r1 * w1 + r * w ** 3) / r
    r3 = u3 + 3.0 * r1 * w ** 2 + 3.0 * r * w * w1
    return [theta, w, w1, w2], [r, r1, r2, r3]


def _in_plane(model: RobotModel, z: list[Complex],
              elbow: Elbow) -> tuple[list[Array], list[Array]]:
    """
    Return the directions of both links in the arm's plane, each with three derivatives.

    The plane is the complex one: z = a2 exp(iA) + d4 exp(iB), its derivatives solved for those
    of A and B in turn.
    """
    a2, d4 = model.a2, model.d4
    W = np.abs(z[0])
    least, most = model.reach
    gamma = 2.0 * np.arctan2(np.sqrt((W - least) * (W + least)), np.sqrt((most - W) * (most + W)))
    lift = np.arctan2(d4 * np.sin(gamma), a2 - d4 * np.cos(gamma))
    side = 1.0 if elbow == 'up' else -1.0
    A = np.angle(z[0]) + side * lift
    theta_3 = gamma - pi / 2 if elbow == 'up' else 1.5 * pi - gamma
    A = np.unwrap(A)
    B = A + theta_3 - pi / 2
    a, b = a2 * np.exp(1j * A), d4 * np.exp(1j * B)

    A1, B1 = _solved(a, b, -1j * z[1])
    A2, B2 = _solved(a, b, -1j * (z[2] + A1 ** 2 * a + B1 ** 2 * b))
    A3, B3 = _solved(a, b, -1j * (z[3] + 3.0 * (A1 * A2 * a + B1 * B2 * b)
                                  + 1j * (A1 ** 3 * a + B1 ** 3 * b)))
    return [A, A1, A2, A3], [B, B1, B2, B3]


def _solved(a: Complex, b: Complex, w: Complex) -> tuple[Array, Array]:
    """Return real x and y with x a + y b = w."""
    area = (a * b.conj()).imag
    return (w * b.conj()).imag / area, -(w * a.conj()).imag / area
