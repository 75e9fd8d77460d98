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
Dense check of a motion along a path: by how much it exceeds limits between the points.

Time scaling: Hollerbach, Dynamic scaling of manipulator trajectories, 1984.
"""

from __future__ import annotations

import ctypes
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.motion_laws.ramps import RampShape
from rrr_traj_planner.core.trajectory.time_scaling import squared_scaling
from rrr_traj_planner.planners.path_timing.constraints import (
    ACCELERATION,
    JERK,
    limited,
    Progress,
    QUANTITIES,
    SPEED,
    TORQUE,
    VELOCITY,
)
from rrr_traj_planner.planners.path_timing.table import PathTerms
from rrr_traj_planner.planners.solver.library import Arena, KERNELS, same_size_as
from rrr_traj_planner.planners.solver.ramps import Variables
from rrr_traj_planner.planners.solver.timing_problem import TimingProblem
from rrr_traj_planner.planners.tolerances import LIMIT_ROUNDING

CHECKS = 8        # samples between two points
CHECKED = 13      # number of quantities: all but acceleration along the path
BACKWARD = 1e-12  # part of the largest speed up to which a negative speed is rounding


class DenseCheck(NamedTuple):
    """The result of a dense check of a motion."""

    excess: Array   # of every limited quantity near each point, (N, 2 n + 1, QUANTITIES)
    time_scale: float  # least factor on all times with which limits hold
    slowest: float  # least speed of the tip [m/s]
    fastest: float  # largest [m/s]

    @property
    def is_forward(self) -> bool:
        """Return whether the tip never moves backward."""
        return self.slowest >= -BACKWARD * self.fastest


@same_size_as('size_of_path_check')
class _PathCheck(ctypes.Structure):  # as in native/path_check.c
    _fields_ = [('checks', ctypes.c_int32), ('stride', ctypes.c_int32),
                ('rounding', ctypes.c_double),
                *((name, ctypes.c_void_p) for name in ('ramp', 'bounds', 'excess', 'scratch')),
                *((name, ctypes.c_double) for name in ('time_scale', 'slowest', 'fastest'))]


def dense_check(problem: TimingProblem, m: Variables, bounds: Array) -> DenseCheck:
    """
    Return by how much a motion exceeds its limits between the points, by the path's table.

    Parameters
    ----------
    problem : TimingProblem
        Of the path.
    m : Variables
        The motion.
    bounds : ndarray, shape (QUANTITIES,)
        On magnitudes, infinite where there is none; that on acceleration along the path is not
        checked.

    Returns
    -------
    DenseCheck
        With CHECKS samples between two points.

    """
    N, n, ramp = len(m.T), problem.grid.n, _unit_ramp(problem.grid.shape.constant_jerk_fraction)
    arrays = Arena({'excess': (N, 2 * n + 1, QUANTITIES), 'bounds': (QUANTITIES,),
                    'scratch': ((CHECKED + 1) * (2 * n * CHECKS + 1) + n + 1,)})
    arrays['bounds'][:], arrays['excess'][:] = bounds, 0.0
    check = _PathCheck(
        CHECKS, QUANTITIES, LIMIT_ROUNDING, ramp=ramp.ctypes.data, **arrays.addresses)
    variables = np.concatenate([f.ravel() for f in m])
    KERNELS.check_path(problem.at, ctypes.byref(check), variables.ctypes.data)
    return DenseCheck(arrays['excess'], check.time_scale, check.slowest, check.fastest)


def least_time_scale(terms: PathTerms, at: Progress, bounds: Array) -> float:
    """
    Return the least factor on all times with which limits hold at given points.

    Parameters
    ----------
    terms : PathTerms
        Of the path at the points.
    at : Progress
        Of the motion.
    bounds : ndarray, shape (..., QUANTITIES)
        On magnitudes, infinite where there is none.

    Returns
    -------
    float
        At most 1 where they hold as it is; infinite where no factor helps.

    """
    x = limited(terms, at)
    ratio = np.abs(x) / bounds
    by_torque = squared_scaling(bounds[..., TORQUE], terms.g, x[..., TORQUE])
    return float(max(ratio[..., VELOCITY].max(), ratio[..., SPEED].max(),
                     np.sqrt(ratio[..., ACCELERATION].max()),
                     np.cbrt(ratio[..., JERK].max()), np.sqrt(by_torque.max())))


@lru_cache(maxsize=64)
def _unit_ramp(fraction: float) -> Array:
    """Return a unit ramp's q, qd, qdd and jerk at all samples, (2 CHECKS, 4)."""
    values = np.stack(RampShape(fraction)(np.arange(2 * CHECKS) / (2 * CHECKS)), axis=1)
    values.setflags(write=False)
    return values
