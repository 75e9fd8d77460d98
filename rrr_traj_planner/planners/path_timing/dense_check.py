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

"""Dense check of a motion along a path: by how much it exceeds limits between the points."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.planners.path_timing.constraints import least_time_scale, limited_quantities
from rrr_traj_planner.planners.solver.excess import excess_near_points
from rrr_traj_planner.planners.solver.splines import Variables
from rrr_traj_planner.planners.solver.timing_problem import TimingProblem

# Samples between two points, chosen: half as many make 48 random motions 0.02 % slower in the
# mean, 0.2 % at most; twice as many make them 0.006 % faster.
CHECKS = 8
# Part of the largest speed up to which a negative speed is rounding; chosen: many times 2^-52.
BACKWARD = 1e-12


class PathCheck(NamedTuple):
    """The result of a dense check of a motion."""

    excess: Array   # of every limited quantity near each point, (N, 2 n + 1, QUANTITIES)
    time_scale: float  # least factor on all times with which limits hold
    slowest: float  # least speed of the tip [m/s]
    fastest: float  # largest [m/s]

    @property
    def is_forward(self) -> bool:
        """Return whether the tip never moves backward."""
        return self.slowest >= -BACKWARD * self.fastest


def dense_check(problem: TimingProblem, m: Variables, bounds: Array,
                reserve: Array | float = 0.0) -> PathCheck:
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
    reserve : ndarray, shape (N, 1, QUANTITIES), or float
        Taken off the bounds.

    Returns
    -------
    PathCheck
        With CHECKS samples between two points.

    """
    viscous = problem.limits.viscous
    assert viscous is not None  # there is one along a path
    z = problem.mesh.samples(problem.points, m, 2 * CHECKS)[..., 0]
    x, gravity = limited_quantities(problem, z, at_points=False)
    reserved = x + np.sign(x) * reserve
    return PathCheck(excess_near_points(reserved, bounds, CHECKS, reach=CHECKS),
                     least_time_scale(x, gravity, viscous, bounds - reserve),
                     float(z[:, :, 1].min()), float(z[:, :, 1].max()))
