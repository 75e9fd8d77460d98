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

"""The least-time problem of motions along a path."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.read_only import ReadOnlyArrays
from rrr_traj_planner.planners.path_timing.constraints import (
    all_bounds,
    PathConstraints,
    QUANTITIES,
    TORQUE,
)
from rrr_traj_planner.planners.path_timing.table import PathTable
from rrr_traj_planner.planners.path_timing.task import PathTask
from rrr_traj_planner.planners.solver.splines import Mesh
from rrr_traj_planner.planners.solver.workspace import Workspace


@dataclass(frozen=True, eq=False)
class PathProblem(ReadOnlyArrays):
    """
    Path and limits, and the family of motions.

    Parameters
    ----------
    task : PathTask
        Path and limits.
    table : PathTable
        The path's.
    mesh : Mesh
        Its n intervals in each piece.
    steady : ndarray of bool, shape (N,)
        Pieces along which the tip's speed is constant.

    """

    task: PathTask
    table: PathTable
    mesh: Mesh
    steady: BoolArray
    _workspace: Workspace = field(default_factory=Workspace)

    @cached_property
    def bounds(self) -> Array:
        """Return bounds on the magnitudes of all limited quantities, see `all_bounds`."""
        return all_bounds(self.task.limits, self.task.max_tip_speed)

    @cached_property
    def reserve(self) -> Array:
        """Return what is taken off the bounds on each piece, (N, 1, QUANTITIES)."""
        found = np.zeros((len(self.steady), 1, QUANTITIES))
        found[..., TORQUE] = self.table.reserve
        return found

    def constraints(self, margins: Array) -> PathConstraints:
        """
        Return the limits less margins.

        Parameters
        ----------
        margins : ndarray, shape (N, 2 n + 1, QUANTITIES)
            By which limits are tightened at the points.

        Returns
        -------
        PathConstraints
            As the solver takes them.

        """
        return PathConstraints(self.table, self.task.limits, self.task.max_tip_speed, self.mesh,
                               margins, self.steady, self._workspace)
