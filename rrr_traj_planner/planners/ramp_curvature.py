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

"""Gradient and Hessian of durations and barrier, in each segment's own unknowns."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.planners.ramp_constraints import Change


class Curvature(NamedTuple):
    """Gradient and Gauss-Newton Hessian of the barrier in each segment's own unknowns."""

    yy: Array  # (N, J, m, m) where joints are independent, else (N, J m, J m)
    yT: Array  # (N, J, m)
    TT: Array  # (N,)
    y: Array   # (N, J, m)
    T: Array   # (N,)


def curvature(slacks: list[Array], linear: list[Change], duals: list[Array],
              pushes: list[Array], weights: Array) -> Curvature:
    """
    Return gradient and Hessian of weights . T and limits that push away, Gauss-Newton.

    Parameters
    ----------
    slacks : list of ndarray, shape (2, N, p, K)
        Room below and above.
    linear : list of Change
        How the limited quantities change.
    duals : list of ndarray
        Multipliers, as slacks.
    pushes : list of ndarray
        What each limit pushes with: barrier / slack. As slacks.
    weights : ndarray, shape (N,)
        Of the durations in the objective.

    Returns
    -------
    Curvature
        Of all segments.

    """
    N, J, m = _sizes(linear)
    coupled = any(x.by_y.ndim > 3 for x in linear)
    y, T = pulled(linear, [push[0] - push[1] for push in pushes])
    T += weights
    yy, yT, TT = np.zeros((N, J, m, m)), np.zeros((N, J, m)), np.zeros(N)
    full = np.zeros((N, J * m, J * m)) if coupled else None
    for s, x, dual in zip(slacks, linear, duals):
        weight = (dual / s).sum(axis=0)
        TT += (weight * x.by_T ** 2).sum(axis=(1, 2))
        if x.by_y.ndim == 3:
            D = x.by_y[:, np.newaxis]                                   # (N, 1, p, m)
            Dt = np.swapaxes(D, -1, -2)
            by_joint = np.moveaxis(weight, -1, 1)[..., np.newaxis]      # (N, 3, p, 1)
            yy += Dt @ (by_joint * D)
            yT += (Dt @ (np.moveaxis(weight * x.by_T, -1, 1)[..., np.newaxis]))[..., 0]
        else:
            D = x.by_y.reshape(N, -1, J * m)
            Dt = np.swapaxes(D, -1, -2)
            full += Dt @ (weight.reshape(N, -1, 1) * D)
            yT += (Dt @ (weight * x.by_T).reshape(N, -1, 1)).reshape(N, J, m)
    if full is None:
        return Curvature(yy, yT, TT, y, T)
    for j in range(J):
        full[:, j * m:(j + 1) * m, j * m:(j + 1) * m] += yy[:, j]
    return Curvature(full, yT, TT, y, T)


def pulled(linear: list[Change], pulls: list[Array]) -> tuple[Array, Array]:
    """
    Return how a weighted sum of the limited quantities changes.

    Parameters
    ----------
    linear : list of Change
        How the limited quantities change.
    pulls : list of ndarray, shape (N, p, K)
        Their weights.

    Returns
    -------
    tuple of ndarray
        By each segment's own unknowns (N, J, m), by its duration (N,).

    """
    N, J, m = _sizes(linear)
    y, T = np.zeros((N, J, m)), np.zeros(N)
    for x, pull in zip(linear, pulls):
        T += (pull * x.by_T).sum(axis=(1, 2))
        if x.by_y.ndim == 3:
            y += np.swapaxes(pull, 1, 2) @ x.by_y
        else:
            y += (pull.reshape(N, 1, -1) @ x.by_y.reshape(N, -1, J * m)).reshape(N, J, m)
    return y, T


def _sizes(linear: list[Change]) -> tuple[int, int, int]:
    """Return the numbers of segments, of coordinates and of each segment's own unknowns."""
    by_y = linear[-1].by_y  # only there may coordinates act on each other
    return by_y.shape[0], linear[-1].by_T.shape[-1] if by_y.ndim == 3 else by_y.shape[-2], (
        by_y.shape[-1])
