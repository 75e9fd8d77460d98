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
The interior-point method as compiled code, an optional extra: the same steps, many times faster.

The code is C in `native`, built with the package where there is a compiler. Where it is not there,
or RRR_TRAJ_PLANNER_COMPILED is 0 in the environment, NumPy does the same.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
import ctypes
from importlib.machinery import EXTENSION_SUFFIXES
import os
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.planners.limit_tables import Tables
from rrr_traj_planner.planners.ramp_chain import Grid, Motion
from rrr_traj_planner.planners.ramp_newton import Freedom

CENTRES = 40  # at most; as in chain.h

# What the library must have; other modules wrap all but the first.
FUNCTIONS = 'chain_minimised', 'path_looked'

_Doubles = ctypes.POINTER(ctypes.c_double)
_Bytes = ctypes.POINTER(ctypes.c_uint8)
_ShouldStop = ctypes.CFUNCTYPE(ctypes.c_int32)


class Settings(NamedTuple):
    """Constants of the method, in the order of chain.h."""

    relative_gap: float
    barrier_reduction: float
    centred: float
    stall: float
    start: float
    far_from_centre: float
    dual_corridor: float
    sufficient_gain: float
    narrow: float
    least_bend: float
    to_boundary: float
    least_room_kept: float
    room_aimed_at: float
    longest_retry: float
    small_relief: float
    patience: int
    raises: int
    iterations: int
    backtracks: int


class Found(NamedTuple):
    """What the method ended with."""

    motion: Motion
    gap: float
    centres: list[tuple[Motion, float]]
    iterations: int
    within: bool           # whether all relief could be taken away


class _Settings(ctypes.Structure):
    _fields_ = [(name, ctypes.c_double) for name in Settings._fields[:15]] + [
        (name, ctypes.c_int32) for name in Settings._fields[15:]]


class _Problem(ctypes.Structure):
    _fields_ = [
        *((name, ctypes.c_int32) for name in ('J', 'N', 'n', 'kind', 'E', 'intervals')),
        *((name, ctypes.c_double) for name in ('whole', 'way', 'speed', 'peak')),
        *((name, _Doubles) for name in ('points', 'restore', 'lower', 'upper')),
        ('boxed', _Bytes), ('general_lower', _Doubles), ('general_upper', _Doubles),
        ('kept', _Bytes), ('floor', _Doubles), ('free', _Bytes), ('tie', _Doubles),
        ('weights', _Doubles), ('still', _Bytes), ('arm', _Doubles), ('table', _Doubles),
        ('overshoot', _Doubles), ('difference', ctypes.c_double)]


def _library() -> Any:
    """Return the compiled code, None where it is not there or not wanted."""
    if os.environ.get('RRR_TRAJ_PLANNER_COMPILED', '1') == '0':
        return None
    for suffix in EXTENSION_SUFFIXES:
        path = Path(__file__).parent / 'native' / f'kernels{suffix}'
        if path.exists():
            library = ctypes.CDLL(str(path))
            if all(hasattr(library, name) for name in FUNCTIONS):  # else it was built of others
                return library
    return None


LIBRARY = _library()


@contextmanager
def asked(should_stop: Callable[[], bool]) -> Iterator[Any]:
    """
    Give a question as C asks it; what it raises goes on where C has returned.

    Parameters
    ----------
    should_stop : callable
        The question.

    Yields
    ------
    object
        A function pointer; its answer is 1 to stop.

    """
    raised: list[BaseException] = []

    def stop() -> int:
        try:
            return int(should_stop())
        except BaseException as error:
            raised.append(error)
            return 1

    yield _ShouldStop(stop)
    if raised:
        raise raised[0]


class Compiled:
    """
    A problem as the compiled code sees it.

    Parameters
    ----------
    grid : Grid
        The family of motions.
    points : ndarray, shape (N + 1, J)
        Via points.
    tables : Tables
        The limits.
    freedom : Freedom
        What may change.
    settings : Settings
        Constants of the method.

    """

    def __init__(self, grid: Grid, points: Array, tables: Tables, freedom: Freedom,
                 settings: Settings) -> None:
        self._kept: list[NDArray[Any]] = []
        self._shape = len(points) - 1, grid.n, points.shape[1]
        (way, speed, _, _), whole = grid.shape(0.5), grid.shape(1.0)[0]
        intervals = 0 if tables.table is None else tables.table.shape[2]
        E = tables.general_lower.shape[-1]
        self._problem = _Problem(
            points.shape[1], len(points) - 1, grid.n, tables.kind, E, intervals,
            float(whole), float(way), float(speed), grid.shape.peak_jerk,
            *(self._doubles(f) for f in (points, grid.restore, tables.lower, tables.upper)),
            self._bytes(tables.boxed), self._doubles(tables.general_lower),
            self._doubles(tables.general_upper), self._bytes(tables.kept),
            self._doubles(tables.floor), self._bytes(freedom.free), self._doubles(freedom.tie),
            self._doubles(freedom.weights), self._bytes(freedom.still),
            self._doubles(tables.arm), self._doubles(tables.table),
            self._doubles(tables.overshoot), tables.difference)
        self._settings = _Settings(*settings)

    def minimised(self, start: Motion, barrier: float | None, least_barrier: float,
                  relief: Array | None, should_stop: Callable[[], bool]) -> Found:
        """
        Return the fastest motion; see `interior_point.minimise`.

        Parameters
        ----------
        start : Motion
            Strictly within the limits, relieved.
        barrier : float or None
            That keeps it there, where that is known.
        least_barrier : float
            The method ends at its centre.
        relief : ndarray or None
            See `relief.relief_in_tables`.
        should_stop : callable
            Asked before every iteration.

        Returns
        -------
        Found
            What it ended with.

        """
        flat = np.concatenate([f.ravel() for f in start])
        centres, barriers = np.empty((CENTRES, len(flat))), np.empty(CENTRES)
        gap, iterations, within = ctypes.c_double(), ctypes.c_int32(), ctypes.c_int32()
        with asked(should_stop) as stop:
            count = LIBRARY.chain_minimised(
                ctypes.byref(self._problem), ctypes.byref(self._settings), _pointer(flat),
                ctypes.c_double(barrier or 0.0), ctypes.c_double(least_barrier),
                self._doubles(relief), stop, ctypes.byref(gap), _pointer(centres),
                _pointer(barriers), ctypes.byref(iterations), ctypes.byref(within))
        if count < 0:
            raise MemoryError('no memory for the interior-point method')
        return Found(self._motion(flat), gap.value, [
            (self._motion(centres[i].copy()), float(barriers[i])) for i in range(count)],
            iterations.value, bool(within.value))

    def _motion(self, flat: Array) -> Motion:
        N, n, J = self._shape
        inner, v, a, T = np.split(flat, np.cumsum((
            N * (n - 1) * J, (N - 1) * J, (N - 1) * J)))
        return Motion(inner.reshape(N, n - 1, J), v.reshape(-1, J), a.reshape(-1, J), T)

    def _doubles(self, values: Array | None) -> Any:
        if values is None:
            return None
        array = np.ascontiguousarray(values, dtype=float)
        self._kept.append(array)
        return _pointer(array)

    def _bytes(self, values: BoolArray) -> Any:
        array = np.ascontiguousarray(values, dtype=np.uint8)
        self._kept.append(array)
        return ctypes.cast(array.ctypes.data, _Bytes)


def _pointer(array: Array) -> Any:
    return ctypes.cast(array.ctypes.data, _Doubles)
