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

"""How fast the tip may pass where pieces of a path meet: what a motion to begin from goes by."""

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

PART = 0.25       # of each limit, for the speed itself and for its changes
HALVINGS = 40


def paces(table: PathTable, bounds: Array) -> Array:
    """
    Return speeds at the ends of all pieces between which the tip can change its speed in time.

    Parameters
    ----------
    table : PathTable
        What the path asks of the joints.
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
        steady = _least(velocity / np.abs(d.dq), np.sqrt(acceleration / np.abs(d.ddq)),
                        np.cbrt(jerk / np.abs(d.dddq)), np.sqrt(torque / np.abs(d.c)))
        speeding = _least(acceleration / np.abs(d.dq), torque / np.abs(d.m))
        jerking = _least(jerk / np.abs(d.dq))
    steady = np.minimum(steady, PART * bounds[SPEED])
    lengths = np.diff(table.ends)
    limit = np.concatenate(([0.0], np.minimum(steady[:-1], steady[1:]), [0.0]))
    forth = _reachable(limit, lengths, speeding, jerking)
    back = _reachable(limit[::-1], lengths[::-1], speeding[::-1], jerking[::-1])[::-1]
    return np.minimum(forth, back)


def _least(*shares: Array) -> Array:
    """Return the least of each piece, over places and joints; what is not limited aside."""
    return np.asarray(np.min([np.nan_to_num(s, nan=np.inf, posinf=np.inf).min(axis=(1, 2))
                              for s in shares], axis=0))


def _reachable(limit: Array, lengths: Array, speeding: Array, jerking: Array) -> Array:
    """Return speeds that are not higher than what can be reached from the one before."""
    speeds = limit.copy()
    for k, length in enumerate(lengths):
        low, high = speeds[k], limit[k + 1]
        if high <= low or _may(low, high, length, speeding[k], jerking[k]):
            continue
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            if _may(speeds[k], middle, length, speeding[k], jerking[k]):
                low = middle
            else:
                high = middle
        speeds[k + 1] = low
    return speeds


def _may(v0: float, v1: float, length: float, speeding: float, jerking: float) -> bool:
    """Return whether a cycloid of velocity, from one speed to another, keeps the limits."""
    T = 2.0 * length / (v0 + v1)
    return 2.0 * (v1 - v0) <= speeding * T and 2.0 * np.pi * (v1 - v0) <= jerking * T * T
