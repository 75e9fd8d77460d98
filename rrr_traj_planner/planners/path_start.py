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

"""Motions along a path to begin from: however slowly, they go from end to end without a stop."""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.planners.ramp_chain import Grid, Motion
from rrr_traj_planner.planners.ramp_moves import restored

HALVINGS = 60  # of a phase's bracket


def cycloid_along(grid: Grid, ends: Array) -> Motion:
    """
    Return a full-period cycloid of 1 s from end to end.

    However short the first piece and the last are, it comes to rest in them without haste.

    Parameters
    ----------
    grid : Grid
        The family of motions.
    ends : ndarray, shape (N + 1,)
        Places where the pieces meet [m].

    Returns
    -------
    Motion
        Through every place.

    """
    length = float(ends[-1])
    phase = _cycloid_phase(ends / length)
    share = np.arange(1, grid.n) / grid.n
    within = phase[:-1, np.newaxis] + np.diff(phase)[:, np.newaxis] * share
    inner, a = (2.0 * np.pi * length * np.sin(p)[..., np.newaxis] for p in (within, phase[1:-1]))
    v = length * (1.0 - np.cos(phase[1:-1]))[:, np.newaxis]
    T = np.diff(phase) / (2.0 * np.pi)
    return restored(grid, ends[:, np.newaxis], Motion(inner, v, a, T))


def uniform_along(grid: Grid, ends: Array) -> Motion:
    """
    Return a motion of 1 m/s, but for the first piece and the last.

    Parameters
    ----------
    grid : Grid
        The family of motions.
    ends : ndarray, shape (N + 1,)
        Places where the pieces meet [m], at least three.

    Returns
    -------
    Motion
        Through every place.

    """
    T = np.diff(ends)
    T[[0, -1]] *= 2.0
    N = len(T)
    return restored(grid, ends[:, np.newaxis], Motion(
        np.zeros((N, grid.n - 1, 1)), np.ones((N - 1, 1)), np.zeros((N - 1, 1)), T))


def _cycloid_phase(share: Array) -> Array:
    """Return where a cycloid, phase - sin phase, has come to shares of its whole way."""
    low, high = np.zeros_like(share), np.full_like(share, 2.0 * np.pi)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        short = middle - np.sin(middle) < 2.0 * np.pi * share
        low, high = np.where(short, middle, low), np.where(short, high, middle)
    return np.where(share >= 1.0, 2.0 * np.pi, low)
