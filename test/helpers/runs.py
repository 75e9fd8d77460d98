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

"""Runs that are known: of an arm that follows its plan, or is off by a known angle."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from rrr_traj_planner.core.arm.model import JOINT_NAMES
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.parameters.table import PLANNER, rows_of
from rrr_traj_planner.nodes.planner_node.planning_answer import success
from rrr_traj_planner.nodes.point_files.task import given
from rrr_traj_planner.nodes.runs.run import Run
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest

BEFORE, AFTER, STATES = 0.5, 0.5, 800


def executed(task, off=0.0, **parameters):
    """Return a run on an arm that follows its plan but for an angle by which joint 1 is off."""
    config = PlannerConfig.from_values({
        **{name: row.default for name, row in rows_of(PLANNER, JOINT_NAMES).items()},
        **parameters})
    joints = task.joint_via_points(JOINT_NAMES)
    found = plan(config.model, config.limits, PlanningRequest(
        task.via_points if joints is None else None, joint_via_points=joints,
        stop_at=given(task.stop_at), dwell=given(task.dwell)))
    t = np.linspace(-BEFORE, found.points.duration + AFTER, STATES)
    q, qd, qdd, _ = spline_through(found.points).at(t)
    torque = inverse_dynamics(config.model, q, qd, qdd)
    q = q + (off, 0.0, 0.0)
    return Run(task, config, success(found, config), found.points,
               TrajectoryPoints(t, q, qd), torque)


def stopping(task, **changes):
    """Return a task with rests, of 0.5 s at the second via point."""
    return replace(task, stop_at=np.array([False, True, True]), dwell=np.array([0.1, 0.5, 0.2]),
                   **changes)
