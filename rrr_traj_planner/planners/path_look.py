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

"""A motion along a path at many times between its points: what it exceeds there, and where."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.planners import compiled, compiled_look
from rrr_traj_planner.planners.path_constraints import (
    ACCELERATION,
    JERK,
    limited,
    Progress,
    QUANTITIES,
    SPEED,
    TORQUE,
    VELOCITY,
)
from rrr_traj_planner.planners.path_table import Demand, PathTable
from rrr_traj_planner.planners.ramp_chain import Grid, Motion
from rrr_traj_planner.planners.ramp_look import near_points

LOOKS = 8        # between two points
BACKWARD = 1e-12  # of the largest speed, that is rounding


class Seen(NamedTuple):
    """What a look at a motion finds."""

    excess: Array   # of every limited quantity up to the points beside each, (N, 2 n + 1, K)
    stretch: float  # by how much the motion must be slowed; see `least_stretch`
    slowest: float  # speed of the tip [m/s]
    fastest: float

    @property
    def goes_on(self) -> bool:
        """Return whether the tip never goes back."""
        return self.slowest >= -BACKWARD * self.fastest


def look(table: PathTable, grid: Grid, m: Motion, bounds: Array) -> Seen:
    """
    Return what a motion exceeds between its points, as a table of the path has it.

    Parameters
    ----------
    table : PathTable
        What the path asks of the joints.
    grid : Grid
        The family of motions.
    m : Motion
        Its unknowns.
    bounds : ndarray, shape (QUANTITIES,)
        On magnitudes, infinite where there is none; on accelerations along the path there is.

    Returns
    -------
    Seen
        At LOOKS times between two points.

    """
    if compiled.LIBRARY is not None:
        excess = np.zeros((len(m.T), 2 * grid.n + 1, QUANTITIES))
        return Seen(excess, *compiled_look.looked(
            table.ends, table.coefficients, grid, m, bounds, LOOKS, excess))
    at = _between(table, grid, m)
    demand, = table(at.s)
    excess = near_points(np.abs(limited(demand, at)), bounds, LOOKS, LOOKS)
    return Seen(excess, least_stretch(demand, at, bounds), float(at.sd.min()),
                float(at.sd.max()))


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


def _between(table: PathTable, grid: Grid, m: Motion) -> Progress:
    """Return a motion's progress at many times of each piece, in order, (N, 2 n LOOKS + 1)."""
    profile = grid.profiles(table.ends[:, np.newaxis], m)[0]
    starts = np.concatenate(([0.0], np.cumsum(m.T)[:-1]))
    share = np.linspace(0.0, 1.0, 2 * grid.n * LOOKS + 1)
    t = starts[:, np.newaxis] + m.T[:, np.newaxis] * share
    s, sd, sdd, sddd = (f.reshape(t.shape) for f in profile(t.ravel()))
    return Progress(np.clip(s, table.ends[:-1, np.newaxis], table.ends[1:, np.newaxis]),
                    sd, sdd, sddd)
