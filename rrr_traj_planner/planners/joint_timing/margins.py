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
Constraint margins: by how much limits are tightened at the points of the problem.

A motion that keeps its limits at the points may exceed them slightly between. At the points beside
such a place, and nowhere else, margins are enlarged by the excess, and the problem is solved again
(an exchange method: Hettich & Kortanek, SIAM Review 35, 1993).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque
from rrr_traj_planner.planners.effort_limits import effort_less_friction
from rrr_traj_planner.planners.joint_timing.dense_check import JointCheck
from rrr_traj_planner.planners.solver.splines import Mesh, Variables
from rrr_traj_planner.planners.tasks import JointTask

LARGER = 1.2                # enlargement of a margin, over the excess; chosen
# Enlargement of positions' margins besides [rad]: in long motions some segment's last 1e-6 rad
# took round after round. Chosen.
MORE = 1e-5
MOST_MARGIN = 0.1           # part of a limit on velocity or acceleration; chosen


class Margins(NamedTuple):
    """Margins at every point of every segment."""

    positions: Array   # upper and lower [rad], (2, N, 2 n + 1, 3)
    velocities: Array  # [rad/s], (N, 2 n + 1, 3)
    accelerations: Array  # [rad/s^2], likewise
    efforts: Array     # [N m], (N, 2 n + 1, 3)
    gravity_margins: Array  # half the torque that is left to a slow motion [N m], likewise
    stays: BoolArray  # which of via velocity, acceleration and jerk are zero, (N - 1, 3, 3)

    @classmethod
    def none(cls, mesh: Mesh, segments: int) -> Margins:
        """
        Return zero margins.

        Parameters
        ----------
        mesh : Mesh
            Its n intervals in each segment.
        segments : int
            Their number.

        Returns
        -------
        Margins
            Zero everywhere.

        """
        zero = np.zeros((segments, 2 * mesh.n + 1, 3))
        return cls(np.stack((zero, zero)), zero, zero, zero, zero,
                   np.zeros((segments - 1, 3, 3), bool))

    @property
    def tighten(self) -> bool:
        """Whether any limit is tightened, or any joint is to stay at a via point."""
        return any(margin.any() for margin in (self.positions, self.velocities,
                                               self.accelerations, self.efforts, self.stays))

    def copy(self) -> Margins:
        """Return the same margins in memory of their own."""
        return Margins(self.positions.copy(), self.velocities.copy(), self.accelerations.copy(),
                       self.efforts.copy(), self.gravity_margins.copy(), self.stays.copy())

    def part(self, part: float) -> Margins:
        """
        Return the margins scaled down.

        Parameters
        ----------
        part : float
            The factor, at most 1.

        Returns
        -------
        Margins
            With the same joints at rest.

        """
        return self._replace(positions=part * self.positions, velocities=part * self.velocities,
                             accelerations=part * self.accelerations,
                             efforts=part * self.efforts)

    def is_same(self, other: Margins) -> bool:
        """
        Return whether other margins are equal.

        Parameters
        ----------
        other : Margins
            For the same problem.

        Returns
        -------
        bool
            True where every value is the same.

        """
        return all(np.array_equal(a, b) for a, b in zip(self, other))

    def of_slow_motion(self) -> Margins:
        """
        Return the margins, reduced to what a slow motion can satisfy.

        Returns
        -------
        Margins
            Those of efforts are at most half of what gravity and Coulomb friction leave of the
            limits.

        """
        return self._replace(efforts=np.minimum(self.efforts, self.gravity_margins))

    def widened(self, task: JointTask, mesh: Mesh, slow: Variables | None,
                check: JointCheck) -> Margins:
        """
        Return margins enlarged where a motion exceeds limits.

        Parameters
        ----------
        task : JointTask
            The via points, the arm and its limits.
        mesh : Mesh
            Its n intervals in each segment.
        slow : Variables, optional
            With stops at the via points; margins of positions are at most half its distance to
            the ends of the ranges, those of efforts half of what gravity leaves. None: no bound.
        check : JointCheck
            Of a motion that exceeds limits.

        Returns
        -------
        Margins
            Unchanged where no limit is exceeded.

        """
        q = None if slow is None else mesh.states(task.points, slow).q
        positions, stays = self._positions(task, q, check.beyond_range)
        gravity_margins = effort_less_friction(task.model, task.limits) - (
            0.0 if q is None else np.abs(gravity_torque(task.model, q)))
        gravity_margins = np.broadcast_to(gravity_margins, self.efforts.shape)
        velocity, acceleration, effort = check.excess()
        return Margins(
            positions, np.minimum(self.velocities + LARGER * velocity,
                                  MOST_MARGIN * task.limits.max_velocity),
            np.minimum(self.accelerations + LARGER * acceleration,
                       MOST_MARGIN * task.limits.max_acceleration),
            self.efforts + LARGER * effort, 0.5 * np.maximum(gravity_margins, 0.0), stays)

    def _positions(self, task: JointTask, q: Array | None,
                   beyond: Array) -> tuple[Array, BoolArray]:
        """Return margins of positions, and which joints stay at via points near a range's end."""
        distance = np.full((2, 1, 1, 1), np.inf) if q is None else np.stack(
            (task.limits.max_position - q, q - task.limits.min_position))
        needed = self.positions.max(axis=2) + LARGER * beyond
        target = np.where((beyond > 0.0)[:, :, np.newaxis], needed[:, :, np.newaxis] + MORE,
                          self.positions)
        positions = np.minimum(target, np.maximum(0.5 * distance, 0.0))
        ends = np.stack((task.points[:-1], task.points[1:]))
        distance = np.stack((task.limits.max_position - ends, ends - task.limits.min_position))
        at_start, at_end = ((beyond > 0.0) & (distance[:, k] <= 2.0 * needed) for k in (0, 1))
        near = (at_end[:, :-1] | at_start[:, 1:]).any(axis=0)[:, np.newaxis]
        # First the velocity is zero; where that is not enough, acceleration and jerk too.
        return positions, self.stays | (near & (self.stays[:, :1] | [[[True], [False], [False]]]))
