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

"""Dense check of a motion along a path: what it exceeds between the points of the problem."""

from __future__ import annotations

import ctypes
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.motion_laws.ramps import RampShape
from rrr_traj_planner.planners.joint_timing.dense_check import ROUNDING
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
from rrr_traj_planner.planners.path_timing.table import Demand
from rrr_traj_planner.planners.solver.library import Arena, KERNELS
from rrr_traj_planner.planners.solver.ramps import Variables
from rrr_traj_planner.planners.solver.timing_problem import TimingProblem

CHECKS = 8        # between two points
CHECKED = 13      # quantities: all but acceleration along the path
BACKWARD = 1e-12  # of the largest speed, that is rounding


class DenseCheck(NamedTuple):
    """What a dense check of a motion finds."""

    excess: Array   # of every limited quantity up to the points beside each, (N, 2 n + 1, K)
    stretch: float  # by how much the motion must be slowed; see `least_stretch`
    slowest: float  # speed of the tip [m/s]
    fastest: float

    @property
    def goes_on(self) -> bool:
        """Return whether the tip never goes back."""
        return self.slowest >= -BACKWARD * self.fastest


class _PathCheck(ctypes.Structure):  # as in native/path_check.c
    _fields_ = [('checks', ctypes.c_int32), ('apart', ctypes.c_int32),
                ('rounding', ctypes.c_double),
                *((name, ctypes.c_void_p) for name in ('ramp', 'bounds', 'excess', 'scratch')),
                *((name, ctypes.c_double) for name in ('stretch', 'slowest', 'fastest'))]


def dense_check(problem: TimingProblem, m: Variables, bounds: Array) -> DenseCheck:
    """
    Return what a motion exceeds between its points, as a table of the path has it.

    Parameters
    ----------
    problem : TimingProblem
        Of the path.
    m : Variables
        Its unknowns.
    bounds : ndarray, shape (QUANTITIES,)
        On magnitudes, infinite where there is none; on accelerations along the path there is.

    Returns
    -------
    DenseCheck
        At CHECKS times between two points.

    """
    N, n, ramp = len(m.T), problem.grid.n, _unit_ramp(problem.grid.shape.cruise)
    arrays = Arena({'excess': (N, 2 * n + 1, QUANTITIES), 'bounds': (QUANTITIES,),
                    'scratch': ((CHECKED + 1) * (2 * n * CHECKS + 1) + n + 1,)})
    arrays['bounds'][:], arrays['excess'][:] = bounds, 0.0
    check = _PathCheck(CHECKS, QUANTITIES, ROUNDING, ramp=ramp.ctypes.data, **arrays.addresses)
    variables = np.concatenate([f.ravel() for f in m])
    KERNELS.path_checked(problem.at, ctypes.byref(check), variables.ctypes.data)
    return DenseCheck(arrays['excess'], check.stretch, check.slowest, check.fastest)


def least_stretch(demand: Demand, at: Progress, bounds: Array) -> float:
    """
    Return by how much a motion must be slowed for its limits at given points.

    Parameters
    ----------
    demand : Demand
        Of the path at the points.
    at : Progress
        Of the motion.
    bounds : ndarray, shape (..., QUANTITIES)
        On magnitudes, infinite where there is none.

    Returns
    -------
    float
        At most 1 where it keeps them as it is; infinite where no slowing helps.

    """
    x = limited(demand, at)
    share = np.abs(x) / bounds
    moving = x[..., TORQUE] - demand.g
    spare = bounds[..., TORQUE] - np.sign(moving) * demand.g
    with np.errstate(divide='ignore', invalid='ignore'):
        by_torque = np.where(moving != 0.0, np.abs(moving) / spare, 0.0)
    by_torque = np.where((spare <= 0.0) & (moving != 0.0), np.inf, by_torque)
    return float(max(share[..., VELOCITY].max(), share[..., SPEED].max(),
                     np.sqrt(share[..., ACCELERATION].max()),
                     np.cbrt(share[..., JERK].max()), np.sqrt(by_torque.max())))


@lru_cache(maxsize=64)
def _unit_ramp(cruise: float) -> Array:
    """Return a unit ramp's values at all checks from its start on, (2 CHECKS, 4)."""
    values = np.stack(RampShape(cruise)(np.arange(2 * CHECKS) / (2 * CHECKS)), axis=1)
    values.setflags(write=False)
    return values
