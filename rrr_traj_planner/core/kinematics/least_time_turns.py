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
    least = others[:, np.newaxis, np.newaxis]
    ends = motion_ends(len(travel))[:, np.newaxis, np.newaxis]
    times = np.stack([np.maximum(least, joint_travel_time(
        limits, joint, np.abs(travel), ends, np.maximum(n - ends, 0), passing))
        + TRAVEL * np.abs(travel) for n in range(3)], axis=1)
    # Axes of the cost: turn at the point before, turn at this point, whether the joint rests at
    # the former.
    best = np.full((*travel.shape[1:], 2), np.inf)
    best[..., 1] = (cost[0] + BEGINNING * np.abs(values[0]))[:, np.newaxis] + cost[1]
    came = []
    for i in range(len(travel) - 1):
        rests = np.sign(travel[i])[:, :, np.newaxis] * np.sign(travel[i + 1]) <= 0.0
        best, origin = _step(best, times[i], rests, cost[i + 2])
        came.append(origin)
    best = best + np.stack([times[-1, 1], times[-1, 2]], axis=-1)
    before, last, rest = (int(k) for k in np.unravel_index(best.argmin(), best.shape))
    chosen = [last, before]
    for origin in reversed(came):
        former, rest = divmod(int(origin[chosen[-1], chosen[-2], rest]), 2)
        chosen.append(former)
    return np.asarray(values[np.arange(len(q)), chosen[::-1]])


def _step(best: Array, times: Array, rests: BoolArray, cost: Array) -> tuple[Array, Array]:
    """Return least costs at the next stage, and the predecessors that attain them."""
    reached, origin = [], []
    for rest in (0, 1):  # at the middle one of three points
        cost_before = best + np.stack([times[rest], times[rest + 1]], axis=-1)
        cost_before = np.moveaxis(cost_before, 2, 1)[..., np.newaxis]
        total = np.where(rests[:, np.newaxis] == rest, cost_before,
                         np.inf)  # turn before, rest before, turn between, turn after
        flat = total.reshape(-1, *total.shape[2:])
        origin.append(flat.argmin(axis=0))
        reached.append(flat.min(axis=0) + cost)
    return np.stack(reached, axis=-1), np.stack(origin, axis=-1)


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
