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
The pieces into which a path is divided for its timing: short near singular positions of the arm.

Near a singular position joint positions change over a length of the path as short as the distance
to it. They are analytic functions of the path length except there, so that splines approximate
them well on pieces no longer than the distance to the singularity in the complex plane (Trefethen,
Approximation Theory and Approximation Practice, 2013, chapter 8). Pieces are halved until they
are: their number grows with the logarithm of the distance.
"""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.along_path import singular_distance
from rrr_traj_planner.core.path.arm_path import ArmPath
from rrr_traj_planner.core.rounding import TIP_ROUNDING

# Chosen: on 48 random paths half of PARTS makes motions 0.05 % faster in the mean, 0.6 % slower at
# most, twice 0.15 % slower: pieces then have fewer intervals (`mesh`). Half and twice of NEAR
# change them by 0.01 % in the mean, by 0.5 % at most.
PARTS = 8        # least number of pieces of equal length
NEAR = 1.5       # largest ratio of a piece's length to the distance of its middle to a singularity


def piece_ends(arm_path: ArmPath) -> Array:
    """
    Return the path lengths where pieces meet: joins of the path, and divisions of long pieces.

    Parameters
    ----------
    arm_path : ArmPath
        The path in joint space.

    Returns
    -------
    ndarray, shape (N + 1,)
        From 0 to the path's length [m].

    """
    path = arm_path.path
    ends = _parted(np.concatenate(([0.0], path.joins, [path.length])))
    while True:
        middle, width = 0.5 * (ends[1:] + ends[:-1]), np.diff(ends)
        distance = singular_distance(arm_path.regularity(middle))
        long = (width > NEAR * distance) & (width > TIP_ROUNDING)
        if not long.any():
            return ends
        ends = np.sort(np.append(ends, middle[long]))


def _parted(ends: Array) -> Array:
    """Return the ends of pieces after long ones are divided equally."""
    counts = np.ceil(np.diff(ends) / ends[-1] * PARTS).astype(int)
    return np.concatenate((*(np.linspace(a, b, k, endpoint=False) for a, b, k in zip(
        ends[:-1], ends[1:], np.maximum(counts, 1))), ends[-1:]))
