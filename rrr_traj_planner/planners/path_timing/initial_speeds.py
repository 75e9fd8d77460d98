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
The tip's speeds where pieces of a path meet, for a feasible first motion.

A forward and a backward pass bound each speed by what is reachable from its neighbour (as in
Pham & Pham, A new approach to time-optimal path parameterization based on reachability analysis,
IEEE Trans. Robotics 34, 2018, but with one speed a piece and with jerk limits).
"""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.planners.path_timing.constraints import (
    ACCELERATION,
    JERK,
    SPEED,
    TORQUE,
    VELOCITY,
)
from rrr_traj_planner.planners.path_timing.table import PathTable

# Of each limit, used by the constant speed and by its changes alike; chosen: of 80 random paths
# the motion of these speeds uses at most 0.4 of a limit on velocity, acceleration or jerk, so that
# the piecewise linear jerk, up to 1.06 times the cycloid's, has room (`start.motion_with_speeds`).
PART = 0.25


def initial_speeds_of(table: PathTable, bounds: Array) -> Array:
    """
    Return speeds at the ends of all pieces such that each piece is long enough for its change.

    Parameters
    ----------
    table : PathTable
        The path's derivatives and dynamics.
    bounds : ndarray, shape (QUANTITIES,)
        On the limited quantities, infinite where there is none.

    Returns
    -------
    ndarray, shape (N + 1,)
        [m/s]; 0 at both ends, positive between them.

    """
    d = table.values
    velocity, acceleration, jerk = (PART * bounds[k] for k in (VELOCITY, ACCELERATION, JERK))
    torque = PART * np.maximum(bounds[TORQUE] - np.abs(d.g), 0.0)
    with np.errstate(divide='ignore', invalid='ignore'):
        constant = _least(velocity / np.abs(d.dq), np.sqrt(acceleration / np.abs(d.ddq)),
                          np.cbrt(jerk / np.abs(d.dddq)), np.sqrt(torque / np.abs(d.c)))
        max_sdd = _least(acceleration / np.abs(d.dq), torque / np.abs(d.m))
        max_sddd = _least(jerk / np.abs(d.dq))
    constant = np.minimum(constant, PART * bounds[SPEED])
    lengths = np.diff(table.ends)
    limit = np.concatenate(([0.0], np.minimum(constant[:-1], constant[1:]), [0.0]))
    forward = _reachable(limit, lengths, max_sdd, max_sddd)
    backward = _reachable(limit[::-1], lengths[::-1], max_sdd[::-1], max_sddd[::-1])[::-1]
    return np.minimum(forward, backward)


def _least(*limits: Array) -> Array:
    """Return the least value on each piece, over positions and joints; NaN counts as no limit."""
    return np.asarray(np.min([np.nan_to_num(s, nan=np.inf, posinf=np.inf).min(axis=(1, 2))
                              for s in limits], axis=0))


def _reachable(limit: Array, lengths: Array, max_sdd: Array, max_sddd: Array) -> Array:
    """Return speeds limited to those that can be reached from the one before."""
    speeds = limit.copy()
    for k, length in enumerate(lengths):
        low, high = speeds[k], limit[k + 1]
        if high <= low or _is_feasible(low, high, length, max_sdd[k], max_sddd[k]):
            continue
        for _ in range(40):  # of a speed's bracket: to 1e-12 of it
            middle = 0.5 * (low + high)
            if _is_feasible(speeds[k], middle, length, max_sdd[k], max_sddd[k]):
                low = middle
            else:
                high = middle
        speeds[k + 1] = low
    return speeds


def _is_feasible(v0: float, v1: float, length: float, max_sdd: float, max_sddd: float) -> bool:
    """Return whether a cycloidal change of speed along a piece keeps the limits."""
    T = 2.0 * length / (v0 + v1)
    return 2.0 * (v1 - v0) <= max_sdd * T and 2.0 * np.pi * (v1 - v0) <= max_sddd * T * T
