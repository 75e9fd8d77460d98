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
Whole turns of one joint at consecutive via points for the least estimated time.

A shortest path through a graph with one stage for each point, by dynamic programming (Bellman,
Dynamic Programming, 1957; Cormen et al., Introduction to Algorithms, 4th ed., ch. 14).
"""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.kinematics.joint_ranges import TURN
from rrr_traj_planner.core.kinematics.travel_time import (
    joint_travel_time,
    motion_ends,
    ViaPointBehaviour,
)
from rrr_traj_planner.core.rounding import JOINT_ROUNDING

MOST_TURNS = 5  # candidates at each point, the nearest: bounds the work in wide ranges; chosen

# Tie-breakers among turns of equal time: least travel, then a beginning near 0. So small that they
# hardly change the order of different times; chosen.
TRAVEL, BEGINNING = 1e-6, 1e-9  # s/rad


def least_time_turns(limits: JointLimits, joint: int, q: Array, others: Array,
                     first_is_fixed: bool, passing: ViaPointBehaviour) -> Array:
    """
    Return one joint's positions with the whole turns of least time within its range.

    The state of the dynamic programme is the pair of turns at a point and the next, and whether
    the joint rests at the former (at the beginning or at a reversal). Linear in the number of
    points.

    Parameters
    ----------
    limits : JointLimits
        Range, velocity and acceleration.
    joint : int
        The joint.
    q : ndarray, shape (m,)
        Its positions up to whole turns, at most half a turn from one to the next [rad].
    others : ndarray, shape (m - 1,)
        Times from each point to the next that the other joints need [s].
    first_is_fixed : bool
        Whether the turn of the first position is fixed.
    passing : ViaPointBehaviour
        How the motion passes via points.

    Returns
    -------
    ndarray, shape (m,)
        Positions [rad]; where no turn is in range, the nearest.

    """
    values, allowed = _options(limits, joint, q, first_is_fixed)
    cost = np.where(allowed, 0.0, np.inf)
    if len(q) == 1:
        return values[0, [np.argmin(cost[0] + BEGINNING * np.abs(values[0]))]]
    travel = values[1:, np.newaxis] - values[:-1, :, np.newaxis]  # from point, turn, to turn
    times = _times(limits, joint, travel, others, passing)
    # A joint that does not reverse cannot rest between two segments, and one that does must.
    reverses = np.sign(travel[:-1, :, :, np.newaxis]) * np.sign(travel[1:, np.newaxis]) <= 0.0
    barred = np.where(reverses[..., np.newaxis] == (False, True), 0.0, np.inf)
    # Axes of the cost: whether the joint rests at the point before, turn there, turn here.
    best = np.full((2, *travel.shape[1:]), np.inf)
    best[1] = (cost[0] + BEGINNING * np.abs(values[0]))[:, np.newaxis] + cost[1]
    came = []
    for i in range(len(travel) - 1):
        # Rest before, turn before, turn between, turn after, rest between.
        total = (best[..., np.newaxis] + times[i])[:, :, :, np.newaxis] + barred[i]
        total = total.reshape(-1, *total.shape[2:])
        came.append(total.argmin(axis=0))
        best = np.moveaxis(total.min(axis=0) + cost[i + 2, :, np.newaxis], 2, 0)
    best = best + times[-1, ..., 1]
    rest, before, last = (int(k) for k in np.unravel_index(best.argmin(), best.shape))
    chosen = [last, before]
    for origin in reversed(came):
        rest, former = divmod(int(origin[chosen[-1], chosen[-2], rest]), values.shape[1])
        chosen.append(former)
    return np.asarray(values[np.arange(len(q)), chosen[::-1]])


def _times(limits: JointLimits, joint: int, travel: Array, others: Array,
           passing: ViaPointBehaviour) -> Array:
    """
    Return the times of segments by the joint's turns, and by whether it rests at both ends.

    At the motion's ends it rests. With a tie-breaker for travel. Shape (m - 1, 2, k, k, 2).
    """
    length, ends = np.abs(travel), motion_ends(len(travel))[:, np.newaxis, np.newaxis]
    by_count = np.stack([np.maximum(others[:, np.newaxis, np.newaxis], joint_travel_time(
        limits, joint, length, ends, np.maximum(n - ends, 0), passing)) + TRAVEL * length
        for n in range(3)], axis=1)
    return np.stack([by_count[:, :2], by_count[:, 1:]], axis=-1)


def _options(limits: JointLimits, joint: int, q: Array,
             first_is_fixed: bool) -> tuple[Array, BoolArray]:
    """Return candidate positions at each point, shape (m, k), and which of them are allowed."""
    low, high = limits.min_position[joint], limits.max_position[joint]
    first = np.ceil((low - q - JOINT_ROUNDING) / TURN)
    last = np.floor((high - q + JOINT_ROUNDING) / TURN)
    none = first > last
    if none.any():  # the range is shorter than a turn, and finite
        first[none] = last[none] = np.round((0.5 * (low + high) - q[none]) / TURN)
    if first_is_fixed:
        first[0] = last[0] = 0.0
    nearest = np.clip(0.0, first, last)
    first = np.maximum(first, np.minimum(nearest - MOST_TURNS // 2, last - (MOST_TURNS - 1)))
    last = np.minimum(last, first + (MOST_TURNS - 1))
    turns = first[:, np.newaxis] + np.arange(int((last - first).max()) + 1)
    return q[:, np.newaxis] + TURN * turns, turns <= last[:, np.newaxis]
