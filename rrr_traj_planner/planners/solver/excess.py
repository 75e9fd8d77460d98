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
By how much densely sampled quantities exceed their limits between a problem's points.

Between samples a smooth quantity rises by at most an eighth of its second difference, up to terms
of higher order (the error of linear interpolation).
"""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kernels import contiguous
from rrr_traj_planner.planners.solver.library import KERNELS
from rrr_traj_planner.planners.tolerances import LIMIT_ROUNDING


def rise_between_samples(x: Array) -> Array:
    """
    Return the rise of smooth quantities between each sample and its neighbours.

    Parameters
    ----------
    x : ndarray, shape (N, W, K)
        Samples, at least 3, of each of N segments.

    Returns
    -------
    ndarray, shape (N, W, K)
        An eighth of the largest second difference there.

    """
    x, rise = contiguous(x), np.empty(x.shape)
    KERNELS.rise_between_samples(*x.shape, x.ctypes.data, rise.ctypes.data)
    return rise


def excess_near_points(x: Array, limit: Array, checks: int, reach: int) -> Array:
    """
    Return by how much the magnitudes of sampled quantities exceed limits near each point.

    Parameters
    ----------
    x : ndarray, shape (N, 2 n checks + 1, K)
        Samples of n intervals in each segment, in the order of time.
    limit : ndarray, shape (K,)
        On magnitudes; infinite where there is none.
    checks : int
        Samples from one of a segment's 2 n + 1 points to the next.
    reach : int
        Number of samples on either side that count as near a point.

    Returns
    -------
    ndarray, shape (N, 2 n + 1, K)
        Nodes, then the middles between them; 0 where the limit holds.

    """
    x, limit, (N, samples, K) = contiguous(x), contiguous(limit), x.shape
    n = (samples - 1) // (2 * checks)
    excess, scratch = np.empty((N, 2 * n + 1, K)), np.empty(samples)
    KERNELS.excess_near_points(N, n, checks, reach, K, x.ctypes.data, limit.ctypes.data,
                               LIMIT_ROUNDING, excess.ctypes.data, scratch.ctypes.data)
    return excess


def range_excess(q: Array, qd: Array, least: Array, most: Array, rest_speed: float) -> Array:
    """
    Return how far sampled positions leave their ranges in each segment, between samples too.

    Parameters
    ----------
    q, qd : ndarray, shape (N, W, K)
        Positions and velocities at samples, at least 3, of each of N segments.
    least, most : ndarray, shape (K,)
        Ends of the ranges; infinite where there is none.
    rest_speed : float
        Speed up to which a joint is at rest: at rest at a sample, it does not reverse beside it.

    Returns
    -------
    ndarray, shape (2, N, K)
        Beyond the upper and the lower end; not above 0 within.

    """
    q, qd, least, most = map(contiguous, (q, qd, least, most))
    beyond, scratch = np.empty((2, len(q), q.shape[2])), np.empty(q.shape[1])
    KERNELS.range_excess(*q.shape, *(f.ctypes.data for f in (q, qd, least, most)), rest_speed,
                         beyond.ctypes.data, scratch.ctypes.data)
    return beyond
