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

"""The compiled kernels of the planners, `planners/native`, and memory for their arrays."""

from __future__ import annotations

from collections.abc import Mapping
from ctypes import c_double, c_int32, c_int64, c_void_p
from itertools import accumulate
import math

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kernels import declared

KERNELS = declared({
    'largest_displacement_at': (None, [c_int32, *[c_void_p] * 10]),
    'largest_velocity_changes': (None, [c_int32, *[c_void_p] * 4]),
    'least_transition_times': (None, [c_int32, *[c_void_p] * 4]),
    'cruise_covering': (None, [c_int32, c_int32, *[c_void_p] * 8]),
    'via_attempt': (c_double, [c_void_p, c_double]),
    'via_begin': (None, [c_void_p]),
    'via_accept': (None, [c_void_p, c_double]),
    'via_damp': (None, [c_void_p, c_double, c_double]),
    'excess_near_points': (None, [*[c_int32] * 5, c_void_p, c_void_p, c_double, *[c_void_p] * 2]),
    'jerks_on_mesh': (None, [*[c_int32] * 3, *[c_void_p] * 2, c_int32, *[c_void_p] * 2]),
    'path_quantities': (None, [c_void_p, c_int32, c_int32, *[c_void_p] * 3]),
    'range_excess': (None, [*[c_int32] * 3, *[c_void_p] * 4, c_double, *[c_void_p] * 2]),
    'refined_parts': (None, [*[c_int32] * 2, *[c_void_p] * 4]),
    'rise_between_samples': (None, [*[c_int32] * 3, c_void_p, c_void_p]),
    'spline_meet_points': (None, [*[c_int32] * 3, *[c_void_p] * 4]),
    'spline_restoring_shapes': (None, [*[c_int32] * 2, *[c_void_p] * 2]),
    'spline_sample': (None, [*[c_int32] * 3, *[c_void_p] * 3, *[c_int32] * 2, c_void_p]),
    'timing_accept': (None, [c_void_p, c_void_p, c_int32, *[c_double] * 3]),
    'timing_central_duals': (None, [c_void_p, c_double]),
    'timing_reduce_shifts': (None, [c_void_p, c_void_p, c_double, c_double]),
    'timing_correct': (c_int32, [c_void_p, c_void_p, c_double, c_void_p]),
    'timing_cost': (c_double, [c_void_p] * 2),
    'timing_constraint_count': (c_double, [c_void_p]),
    'timing_linearise': (None, [c_void_p, c_double]),
    'timing_log_sum': (c_double, [c_void_p] * 2),
    'timing_newton': (c_int32, [c_void_p, c_int32, c_void_p]),
    'timing_newton_size': (c_int64, [c_void_p]),
    'timing_slacks': (c_double, [c_void_p] * 3),
    'timing_trial': (c_int32, [c_void_p, c_void_p, *[c_double] * 3]),
})


class Arena:
    """
    Memory for the arrays of one problem, allocated as one block.

    Parameters
    ----------
    shapes : mapping of str to tuple of int
        Of each array.

    Attributes
    ----------
    addresses : dict of str to int
        Of each array's first number.

    """

    def __init__(self, shapes: Mapping[str, tuple[int, ...]]) -> None:
        self._shapes = shapes
        ends = list(accumulate(map(math.prod, shapes.values()), initial=0))
        self._parts = dict(zip(shapes, zip(ends, ends[1:])))
        self._block = np.empty(ends[-1])
        self._views: dict[str, Array] = {}
        first, size = self._block.ctypes.data, self._block.itemsize
        self.addresses = {name: first + size * start for name, start in zip(shapes, ends)}

    def __getitem__(self, name: str) -> Array:
        """Return an array: a view of the memory that kernels write into."""
        if name not in self._views:
            start, end = self._parts[name]
            self._views[name] = self._block[start:end].reshape(self._shapes[name])
        return self._views[name]
