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

"""Conversion of tasks to requests, and of trajectory messages to arrays, for a client."""

from __future__ import annotations

from geometry_msgs.msg import Pose, PoseArray
import numpy as np
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.nodes.output.message_times import seconds
from rrr_traj_planner.nodes.parameters.configuration_files import Task
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from trajectory_msgs.msg import JointTrajectory


def plan_request(task: Task) -> PlanTrajectory.Request:
    """
    Return the request message of a task.

    Parameters
    ----------
    task : Task
        Via points, planner and durations.

    Returns
    -------
    PlanTrajectory.Request
        Other fields are empty, so that the node's defaults apply.

    """
    request = PlanTrajectory.Request(planner_id=task.planner_id)
    request.segment_durations = task.segment_durations.tolist()
    request.via_points = PoseArray(poses=[Pose() for _ in task.via_points])
    for pose, (x, y, z) in zip(request.via_points.poses, task.via_points.tolist()):
        pose.position.x, pose.position.y, pose.position.z = x, y, z
    return request


def trajectory_points(trajectory: JointTrajectory) -> TrajectoryPoints:
    """
    Return the points of a trajectory message.

    Parameters
    ----------
    trajectory : JointTrajectory
        Points with velocities and accelerations.

    Returns
    -------
    TrajectoryPoints
        Times are from the start of the trajectory.

    """
    points = trajectory.points
    times = [seconds(p.time_from_start) for p in points]
    return TrajectoryPoints(np.array(times), *(
        np.array([getattr(p, f) for p in points])
        for f in ('positions', 'velocities', 'accelerations')))
