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

from functools import cached_property, lru_cache

import numpy as np
from rrr_traj_planner.core.arm.compiled_arm import compiled
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.planners.effort_limits import effort_less_friction
from rrr_traj_planner.planners.solver.limits import DurationConstraints, FAR, Limits
from rrr_traj_planner.planners.solver.splines import Mesh, Variables
from rrr_traj_planner.planners.solver.timing_problem import TimingProblem
from rrr_traj_planner.planners.solver.workspace import Workspace

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
        Subtracted from each joint's acceleration limit at each point [rad/s^2]. This and the two
        before: of one segment, if those of all are alike.
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
        self._effort = effort_less_friction(model, limits)
        self._workspace, self._stays = workspace, stays
        self._first_jerk = 0 if starts_moving else 1
        self._model, self._margins = model, margins
        self._velocity_margins, self._acceleration_margins = velocity_margins, acceleration_margins
        self._effort_margins = effort_margins

    @property
    def effort(self) -> Array:
        """Bounds of torques less Coulomb friction, but at first points, (N, 2 n, 3) [N m]."""
        return np.asarray((np.minimum(self._effort, FAR) - self._effort_margins)[:, 1:])

    @cached_property
    def problem(self) -> TimingProblem:
        """Return the problem that the solver works on."""
        lower, upper, bounded = self._bounds()
        N, P = len(self.points) - 1, lower.shape[1]
        general = np.zeros((P, 3 if self.with_torque else 0), bool)
        effort, arm = np.full((N, *general.shape), FAR), None
        if self.with_torque:
            general[1:], effort[:, 1:], arm = True, self.effort, compiled(self._model)
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
        if self._stays is not None and self._stays.any():
            via = np.stack((motion.v, motion.a, motion.j), axis=1)[1:-1]
            if via[self._stays].any():
                return False
        return self.problem.is_within(motion)

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
        """Return lower and upper bounds on states (N or 1, P, 12), and which are limited."""
        limits, n, N = self.limits, self.mesh.n, self._margins.shape[1]
        if self._stays is not None and self._stays.any():
            N = len(self.points) - 1
        lower, upper = bounds = np.empty((2, N, 2 * n + 1, 4, 3))
        upper[:, :, 0] = limits.max_position + EDGE - self._margins[0]
        upper[:, :, 1] = limits.max_velocity - self._velocity_margins
        upper[:, :, 2] = limits.max_acceleration - self._acceleration_margins
        upper[:, :, 3] = limits.max_jerk
        lower[:, :, 0] = limits.min_position - EDGE + self._margins[1]
        np.negative(upper[:, :, 1:], out=lower[:, :, 1:])
        np.minimum(np.maximum(bounds, -FAR, out=bounds), FAR, out=bounds)
        finite = (np.isfinite(limit).any() for limit in (
            (limits.min_position, limits.max_position), limits.max_velocity,
            limits.max_acceleration, limits.max_jerk))
        bounded = _bounded_points(n, self._first_jerk, tuple(map(bool, finite))).copy()
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


@lru_cache
def _bounded_points(n: int, first_jerk: int, limited: tuple[bool, bool, bool, bool]) -> BoolArray:
    """Return where the limited ones of q, qd, qdd and jerk have bounds, (P, 4, 3)."""
    found = np.zeros((2 * n + 1, 4, 3), bool)
    found[1:n, 0] = found[n + 1:, 0] = True  # not at the via points, where position is given
    found[1:, 1:3] = True
    found[first_jerk:n + 1, 3] = True
    return np.asarray(found & np.array(limited)[:, np.newaxis])
