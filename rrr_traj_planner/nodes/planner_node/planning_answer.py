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

"""Plans and errors as PlanTrajectory responses, plans as trajectory and path messages."""

from __future__ import annotations

from array import array
from typing import Any

from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Path
import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.cancellation import never, ShouldStop
from rrr_traj_planner.core.errors import (
    InvalidInputError,
    LimitViolationError,
    RrrPlannerError,
    StartStateError,
    UnreachableError,
)
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.planner_node.frame_transforms import FrameError
from rrr_traj_planner.planners.plan import Plan
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

POINTS_PER_CHECK = 1000  # points filled between two calls of `should_stop`, some 20 ms

_RESPONSE = PlanTrajectory.Response
_CODES: tuple[tuple[type[RrrPlannerError], int], ...] = (
    (FrameError, _RESPONSE.FRAME_TRANSFORM_FAILURE),
    (StartStateError, _RESPONSE.START_STATE_INVALID),
    (InvalidInputError, _RESPONSE.INVALID_GOAL_CONSTRAINTS),
    (UnreachableError, _RESPONSE.NO_IK_SOLUTION),
    (LimitViolationError, _RESPONSE.GOAL_CONSTRAINTS_VIOLATED),
    (RrrPlannerError, _RESPONSE.PLANNING_FAILED),
)


def success(plan: Plan, config: PlannerConfig,
            should_stop: ShouldStop = never) -> PlanTrajectory.Response:
    """
    Return a plan as the response.

    Parameters
    ----------
    plan : Plan
        The plan.
    config : PlannerConfig
        The node's parameters.
    should_stop : callable
        Called at intervals; an error that it raises cancels the conversion.

    Returns
    -------
    PlanTrajectory.Response
        Complete except for the planning time.

    """
    return PlanTrajectory.Response(
        error_code=_RESPONSE.SUCCESS, message=plan.note, failed_via_point=-1,
        trajectory=joint_trajectory(plan.points, config, should_stop),
        via_times=plan.via_times.tolist(),
        peak_velocity=plan.peaks.velocity.tolist(),
        peak_acceleration=plan.peaks.acceleration.tolist(),
        peak_jerk=plan.peaks.jerk.tolist(), peak_effort=plan.effort.tolist())


def refusal(error: RrrPlannerError) -> PlanTrajectory.Response:
    """
    Return the response to a request that cannot be met.

    Parameters
    ----------
    error : RrrPlannerError
        Why there is no plan.

    Returns
    -------
    PlanTrajectory.Response
        Error code, message and index of the via point at fault; no trajectory.

    """
    return PlanTrajectory.Response(
        error_code=next(code for kind, code in _CODES if isinstance(error, kind)),
        message=str(error), failed_via_point=error.via_point)


def failure(error: Exception) -> PlanTrajectory.Response:
    """
    Return the response to a request that failed because of a bug.

    Parameters
    ----------
    error : Exception
        The unexpected exception.

    Returns
    -------
    PlanTrajectory.Response
        Error code and message; no trajectory.

    """
    return PlanTrajectory.Response(
        error_code=_RESPONSE.FAILURE, failed_via_point=-1,
        message=f'internal error, {type(error).__name__}: {error}')


def joint_trajectory(points: TrajectoryPoints, config: PlannerConfig,
                     should_stop: ShouldStop = never) -> JointTrajectory:
    """
    Return the message that joint_trajectory_controller accepts.

    Parameters
    ----------
    points : TrajectoryPoints
        Points with velocities and accelerations.
    config : PlannerConfig
        Gives the frame and the joint names.
    should_stop : callable
        As in `success`.

    Returns
    -------
    JointTrajectory
        Stamp 0: it starts when it is received.

    """
    message = JointTrajectory(joint_names=list(config.model.joint_names))
    message.header.frame_id = config.base_frame
    stamps = np.round(points.times * SECOND).astype(np.int64).tolist()
    q, qd, qdd = (_flat(v) for v in (points.positions, points.velocities, points.accelerations))
    filled = []
    for i, stamp in enumerate(stamps):
        if i % POINTS_PER_CHECK == 0:
            should_stop()
        point = JointTrajectoryPoint()
        row = slice(3 * i, 3 * i + 3)
        point.positions, point.velocities, point.accelerations = q[row], qd[row], qdd[row]
        point.time_from_start.sec, point.time_from_start.nanosec = divmod(stamp, SECOND)
        filled.append(point)
    message.points = filled
    return message


def tip_path(points: TrajectoryPoints, config: PlannerConfig, stamp: Any,
             should_stop: ShouldStop = never) -> Path:
    """
    Return the path of the tip through the points of a motion.

    Parameters
    ----------
    points : TrajectoryPoints
        The points.
    config : PlannerConfig
        Gives the frame and the arm's model.
    stamp : builtin_interfaces.msg.Time
        Time of the request.
    should_stop : callable
        As in `success`.

    Returns
    -------
    Path
        Poses with identity orientation.

    """
    message = Path()
    message.header.frame_id, message.header.stamp = config.base_frame, stamp
    poses = []
    for i, (x, y, z) in enumerate(forward_kinematics(config.model, points.positions).tolist()):
        if i % POINTS_PER_CHECK == 0:
            should_stop()
        pose = PoseStamped(header=message.header)
        position = pose.pose.position
        position.x, position.y, position.z = x, y, z
        poses.append(pose)
    message.poses = poses
    return message


def _flat(rows: Array | None) -> array[float]:
    """Return the rows in one array, whose slices fill message fields fastest."""
    return array('d', np.ascontiguousarray(rows).tobytes())
