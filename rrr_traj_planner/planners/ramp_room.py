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
What is kept free of limits, for what happens between the points that are looked at.

A motion planned on points exceeds limits a little between them. Room is made there, and nowhere
else, and the motion is planned again.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.dynamics import gravity_torque
from rrr_traj_planner.planners.ramp_chain import Grid, Motion
from rrr_traj_planner.planners.ramp_constraints import Constraints
from rrr_traj_planner.planners.ramp_look import Look
from rrr_traj_planner.planners.request import JointTask

LARGER = 1.2             # than what was exceeded
MOST_VELOCITY_ROOM = 0.1  # of a velocity limit


class Room(NamedTuple):
    """Room at every point of every segment."""

    positions: Array   # above and below, (2, N, 2 n + 1, 3)
    velocities: Array  # (N, 2 n + 1, 3)
    efforts: Array     # (N, 2 n + 1, 3)
    spare: Array       # half of what gravity leaves on a slow motion, likewise
    still: BoolArray   # via velocities that stay zero, (N - 1, 3)

    @classmethod
    def none(cls, grid: Grid, segments: int) -> Room:
        """
        Return no room at all.

        Parameters
        ----------
        grid : Grid
            The family of motions.
        segments : int
            Their number.

        Returns
        -------
        Room
            Zero everywhere.

        """
        zero = np.zeros((segments, 2 * grid.n + 1, 3))
        return cls(np.stack((zero, zero)), zero, zero, zero, np.zeros((segments - 1, 3), bool))

    def part(self, part: float) -> Room:
        """
        Return a part of it.

        Parameters
        ----------
        part : float
            1 for all of it.

        Returns
        -------
        Room
            Of the same still joints.

        """
        return self._replace(positions=part * self.positions, velocities=part * self.velocities,
                             efforts=part * self.efforts)

    def is_same(self, other: Room) -> bool:
        """
        Return whether there is as much room elsewhere.

        Parameters
        ----------
        other : Room
            Of the same motions.

        Returns
        -------
        bool
            True where every value is the same.

        """
        return all(np.array_equal(a, b) for a, b in zip(self, other))

    def kept(self) -> Room:
        """
        Return what a slow motion can keep.

        Returns
        -------
        Room
            Of efforts, at most half of what gravity leaves.

        """
        return self._replace(efforts=np.minimum(self.efforts, self.spare))

    def constraints(self, task: JointTask, grid: Grid, floor: Array | None) -> Constraints:
        """
        Return the limits with this room.

        Parameters
        ----------
        task : JointTask
            The via points, the arm and its limits.
        grid : Grid
            The family of motions.
        floor : ndarray, shape (N,), optional
            Least durations of the segments [s].

        Returns
        -------
        Constraints
            What the method works with.

        """
        return Constraints(task.model, task.limits, grid, task.points, self.positions,
                           self.velocities, self.efforts, floor)

    def grown(self, task: JointTask, grid: Grid, slow: Motion, look: Look) -> Room:
        """
        Return more room where a motion breaks limits.

        Parameters
        ----------
        task : JointTask
            The via points, the arm and its limits.
        grid : Grid
            The family of motions.
        slow : Motion
            With stops at the via points; positions get no more room than it leaves.
        look : Look
            At a motion that breaks limits.

        Returns
        -------
        Room
            As it was where no limit is broken.

        """
        q = grid.states(task.points, slow).q
        positions, still = self._positions(task, q, look.beyond_range)
        spare = task.limits.max_effort - np.abs(gravity_torque(task.model, q))
        velocity, effort = look.excess()
        return Room(
            positions, np.minimum(self.velocities + LARGER * velocity,
                                  MOST_VELOCITY_ROOM * task.limits.max_velocity),
            self.efforts + LARGER * effort, 0.5 * np.maximum(spare, 0.0), still)

    def _positions(self, task: JointTask, q: Array, beyond: Array) -> tuple[Array, BoolArray]:
        """Keep joints further inside their range; at via points too near its end, at rest."""
        room = np.stack((task.limits.max_position - q, q - task.limits.min_position))
        most = self.positions.max(axis=2) + LARGER * beyond
        wanted = np.where((beyond > 0.0)[:, :, np.newaxis], most[:, :, np.newaxis], self.positions)
        positions = np.minimum(wanted, np.maximum(0.5 * room, 0.0))
        ends = np.stack((task.points[:-1], task.points[1:]))
        room = np.stack((task.limits.max_position - ends, ends - task.limits.min_position))
        at_start, at_end = ((beyond > 0.0) & (room[:, k] <= 2.0 * most) for k in (0, 1))
        return positions, self.still | (at_end[:, :-1] | at_start[:, 1:]).any(axis=0)
