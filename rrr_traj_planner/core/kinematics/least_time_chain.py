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

A shortest path through a graph with one stage for each point, by dynamic programming (Bellman,
Dynamic Programming, 1957). Its state is a pair of solutions at consecutive points, and which of
the joints rest at the former: whether a joint reverses depends on three points, and a segment's
time on the reversals at both of its ends.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arrays import Array, BoolArray, IntArray
from rrr_traj_planner.core.kinematics.joint_ranges import TURN
from rrr_traj_planner.core.kinematics.least_time_turns import TRAVEL
from rrr_traj_planner.core.kinematics.travel_time import (
    joint_travel_time,
    motion_ends,
    ViaPointBehaviour,
)

RESTS = 8  # sets of joints: joint j, from 0, belongs to the sets whose bit j is 1
MEMBERS = (np.arange(RESTS)[:, np.newaxis] >> np.arange(3)) & 1  # (sets, joints)
AT_ENDS = MEMBERS[:, np.newaxis] + MEMBERS  # ends at which a joint rests, by the sets at both


def least_time_chain(limits: JointLimits, options: Sequence[Array], passing: ViaPointBehaviour,
                     turning: BoolArray) -> list[int]:
    """
    Return which of its options each point has in the motion of least estimated time.

    Parameters
    ----------
    limits : JointLimits
        Velocities and accelerations.
    options : sequence of ndarray, shape (m_i, 3)
        Joint positions at each point [rad]; NaN where a joint's is arbitrary.
    passing : ViaPointBehaviour
        How the motion passes via points.
    turning : ndarray of bool, shape (3,)
        Joints whose positions are given up to whole turns: they take the shorter way.

    Returns
    -------
    list of int
        An index into each of the options. The first of several that are equally good.

    """
    if len(options) == 1 or all(len(q) == 1 for q in options):
        return [0] * len(options)
    q, cost = _padded(options)
    travel = q[1:, np.newaxis] - q[:-1, :, np.newaxis]
    travel[np.isnan(travel)] = 0.0
    travel -= np.where(turning, TURN * np.round(travel / TURN), 0.0)
    times = _times(limits, travel, motion_ends(len(travel)), passing)
    # Axes of the cost: option at the point before, option at this point, rests at the former.
    best = np.full((*travel.shape[1:3], RESTS), np.inf)
    best[..., 0] = cost[0][:, np.newaxis] + cost[1]
    came = []
    for i in range(len(travel) - 1):
        best, origin = _step(best, times[i], _rests(travel[i], travel[i + 1]), cost[i + 2])
        came.append(origin)
    best = best + times[-1][..., 0]
    before, last, rest = (int(k) for k in np.unravel_index(best.argmin(), best.shape))
    chosen = [last, before]
    for origin in reversed(came):
        former, rest = divmod(int(origin[chosen[-1], chosen[-2], rest]), RESTS)
        chosen.append(former)
    return chosen[::-1]


def _padded(options: Sequence[Array]) -> tuple[Array, Array]:
    """Return options (n, m, 3) and their costs (n, m): 0, infinite where a point has fewer."""
    most = max(map(len, options))
    q, cost = np.zeros((len(options), most, 3)), np.full((len(options), most), np.inf)
    for i, of_point in enumerate(options):
        q[i, :len(of_point)], cost[i, :len(of_point)] = of_point, 0.0
    return q, cost


def _rests(before: Array, after: Array) -> IntArray:
    """Return the number of the set of joints that reverse between travels, shape (m, m', m'')."""
    reverses = np.sign(before)[:, :, np.newaxis] * np.sign(after) <= 0.0
    return np.asarray(reverses @ (1 << np.arange(3)))


def _times(limits: JointLimits, travel: Array, ends: IntArray,
           passing: ViaPointBehaviour) -> Array:
    """
    Return the slowest joint's times by the joints that rest at both ends of each segment.

    With a tie-breaker for travel. Shape (n, m, m, 8, 8).
    """
    length = np.abs(travel)
    by_count = joint_travel_time(
        limits, slice(None), length[..., np.newaxis, :],
        ends[:, np.newaxis, np.newaxis, np.newaxis, np.newaxis],
        np.arange(3)[:, np.newaxis], passing)
    # Axes: segment, option before, option after, number of rests, joint.
    by_count = np.broadcast_to(by_count, (*length.shape[:-1], 3, 3))
    slowest = np.maximum.reduce([by_count[..., AT_ENDS[..., j], j] for j in range(3)])
    return np.asarray(slowest + TRAVEL * length.sum(axis=-1)[..., np.newaxis, np.newaxis])


def _step(best: Array, times: Array, rests: IntArray, cost: Array) -> tuple[Array, IntArray]:
    """Return least costs at the next stage, and the predecessors that attain them."""
    a, b = np.arange(rests.shape[0])[:, np.newaxis], np.arange(rests.shape[1])
    total = best[:, :, np.newaxis] + np.swapaxes(times, 2, 3)[
        a[..., np.newaxis], b[..., np.newaxis], rests]  # option before, this, next; rests before
    former, least = total.argmin(axis=-1), total.min(axis=-1)
    of_rest = np.where(rests[..., np.newaxis] == np.arange(RESTS), least[..., np.newaxis], np.inf)
    from_option = of_rest.argmin(axis=0)  # option at this point, next, rests at this point
    this, following = (np.arange(rests.shape[1])[:, np.newaxis, np.newaxis],
                       np.arange(rests.shape[2])[:, np.newaxis])
    origin = RESTS * from_option + former[from_option, this, following]
    return of_rest.min(axis=0) + cost[:, np.newaxis], origin
