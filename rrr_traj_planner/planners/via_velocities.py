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
Velocities at the via points and durations of the segments that take least total time.

For one joint the time that a segment takes between given velocities is bounded below by a
second-order cone, so the problem is convex but for the bound from above (a joint must not be too
fast for the others). A step of the method factors nine diagonals: its cost is linear in the number
of via points.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.planners.barrier import Derivatives
from rrr_traj_planner.planners.central_path import follow, Solution
from rrr_traj_planner.planners.chain import Chain
from rrr_traj_planner.planners.request import never
from scipy.linalg import solveh_banded

START_ROOM = 1.3  # the start's durations over the least ones from rest to rest
BANDWIDTH = 4


def least_time(chain: Chain, floor: Array | None = None,
               should_stop: Callable[[], bool] = never) -> Solution:
    """
    Return the via velocities and durations of least total time.

    Parameters
    ----------
    chain : Chain
        The via points; no displacement zero in all joints.
    floor : ndarray, shape (n,), optional
        Durations [s] that no segment may fall below.
    should_stop : callable
        Asked before every step; True ends the search with what it has.

    Returns
    -------
    Solution
        Where the problem is convex and nothing stops it, within a relative 2e-7 of the least
        total time.

    """
    n = len(chain.displacements)
    T = chain.rest_to_rest_times()
    if floor is not None:
        T = np.maximum(T, floor)
    return follow(_FreeDurations(chain, floor), np.zeros((n - 1, 3)), START_ROOM * T,
                  should_stop)


def least_stretch(chain: Chain, durations: Array) -> tuple[float, Solution]:
    """
    Return by how much prescribed durations must be stretched to be feasible.

    Parameters
    ----------
    chain : Chain
        The via points.
    durations : ndarray, shape (n,)
        Prescribed durations [s], positive.

    Returns
    -------
    tuple of float and Solution
        The least common factor, below 1 where there is time to spare, and the stretched motion.

    """
    n = len(chain.displacements)
    factor = START_ROOM * max(float((chain.rest_to_rest_times() / durations).max()), 1e-6)
    solution = follow(_CommonStretch(chain, durations), np.zeros((n - 1, 3)), factor * durations,
                      never)
    return float(solution.durations[0] / durations[0]), solution


class _FreeDurations:
    """Least sum of durations: every duration is a variable."""

    proportions = None

    def __init__(self, chain: Chain, floor: Array | None) -> None:
        self.chain = chain
        self.floor = floor

    def objective(self, T: Array) -> float:
        """Return the total time [s]."""
        return float(T.sum())

    def newton_step(self, b: Derivatives, weight: float) -> tuple[Array, Array, float]:
        """Return the step; variables in the order T0, v0 of three joints, T1, v1, ..."""
        n = len(b.T_T)
        band, right = np.zeros((BANDWIDTH + 1, 4 * n)), np.zeros(4 * n)
        band[0, 0::4] = b.T_T
        band[0, 4 * n - 3:] = 1.0
        right[0::4] = -(weight + b.g_T)
        for i in range(3):
            band[0, 1 + i:4 * n - 4:4] = b.v_v[:, i]
            band[1 + i, 0:4 * n - 4:4] = b.v1_T[:-1, i]
            band[3 - i, 1 + i:4 * n - 4:4] = b.v0_T[1:, i]
            band[4, 1 + i:4 * n - 8:4] = b.v_next[:, i]
            right[1 + i:4 * n - 4:4] = -b.g_v[:, i]
        x = solveh_banded(band, right, lower=True, check_finite=False)
        steps = x.reshape(n, 4)
        return steps[:-1, 1:], steps[:, 0], float(x @ right)


class _CommonStretch:
    """Least common stretch of given durations: one variable beside the velocities."""

    floor = None

    def __init__(self, chain: Chain, durations: Array) -> None:
        self.chain = chain
        self.proportions = durations

    def objective(self, T: Array) -> float:
        """Return the stretch."""
        return float(T[0] / self.proportions[0])

    def newton_step(self, b: Derivatives, weight: float) -> tuple[Array, Array, float]:
        """Return the step: a band for the velocities, bordered by the stretch."""
        d = self.proportions
        g, h = weight + float(b.g_T @ d), float(b.T_T @ d ** 2)
        if len(d) == 1:
            return b.g_v, -g / h * d, g * g / h
        border = (b.v1_T[:-1] * d[:-1, np.newaxis] + b.v0_T[1:] * d[1:, np.newaxis]).ravel()
        band = np.zeros((4, b.v_v.size))
        band[0] = b.v_v.ravel()
        band[3, :b.v_next.size] = b.v_next.ravel()
        x = solveh_banded(band, np.stack((b.g_v.ravel(), border), axis=1), lower=True,
                          check_finite=False)
        stretch = -(g - float(border @ x[:, 0])) / (h - float(border @ x[:, 1]))
        dv = -(x[:, 0] + x[:, 1] * stretch)
        decrement = -float(b.g_v.ravel() @ dv) - g * stretch
        return dv.reshape(-1, 3), stretch * d, decrement
