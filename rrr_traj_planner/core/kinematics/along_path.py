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

Thesis (5.8)-(5.12), differentiated three times.

The derivatives of the tip's position are expressed in the arm's vertical plane, and the constraint
of the two links in that plane is differentiated three times. Only angles need the arc tangent.
"""

from __future__ import annotations

from math import pi
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.postures import Elbow, elbow_angles, Posture


class JointPath(NamedTuple):
    """Joint positions and their first three derivatives by arc length, shape (n, 3) each."""

    q: Array     # [rad]
    dq: Array    # [rad/m]
    ddq: Array   # [rad/m^2]
    dddq: Array  # [rad/m^3]


class PathPoints(NamedTuple):
    """
    Positions of the tip and their first three derivatives by arc length, shape (n, 3).

    For a piece of the path in a vertical plane through joint axis 1 the plane's azimuth is given
    too: joint 1 is constant there, also where the piece meets the axis.
    """

    p: Array     # [m]
    dp: Array    # [1]
    ddp: Array   # [1/m]
    dddp: Array  # [1/m^2]
    plane: Array | None = None  # [rad], shape (n,); NaN elsewhere


def unlimited_joint_path(model: RobotModel, points: PathPoints, posture: Posture) -> JointPath:
    """
    Return continuous joint positions along a path, without regard to the joints' ranges.

    Parameters
    ----------
    model : RobotModel
        The arm.
    points : PathPoints
        In the path's order, none singular.
    posture : Posture
        The posture; where the path crosses joint axis 1, at its beginning.

    Returns
    -------
    JointPath
        Joint positions and derivatives.

    """
    found = joint_path_modulo_turns(model, points, posture)
    return found._replace(q=np.unwrap(found.q, axis=0))


def joint_path_modulo_turns(model: RobotModel, points: PathPoints, posture: Posture) -> JointPath:
    """
    Return joint positions at points of a path, each joint up to whole turns.

    Parameters
    ----------
    model : RobotModel
        The arm.
    points : PathPoints
        In any order, none singular.
    posture : Posture
        The posture; where the path crosses joint axis 1, at its beginning.

    Returns
    -------
    JointPath
        Joint positions and derivatives.

    """
    theta_1, radial = _cylindrical(points)
    if points.plane is not None:
        _fix_joint_1(points, points.plane, theta_1, radial)
    if posture.shoulder == 'back':
        theta_1[0], radial = theta_1[0] + pi, [-x for x in radial]
    z = np.array(radial), np.stack([x[:, 2] for x in points[:4]])
    z[1][0] -= model.d1
    upper, fore = _in_plane(model, np.stack(z, axis=1), posture.elbow)
    # The forearm's direction in the plane is theta_2 + theta_3 - 90 deg.
    third = [f - u for f, u in zip(fore, upper)]
    third[0] = third[0] + pi / 2
    return JointPath(*(np.stack(joints, axis=-1) for joints in zip(theta_1, upper, third)))


def _cylindrical(points: PathPoints) -> tuple[list[Array], list[Array]]:
    """Return theta_1 and the distance from joint axis 1, each with three derivatives."""
    theta = np.arctan2(points.p[:, 1], points.p[:, 0])
    r = np.hypot(points.p[:, 0], points.p[:, 1])
    if points.plane is not None:  # avoids 0 / 0 on the axis; `_fix_joint_1` sets the values
        r = np.where(np.isfinite(points.plane), 1.0, r)
    c, s = points.p[:, 0] / r, points.p[:, 1] / r
    # Radial and tangential components of each derivative.
    (u1, t1), (u2, t2), (u3, t3) = (
        (c * d[:, 0] + s * d[:, 1], c * d[:, 1] - s * d[:, 0]) for d in points[1:4])
    theta1, r1 = t1 / r, u1
    theta2 = (t2 - 2.0 * r1 * theta1) / r
    r2 = u2 + r * theta1 ** 2
    theta3 = (t3 + theta1 * (r * theta1 ** 2 - 3.0 * r2) - 3.0 * r1 * theta2) / r
    r3 = u3 + 3.0 * r1 * theta1 ** 2 + 3.0 * r * theta1 * theta2
    return [theta, theta1, theta2, theta3], [r, r1, r2, r3]


def _fix_joint_1(points: PathPoints, plane: Array, theta_1: list[Array],
                 radial: list[Array]) -> None:
    """Set theta_1 and the signed distance from joint axis 1 where joint 1 is constant."""
    at = np.flatnonzero(np.isfinite(plane))
    theta = plane[at]
    theta_1[0][at] = theta
    for derivative in theta_1[1:]:
        derivative[at] = 0.0
    for r, x in zip(radial, points[:4]):
        assert x is not None
        r[at] = np.cos(theta) * x[at, 0] + np.sin(theta) * x[at, 1]


def _in_plane(model: RobotModel, z: Array, elbow: Elbow) -> tuple[list[Array], list[Array]]:
    """
    Return the directions of both links in the arm's plane, each with three derivatives.

    With z the tip's radial and vertical position and its derivatives, shape (4, 2, n): z = a + b
    with a of length a2 at angle A, b of length d4 at angle B. Each derivative of this equation is
    linear in the highest derivatives of A and B.
    """
    a2, d4 = model.a2, model.d4
    beta, theta_3 = elbow_angles(model, np.hypot(*z[0]), elbow)
    A = np.arctan2(z[0, 1], z[0, 0]) + beta
    B = A + theta_3 - pi / 2
    a, b = (length * np.array([np.cos(x), np.sin(x)]) for length, x in ((a2, A), (d4, B)))
    area = a[1] * b[0] - a[0] * b[1]

    def solve(w: Array) -> tuple[Array, Array]:
        """Return x and y with x a + y b, rotated by 90 deg, equal to w."""
        return -(w * b).sum(axis=0) / area, (w * a).sum(axis=0) / area

    A1, B1 = solve(z[1])
    A2, B2 = solve(z[2] + A1 ** 2 * a + B1 ** 2 * b)
    cubic = A1 * A1 ** 2 * a + B1 * B1 ** 2 * b
    A3, B3 = solve(z[3] + 3.0 * (A1 * A2 * a + B1 * B2 * b) + np.array([-cubic[1], cubic[0]]))
    return [A, A1, A2, A3], [B, B1, B2, B3]
