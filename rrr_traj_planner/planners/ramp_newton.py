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
from rrr_traj_planner.planners.ramp_constraints import Change
from scipy.linalg import solveh_banded

# A segment's border, in this order: v0 (3), a0 (3), v1 (3), a1 (3).
BORDER = 12

STIFF = 1e60  # holds an unknown where it is
STIFFENING = (0.0, 1e-9, 1e-6, 1e-3, 1.0)


class Curvature(NamedTuple):
    """Gradient and Gauss-Newton Hessian of the barrier in each segment's own unknowns."""

    yy: Array  # (N, 3, m, m) where joints are independent, else (N, 3 m, 3 m)
    yT: Array  # (N, 3, m)
    TT: Array  # (N,)
    y: Array   # (N, 3, m)
    T: Array   # (N,)


def curvature(slacks: list[Array], linear: list[Change], duals: list[Array],
              barrier: float, weights: Array) -> Curvature:
    """
    Return gradient and Hessian of weights . T - barrier * sum log(slack), Gauss-Newton.

    Parameters
    ----------
    slacks : list of ndarray, shape (2, N, p, 3)
        Room below and above.
    linear : list of Change
        How the limited quantities change.
    duals : list of ndarray
        Multipliers, as slacks.
    barrier : float
        The barrier's weight.
    weights : ndarray, shape (N,)
        Of the durations in the objective.

    Returns
    -------
    Curvature
        Of all segments.

    """
    N, m = linear[0].by_y.shape[0], linear[0].by_y.shape[-1]
    coupled = any(x.by_y.ndim > 3 for x in linear)
    yy, yT, y = np.zeros((N, 3, m, m)), np.zeros((N, 3, m)), np.zeros((N, 3, m))
    TT, T = np.zeros(N), weights.copy()
    full = np.zeros((N, 3 * m, 3 * m)) if coupled else None
    for s, x, dual in zip(slacks, linear, duals):
        weight = (dual / s).sum(axis=0)
        pull = barrier * (1.0 / s[0] - 1.0 / s[1])
        TT += (weight * x.by_T ** 2).sum(axis=(1, 2))
        T += (pull * x.by_T).sum(axis=(1, 2))
        if x.by_y.ndim == 3:
            D = x.by_y[:, np.newaxis]                                   # (N, 1, p, m)
            Dt = np.swapaxes(D, -1, -2)
            by_joint = np.moveaxis(weight, -1, 1)[..., np.newaxis]      # (N, 3, p, 1)
            yy += Dt @ (by_joint * D)
            yT += (Dt @ (np.moveaxis(weight * x.by_T, -1, 1)[..., np.newaxis]))[..., 0]
            y += (Dt @ np.moveaxis(pull, -1, 1)[..., np.newaxis])[..., 0]
        else:
            D = x.by_y.reshape(N, -1, 3 * m)
            Dt = np.swapaxes(D, -1, -2)
            full += Dt @ (weight.reshape(N, -1, 1) * D)
            yT += (Dt @ (weight * x.by_T).reshape(N, -1, 1)).reshape(N, 3, m)
            y += (Dt @ pull.reshape(N, -1, 1)).reshape(N, 3, m)
    if full is None:
        return Curvature(yy, yT, TT, y, T)
    for j in range(3):
        full[:, j * m:(j + 1) * m, j * m:(j + 1) * m] += yy[:, j]
    return Curvature(full, yT, TT, y, T)


class Freedom(NamedTuple):
    """
    Which durations are free, and which are common multiples of given ones; what stays at rest.

    Durations that are not free change by `tie` times a common unknown.
    """

    free: BoolArray  # (N,)
    tie: Array       # (N,), 0 where free or fixed
    weights: Array   # (N,), in the objective
    still: BoolArray  # (N - 1, 3), joints whose velocity at a via point stays as it is


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
        How velocity and way at the segments' ends change: (N, 2, m) by y, (N, 2, 3) by T.
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
    column, pivot = S[:, :BORDER, BORDER], S[:, BORDER, BORDER]
    share = np.where(free, 1.0 / pivot, 0.0)  # free durations are eliminated
    Sb = S[:, :BORDER, :BORDER] - share[:, np.newaxis, np.newaxis] * (
        column[:, :, np.newaxis] * column[:, np.newaxis])
    rb = r[:, :BORDER] - (share * r[:, BORDER])[:, np.newaxis] * column
    at_vias, common = _coupled(Sb, rb, tie[:, np.newaxis] * column, float(tie ** 2 @ pivot),
                               float(tie @ r[:, BORDER]), still)
    border = np.concatenate((at_vias[:-1], at_vias[1:]), axis=1)
    dT = np.where(free, -share * (r[:, BORDER] + (column * border).sum(axis=1)), tie * common)
    inner = back(border, dT)
    own = np.swapaxes(border.reshape(-1, 4, 3)[:, [0, 1, 3]], 1, 2)
    gain = -float((c.y[:, :, 2:-1] * np.swapaxes(inner, 1, 2)).sum() + c.T @ dT
                  + (c.y[:, :, [0, 1, -1]] * own).sum())
    return Step(Motion(inner, at_vias[1:-1, :3], at_vias[1:-1, 3:], dT), gain)


def _without_inner(n: int, ends: tuple[Array, Array], c: Curvature) -> tuple[
        Array, Array, Callable[[Array, Array], Array]]:
    """
    Eliminate the inner accelerations.

    Returns the Hessian (N, 13, 13) and gradient (N, 13) left over border and duration, and the
    function that gives the inner accelerations' step for theirs.
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
    N, k, inner, own = len(c.T), n - 1, slice(2, n + 1), [0, 1, n + 1]
    E = np.broadcast_to(by_y[:, np.newaxis], (N, 3, 2, n + 2))
    K, R = np.zeros((N, 3, k + 2, k + 2)), np.zeros((N, 3, k + 2, 6))
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
    S, r = np.zeros((N, 13, 13)), np.zeros((N, 13))
    for j in range(3):
        at = np.arange(4) * 3 + j
        S[:, at[:, np.newaxis], at] = left[:, j, :4, :4]
        S[:, at, BORDER] = S[:, BORDER, at] = left[:, j, :4, 4]
        r[:, at] = left[:, j, :4, 5]
    S[:, BORDER, BORDER] = c.TT + left[:, :, 4, 4].sum(axis=1)
    r[:, BORDER] = c.T + left[:, :, 4, 5].sum(axis=1)

    def back(border: Array, dT: Array) -> Array:
        by_joint = np.swapaxes(border.reshape(N, 4, 3), 1, 2)[..., np.newaxis]
        x = X[..., :k, 5] + (X[..., :k, :4] @ by_joint)[..., 0] + X[..., :k, 4] * dT[
            :, np.newaxis, np.newaxis]
        return -np.swapaxes(x, 1, 2)

    return S, r, back


def _without_inner_jointly(n: int, ends: tuple[Array, Array], c: Curvature) -> tuple[
        Array, Array, Callable[[Array, Array], Array]]:
    """Eliminate where joints act on each other; columns border, duration, gradient."""
    by_y, by_T = ends
    N, k, inner, own = len(c.T), 3 * (n - 1), slice(2, n + 1), (0, 1, n + 1)
    H = c.yy.reshape(N, 3, n + 2, 3, n + 2)
    K, R = np.zeros((N, k + 6, k + 6)), np.zeros((N, k + 6, 14))
    K[:, :k, :k] = H[:, :, inner, :, inner].reshape(N, k, k)
    for j in range(3):
        rows, columns = slice(k + 2 * j, k + 2 * j + 2), slice(j * (n - 1), (j + 1) * (n - 1))
        K[:, rows, columns] = by_y[..., inner]
        K[:, columns, rows] = np.swapaxes(by_y[..., inner], 1, 2)
        R[:, k + 2 * j, 6 + j], R[:, rows, BORDER] = -1.0, by_T[:, :, j]
        for kind, source in zip(_OWN, own):
            R[:, :k, 3 * kind + j] = H[:, :, inner, j, source].reshape(N, k)
            R[:, rows, 3 * kind + j] = by_y[..., source]
    R[:, :k, 12], R[:, :k, 13] = (f[..., inner].reshape(N, k) for f in (c.yT, c.y))
    X = np.linalg.solve(K, R)
    left = -np.swapaxes(R, 1, 2) @ X
    for kind, source in zip(_OWN, own):
        at = slice(3 * kind, 3 * kind + 3)
        for other, its_source in zip(_OWN, own):
            left[:, at, 3 * other:3 * other + 3] += H[:, :, source, :, its_source]
        left[:, at, 12] += c.yT[..., source]
        left[:, 12, at] += c.yT[..., source]
        left[:, at, 13] += c.y[..., source]
    left[:, 12, 12] += c.TT
    left[:, 12, 13] += c.T

    def back(border: Array, dT: Array) -> Array:
        x = X[:, :k, 13] + (X[:, :k, :12] @ border[..., np.newaxis])[..., 0] + (
            X[:, :k, 12] * dT[:, np.newaxis])
        return -np.swapaxes(x.reshape(N, 3, n - 1), 1, 2)

    return left[:, :13, :13], left[:, :13, 13], back


def _coupled(S: Array, r: Array, tie: Array, tie_tie: float, tie_r: float,
             still: BoolArray) -> tuple[Array, float]:
    """Return the steps at all via points, (N + 1, 6), and of the common unknown."""
    vias = len(S) - 1
    at_vias = np.zeros((vias + 2, 6))
    if vias == 0:
        return at_vias, -tie_r / tie_tie if tie_tie else 0.0
    band = np.zeros((12, 6 * vias))
    D, beside = S[:-1, 6:, 6:] + S[1:, :6, :6], S[1:-1, 6:, :6]
    for i in range(6):
        for j in range(i + 1):
            band[i - j, j::6] = D[:, i, j]
        for j in range(6):
            band[6 + i - j, j:6 * (vias - 1):6] = beside[:, i, j]
    right = np.stack([(x[:-1, 6:] + x[1:, :6]).ravel() for x in (r, tie)], axis=1)
    for via, joint in np.argwhere(still):
        band[0, 6 * via + joint] = STIFF
    x = _solved(band, right)
    common = -(tie_r - right[:, 1] @ x[:, 0]) / (
        tie_tie - right[:, 1] @ x[:, 1]) if tie_tie else 0.0
    at_vias[1:-1] = -(x[:, 0] + x[:, 1] * common).reshape(vias, 6)
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
