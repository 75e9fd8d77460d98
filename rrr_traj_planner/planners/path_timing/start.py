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

"""First motions along a path, from end to end without a stop; scaled in time they are feasible."""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.planners.solver.ramps import Grid, Variables


def motion_with_speeds(grid: Grid, ends: Array, speeds: Array) -> Variables:
    """
    Return a motion of given speeds where pieces meet, with cycloidal transitions between them.

    Parameters
    ----------
    grid : Grid
        Discretisation: n ramps per segment.
    ends : ndarray, shape (N + 1,)
        Path lengths where the pieces meet [m].
    speeds : ndarray, shape (N + 1,)
        [m/s], no two neighbours 0.

    Returns
    -------
    Variables
        From rest to rest where the outer speeds are 0.

    """
    T = 2.0 * np.diff(ends) / (speeds[1:] + speeds[:-1])
    N, share = len(T), np.arange(1, grid.n) / grid.n
    rise = (np.diff(speeds) / T)[:, np.newaxis] * (1.0 - np.cos(2.0 * np.pi * share))
    return grid.restored(ends[:, np.newaxis], Variables(
        rise[..., np.newaxis], speeds[1:-1, np.newaxis], np.zeros((N - 1, 1)), T))


def uniform_along(grid: Grid, ends: Array) -> Variables:
    """
    Return a motion of 1 m/s, except on the first and the last piece (5.61-5.62).

    Parameters
    ----------
    grid : Grid
        Discretisation: n ramps per segment.
    ends : ndarray, shape (N + 1,)
        Path lengths where the pieces meet [m], at least three.

    Returns
    -------
    Variables
        From rest to rest.

    """
    T = np.diff(ends)
    T[[0, -1]] *= 2.0
    N = len(T)
    return grid.restored(ends[:, np.newaxis], Variables(
        np.zeros((N, grid.n - 1, 1)), np.ones((N - 1, 1)), np.zeros((N - 1, 1)), T))
