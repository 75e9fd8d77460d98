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
An arm as three tables of trigonometric coefficients: tip, inertia matrix, potential energy.

Of any chain of three revolute joints the tip's position and the potential energy are of degree 1
in each joint's cosine and sine; the inertia matrix does not depend on joint 1 and is of degree 2
in joints 2 and 3. So samples at three and at five equally spaced angles determine them exactly (a
discrete Fourier transform), and all derivatives follow from the coefficients.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.chain import Chain
from rrr_traj_planner.core.arrays import Array

# Elements of the inertia matrix M, in the order of the table.
ELEMENTS = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))

# Part of a table's scale up to which a coefficient is rounding: of the transform, sums of up to 27
# samples, each from some ten products of rotations.
ROUNDING = 1e-14


class ArmTables(NamedTuple):
    """Coefficients by functions of each joint: 1, cos q, sin q, and of M also cos 2 q, sin 2 q."""

    tip: Array        # [m], shape (3, 3, 3, 3): coordinate; functions of q1, q2, q3
    inertia: Array    # [kg m^2], (6, 5, 5): element; functions of q2, q3
    potential: Array  # [J], (3, 3, 3): functions of q1, q2, q3; the constant is left out


def tables_of(chain: Chain, gravity: Array, rotor_inertia: Array) -> ArmTables:
    """
    Return the tables of an arm.

    Parameters
    ----------
    chain : Chain
        Its joints and links.
    gravity : ndarray, shape (3,)
        Acceleration of gravity in the base frame [m/s^2].
    rotor_inertia : ndarray, shape (3,)
        Of the motors, reflected to the joints [kg m^2].

    Returns
    -------
    ArmTables
        Exact up to rounding.

    """
    three, five = (np.arange(n) * (2.0 * np.pi / n) for n in (3, 5))
    tip, _, potential = _sampled(chain, gravity, np.stack(
        np.meshgrid(three, three, three, indexing='ij'), axis=-1))
    _, inertia, _ = _sampled(chain, gravity, np.stack(
        np.meshgrid(0.0, five, five, indexing='ij'), axis=-1)[0])
    inertia += np.diag(rotor_inertia)
    elements = np.stack([inertia[..., i, j] for i, j in ELEMENTS])
    of_three, of_five = _from_samples(3), _from_samples(5)
    of_tip = np.einsum('ai,bj,ck,ijkx->xabc', of_three, of_three, of_three, tip)
    of_inertia = np.einsum('bj,ck,xjk->xbc', of_five, of_five, elements)
    of_potential = np.einsum('ai,bj,ck,ijk->abc', of_three, of_three, of_three, potential)
    of_potential[0, 0, 0] = 0.0
    root = np.sqrt([np.abs(of_inertia[k]).max() for k in (0, 3, 5)])  # M_ij^2 < M_ii M_jj
    scale = np.array([root[i] * root[j] for i, j in ELEMENTS])
    return ArmTables(_cleared(of_tip, np.abs(of_tip).max()),
                     _cleared(of_inertia, scale[:, np.newaxis, np.newaxis]),
                     _cleared(of_potential, np.abs(of_potential).max()))


def _cleared(table: Array, scale: Array | float) -> Array:
    """Return a table without coefficients that are rounding."""
    return np.where(np.abs(table) > ROUNDING * scale, table, 0.0)


def _from_samples(n: int) -> Array:
    """Return the matrix from samples at n equally spaced angles to coefficients."""
    angles = np.arange(n) * (2.0 * np.pi / n)
    functions = [np.ones(n)]
    for k in range(1, n // 2 + 1):
        functions += [np.cos(k * angles), np.sin(k * angles)]
    return np.linalg.inv(np.stack(functions, axis=1))


def _sampled(chain: Chain, gravity: Array, q: Array) -> tuple[Array, Array, Array]:
    """Return the tip, M (Lynch & Park, Modern Robotics, 8.1) and the potential energy at q."""
    poses = chain.link_poses(q)
    axes, points = chain.axes_at(poses)
    M, potential = np.zeros((*q.shape[:-1], 3, 3)), np.zeros(q.shape[:-1])
    for i, (R, t) in enumerate(poses):
        centre = R @ chain.centre[i] + t
        moves = np.arange(3) <= i
        linear = np.cross(axes, centre[..., np.newaxis, :] - points) * moves[:, np.newaxis]
        angular = axes * moves[:, np.newaxis]
        inertia = R @ chain.inertia[i] @ np.swapaxes(R, -1, -2)
        M += (chain.mass[i] * linear @ np.swapaxes(linear, -1, -2)
              + angular @ inertia @ np.swapaxes(angular, -1, -2))
        potential -= chain.mass[i] * (centre @ gravity)
    R, t = poses[2]
    return R @ chain.tip + t, M, potential
