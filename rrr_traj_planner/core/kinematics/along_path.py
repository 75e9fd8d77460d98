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
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.postures import Elbow, Posture


class JointPath(NamedTuple):
    """Joint positions and their first three derivatives by arc length, shape (n, 3) each."""

    q: Array     # [rad]
    dq: Array    # [rad/m]
    ddq: Array   # [rad/m^2]
    dddq: Array  # [rad/m^3]


class PathPoints(NamedTuple):
    """
    Positions of the tip and their first three derivatives by arc length, shape (n, 3).

    Where a piece of the path lies in a vertical plane through joint axis 1, the plane's azimuth is
    given too: joint 1 stands still on it, whether or not it meets the axis.
    """

    p: Array     # [m]
    dp: Array    # [1]
    ddp: Array   # [1/m]
    dddp: Array  # [1/m^2]
    plane: Array | None = None  # [rad], shape (n,); NaN elsewhere


def unlimited_joint_path(model: RobotModel, points: PathPoints, posture: Posture) -> JointPath:
    """
    Return joint positions along a path wherever joint 1 begins, in no range.

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
    Return joint positions along a path, of each as many whole turns as it happens.

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
    turn, radial = _about_axis(points)
    if points.plane is not None:
        _stand_still(points, points.plane, turn, radial)
    if posture.shoulder == 'back':
        turn[0], radial = turn[0] + pi, [-x for x in radial]
    z = np.array(radial), np.stack([x[:, 2] for x in points[:4]])
    z[1][0] -= model.d1
    upper, fore = _in_plane(model, np.stack(z, axis=1), posture.elbow)
    # The forearm's direction in the plane is theta_2 + theta_3 - 90 deg.
    third = [f - u for f, u in zip(fore, upper)]
    third[0] = third[0] + pi / 2
    return JointPath(*(np.stack(joints, axis=-1) for joints in zip(turn, upper, third)))


def _about_axis(points: PathPoints) -> tuple[list[Array], list[Array]]:
    """Return theta_1 and the distance from joint axis 1, each with three derivatives."""
    theta = np.arctan2(points.p[:, 1], points.p[:, 0])
    r = np.hypot(points.p[:, 0], points.p[:, 1])
    if points.plane is not None:  # which is used instead, on the axis itself too
        r = np.where(np.isfinite(points.plane), 1.0, r)
    c, s = points.p[:, 0] / r, points.p[:, 1] / r
    # Each derivative in the axes that turn with joint 1: outward and around.
    (u1, t1), (u2, t2), (u3, t3) = (
        (c * d[:, 0] + s * d[:, 1], c * d[:, 1] - s * d[:, 0]) for d in points[1:4])
    w = t1 / r
    r1 = u1
    w1 = (t2 - 2.0 * r1 * w) / r
    r2 = u2 + r * w ** 2
    w2 = (t3 + w * (r * w ** 2 - 3.0 * r2) - 3.0 * r1 * w1) / r
    r3 = u3 + 3.0 * r1 * w ** 2 + 3.0 * r * w * w1
    return [theta, w, w1, w2], [r, r1, r2, r3]


def _stand_still(points: PathPoints, plane: Array, turn: list[Array],
                 radial: list[Array]) -> None:
    """Enter theta_1 and the signed distance from joint axis 1 where joint 1 stands still."""
    at = np.flatnonzero(np.isfinite(plane))
    theta = plane[at]
    turn[0][at] = theta
    for rate in turn[1:]:
        rate[at] = 0.0
    for r, x in zip(radial, points[:4]):
        assert x is not None
        r[at] = np.cos(theta) * x[at, 0] + np.sin(theta) * x[at, 1]


def _in_plane(model: RobotModel, z: Array, elbow: Elbow) -> tuple[list[Array], list[Array]]:
    """
    Return the directions of both links in the arm's plane, each with three derivatives.

    With z outward and up, shape (4, 2, n): z = a + b, links a2 long at A and d4 long at B; its
    derivatives are solved for those of A and B in turn.
    """
    a2, d4 = model.a2, model.d4
    W = np.hypot(*z[0])
    least, most = model.reach
    gamma = 2.0 * np.arctan2(np.sqrt((W - least) * (W + least)), np.sqrt((most - W) * (most + W)))
    lift = np.arctan2(d4 * np.sin(gamma), a2 - d4 * np.cos(gamma))
    A = np.arctan2(z[0, 1], z[0, 0]) + (lift if elbow == 'up' else -lift)
    theta_3 = gamma - pi / 2 if elbow == 'up' else 1.5 * pi - gamma
    B = A + theta_3 - pi / 2
    a, b = (length * np.array([np.cos(x), np.sin(x)]) for length, x in ((a2, A), (d4, B)))
    area = a[1] * b[0] - a[0] * b[1]

    def rates(w: Array) -> tuple[Array, Array]:
        """Return x and y of x a + y b, turned by 90 deg, = w."""
        return -(w * b).sum(axis=0) / area, (w * a).sum(axis=0) / area

    A1, B1 = rates(z[1])
    A2, B2 = rates(z[2] + A1 ** 2 * a + B1 ** 2 * b)
    bent = A1 * A1 ** 2 * a + B1 * B1 ** 2 * b
    A3, B3 = rates(z[3] + 3.0 * (A1 * A2 * a + B1 * B2 * b) + np.array([-bent[1], bent[0]]))
    return [A, A1, A2, A3], [B, B1, B2, B3]
