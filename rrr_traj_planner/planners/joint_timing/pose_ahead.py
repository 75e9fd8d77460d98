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
A way on for an arm that cannot stop where it moves: through a pose ahead of it.

Where a joint moves fast towards poses that gravity makes hard to hold, its motor may be too weak
to stop it; but the arm may fold while it goes on.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.planners.joint_timing.problem import Solved
from rrr_traj_planner.planners.sampling_jerk_limit import acceleration_scale
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.via_points import can_hold

# Tried in turn, over the time in which the joints would stop by the torque and inertia of their
# best poses: what gravity leaves of a torque may be a small part. Chosen: the first four plan for
# 11 of 23 random states in which the arm cannot stop; one of 10,000 states of planned motions
# needs one of the others.
AHEAD = (32.0, 64.0, 16.0, 1.0, 128.0, 4.0)


def through_a_pose_ahead(task: JointTask,
                         fastest: Callable[[JointTask], Solved | None]) -> Solved | None:
    """
    Return a motion that passes a pose ahead of the arm, then the via points.

    Parameters
    ----------
    task : JointTask
        The arm, its limits, the via points and how the joints move at the start.
    fastest : callable
        Returns the fastest motion of a task that goes straight on; None where none is found.

    Returns
    -------
    Solved or None
        Without the pose among its via points; None where no pose leads to a motion.

    """
    for pose in _poses_ahead(task):
        task.should_stop()
        found = fastest(replace(task, points=np.insert(task.points, 1, pose, axis=0)))
        if found is not None:
            passed = found.trajectory
            return found._replace(trajectory=PiecewiseTrajectory(
                passed.profiles, np.delete(passed.via_times, 1), passed.note))
    return None


def _poses_ahead(task: JointTask) -> Array:
    """Return the poses that the arm would have if it went on as it moves, and that it can hold."""
    velocity, limits = task.rates_at_start.velocity, task.limits
    to_stop = np.max(np.abs(velocity) / acceleration_scale(task.model, limits, task.points))
    q = np.clip(task.points[0] + np.outer(AHEAD, to_stop * velocity),
                limits.min_position, limits.max_position)
    return np.asarray(q[can_hold(task.model, limits, q)])
