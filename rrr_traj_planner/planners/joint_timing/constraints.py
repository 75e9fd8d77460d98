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

"""The joints' limits on position, velocity, acceleration, jerk and torque, for the solver."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from rrr_traj_planner.core.arm.compiled_arm import compiled
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.planners.effort_limits import effort_less_friction
from rrr_traj_planner.planners.solver.limits import DurationConstraints, FAR, Limits
from rrr_traj_planner.planners.solver.splines import Mesh, Variables
from rrr_traj_planner.planners.solver.timing_problem import TimingProblem, Workspace

# Relaxation of position bounds so that joints resting at a range's end have an interior [rad];
# below JOINT_ROUNDING.
EDGE = 5e-10

# Acceleration, over its limit, or without one in rad/s^2, that a joint may have towards the end of
# its range where it rests there: a barrier method needs an interior. Its excursion is of the third
# power, below JOINT_ROUNDING. Chosen.
OUTWARDS = 1e-4


class JointConstraints:
    """
    The joints' limits, less margins.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Infinite where there is none.
    mesh : Mesh
        Its n intervals in each segment.
    points : ndarray, shape (N + 1, 3)
        Via points [rad].
    margins : ndarray, shape (2, N, 2 n + 1, 3)
        Distance to keep from the ends of each joint's range at each point, upper and lower [rad].
    velocity_margins : ndarray, shape (N, 2 n + 1, 3)
        Subtracted from each joint's velocity limit at each point [rad/s].
    acceleration_margins : ndarray, shape (N, 2 n + 1, 3)
        Subtracted from each joint's acceleration limit at each point [rad/s^2].
    effort_margins : ndarray, shape (N, 2 n + 1, 3)
        Subtracted from each joint's effort limit at each point [N m].
    least_T : ndarray, shape (N,), optional
        Least durations of the segments [s].
    workspace : Workspace, optional
        Memory shared by problems that are solved one after the other.
    stays : ndarray of bool, shape (N - 1, 3, 3), optional
        Which of velocity, acceleration and jerk are zero at the via points, for each joint. Where
        velocity alone is, the joint is near an end of its range, and accelerates away from it.
    starts_moving : bool
        Whether jerk at the start is unknown; else it is zero.

    Attributes
    ----------
    effort : ndarray, shape (N, 2 n, 3)
        Bounds of the torques, less Coulomb friction and margins, at all points but a segment's
        first [N m].
    with_torque : bool
        Whether torque is limited; without it the joints are coupled through the durations only.

    """

    def __init__(self, model: RobotModel, limits: JointLimits, mesh: Mesh, points: Array,
                 margins: Array, velocity_margins: Array, acceleration_margins: Array,
                 effort_margins: Array, least_T: Array | None = None,
                 workspace: Workspace | None = None, stays: BoolArray | None = None,
                 starts_moving: bool = False) -> None:
        self.mesh, self.points, self.limits, self.least_T = mesh, points, limits, least_T
        self.with_torque = bool(np.isfinite(limits.max_effort).any())
        effort = effort_less_friction(model, limits)
        self.effort = (np.minimum(effort, FAR) - effort_margins)[:, 1:]
        self._workspace, self._stays = workspace, stays
        self._first_jerk = 0 if starts_moving else 1
        self._model, self._margins = model, margins
        self._velocity_margins, self._acceleration_margins = velocity_margins, acceleration_margins
        self._effort_margins = effort_margins

    @cached_property
    def problem(self) -> TimingProblem:
        """Return the problem that the solver works on."""
        lower, upper, bounded = self._bounds()
        N, P, _ = lower.shape
        general = np.zeros((P, 3), bool)
        general[1:] = self.with_torque
        effort = np.concatenate((np.full((N, 1, 3), FAR), self.effort), axis=1)
        arm = compiled(self._model) if self.with_torque else None
        return TimingProblem(self.mesh, self.points, Limits(
            lower, upper, bounded, -effort, effort, general, self.least_T, arm), self._workspace)

    def of_first(self, segments: int) -> JointConstraints:
        """
        Return the constraints on the first segments.

        Parameters
        ----------
        segments : int
            Their number.

        Returns
        -------
        JointConstraints
            On a motion that ends there.

        """
        n, least_T, stays = segments, self.least_T, self._stays
        return JointConstraints(
            self._model, self.limits, Mesh(self.mesh.parts[:n]), self.points[:n + 1],
            self._margins[:, :n], self._velocity_margins[:n], self._acceleration_margins[:n],
            self._effort_margins[:n], None if least_T is None else least_T[:n], None,
            None if stays is None else stays[:n - 1], self._first_jerk == 0)

    def is_within(self, motion: Variables) -> bool:
        """
        Return whether a motion is strictly within the constraints, to start from.

        Parameters
        ----------
        motion : Variables
            On this mesh.

        Returns
        -------
        bool
            False also where a joint that is to stay at a via point does not.

        """
        via = np.stack((motion.v, motion.a, motion.j), axis=1)[1:-1]
        stays = self._stays is None or not via[self._stays].any()
        return stays and self.problem.is_within(motion)

    def staying(self, motion: Variables) -> Variables:
        """
        Return a motion on which joints that are to stay at a via point do.

        Parameters
        ----------
        motion : Variables
            On this mesh.

        Returns
        -------
        Variables
            The same where none is to; else it may exceed other constraints.

        """
        if self._stays is None or not self._stays.any():
            return motion
        via = np.stack((motion.v, motion.a, motion.j), axis=1)
        via[1:-1][self._stays] = 0.0
        v, a, j = np.moveaxis(via, 1, 0)
        return self.mesh.restored(self.points, motion._replace(v=v, a=a, j=j))

    def fixing(self, durations: DurationConstraints) -> DurationConstraints:
        """
        Return the objective with jerk, and what is fixed where joints are to stay at via points.

        Parameters
        ----------
        durations : DurationConstraints
            Of the problem.

        Returns
        -------
        DurationConstraints
            For the solver.

        """
        fixed = durations.fixed.copy()
        if self._stays is not None:
            fixed[1:-1] |= self._stays
        return durations._replace(fixed=fixed, max_jerk=self.limits.max_jerk)

    def _bounds(self) -> tuple[Array, Array, BoolArray]:
        """Return lower and upper bounds on states (N, P, 12), and which are limited (P, 12)."""
        limits, n, N = self.limits, self.mesh.n, len(self.points) - 1
        bounds, bounded = np.zeros((2, N, 2 * n + 1, 4, 3)), np.zeros((2 * n + 1, 4, 3), bool)
        inside = np.r_[1:n, n + 1:2 * n + 1]  # not at the via points, where position is given
        fastest = limits.max_velocity - self._velocity_margins[:, 1:]
        hardest = limits.max_acceleration - self._acceleration_margins[:, 1:]
        above, below = self._margins[:, :, inside]
        for column, points, lowest, highest in (
                (0, inside, limits.min_position - EDGE + below,
                 limits.max_position + EDGE - above),
                (1, np.arange(1, 2 * n + 1), -fastest, fastest),
                (2, np.arange(1, 2 * n + 1), -hardest, hardest),
                (3, np.arange(self._first_jerk, n + 1), -limits.max_jerk, limits.max_jerk)):
            bounds[0][:, points, column] = np.maximum(lowest, -FAR)
            bounds[1][:, points, column] = np.minimum(highest, FAR)
            bounded[points, column] = np.isfinite(highest).any() or np.isfinite(lowest).any()
        if self._stays is not None and self._stays.any():
            via, largest = self.points[1:-1], OUTWARDS * limits.max_acceleration
            largest = np.where(np.isfinite(largest), largest, OUTWARDS)
            is_low = via - limits.min_position < limits.max_position - via
            for side, sign, there in ((0, -1.0, is_low), (1, 1.0, ~is_low)):
                at = bounds[side][:-1, n, 2]
                at[:] = np.where(self._stays[:, 0] & there, sign * largest, at)
            bounded[n, 2] |= self._stays[:, 0].any(axis=0)
        lower, upper = bounds.reshape(2, N, 2 * n + 1, 12)
        return lower, upper, bounded.reshape(-1, 12)
