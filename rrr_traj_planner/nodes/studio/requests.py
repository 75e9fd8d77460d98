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

"""What the planner is asked for."""

from __future__ import annotations

from rrr_traj_planner.nodes.runs.messages import plan_request
from rrr_traj_planner.nodes.studio.wanted import Wanted
from rrr_traj_planner.planners.registry import planner
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from trajectory_msgs.msg import JointTrajectoryPoint


def request_of(wanted: Wanted) -> PlanTrajectory.Request:
    """
    Return the request for a motion.

    Parameters
    ----------
    wanted : Wanted
        The motion.

    Returns
    -------
    PlanTrajectory.Request
        From rest at the first via point.

    """
    request = plan_request(wanted.task, ())
    if wanted.joints is not None and wanted.joints_known:
        request.joint_via_points = [
            JointTrajectoryPoint(positions=q) for q in wanted.joints.tolist()]
        request.via_points.poses = []
    else:
        request.elbow, request.shoulder = wanted.elbow, wanted.shoulder
    if planner(wanted.task.planner_id).plan_path is not None:
        request.max_deviation = float(wanted.max_deviation)
    request.max_velocity_scaling_factor = float(wanted.velocity_scaling)
    request.max_acceleration_scaling_factor = float(wanted.acceleration_scaling)
    return request
