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

"""The log barrier of a chain of segments: value, gradient and a positive definite Hessian."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.cycloid_transitions import CYCLOID
from rrr_traj_planner.core.pieces import TransitionFunction
from rrr_traj_planner.planners.segment import Reach, reach, TransitionLaw

# The Hessian comes from differences of exact gradients, over this part of each variable's scale.
DIFFERENCE = 1e-6
LEAST_EIGENVALUE = 1e-12  # of a block scaled to a unit diagonal

# What is added to v0, v1 and T in the four evaluations; velocities stay below their limit.
TOWARDS = np.array([[0.0, -1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [0.0, 0.0, 0.0, 1.0]])[
    ..., np.newaxis, np.newaxis, np.newaxis]

FORTH_AND_BACK = np.array([1.0, -1.0])[:, np.newaxis, np.newaxis]


@dataclass(frozen=True, eq=False)
class Chain:
    """
    Via points of all joints, and what bounds the motion through them.

    Parameters
    ----------
    displacements : ndarray, shape (n, 3)
        From point to point [rad].
    law : TransitionLaw
        Transitions' least durations.
    max_velocity : ndarray, shape (3,)
        [rad/s], finite.
    lowest, highest : ndarray, shape (n - 1, 3)
        Bounds of the velocities at the via points [rad/s], around 0.
    function : TransitionFunction
        What transitions are made of.

    """

    displacements: Array
    law: TransitionLaw
    max_velocity: Array
    lowest: Array
    highest: Array
    function: TransitionFunction = CYCLOID

    def rest_to_rest_times(self) -> Array:
        """Return the least durations with a stop at every via point, shape (n,) [s]."""
        D = np.abs(self.displacements)
        slope, root = self.law.slope, self.law.root
        with np.errstate(divide='ignore', invalid='ignore'):
            by_jerk = np.where(root > 0.0, (D / root) ** (2.0 / 3.0), np.inf)
            # cruise u without a velocity limit: D = u t(u)
            u = np.minimum(np.minimum(np.sqrt(D / slope), by_jerk), self.max_velocity)
            total = np.where(D > 0.0, self.law.least_time(u) + D / u, 0.0)
        return np.asarray(total.max(axis=1))

    def reaches(self, v0: Array, v1: Array, T: Array) -> Reach:
        """
        Return the largest displacements forth and back, stacked on a first axis.

        Parameters
        ----------
        v0, v1 : ndarray, shape (n, 3)
            Velocities at the segments' ends [rad/s].
        T : ndarray, shape (n, 1)
            Durations [s].

        Returns
        -------
        Reach
            Fields of shape (2, n, 3); those of the way back are of the opposite velocities.

        """
        return reach(self.law, self.max_velocity, FORTH_AND_BACK * v0, FORTH_AND_BACK * v1, T)


class Derivatives(NamedTuple):
    """Gradient and Hessian of the barrier by via velocity v and segment duration T."""

    g_v: Array     # shape (n - 1, 3)
    g_T: Array     # (n,)
    v_v: Array     # (n - 1, 3), diagonal
    v_next: Array  # (n - 2, 3), between neighbouring via points
    v0_T: Array    # (n, 3), between a segment's duration and the velocity at its start
    v1_T: Array    # (n, 3), at its end
    T_T: Array     # (n,), diagonal


def value(chain: Chain, floor: Array | None, v: Array, T: Array) -> float:
    """
    Return -sum log(slack) over every constraint.

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
    float
        Infinite where a constraint is not strictly kept.

    """
    if not (T > 0.0).all():
        return np.inf
    v0, v1 = _ends(v)
    slacks = [_displacement_slacks(chain, chain.reaches(v0, v1, T[:, np.newaxis]).distance),
              _change_slacks(chain, v0, v1, T), v - chain.lowest, chain.highest - v]
    if floor is not None:
        slacks.append(T - floor)
    if min(float(s.min(initial=np.inf)) for s in slacks) <= 0.0:
        return np.inf
    return -sum(float(np.log(s).sum()) for s in slacks)


def derivatives(chain: Chain, floor: Array | None, v: Array, T: Array) -> Derivatives:
    """
    Return the barrier's gradient, and its Hessian with the curvature of each segment made convex.

    Parameters
    ----------
    chain, floor, v, T
        As in `value`, strictly feasible.

    Returns
    -------
    Derivatives
        The Hessian is positive definite.

    """
    slack, gradient, hessian = _segment_constraints(chain, v, T)
    relative = gradient / slack[..., np.newaxis]
    slope = -relative.sum(axis=0)
    blocks = np.einsum('cnji,cnjk->njik', relative, relative) - (
        hessian / slack[:2, ..., np.newaxis, np.newaxis]).sum(axis=0)
    blocks = _made_convex(blocks)
    low, high = 1.0 / (v - chain.lowest), 1.0 / (chain.highest - v)
    g_T, T_T = slope[..., 2].sum(axis=1), blocks[..., 2, 2].sum(axis=1)
    if floor is not None:
        g_T -= 1.0 / (T - floor)
        T_T += 1.0 / (T - floor) ** 2
    return Derivatives(
        g_v=slope[:-1, :, 1] + slope[1:, :, 0] - low + high, g_T=g_T,
        v_v=blocks[:-1, :, 1, 1] + blocks[1:, :, 0, 0] + low ** 2 + high ** 2,
        v_next=blocks[1:-1, :, 0, 1], v0_T=blocks[..., 0, 2], v1_T=blocks[..., 1, 2], T_T=T_T)


def _segment_constraints(chain: Chain, v: Array, T: Array) -> tuple[Array, Array, Array]:
    """
    Return slacks (4, n, 3), their gradients (4, n, 3, 3) by (v0, v1, T), and Hessians.

    The first two, forth and back, are the displacement's; the last two, which are linear but
    for T, the change of velocity's. Hessians, (2, n, 3, 3, 3), are the first two's.
    """
    v0, v1 = _ends(v)
    t = T[:, np.newaxis]
    step_v, step_T = DIFFERENCE * chain.max_velocity, DIFFERENCE * t
    sides = reach(chain.law, chain.max_velocity, FORTH_AND_BACK * v0 + TOWARDS[0] * step_v,
                  FORTH_AND_BACK * v1 + TOWARDS[1] * step_v, t + TOWARDS[2] * step_T)
    signed = np.stack((FORTH_AND_BACK * sides.d_v0, FORTH_AND_BACK * sides.d_v1, sides.d_T), -1)
    steps = np.stack(np.broadcast_arrays(
        -FORTH_AND_BACK * step_v, -FORTH_AND_BACK * step_v, step_T + 0.0 * FORTH_AND_BACK))
    hessian = np.moveaxis((signed[1:] - signed[0]) / steps[..., np.newaxis], 0, -1)
    change = chain.law.largest_change(t)
    rate = (chain.law.largest_change(t + step_T) - change) / step_T
    one = np.ones_like(v0)
    rate = rate * one
    slack = np.concatenate((_displacement_slacks(chain, sides.distance[0]),
                            _change_slacks(chain, v0, v1, T)))
    gradient = np.concatenate((signed[0], [np.stack((one, -one, rate), -1)],
                               [np.stack((-one, one, rate), -1)]))
    return slack, gradient, 0.5 * (hessian + np.swapaxes(hessian, -1, -2))


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
