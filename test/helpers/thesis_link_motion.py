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
Position, velocity and acceleration of every link's frame and centre of mass (5.13-5.28).

The package evaluates kinematics and dynamics from the arm's tables.
"""

from __future__ import annotations

from typing import NamedTuple

from helpers.thesis_arm import ThesisArm
import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array, joint_states


class PointMotion(NamedTuple):
    """Motion of one point of each link in the base frame; axis -2 is the link."""

    position: Array      # [m], shape (..., 3, 3)
    velocity: Array      # [m/s]
    acceleration: Array  # [m/s^2]


class LinkMotion(NamedTuple):
    """Motion of the three links; axis -2 of each array is the link."""

    rotation: Array              # frame i in the base frame, shape (..., 3, 3, 3)
    angular_velocity: Array      # in frame i [rad/s], shape (..., 3, 3)
    angular_acceleration: Array  # in frame i [rad/s^2], shape (..., 3, 3)
    frame: PointMotion           # origins of frames 1, 2, 3: shoulder, elbow, tip
    centre_of_mass: PointMotion


def link_motion(model: ThesisArm, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike) -> LinkMotion:
    """
    Return rotations, velocities and accelerations of all links: the outward recursion.

    Frames are those of section 5.2 with their origins at the links' far ends, frame 3's at the
    tip. Angular quantities are expressed in the link's own frame as the thesis does, points in
    the base frame. Corrected: 5.14's first row, and l3 for d4 where 5.28 means a centre of mass.

    Parameters
    ----------
    model : ThesisArm
        The arm.
    q, qd, qdd : array_like, shape (..., 3)
        Joint positions [rad], velocities [rad/s] and accelerations [rad/s^2].

    Returns
    -------
    LinkMotion
        Rotations, angular motion, and motion of frame origins and centres of mass.

    Raises
    ------
    InvalidInputError
        If a shape is wrong, or a value not finite.

    """
    q, qd, qdd = np.broadcast_arrays(*joint_states(q=q, qd=qd, qdd=qdd))
    R = _rotations(q)
    w, wd = _angular_motion(q, qd, qdd)
    base = np.zeros(q.shape)
    shoulder = base + (0.0, 0.0, model.d1)
    elbow = _relative_motion(R[..., 1, :, :], w[..., 1, :], wd[..., 1, :], (model.a2, 0.0, 0.0))
    forearm = _relative_motion(R[..., 2, :, :], w[..., 2, :], wd[..., 2, :], (0.0, 0.0, model.d4))
    upper_com = _relative_motion(
        R[..., 1, :, :], w[..., 1, :], wd[..., 1, :], (model.l2, 0.0, 0.0))
    fore_com = _relative_motion(R[..., 2, :, :], w[..., 2, :], wd[..., 2, :], (0.0, 0.0, model.l3))
    at_shoulder = (shoulder, base, base)
    at_elbow = _added(at_shoulder, elbow)
    return LinkMotion(
        R, w, wd,
        _stacked(at_shoulder, at_elbow, _added(at_elbow, forearm)),
        _stacked(at_shoulder, _added(at_shoulder, upper_com), _added(at_elbow, fore_com)))


def matrix(*rows: tuple[Array, Array, Array]) -> Array:
    """Return 3 x 3 matrices, shape (..., 3, 3), from the elements of each row."""
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def _rotations(q: Array) -> Array:
    """Return the rotations of frames 1 to 3 in the base frame (products of 5.2)."""
    c1, s1 = np.cos(q[..., 0]), np.sin(q[..., 0])
    c2, s2 = np.cos(q[..., 1]), np.sin(q[..., 1])
    c23, s23 = np.cos(q[..., 1] + q[..., 2]), np.sin(q[..., 1] + q[..., 2])
    zero, one = np.zeros_like(c1), np.ones_like(c1)
    return np.stack([
        matrix((c1, zero, s1), (s1, zero, -c1), (zero, one, zero)),
        matrix((c1 * c2, -c1 * s2, s1), (s1 * c2, -s1 * s2, -c1), (s2, c2, zero)),
        matrix((c1 * c23, s1, c1 * s23), (s1 * c23, -c1, s1 * s23), (s23, zero, -c23)),
    ], axis=-3)


def _angular_motion(q: Array, qd: Array, qdd: Array) -> tuple[Array, Array]:
    """Return angular velocities (5.13-5.15) and accelerations (5.19-5.23), each in frame i."""
    qd1, qd2, qd23 = qd[..., 0], qd[..., 1], qd[..., 1] + qd[..., 2]
    qdd1, qdd2, qdd23 = qdd[..., 0], qdd[..., 1], qdd[..., 1] + qdd[..., 2]
    c2, s2 = np.cos(q[..., 1]), np.sin(q[..., 1])
    c23, s23 = np.cos(q[..., 1] + q[..., 2]), np.sin(q[..., 1] + q[..., 2])
    zero = np.zeros_like(qd1)
    velocity = matrix((zero, qd1, zero), (s2 * qd1, c2 * qd1, qd2), (s23 * qd1, qd23, -c23 * qd1))
    acceleration = matrix(
        (zero, qdd1, zero),
        (s2 * qdd1 + c2 * qd1 * qd2, c2 * qdd1 - s2 * qd1 * qd2, qdd2),
        (s23 * qdd1 + c23 * qd1 * qd23, qdd23, -c23 * qdd1 + s23 * qd1 * qd23))
    return velocity, acceleration


def _relative_motion(R: Array, w: Array, wd: Array,
                     offset: tuple[float, float, float]) -> tuple[Array, Array, Array]:
    """Return a point's motion relative to its link's joint (5.17, 5.25-5.28), base frame."""
    lever = np.broadcast_to(np.array(offset), w.shape)
    velocity = np.cross(w, lever)
    acceleration = np.cross(wd, lever) + np.cross(w, velocity)
    to_base = [np.einsum('...ij,...j->...i', R, v) for v in (lever, velocity, acceleration)]
    return to_base[0], to_base[1], to_base[2]


def _added(a: tuple[Array, Array, Array],
           b: tuple[Array, Array, Array]) -> tuple[Array, Array, Array]:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def _stacked(*points: tuple[Array, Array, Array]) -> PointMotion:
    position, velocity, acceleration = (np.stack(v, axis=-2) for v in zip(*points))
    return PointMotion(position, velocity, acceleration)
