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
One Newton step of the interior-point method on a chain of ramps.

Within a segment the inner node accelerations, bound by the two conditions that end velocity and
way are given, are eliminated; then its duration; what is left couples neighbouring via points only
and is solved as a band. The cost is linear in the number of segments.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray, IntArray
from rrr_traj_planner.planners.ramp_chain import Motion
from rrr_traj_planner.planners.ramp_curvature import Curvature
from scipy.linalg import solveh_banded

STIFF = 1e60  # holds an unknown where it is
STIFFENING = (0.0, 1e-9, 1e-6, 1e-3, 1.0)


class Freedom(NamedTuple):
    """
    Which durations are free, and which are common multiples of given ones; what stays at rest.

    Durations that are not free change by `tie` times a common unknown.
    """

    free: BoolArray  # (N,)
    tie: Array       # (N,), 0 where free or fixed
    weights: Array   # (N,), in the objective
    still: BoolArray  # (N - 1, J), joints whose velocity at a via point stays as it is

    def cost(self, T: Array) -> float:
        """
        Return what is minimised.

        Parameters
        ----------
        T : ndarray, shape (N,)
            Durations [s].

        Returns
        -------
        float
            Their weighted sum.

        """
        return float(self.weights @ T)


class Step(NamedTuple):
    """A step of all unknowns, and what it promises to gain."""

    motion: Motion
    gain: float


def newton_step(n: int, ends: tuple[Array, Array], c: Curvature,
                freedom: Freedom) -> Step:
    """
    Return the Newton step.

    Parameters
    ----------
    n : int
        Number of ramps in a segment.
    ends : tuple of ndarray
        How velocity and way at the segments' ends change: (N, 2, m) by y, (N, 2, J) by T.
    c : Curvature
        Gradient and Hessian.
    freedom : Freedom
        What may change.

    Returns
    -------
    Step
        Keeps every segment's end to first order.

    """
    S, r, back = _without_inner(n, ends, c)
    free, tie, _, still = freedom
    J, B = c.y.shape[1], S.shape[-1] - 1
    column, pivot = S[:, :B, B], S[:, B, B]
    # free durations are eliminated
    share = np.divide(1.0, pivot, out=np.zeros_like(pivot), where=free & (pivot != 0.0))
    Sb = S[:, :B, :B] - share[:, np.newaxis, np.newaxis] * (
        column[:, :, np.newaxis] * column[:, np.newaxis])
    rb = r[:, :B] - (share * r[:, B])[:, np.newaxis] * column
    at_vias, common = _coupled(Sb, rb, tie[:, np.newaxis] * column, float(tie ** 2 @ pivot),
                               float(tie @ r[:, B]), still)
    border = np.concatenate((at_vias[:-1], at_vias[1:]), axis=1)
    dT = np.where(free, -share * (r[:, B] + (column * border).sum(axis=1)), tie * common)
    inner = back(border, dT)
    own = np.swapaxes(border.reshape(-1, 4, J)[:, [0, 1, 3]], 1, 2)
    gain = -float((c.y[:, :, 2:-1] * np.swapaxes(inner, 1, 2)).sum() + c.T @ dT
                  + (c.y[:, :, [0, 1, -1]] * own).sum())
    return Step(Motion(inner, at_vias[1:-1, :J], at_vias[1:-1, J:], dT), gain)


def _without_inner(n: int, ends: tuple[Array, Array], c: Curvature) -> tuple[
        Array, Array, Callable[[Array, Array], Array]]:
    """
    Eliminate the inner accelerations.

    Returns the Hessian (N, B + 1, B + 1) and gradient (N, B + 1) left over the segment's border
    and its duration, and the function that gives the inner accelerations' step for theirs. The
    border is, in this order, v0, a0, v1 and a1 of all J coordinates; B = 4 J.
    """
    if c.yy.ndim == 4:
        return _without_inner_by_joint(n, ends, c)
    return _without_inner_jointly(n, ends, c)


# Columns of the border that are unknowns y of the segment, and which: v0, a0 and a1, not v1.
_OWN = (0, 1, 3)


def _without_inner_by_joint(n: int, ends: tuple[Array, Array], c: Curvature) -> tuple[
        Array, Array, Callable[[Array, Array], Array]]:
    """Eliminate where joints are independent; columns v0, a0, v1, a1, duration, gradient."""
    by_y, by_T = ends
    N, J, k, inner, own = len(c.T), c.y.shape[1], n - 1, slice(2, n + 1), [0, 1, n + 1]
    E = np.broadcast_to(by_y[:, np.newaxis], (N, J, 2, n + 2))
    K, R = np.zeros((N, J, k + 2, k + 2)), np.zeros((N, J, k + 2, 6))
    K[..., :k, :k], K[..., k:, :k] = c.yy[..., inner, inner], E[..., inner]
    K[..., :k, k:] = np.swapaxes(E[..., inner], -1, -2)
    R[..., :k, _OWN], R[..., k:, _OWN] = c.yy[..., inner, own], E[..., own]
    R[..., k, 2] = -1.0
    R[..., :k, 4], R[..., k:, 4] = c.yT[..., inner], np.swapaxes(by_T, 1, 2)
    R[..., :k, 5] = c.y[..., inner]
    X = np.linalg.solve(K, R)
    left = -np.swapaxes(R, -1, -2) @ X
    left[:, :, _column(_OWN), _OWN] += c.yy[:, :, _column(own), own]
    left[:, :, _OWN, 4] += c.yT[:, :, own]
    left[:, :, _OWN, 5] += c.y[:, :, own]
    B = 4 * J
    S, r = np.zeros((N, B + 1, B + 1)), np.zeros((N, B + 1))
    for j in range(J):
        at = np.arange(4) * J + j
        S[:, at[:, np.newaxis], at] = left[:, j, :4, :4]
        S[:, at, B] = S[:, B, at] = left[:, j, :4, 4]
        r[:, at] = left[:, j, :4, 5]
    S[:, B, B] = c.TT + left[:, :, 4, 4].sum(axis=1)
    r[:, B] = c.T + left[:, :, 4, 5].sum(axis=1)

    def back(border: Array, dT: Array) -> Array:
        by_joint = np.swapaxes(border.reshape(N, 4, J), 1, 2)[..., np.newaxis]
        x = X[..., :k, 5] + (X[..., :k, :4] @ by_joint)[..., 0] + X[..., :k, 4] * dT[
            :, np.newaxis, np.newaxis]
        return -np.swapaxes(x, 1, 2)

    return S, r, back


def _without_inner_jointly(n: int, ends: tuple[Array, Array], c: Curvature) -> tuple[
        Array, Array, Callable[[Array, Array], Array]]:
    """Eliminate where joints act on each other; columns border, duration, gradient."""
    by_y, by_T = ends
    N, J, inner, own = len(c.T), c.y.shape[1], slice(2, n + 1), (0, 1, n + 1)
    k, B = J * (n - 1), 4 * J
    H = c.yy.reshape(N, J, n + 2, J, n + 2)
    K, R = np.zeros((N, k + 2 * J, k + 2 * J)), np.zeros((N, k + 2 * J, B + 2))
    K[:, :k, :k] = H[:, :, inner, :, inner].reshape(N, k, k)
    for j in range(J):
        rows, columns = slice(k + 2 * j, k + 2 * j + 2), slice(j * (n - 1), (j + 1) * (n - 1))
        K[:, rows, columns] = by_y[..., inner]
        K[:, columns, rows] = np.swapaxes(by_y[..., inner], 1, 2)
        R[:, k + 2 * j, 2 * J + j], R[:, rows, B] = -1.0, by_T[:, :, j]
        for kind, source in zip(_OWN, own):
            R[:, :k, J * kind + j] = H[:, :, inner, j, source].reshape(N, k)
            R[:, rows, J * kind + j] = by_y[..., source]
    R[:, :k, B], R[:, :k, B + 1] = (f[..., inner].reshape(N, k) for f in (c.yT, c.y))
    X = np.linalg.solve(K, R)
    left = -np.swapaxes(R, 1, 2) @ X
    for kind, source in zip(_OWN, own):
        at = slice(J * kind, J * kind + J)
        for other, its_source in zip(_OWN, own):
            left[:, at, J * other:J * other + J] += H[:, :, source, :, its_source]
        left[:, at, B] += c.yT[..., source]
        left[:, B, at] += c.yT[..., source]
        left[:, at, B + 1] += c.y[..., source]
    left[:, B, B] += c.TT
    left[:, B, B + 1] += c.T

    def back(border: Array, dT: Array) -> Array:
        x = X[:, :k, B + 1] + (X[:, :k, :B] @ border[..., np.newaxis])[..., 0] + (
            X[:, :k, B] * dT[:, np.newaxis])
        return -np.swapaxes(x.reshape(N, J, n - 1), 1, 2)

    return left[:, :B + 1, :B + 1], left[:, :B + 1, B + 1], back


def _coupled(S: Array, r: Array, tie: Array, tie_tie: float, tie_r: float,
             still: BoolArray) -> tuple[Array, float]:
    """Return the steps at all via points, (N + 1, B), and of the common unknown."""
    vias, B = len(S) - 1, S.shape[-1] // 2
    at_vias = np.zeros((vias + 2, B))
    if vias == 0:
        return at_vias, -tie_r / tie_tie if tie_tie else 0.0
    band = np.zeros((2 * B, B * vias))
    D, beside = S[:-1, B:, B:] + S[1:, :B, :B], S[1:-1, B:, :B]
    for i in range(B):
        for j in range(i + 1):
            band[i - j, j::B] = D[:, i, j]
        for j in range(B):
            band[B + i - j, j:B * (vias - 1):B] = beside[:, i, j]
    right = np.stack([(x[:-1, B:] + x[1:, :B]).ravel() for x in (r, tie)], axis=1)
    for via, joint in np.argwhere(still):
        band[0, B * via + joint] = STIFF
    x = _solved(band, right)
    common = -(tie_r - right[:, 1] @ x[:, 0]) / (
        tie_tie - right[:, 1] @ x[:, 1]) if tie_tie else 0.0
    at_vias[1:-1] = -(x[:, 0] + x[:, 1] * common).reshape(vias, B)
    return at_vias, float(common)


def _solved(band: Array, right: Array) -> Array:
    """Solve a symmetric band; made stiffer where rounding has left it not positive definite."""
    for extra in STIFFENING:
        stiff = band.copy()
        stiff[0] += extra * np.abs(band[0])
        try:
            return np.asarray(solveh_banded(stiff, right, lower=True, check_finite=False))
        except np.linalg.LinAlgError:
            continue
    return np.asarray(right / np.abs(band[0])[:, np.newaxis])


def _column(index: Sequence[int]) -> IntArray:
    return np.array(index)[:, np.newaxis]
