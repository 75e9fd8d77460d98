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

"""Plan requests, and checks of their responses."""

from __future__ import annotations

from geometry_msgs.msg import Pose, PoseArray
import numpy as np
from rclpy.parameter import Parameter
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.nodes.output.message_times import nanoseconds
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from sensor_msgs.msg import JointState

NAMES = ['joint_1', 'joint_2', 'joint_3']
TABLE_6_1 = ((1.02, 0.59, 0.97), (0.46, 0.55, 1.44), (0.45, 0.38, 1.45))
TABLE_6_3 = ((0.2, 0.8, 0.5), (0.5, 1.0, 1.0), (0.8, 1.2, 0.6))
NEAR = ((1.02, 0.59, 0.97), (1.0, 0.6, 1.0))  # a short motion
START = inverse_kinematics(RobotModel(), TABLE_6_1[0])
SECOND = 10 ** 9


def patient(**overrides):
    """Return parameters that let planning finish on a busy machine."""
    return [Parameter(name, value=value)
            for name, value in {'planning_time_limit': 60.0, **overrides}.items()]


def plan_request(points=TABLE_6_1, frame='', start=None, **fields):
    """Return a request; start is a dict of JointState's fields, or joint positions."""
    request = PlanTrajectory.Request(**fields)
    request.via_points = PoseArray(poses=[Pose() for _ in points])
    request.via_points.header.frame_id = frame
    for pose, point in zip(request.via_points.poses, points):
        pose.position.x, pose.position.y, pose.position.z = map(float, point)
    if start is not None:
        fields = start if isinstance(start, dict) else {'position': start}
        request.start_state = JointState(
            **{'name': NAMES, **{k: list(v) for k, v in fields.items()}})
    return request


def stamps(trajectory):
    """Return the times of a message's points [ns]."""
    return np.array([nanoseconds(p.time_from_start) for p in trajectory.points])


def points_of(trajectory):
    """Return a message's points as `TrajectoryPoints`."""
    return TrajectoryPoints(1e-9 * stamps(trajectory), *(
        np.array([getattr(p, field) for p in trajectory.points])
        for field in ('positions', 'velocities', 'accelerations')))


def is_refused(response, code, text, via_point=-1):
    """Assert that a response is a refusal without a trajectory."""
    assert (response.error_code, response.failed_via_point) == (code, via_point), response.message
    assert text in response.message
    assert not response.trajectory.points
    assert not response.trajectory.joint_names
    for field in ('via_times', 'peak_velocity', 'peak_acceleration', 'peak_jerk', 'peak_effort'):
        assert len(getattr(response, field)) == 0


def assert_refused(ask, request, code, text, via_point=-1):
    """Assert that a request is refused, and the node continues as before."""
    is_refused(ask(request), code, text, via_point)
    assert ask(plan_request()).error_code == PlanTrajectory.Response.SUCCESS
