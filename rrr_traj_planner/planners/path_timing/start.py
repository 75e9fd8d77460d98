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
from rrr_traj_planner.planners.solver.splines import Mesh, Variables, with_stops


def motion_with_speeds(mesh: Mesh, ends: Array, speeds: Array) -> Variables:
    """
    Return a motion of given speeds where pieces meet, with cycloidal changes between them.

    Parameters
    ----------
    mesh : Mesh
        Its n intervals in each piece.
    ends : ndarray, shape (N + 1,)
        Path lengths where the pieces meet [m].
    speeds : ndarray, shape (N + 1,)
        [m/s], no two neighbours 0.

    Returns
    -------
    Variables
        From rest to rest where the outer speeds are 0. Jerk is linear between samples of a sine.

    """
    T = 2.0 * np.diff(ends) / (speeds[1:] + speeds[:-1])
    change = 2.0 * np.pi * (np.diff(speeds) / T ** 2)[:, np.newaxis]
    jerks = change * np.sin(2.0 * np.pi * mesh.starts[:, 1:-1])
    m = with_stops(jerks[..., np.newaxis], T)._replace(v=speeds[:, np.newaxis])
    return mesh.restored(ends[:, np.newaxis], m)


def uniform_along(mesh: Mesh, ends: Array) -> Variables:
    """
    Return a motion of 1 m/s, except on the first and the last piece (5.61-5.62).

    Parameters
    ----------
    mesh : Mesh
        Its n intervals in each piece.
    ends : ndarray, shape (N + 1,)
        Path lengths where the pieces meet [m], at least three.

    Returns
    -------
    Variables
        From rest to rest.

    """
    T = np.diff(ends)
    T[[0, -1]] *= 2.0
    speeds = np.ones((len(ends), 1))
    speeds[[0, -1]] = 0.0
    m = with_stops(np.zeros((len(T), mesh.n - 1, 1)), T)._replace(v=speeds)
    return mesh.restored(ends[:, np.newaxis], m)
