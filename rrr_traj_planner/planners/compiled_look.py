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

"""Looks at a motion along a path by compiled code: `path_look.look` in native/look.c."""

from __future__ import annotations

import ctypes
from functools import lru_cache
from typing import Any

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.ramps import RampShape
from rrr_traj_planner.planners import compiled
from rrr_traj_planner.planners.ramp_chain import Grid, Motion

_Doubles = ctypes.POINTER(ctypes.c_double)


class _Look(ctypes.Structure):
    _fields_ = [
        *((name, ctypes.c_int32) for name in ('N', 'n', 'intervals', 'looks')),
        ('whole', ctypes.c_double),
        *((name, _Doubles) for name in ('ramp', 'ends', 'table', 'bounds'))]


def looked(ends: Array, table: Array, grid: Grid, m: Motion, bounds: Array, looks: int,
           excess: Array) -> tuple[float, float, float]:
    """
    Return what a look finds of a whole motion, and enter what it exceeds near its points.

    Parameters
    ----------
    ends, table : ndarray
        Of a `PathTable`: `ends` and `coefficients`.
    grid : Grid
        The family of motions.
    m : Motion
        Its unknowns.
    bounds : ndarray, shape (QUANTITIES,)
        As of `path_look.look`.
    looks : int
        Between two points.
    excess : ndarray, shape (N, 2 n + 1, QUANTITIES)
        Zeros, to be filled.

    Returns
    -------
    tuple of float
        Stretch, least and largest speed, as of `path_look.Seen`.

    """
    arrays = [np.ascontiguousarray(f, dtype=float) for f in (
        _ramp(grid.shape.cruise, looks), ends, table, bounds, *m)]
    ramp, ends, table, bounds, *unknowns = map(_pointer, arrays)
    found = np.empty(3)
    failed = compiled.LIBRARY.path_looked(
        ctypes.byref(_Look(len(m.T), grid.n, arrays[2].shape[2], looks,
                           float(grid.shape(1.0)[0]), ramp, ends, table, bounds)),
        *unknowns, _pointer(excess), excess.shape[2], _pointer(found))
    if failed:
        raise MemoryError('no memory for a look at a motion')
    stretch, slowest, fastest = found.tolist()
    return stretch, slowest, fastest


@lru_cache(maxsize=64)
def _ramp(cruise: float, looks: int) -> Array:
    """Return a unit ramp's values at all looks from its start on, (2 looks, 4)."""
    values = np.stack(RampShape(cruise)(np.arange(2 * looks) / (2 * looks)), axis=1)
    values.setflags(write=False)
    return values


def _pointer(array: Array) -> Any:
    return ctypes.cast(array.ctypes.data, _Doubles)
