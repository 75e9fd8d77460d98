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

"""Motions that start moving, slowed after their first segments until they keep every limit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from rrr_traj_planner.core.cancellation import until_found
from rrr_traj_planner.planners.joint_timing.dense_check import JointCheck
from rrr_traj_planner.planners.joint_timing.local_repairs import Span
from rrr_traj_planner.planners.joint_timing.margins import Margins
from rrr_traj_planner.planners.joint_timing.problem import brought_within, JointProblem
from rrr_traj_planner.planners.joint_timing.within_limits import (
    beyond_range,
    fitted,
    kinematic_time_scale,
)
from rrr_traj_planner.planners.solver.interior_point import CentralPathPoint
from rrr_traj_planner.planners.solver.splines import time_scaled, Variables
from rrr_traj_planner.planners.torque_scaling import torque_time_scale

# Chosen values.
FIRST = 3        # segments that change so that the motion begins as given
MOST = 1.05      # factor on the times of the others
ROOM = 1e-6      # part by which they are slower than limits require
GAP = 5e-3       # of the first segments, as a part of their time
ROUNDS = 6       # in which their margins grow


def slowed_after_start(problem: JointProblem, motion: Variables) -> Variables | None:
    """
    Return a motion slowed by a common factor, but for its first segments: they are planned again.

    That takes some milliseconds, also where planning is to stop.

    Parameters
    ----------
    problem : JointProblem
        Of a motion that starts moving.
    motion : Variables
        One that exceeds limits slightly.

    Returns
    -------
    Variables or None
        None where a joint leaves its range, or the first segments cannot be so slow.

    """
    task, mesh = problem.task, problem.mesh
    trajectory = mesh.trajectory(task.points, motion)
    factor = max(kinematic_time_scale(task, trajectory), torque_time_scale(task, trajectory))
    if len(motion.T) <= FIRST or not factor <= MOST or beyond_range(task, trajectory).any():
        return None
    slower = time_scaled(motion, factor * (1.0 + ROOM))
    slower.v[0], slower.a[0] = motion.v[0], motion.a[0]
    head = Span(0, FIRST).problem(replace(problem, task=replace(
        task, should_stop=until_found(task.should_stop))))
    head = replace(head, durations=head.durations.from_motion())
    start, margins = Span(0, FIRST).motion(slower), Margins.none(head.mesh, FIRST)
    start = head.mesh.restored(head.task.points, start)
    for _ in range(ROUNDS):
        constraints = head.constraints(margins)
        within = brought_within(constraints, start, head.durations, head.task.should_stop)
        if within is None:
            return None
        found = head.minimised(constraints, CentralPathPoint(within, None), GAP).motion
        if fitted(head.task, head.mesh.trajectory(head.task.points, found), False) is not None:
            return Variables(*(np.concatenate((new, f[len(new):]))
                               for new, f in zip(found, slower)))
        margins = margins.widened(head.task, head.mesh, None, JointCheck(
            head.task, head.mesh, found))
    return None
