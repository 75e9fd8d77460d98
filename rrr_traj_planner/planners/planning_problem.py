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

"""A request, and the arm that is to meet it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.postures import Posture
from rrr_traj_planner.core.kinematics.travel_time import THROUGH, ViaPointBehaviour
from rrr_traj_planner.core.read_only import ReadOnlyArrays
from rrr_traj_planner.planners.request import PlanningRequest
from rrr_traj_planner.planners.via_points import checked_joint_positions, joint_via_points


@dataclass(frozen=True, eq=False)
class PlanningProblem(ReadOnlyArrays):
    """
    A request, and the arm that is to meet it.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Its limits, scaled as requested; slightly raised where a start that moves needs it.
    request : PlanningRequest
        Via points and how to pass them.
    start : ndarray, shape (3,), optional
        Joint positions [rad] where the motion starts, within the ranges; None: at the first via
        point.
    from_rest : JointLimits
        Limits of the parts of the motion that begin at rest: scaled as requested.
    note : str
        On limits that cannot be checked, for the plan; usually empty.

    """

    model: RobotModel
    limits: JointLimits
    request: PlanningRequest
    start: Array | None
    from_rest: JointLimits
    note: str = ''

    @property
    def asked(self) -> Posture:
        """Return what the request asks of the arm's posture."""
        return Posture(self.request.elbow, self.request.shoulder)

    @cached_property
    def tips(self) -> Array:
        """Return the tip's positions at the via points, shape (n, 3) [m]."""
        if self.request.via_points is not None:
            return self.request.via_points
        tips = forward_kinematics(self.model, self.given_joints)
        tips.setflags(write=False)
        return tips

    @cached_property
    def given_joints(self) -> Array:
        """
        Return the joint positions that the request gives for the via points, checked.

        Returns
        -------
        ndarray, shape (n, 3)
            [rad]; empty where it gives positions of the tip.

        Raises
        ------
        JointRangeError, LimitViolationError
            As of `checked_joint_positions`.

        """
        given = self.request.joint_via_points
        return np.zeros((0, 3)) if given is None else checked_joint_positions(
            self.model, self.limits, given)

    def joint_points(self, posture: Posture, passing: ViaPointBehaviour = THROUGH) -> Array:
        """
        Return joint positions of the start, if there is one, and of the via points.

        Parameters
        ----------
        posture : Posture
            Of all via points, so far as it is asked for; not of via points that are given as joint
            positions.
        passing : ViaPointBehaviour
            How the motion passes via points, for the choice of whole turns.

        Returns
        -------
        ndarray, shape (n, 3)
            [rad].

        Raises
        ------
        UnreachableError, JointRangeError, LimitViolationError
            As of `joint_via_points` and `checked_joint_positions`.

        """
        q = self.given_joints if self.request.via_points is None else joint_via_points(
            self.model, self.limits, self.request.via_points, self.start, posture, passing)
        return q if self.start is None else np.vstack((self.start, q))
