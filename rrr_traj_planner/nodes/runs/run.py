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

"""What was asked for, planned and executed in one run of a task on an arm."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.point_files.task import given, Task
from rrr_traj_planner.planners.registration import Registered
from rrr_traj_planner.planners.registry import planner
from rrr_traj_planner.planners.rests import Rests, rests_at_via_points


@dataclass(frozen=True, eq=False)
class Run:
    """
    One run: the task, the planner's response, and the recorded motion.

    Attributes
    ----------
    task : Task
        The via points that were asked for.
    config : PlannerConfig
        The planner's parameters.
    response : PlanTrajectory.Response
        The plan.
    planned : TrajectoryPoints
        Its points.
    recorded : TrajectoryPoints
        The arm's motion; time 0 is the start of the trajectory.
    torque : ndarray, shape (n, 3), optional
        Motor torques at the recorded points [N m]; None: the arm does not publish them.
    started : bool
        Whether the motion starts elsewhere than at the first via point.

    """

    task: Task
    config: PlannerConfig
    response: Any
    planned: TrajectoryPoints
    recorded: TrajectoryPoints
    torque: Array | None
    started: bool = False

    @cached_property
    def joint_via_points(self) -> Array | None:
        """Return the joint positions that the task gives for its via points, (n, 3) [rad]."""
        return self.task.joint_via_points(self.config.model.joint_names)

    @cached_property
    def tips(self) -> Array:
        """Return the tip's positions at the via points, shape (n, 3) [m]."""
        joints = self.joint_via_points
        return (self.task.via_points if joints is None
                else forward_kinematics(self.config.model, joints))

    @cached_property
    def rests(self) -> Rests:
        """Return where and how long the arm is to rest."""
        return rests_at_via_points(
            given(self.task.stop_at), given(self.task.dwell), len(self.tips), self.started)

    @property
    def planner(self) -> Registered:
        """Return the planner of the motion."""
        return planner(self.task.planner_id or self.config.default_planner_id)

    @property
    def follows_path(self) -> bool:
        """Return whether the planner is Cartesian: whether it plans the tip's path."""
        return self.planner.plan_path is not None
