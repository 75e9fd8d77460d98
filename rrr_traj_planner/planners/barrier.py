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
The log barrier of a chain of segments: value, gradient and a positive definite Hessian.

It is a sum of parts, one for each joint of a segment, each via velocity and each duration.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.planners import segment
from rrr_traj_planner.planners.chain import Chain

LEAST_EIGENVALUE = 1e-12  # of a block scaled to a unit diagonal
TOLERATED = 0.75          # a part may rise by so much of its curvature, half of which is foretold

FORTH_AND_BACK = np.array([1.0, -1.0])[:, np.newaxis, np.newaxis]

# Signs of derivatives by v0, v1 and T.
SIGNS = np.array([[1.0, 1.0, 1.0], [-1.0, -1.0, 1.0]])[:, np.newaxis, np.newaxis]


class Parts(NamedTuple):
    """Something for each part of the barrier."""

    segments: Array    # of a segment's joint, shape (n, 3)
    velocities: Array  # of a via velocity's bounds, (n - 1, 3)
    durations: Array   # of a duration's floor, (n,)


class Local(NamedTuple):
    """First and second derivatives of each part."""

    slope: Array       # of a segment's joint by v0, v1 and T, shape (n, 3, 3)
    block: Array       # (n, 3, 3, 3), positive definite
    velocities: Array  # (2, n - 1, 3)
    durations: Array   # (2, n)


class Derivatives(NamedTuple):
    """Gradient and Hessian of the barrier by via velocity v and segment duration T."""

    g_v: Array     # shape (n - 1, 3)
    g_T: Array     # (n,)
    v_v: Array     # (n - 1, 3), diagonal
    v_next: Array  # (n - 2, 3), between neighbouring via points
    v0_T: Array    # (n, 3), between a segment's duration and the velocity at its start
    v1_T: Array    # (n, 3), at its end
    T_T: Array     # (n,), diagonal


def values(chain: Chain, floor: Array | None, v: Array, T: Array) -> Parts:
    """
    Return -sum log(slack) over the constraints of each part.

    Parameters
    ----------
    chain : Chain
        The via points.
    floor : ndarray, shape (n,), optional
        Least durations [s].
    v : ndarray, shape (n - 1, 3)
        Via velocities [rad/s].
    T : ndarray, shape (n,)
        Durations [s].

    Returns
    -------
    Parts
        Infinite where a constraint is not strictly kept.

    """
    v0, v1 = _ends(v)
    lasting = T > 0.0
    some = np.where(lasting, T, 1.0)
    reach = segment.reach(chain.law, chain.max_velocity, FORTH_AND_BACK * v0,
                          FORTH_AND_BACK * v1, some[:, np.newaxis])
    segments = _barrier(_displacement_slacks(chain, reach)) + _barrier(
        _change_slacks(chain, v0, v1, some))
    return Parts(np.where(lasting[:, np.newaxis], segments, np.inf),
                 _barrier(np.stack((v - chain.lowest, chain.highest - v))),
                 np.zeros(len(T)) if floor is None else _barrier((T - floor)[np.newaxis]))


def local(chain: Chain, floor: Array | None, v: Array, T: Array) -> Local:
    """
    Return the derivatives of each part, with the curvature of each segment made convex.

    Parameters
    ----------
    chain, floor, v, T
        As in `values`, strictly feasible.

    Returns
    -------
    Local
        The derivatives.

    """
    slack, gradient, hessian = _segment_constraints(chain, v, T)
    relative = gradient / slack[..., np.newaxis]
    block = np.einsum('cnji,cnjk->njik', relative, relative) - (
        hessian / slack[:2, ..., np.newaxis, np.newaxis]).sum(axis=0)
    low, high = 1.0 / (v - chain.lowest), 1.0 / (chain.highest - v)
    spare = np.zeros(len(T)) if floor is None else 1.0 / (T - floor)
    return Local(-relative.sum(axis=0), _made_convex(block),
                 np.stack((high - low, low ** 2 + high ** 2)), np.stack((-spare, spare ** 2)))


def damped(at: Local, damping: Parts) -> Local:
    """
    Return parts whose curvature is raised.

    Parameters
    ----------
    at : Local
        The parts.
    damping : Parts
        By how much of it the curvature of each is raised.

    Returns
    -------
    Local
        The parts.

    """
    (g_v, v_v), (g_T, T_T) = at.velocities, at.durations
    return Local(at.slope, at.block * (1.0 + damping.segments)[..., np.newaxis, np.newaxis],
                 np.stack((g_v, v_v * (1.0 + damping.velocities))),
                 np.stack((g_T, T_T * (1.0 + damping.durations))))


def derivatives(at: Local) -> Derivatives:
    """
    Return the barrier's derivatives.

    Parameters
    ----------
    at : Local
        Those of its parts.

    Returns
    -------
    Derivatives
        The Hessian is positive definite.

    """
    slope, block = at.slope, at.block
    (g_v, v_v), (g_T, T_T) = at.velocities, at.durations
    return Derivatives(
        g_v=slope[:-1, :, 1] + slope[1:, :, 0] + g_v, g_T=slope[..., 2].sum(axis=1) + g_T,
        v_v=block[:-1, :, 1, 1] + block[1:, :, 0, 0] + v_v,
        v_next=block[1:-1, :, 0, 1], v0_T=block[..., 0, 2], v1_T=block[..., 1, 2],
        T_T=block[..., 2, 2].sum(axis=1) + T_T)


def misjudged(at: Local, dv: Array, dT: Array, change: Parts) -> list[BoolArray]:
    """
    Return which parts rise more along a step than their derivatives foretell.

    Parameters
    ----------
    at : Local
        The derivatives where it begins.
    dv : ndarray, shape (n - 1, 3)
        Changes of via velocities [rad/s].
    dT : ndarray, shape (n,)
        Changes of durations [s].
    change : Parts
        How the parts change along it.

    Returns
    -------
    list of ndarray of bool
        As the fields of `Parts`; all of them where there is none.

    """
    d0, d1 = _ends(dv)
    step = np.stack((d0, d1, np.broadcast_to(dT[:, np.newaxis], d0.shape)), axis=-1)
    bend = np.einsum('nji,njik,njk->nj', step, at.block, step)
    first = Parts((at.slope * step).sum(axis=-1), at.velocities[0] * dv, at.durations[0] * dT)
    second = Parts(bend, at.velocities[1] * dv ** 2, at.durations[1] * dT ** 2)
    found = [~(c - f <= TOLERATED * s) for c, f, s in zip(change, first, second)]
    return found if any(f.any() for f in found) else [np.ones_like(f) for f in found]


def _barrier(slacks: Array) -> Array:
    """Return -sum log over the first axis, infinite where one is not positive."""
    kept = (slacks > 0.0).all(axis=0)
    return np.where(kept, -np.log(np.where(slacks > 0.0, slacks, 1.0)).sum(axis=0), np.inf)


def _segment_constraints(chain: Chain, v: Array, T: Array) -> tuple[Array, Array, Array]:
    """
    Return slacks (4, n, 3), their gradients (4, n, 3, 3) by (v0, v1, T), and Hessians.

    The first two, forth and back, are the displacement's; the last two, which are linear but
    for T, the change of velocity's. Hessians, (2, n, 3, 3, 3), are the first two's.
    """
    v0, v1 = _ends(v)
    t = T[:, np.newaxis]
    law = chain.law
    found = segment.derivatives(law, chain.max_velocity, FORTH_AND_BACK * v0,
                                FORTH_AND_BACK * v1, t)
    one = np.ones_like(v0)
    rate = law.change_rate(t) * one
    slack = np.concatenate((_displacement_slacks(chain, found.distance),
                            _change_slacks(chain, v0, v1, T)))
    gradient = np.concatenate((SIGNS * found.gradient, [np.stack((one, -one, rate), -1)],
                               [np.stack((-one, one, rate), -1)]))
    return slack, gradient, SIGNS[..., np.newaxis] * SIGNS[..., np.newaxis, :] * found.hessian


def _ends(v: Array) -> tuple[Array, Array]:
    """Return the velocities at the start and at the end of every segment."""
    rest = np.zeros((1, 3))
    return np.concatenate((rest, v)), np.concatenate((v, rest))


def _displacement_slacks(chain: Chain, distance: Array) -> Array:
    return distance - FORTH_AND_BACK * chain.displacements


def _change_slacks(chain: Chain, v0: Array, v1: Array, T: Array) -> Array:
    return chain.law.largest_change(T[:, np.newaxis]) - FORTH_AND_BACK * (v1 - v0)


def _made_convex(blocks: Array) -> Array:
    """Return symmetric blocks with the magnitudes of their eigenvalues."""
    scale = 1.0 / np.sqrt(np.abs(np.einsum('...ii->...i', blocks)) + 1e-300)
    scale = scale[..., np.newaxis] * scale[..., np.newaxis, :]
    values, vectors = np.linalg.eigh(blocks * scale)
    values = np.maximum(np.abs(values), LEAST_EIGENVALUE)
    return np.asarray(np.einsum('...ij,...j,...kj->...ik', vectors, values, vectors) / scale)
