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

from collections.abc import Sequence

from geometry_msgs.msg import Pose, PoseArray
import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.nodes.output.message_times import seconds
from rrr_traj_planner.nodes.point_files.task import Task
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint


def plan_request(task: Task, joint_names: Sequence[str]) -> PlanTrajectory.Request:
    """
    Return the request message of a task.

    Parameters
    ----------
    task : Task
        Via points, planner, durations, stops and rests.
    joint_names : sequence of str
        The arm's joints, whose order joint positions have in the message.

    Returns
    -------
    PlanTrajectory.Request
        Other fields are empty, so that the node's defaults apply.

    Raises
    ------
    InvalidInputError
        If the task has joint positions, but not of these joints.

    """
    request = PlanTrajectory.Request(
        planner_id=task.planner_id, segment_durations=task.segment_durations.tolist(),
        stop_at=task.stop_at.tolist(), dwell=task.dwell.tolist())
    joints = task.joint_via_points(joint_names)
    if joints is not None:
        request.joint_via_points = [JointTrajectoryPoint(positions=q) for q in joints.tolist()]
    request.via_points = PoseArray(poses=[Pose() for _ in task.via_points])
    request.via_points.header.frame_id = task.frame
    for pose, (x, y, z) in zip(request.via_points.poses, task.via_points.tolist()):
        pose.position.x, pose.position.y, pose.position.z = x, y, z
    return request


def way_to(q: Array, state: JointState, planner_id: str) -> PlanTrajectory.Request:
    """
    Return the request for the way from a state to joint positions.

    Parameters
    ----------
    q : ndarray, shape (3,)
        Where it ends, in the arm's order [rad].
    state : JointState
        Where it begins, at rest.
    planner_id : str
        The planner, in joint space.

    Returns
    -------
    PlanTrajectory.Request
        Other fields are empty.

    """
    request = PlanTrajectory.Request(
        planner_id=planner_id, joint_via_points=[JointTrajectoryPoint(positions=q.tolist())])
    request.start_state.name, request.start_state.position = list(state.name), list(state.position)
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
