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
Constraint margins: how far within its limits a motion is to stay at the points of the problem.

A motion that keeps its limits at the points exceeds them a little between. There, and nowhere
else, margins at the points beside are made as large as what was exceeded, and the problem is
solved again.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque
from rrr_traj_planner.planners.joint_timing.dense_check import DenseCheck
from rrr_traj_planner.planners.request import JointTask
from rrr_traj_planner.planners.solver.ramps import Grid, Variables

LARGER = 1.2             # than what was exceeded
MOST_VELOCITY_MARGIN = 0.1  # part of a velocity limit


class Margins(NamedTuple):
    """Margins at every point of every segment."""

    positions: Array   # above and below, (2, N, 2 n + 1, 3)
    velocities: Array  # (N, 2 n + 1, 3)
    efforts: Array     # (N, 2 n + 1, 3)
    spare: Array       # half of what gravity leaves on a slow motion, likewise
    at_rest: BoolArray   # via velocities that stay zero, (N - 1, 3)

    @classmethod
    def none(cls, grid: Grid, segments: int) -> Margins:
        """
        Return none at all.

        Parameters
        ----------
        grid : Grid
            The family of motions.
        segments : int
            Their number.

        Returns
        -------
        Margins
            Zero everywhere.

        """
        zero = np.zeros((segments, 2 * grid.n + 1, 3))
        return cls(np.stack((zero, zero)), zero, zero, zero, np.zeros((segments - 1, 3), bool))

    def part(self, part: float) -> Margins:
        """
        Return a part of them.

        Parameters
        ----------
        part : float
            1 for all of them.

        Returns
        -------
        Margins
            Of the same at_rest joints.

        """
        return self._replace(positions=part * self.positions, velocities=part * self.velocities,
                             efforts=part * self.efforts)

    def is_same(self, other: Margins) -> bool:
        """
        Return whether others are the same.

        Parameters
        ----------
        other : Margins
            Of the same motions.

        Returns
        -------
        bool
            True where every value is the same.

        """
        return all(np.array_equal(a, b) for a, b in zip(self, other))

    def of_slow_motion(self) -> Margins:
        """
        Return as much of them as a slow motion can keep.

        Returns
        -------
        Margins
            Of efforts at most half of what gravity leaves.

        """
        return self._replace(efforts=np.minimum(self.efforts, self.spare))

    def widened(self, task: JointTask, grid: Grid, slow: Variables, check: DenseCheck) -> Margins:
        """
        Return larger ones where a motion breaks limits.

        Parameters
        ----------
        task : JointTask
            The via points, the arm and its limits.
        grid : Grid
            The family of motions.
        slow : Variables
            With stops at the via points; margins of positions are at most half of its own.
        check : DenseCheck
            Of a motion that breaks limits.

        Returns
        -------
        Margins
            As it was where no limit is broken.

        """
        q = grid.states(task.points, slow).q
        positions, at_rest = self._positions(task, q, check.beyond_range)
        spare = task.limits.max_effort - np.abs(gravity_torque(task.model, q))
        velocity, effort = check.excess()
        return Margins(
            positions, np.minimum(self.velocities + LARGER * velocity,
                                  MOST_VELOCITY_MARGIN * task.limits.max_velocity),
            self.efforts + LARGER * effort, 0.5 * np.maximum(spare, 0.0), at_rest)

    def _positions(self, task: JointTask, q: Array, beyond: Array) -> tuple[Array, BoolArray]:
        """Keep joints further inside their range; at via points too near its end, at rest."""
        room = np.stack((task.limits.max_position - q, q - task.limits.min_position))
        most = self.positions.max(axis=2) + LARGER * beyond
        wanted = np.where((beyond > 0.0)[:, :, np.newaxis], most[:, :, np.newaxis], self.positions)
        positions = np.minimum(wanted, np.maximum(0.5 * room, 0.0))
        ends = np.stack((task.points[:-1], task.points[1:]))
        room = np.stack((task.limits.max_position - ends, ends - task.limits.min_position))
        at_start, at_end = ((beyond > 0.0) & (room[:, k] <= 2.0 * most) for k in (0, 1))
        return positions, self.at_rest | (at_end[:, :-1] | at_start[:, 1:]).any(axis=0)
