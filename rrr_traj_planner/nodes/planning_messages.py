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

"""PlanTrajectory's request as the planners take it, and their plan as its response."""

from __future__ import annotations

from array import array
from collections.abc import Callable
from math import inf, isfinite
from typing import Any

from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Path
import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import (
    InvalidInputError,
    LimitViolationError,
    quoted,
    RrrPlannerError,
    StartStateError,
    UnreachableError,
)
from rrr_traj_planner.core.interpolation import TrajectoryPoints
from rrr_traj_planner.core.kinematics import forward_kinematics
from rrr_traj_planner.core.model import RobotModel
from rrr_traj_planner.nodes.configuration import PlannerConfig
from rrr_traj_planner.planners.request import never, Plan, PlanningRequest
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

SECOND = 1_000_000_000  # ns

# Other periods would ask for answers of no use to any controller [s].
LEAST_SAMPLE_PERIOD, LARGEST_SAMPLE_PERIOD = 1e-4, 10.0

# Zones of less cannot be told from corners; more is beyond any arm [m].
LEAST_DEVIATION, LARGEST_DEVIATION = 1e-6, 100.0

# A start state that moves faster is not at rest [rad/s]; encoders' noise stays below it.
AT_REST = 0.01


class FrameError(RrrPlannerError):
    """Via points in a frame that the node cannot transform."""


_RESPONSE = PlanTrajectory.Response
_CODES: tuple[tuple[type[RrrPlannerError], int], ...] = (
    (FrameError, _RESPONSE.FRAME_TRANSFORM_FAILURE),
    (StartStateError, _RESPONSE.START_STATE_INVALID),
    (InvalidInputError, _RESPONSE.INVALID_GOAL_CONSTRAINTS),
    (UnreachableError, _RESPONSE.NO_IK_SOLUTION),
    (LimitViolationError, _RESPONSE.GOAL_CONSTRAINTS_VIOLATED),
    (RrrPlannerError, _RESPONSE.PLANNING_FAILED),
)


def planning_request(message: PlanTrajectory.Request, config: PlannerConfig,
                     should_stop: Callable[[], bool] = never) -> PlanningRequest:
    """
    Return what a message asks, with the node's defaults in the empty fields.

    Parameters
    ----------
    message : PlanTrajectory.Request
        The message.
    config : PlannerConfig
        The node's parameters.
    should_stop : callable
        See `PlanningRequest`.

    Returns
    -------
    PlanningRequest
        The request, checked for form.

    Raises
    ------
    FrameError, StartStateError, InvalidInputError
        If the frame is another, the start state is incomplete, or a field is malformed.

    """
    frame = message.via_points.header.frame_id
    if frame not in ('', config.base_frame):
        raise FrameError(f'via_points are in frame {quoted(frame)}, must be in '
                         f"'{config.base_frame}' (an empty frame_id means the same)")
    count = len(message.via_points.poses)
    if count > config.max_via_points:
        raise InvalidInputError(f'{count} via points given, at most {config.max_via_points} '
                                'allowed (max_via_points)')
    period = message.sample_period
    if period != 0.0 and not LEAST_SAMPLE_PERIOD <= period <= LARGEST_SAMPLE_PERIOD:
        raise InvalidInputError(f'sample_period is {period:g} s, must be 0 or in '
                                f'[{LEAST_SAMPLE_PERIOD:g}, {LARGEST_SAMPLE_PERIOD:g}] s')
    deviation = message.max_deviation
    if deviation != 0.0 and not LEAST_DEVIATION <= deviation <= LARGEST_DEVIATION:
        raise InvalidInputError(f'max_deviation is {deviation:g} m, must be 0 or in '
                                f'[{LEAST_DEVIATION:g}, {LARGEST_DEVIATION:g}] m')
    return PlanningRequest(
        via_points=_tip_positions(message.via_points.poses),
        start=_start(message.start_state, config.model),
        planner_id=message.planner_id or config.default_planner_id,
        segment_durations=np.array(message.segment_durations) if len(
            message.segment_durations) else None,
        velocity_scaling=_unless_zero(message.max_velocity_scaling_factor, 1.0),
        acceleration_scaling=_unless_zero(message.max_acceleration_scaling_factor, 1.0),
        sample_period=_unless_zero(period, config.sample_period),
        elbow=message.elbow or None,
        max_deviation=_unless_zero(deviation, config.max_deviation),
        max_tip_speed=_unless_zero(config.max_tip_speed, inf), steady_zones=config.steady_zones,
        half_transition=config.half_transition,
        should_stop=should_stop, max_points=config.max_points)


def success(plan: Plan, config: PlannerConfig) -> PlanTrajectory.Response:
    """
    Return a plan as the response.

    Parameters
    ----------
    plan : Plan
        The plan.
    config : PlannerConfig
        The node's parameters.

    Returns
    -------
    PlanTrajectory.Response
        Complete but for the planning time.

    """
    return PlanTrajectory.Response(
        error_code=_RESPONSE.SUCCESS, message=plan.note, failed_via_point=-1,
        trajectory=joint_trajectory(plan.points, config), via_times=plan.via_times.tolist(),
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
        Code, message and via point to blame; no trajectory.

    """
    return PlanTrajectory.Response(
        error_code=next(code for kind, code in _CODES if isinstance(error, kind)),
        message=str(error), failed_via_point=error.via_point)


def failure(error: Exception) -> PlanTrajectory.Response:
    """
    Return the response to a request that has met a bug.

    Parameters
    ----------
    error : Exception
        The bug.

    Returns
    -------
    PlanTrajectory.Response
        Code and message; no trajectory.

    """
    return PlanTrajectory.Response(
        error_code=_RESPONSE.FAILURE, failed_via_point=-1,
        message=f'internal error, {type(error).__name__}: {error}')


def joint_trajectory(points: TrajectoryPoints, config: PlannerConfig) -> JointTrajectory:
    """
    Return the message that joint_trajectory_controller accepts.

    Parameters
    ----------
    points : TrajectoryPoints
        With velocities and accelerations.
    config : PlannerConfig
        For the frame and the joints' names.

    Returns
    -------
    JointTrajectory
        Stamp 0: to be started when it is received.

    """
    message = JointTrajectory(joint_names=list(config.model.joint_names))
    message.header.frame_id = config.base_frame
    stamps = np.round(points.times * SECOND).astype(np.int64).tolist()
    q, qd, qdd = (_flat(v) for v in (points.positions, points.velocities, points.accelerations))
    filled = []
    for i, stamp in enumerate(stamps):
        point = JointTrajectoryPoint()
        row = slice(3 * i, 3 * i + 3)
        point.positions, point.velocities, point.accelerations = q[row], qd[row], qdd[row]
        point.time_from_start.sec, point.time_from_start.nanosec = divmod(stamp, SECOND)
        filled.append(point)
    message.points = filled
    return message


def tip_path(points: TrajectoryPoints, config: PlannerConfig, stamp: Any) -> Path:
    """
    Return the path of the tip through the points of a motion.

    Parameters
    ----------
    points : TrajectoryPoints
        The points.
    config : PlannerConfig
        For the frame and the arm.
    stamp : builtin_interfaces.msg.Time
        When it was planned.

    Returns
    -------
    Path
        Poses of unit orientation.

    """
    message = Path()
    message.header.frame_id, message.header.stamp = config.base_frame, stamp
    poses = []
    for x, y, z in forward_kinematics(config.model, points.positions).tolist():
        pose = PoseStamped(header=message.header)
        position = pose.pose.position
        position.x, position.y, position.z = x, y, z
        poses.append(pose)
    message.poses = poses
    return message


def _flat(rows: Array | None) -> array[float]:
    """Return the numbers row by row: slices of it fill message fields fastest."""
    return array('d', np.ascontiguousarray(rows).tobytes())


def _unless_zero(value: float, default: float) -> float:
    return default if value == 0.0 else value


def _tip_positions(poses: Any) -> Array:
    """Return positions; orientations are not used, but must be finite."""
    orientations = [(p.orientation.x, p.orientation.y, p.orientation.z, p.orientation.w)
                    for p in poses]
    for i, orientation in enumerate(orientations):
        if not np.isfinite(orientation).all():
            raise _blamed(InvalidInputError(
                f'via point {i}: orientation is {orientation}, must be finite'), i)
    points = np.array([(p.position.x, p.position.y, p.position.z) for p in poses]).reshape(-1, 3)
    for i in np.flatnonzero(~np.isfinite(points).all(axis=1)).tolist():
        raise _blamed(InvalidInputError(
            f'via point {i}: position is {tuple(points[i].tolist())} m, must be finite'), i)
    return points


def _blamed(error: InvalidInputError, via_point: int) -> InvalidInputError:
    error.via_point = via_point
    return error


def _start(state: JointState, model: RobotModel) -> Array | None:
    """Return the start's joint positions in the arm's order, None where there is no start."""
    names, position, velocity = list(state.name), list(state.position), list(state.velocity)
    if not (names or position or velocity):
        return None
    for name in model.joint_names:
        if names.count(name) != 1:
            raise StartStateError(f'start state names {name} {names.count(name)} times, must '
                                  f"name each of {', '.join(model.joint_names)} once")
    if len(position) != len(names) or len(velocity) not in (0, len(names)):
        raise StartStateError(
            f'start state has {len(names)} names, {len(position)} positions and '
            f'{len(velocity)} velocities, must have a position for each name, and a velocity '
            'for each or none')
    order = [names.index(n) for n in model.joint_names]
    q = [position[i] for i in order]
    qd = [velocity[i] for i in order] if velocity else [0.0] * len(order)
    for name, x, v in zip(model.joint_names, q, qd):
        if not isfinite(x):
            raise StartStateError(f'start state: {name} is at {x:g} rad, must be finite')
        if not abs(v) <= AT_REST:
            raise StartStateError(
                f'start state: {name} moves at {v:g} rad/s, must be at rest (no faster than '
                f'{AT_REST:g} rad/s)')
    return np.array(q)
