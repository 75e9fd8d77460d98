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
One inverse solution at each of consecutive via points, for the least estimated time.

A shortest path through a graph with one stage for each point, by dynamic programming over pairs of
solutions at consecutive points (Bellman, Dynamic Programming, 1957).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.least_time_turns import TRAVEL
from rrr_traj_planner.core.kinematics.travel_time import (
    joint_travel_time,
    motion_ends,
    ViaPointBehaviour,
)


def least_time_chain(limits: JointLimits, options: Sequence[Array], costs: Sequence[Array],
                     passing: ViaPointBehaviour) -> list[int]:
    """
    Return which of its options each point has in the motion of least estimated time.

    Parameters
    ----------
    limits : JointLimits
        Velocities and accelerations.
    options : sequence of ndarray, shape (m_i, 3)
        Joint positions at each point [rad]; NaN where a joint's is arbitrary.
    costs : sequence of ndarray, shape (m_i,)
        Of the options themselves [s].
    passing : ViaPointBehaviour
        How the motion passes via points.

    Returns
    -------
    list of int
        An index into each of the options. The first of several that are equally good.

    """
    if len(options) == 1:
        return [int(costs[0].argmin())]
    ends = motion_ends(len(options) - 1)
    travel = [np.nan_to_num(b - a[:, np.newaxis]) for a, b in zip(options, options[1:])]
    best = costs[0][:, np.newaxis] + _time(limits, travel[0], ends[0], 0, passing) + costs[1]
    came = []
    for i in range(1, len(travel)):
        reverses = np.sign(travel[i - 1])[:, :, np.newaxis] * np.sign(travel[i]) <= 0.0
        total = best[..., np.newaxis]
        for part, end in ((travel[i - 1][:, :, np.newaxis], ends[i - 1]), (travel[i], ends[i])):
            total = total + (_time(limits, part, end, reverses.astype(int), passing)
                             - _time(limits, part, end, 0, passing))
        origin = total.argmin(axis=0)
        came.append(origin)
        best = (np.take_along_axis(total, origin[np.newaxis], axis=0)[0]
                + _time(limits, travel[i], ends[i], 0, passing) + costs[i + 1])
    before, last = (int(k) for k in np.unravel_index(best.argmin(), best.shape))
    chosen = [last, before]
    for origin in reversed(came):
        chosen.append(int(origin[chosen[-1], chosen[-2]]))
    return chosen[::-1]


def _time(limits: JointLimits, travel: Array, ends: int, reversals: Array | int,
          passing: ViaPointBehaviour) -> Array:
    """Return the slowest joint's time over the last axis, with a tie-breaker for travel."""
    length = np.abs(travel)
    times = joint_travel_time(limits, slice(None), length, ends, reversals, passing)
    return np.asarray(times.max(axis=-1) + TRAVEL * length.sum(axis=-1))
