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

"""Via velocities and cruises of segments by compiled code: the same steps, many times faster."""

from __future__ import annotations

from collections.abc import Callable
import ctypes
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.planners import compiled
from rrr_traj_planner.planners.barrier import LEAST_EIGENVALUE, TOLERATED
from rrr_traj_planner.planners.chain import Chain
from rrr_traj_planner.planners.segment import TransitionLaw


class VelocitySettings(NamedTuple):
    """Constants of the method, in the order of velocities.c."""

    relative_gap: float
    barrier_reduction: float
    centred: float
    polished: float
    sufficient_decrease: float
    more_damping: float
    less_damping: float
    rounding: float
    steps_to_centre: int
    tries: int


class _Settings(ctypes.Structure):
    _fields_ = [(name, ctypes.c_double) for name in VelocitySettings._fields[:8]] + [
        (name, ctypes.c_int32) for name in VelocitySettings._fields[8:]]


class _Chain(ctypes.Structure):
    _fields_ = [('n', ctypes.c_int32), *((name, ctypes.c_void_p) for name in (
        'displacements', 'slope', 'root', 'max_velocity', 'lowest', 'highest', 'floor',
        'proportions')), ('least_eigenvalue', ctypes.c_double),
        ('tolerated', ctypes.c_double)]


def followed(chain: Chain, floor: Array | None, proportions: Array | None, v: Array, T: Array,
             settings: VelocitySettings,
             should_stop: Callable[[], bool]) -> tuple[Array, Array, float]:
    """
    Return the least total time, or the least common stretch of given durations.

    Parameters
    ----------
    chain : Chain
        The via points.
    floor : ndarray, shape (n,), optional
        Least durations [s].
    proportions : ndarray, shape (n,), optional
        Durations whose common stretch is sought [s].
    v : ndarray, shape (n - 1, 3)
        Via velocities [rad/s] to begin with: strictly within the limits, with their durations.
    T : ndarray, shape (n,)
        Durations [s].
    settings : VelocitySettings
        Constants of the method.
    should_stop : callable
        Asked before every step; True ends the search with what it has.

    Returns
    -------
    tuple
        Via velocities (n - 1, 3), durations (n,) and the gap.

    """
    kept = [None if a is None else np.ascontiguousarray(a, dtype=float) for a in (
        chain.displacements, chain.law.slope, chain.law.root, chain.max_velocity, chain.lowest,
        chain.highest, floor, proportions)]
    place = np.concatenate((v.ravel(), T))
    gap = ctypes.c_double()
    with compiled.asked(should_stop) as stop:
        out_of_memory = compiled.LIBRARY.velocities_minimised(
            ctypes.byref(_Chain(len(T), *(None if a is None else a.ctypes.data for a in kept),
                                LEAST_EIGENVALUE, TOLERATED)),
            ctypes.byref(_Settings(*settings)), ctypes.c_void_p(place.ctypes.data), stop,
            ctypes.byref(gap))
    if out_of_memory:
        raise MemoryError('no memory for the interior-point method')
    return place[:v.size].reshape(v.shape), place[v.size:], gap.value


def cruise_covering(law: TransitionLaw, low: Array, high: Array, a: Array, b: Array, T: Array,
                    D: Array, bisections: int) -> Array:
    """
    Return cruises that cover displacements; see `segment_motion`.

    Parameters
    ----------
    law : TransitionLaw
        Transitions' least durations.
    low, high : ndarray, shape (n, 3)
        Cruises that cover too little, and enough [rad/s].
    a, b : ndarray, shape (n, 3)
        Velocities at the ends [rad/s], not above the cruises.
    T : ndarray, shape (n, 1)
        Durations [s].
    D : ndarray, shape (n, 3)
        Displacements [rad].
    bisections : int
        How often the range is halved.

    Returns
    -------
    ndarray, shape (n, 3)
        [rad/s].

    """
    found = high.copy()
    kept = [np.ascontiguousarray(x, dtype=float) for x in (*law, low, a, b, T, D)]
    compiled.LIBRARY.cruise_covering(
        ctypes.c_int32(len(T)), ctypes.c_int32(bisections),
        *(ctypes.c_void_p(x.ctypes.data) for x in (*kept, found)))
    return found
