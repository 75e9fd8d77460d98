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

"""Rotations in space: about an axis, by roll, pitch and yaw, and of z to a direction."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, sin

import numpy as np
from rrr_traj_planner.core.arrays import Array

Quaternion = tuple[float, float, float, float]  # x, y, z, w, of length 1

HALF_TURN = np.diag((1.0, -1.0, -1.0))  # about x

# z of a direction below which it is reached from -z. Between, both ways are accurate. Chosen.
BACKWARDS = -0.5


def rotation(axis: Array, angle: Array | float) -> Array:
    """
    Return the rotations about an axis (Rodrigues's formula).

    Parameters
    ----------
    axis : ndarray, shape (3,)
        Of length 1.
    angle : float or ndarray, shape (...)
        Of the rotations [rad].

    Returns
    -------
    ndarray, shape (..., 3, 3)
        A matrix for each angle.

    """
    x, y, z = axis
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    angle = np.asarray(angle)[..., np.newaxis, np.newaxis]
    return np.asarray(np.eye(3) + np.sin(angle) * K + (1.0 - np.cos(angle)) * (K @ K))


def rotated(vector: Sequence[float], axis: Sequence[float], angle: float
            ) -> tuple[float, float, float]:
    """
    Return a vector rotated about an axis (Rodrigues's formula), in floats: six times faster.

    Parameters
    ----------
    vector : sequence of 3 floats
        The vector.
    axis : sequence of 3 floats
        Of length 1.
    angle : float
        Of the rotation [rad].

    Returns
    -------
    tuple of 3 floats
        The same as `rotation(axis, angle) @ vector`.

    """
    (x, y, z), (a, b, d), c, s = vector, axis, cos(angle), sin(angle)
    along = (a * x + b * y + d * z) * (1.0 - c)
    return (c * x + s * (b * z - d * y) + along * a, c * y + s * (d * x - a * z) + along * b,
            c * z + s * (a * y - b * x) + along * d)


def quaternion(R: Array) -> Quaternion:
    """
    Return the quaternion of a rotation, by Shepperd's method.

    Parameters
    ----------
    R : ndarray, shape (3, 3)
        The rotation.

    Returns
    -------
    tuple of 4 floats
        x, y, z, w; of the two the one whose largest component is positive.

    """
    trace = float(np.trace(R))
    # Four times the products of each pair of components; the column of the largest square.
    products = np.array((
        (1.0 + 2.0 * R[0, 0] - trace, R[1, 0] + R[0, 1], R[0, 2] + R[2, 0], R[2, 1] - R[1, 2]),
        (R[1, 0] + R[0, 1], 1.0 + 2.0 * R[1, 1] - trace, R[2, 1] + R[1, 2], R[0, 2] - R[2, 0]),
        (R[0, 2] + R[2, 0], R[2, 1] + R[1, 2], 1.0 + 2.0 * R[2, 2] - trace, R[1, 0] - R[0, 1]),
        (R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1], 1.0 + trace)))
    column = products[:, int(np.argmax(np.diag(products)))]
    x, y, z, w = (column / np.linalg.norm(column)).tolist()
    return x, y, z, w


def quaternion_product(a: Quaternion, b: Quaternion) -> Quaternion:
    """
    Return the rotation b followed by a.

    Parameters
    ----------
    a, b : tuple of 4 floats
        x, y, z, w.

    Returns
    -------
    tuple of 4 floats
        x, y, z, w.

    """
    (x, y, z, w), (u, v, r, s) = a, b
    return (w * u + x * s + y * r - z * v, w * v - x * r + y * s + z * u,
            w * r + x * v - y * u + z * s, w * s - x * u - y * v - z * r)


def rotation_z_to(direction: Array) -> Array:
    """
    Return the rotation that takes z to a direction the shortest way.

    Parameters
    ----------
    direction : ndarray, shape (3,)
        Of length 1.

    Returns
    -------
    ndarray, shape (3, 3)
        For directions near to -z, half a turn about x and the shortest way from there.

    """
    if direction[2] < BACKWARDS:
        return np.asarray(HALF_TURN @ rotation_z_to(HALF_TURN @ direction))
    x, y, z = direction
    K = np.array([[0.0, 0.0, x], [0.0, 0.0, y], [-x, -y, 0.0]])  # of the cross product with z
    return np.asarray(np.eye(3) + K + K @ K / (1.0 + z))


def from_roll_pitch_yaw(angles: Sequence[float]) -> Array:
    """
    Return the rotation Rz(yaw) Ry(pitch) Rx(roll), as URDF has it.

    Parameters
    ----------
    angles : sequence of 3 floats
        Roll, pitch, yaw [rad].

    Returns
    -------
    ndarray, shape (3, 3)
        The rotation.

    """
    (sr, sp, sy), (cr, cp, cy) = np.sin(angles), np.cos(angles)
    return np.array(((cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
                     (sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
                     (-sp, cp * sr, cp * cr)))


def roll_pitch_yaw(R: Array) -> tuple[float, float, float]:
    """
    Return the angles of a rotation Rz(yaw) Ry(pitch) Rx(roll), as URDF has them.

    Parameters
    ----------
    R : ndarray, shape (3, 3)
        The rotation.

    Returns
    -------
    tuple of three floats
        Roll, pitch, yaw [rad]. Accurate at pitches of a right angle too, where any yaw will do:
        roll is that of Rz(-yaw) R.

    """
    yaw = atan2(R[1, 0], R[0, 0])
    c, s = cos(yaw), sin(yaw)
    return (atan2(s * R[0, 2] - c * R[1, 2], c * R[1, 1] - s * R[0, 1]),
            atan2(-R[2, 0], c * R[0, 0] + s * R[1, 0]), yaw)
