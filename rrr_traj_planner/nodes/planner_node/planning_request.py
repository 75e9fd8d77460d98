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

"""Conversion of the message PlanTrajectory.Request to the planners' `PlanningRequest`."""

from __future__ import annotations

from math import inf, isfinite
from typing import Any, NamedTuple

from geometry_msgs.msg import TransformStamped
import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.cancellation import never, ShouldStop
from rrr_traj_planner.core.errors import (
    counted,
    format_distinct,
    InvalidInputError,
    quoted,
    StartStateError,
)
from rrr_traj_planner.core.kinematics.postures import ELBOWS, SHOULDERS
from rrr_traj_planner.nodes.output.message_times import seconds
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.parameters.error_names import named
from rrr_traj_planner.nodes.planner_node.frame_transforms import FrameError, in_base_frame
from rrr_traj_planner.planners.request import PlanningRequest
from rrr_traj_planner_interfaces.srv import PlanTrajectory

# Range of sample_period [s]: no controller can use points closer together or further apart.
MIN_SAMPLE_PERIOD, MAX_SAMPLE_PERIOD = 1e-4, 10.0

# Range of max_deviation [m]: smaller zones are practically corners, larger ones exceed any arm.
MIN_DEVIATION, MAX_DEVIATION = 1e-6, 100.0

# Arguments of `PlanningRequest` with other names in the service or the node's parameters.
# rad/s^2, up to which an arm that does not move is at rest: rounding. Chosen.
ACCELERATION_ROUNDING = 1e-6

FIELDS = {'start': 'start_state', 'start_velocity': 'start_state',
          'velocity_scaling': 'max_velocity_scaling_factor',
          'acceleration_scaling': 'max_acceleration_scaling_factor',
          'half_transition': 'poly_414.t_acc'}


def planning_request(message: PlanTrajectory.Request, config: PlannerConfig,
                     should_stop: ShouldStop = never,
                     to_base: TransformStamped | None = None) -> PlanningRequest:
    """
    Return the planning request of a message, with the node's defaults for empty fields.

    Parameters
    ----------
    message : PlanTrajectory.Request
        The message.
    config : PlannerConfig
        The node's parameters.
    should_stop : callable
        See `PlanningRequest`.
    to_base : TransformStamped, optional
        From the frame of the via points to the base frame; None: they are in the base frame.

    Returns
    -------
    PlanningRequest
        The request, whose fields have been checked one by one.

    Raises
    ------
    FrameError
        If the via points are in another frame, and there is no transform, or it is malformed.
    StartStateError
        If the start state is incomplete or not finite.
    InvalidInputError
        If another field is malformed.

    """
    via_points = _via_points(message, config, to_base)
    _check_range('sample_period', message.sample_period, MIN_SAMPLE_PERIOD, MAX_SAMPLE_PERIOD, 's')
    _check_range('max_deviation', message.max_deviation, MIN_DEVIATION, MAX_DEVIATION, 'm')
    for name, choices in (('elbow', ELBOWS), ('shoulder', SHOULDERS)):
        if getattr(message, name) not in ('', *choices):
            raise InvalidInputError(
                f'{name} is {quoted(getattr(message, name))}, must be '
                f"'{choices[0]}', '{choices[1]}' or empty")
        if getattr(message, name) and len(message.joint_via_points):
            raise InvalidInputError(
                f'{name} is {quoted(getattr(message, name))}, must be empty: joint_via_points '
                'have postures of their own')
    start = _start(message, config)
    with named(FIELDS):
        return PlanningRequest(
            **via_points, stop_at=list(message.stop_at) or None,
            dwell=_array_or_none(message.dwell), start=start.position,
            start_velocity=start.velocity, start_acceleration=start.acceleration,
            planner_id=message.planner_id or config.default_planner_id,
            segment_durations=_array_or_none(message.segment_durations),
            velocity_scaling=_or_default(message.max_velocity_scaling_factor, 1.0),
            acceleration_scaling=_or_default(message.max_acceleration_scaling_factor, 1.0),
            sample_period=_or_default(message.sample_period, config.sample_period),
            elbow=message.elbow or None, shoulder=message.shoulder or None,
            max_deviation=_or_default(message.max_deviation, config.max_deviation),
            max_tip_speed=_or_default(config.max_tip_speed, inf),
            steady_zones=config.steady_zones, half_transition=config.half_transition,
            least_jerk_rise=config.least_jerk_rise,
            should_stop=should_stop, max_points=config.max_points,
            start_state_tolerance=config.start_state_tolerance)


def _via_points(message: PlanTrajectory.Request, config: PlannerConfig,
                to_base: TransformStamped | None) -> dict[str, Array]:
    """Return the via points, checked, by the name of the argument that takes them."""
    poses, joint_points = message.via_points.poses, message.joint_via_points
    if len(poses) and len(joint_points):
        raise InvalidInputError(
            f'{counted(len(poses), "via point")} and {len(joint_points)} joint_via_points are '
            'given, must be one of the two')
    count = len(poses) + len(joint_points)
    if count > config.max_via_points:
        raise InvalidInputError(f'{count} via points given, at most {config.max_via_points} '
                                'allowed (max_via_points)')
    if len(joint_points):
        return {'joint_via_points': _joint_positions(joint_points, config)}
    points, frame = _tip_positions(poses), message.via_points.header.frame_id
    if to_base is None and len(poses) and frame not in ('', config.base_frame):
        raise FrameError(f'via_points are in frame {quoted(frame)}, must be in '
                         f"'{config.base_frame}' (an empty frame_id means the same)")
    return {'via_points': points if to_base is None else in_base_frame(points, to_base)}


def _check_range(field: str, value: float, low: float, high: float, unit: str) -> None:
    """Check a field that is in a range, or 0 for the node's default."""
    if value != 0.0 and not low <= value <= high:
        given, least, most = format_distinct(value, low, high)
        raise InvalidInputError(
            f'{field} is {given} {unit}, must be 0 or in [{least}, {most}] {unit}')


def _or_default(value: float, default: float) -> float:
    return default if value == 0.0 else value


def _tip_positions(poses: Any) -> Array:
    """Return the positions of poses [m]; orientations are ignored, but must be finite."""
    orientations = [(p.orientation.x, p.orientation.y, p.orientation.z, p.orientation.w)
                    for p in poses]
    for i, orientation in enumerate(orientations):
        if not np.isfinite(orientation).all():
            raise _at_via_point(InvalidInputError(
                f'via point {i}: orientation is {orientation}, must be finite'), i)
    points = np.array([(p.position.x, p.position.y, p.position.z) for p in poses]).reshape(-1, 3)
    for i in np.flatnonzero(~np.isfinite(points).all(axis=1)).tolist():
        raise _at_via_point(InvalidInputError(
            f'via point {i}: position is {tuple(points[i].tolist())} m, must be finite'), i)
    return points


def _joint_positions(points: Any, config: PlannerConfig) -> Array:
    """Return the positions of trajectory points [rad]; they may have nothing else."""
    names = config.model.joint_names
    for i, point in enumerate(points):
        name = f'joint_via_points[{i}]'
        if len(point.positions) != len(names):
            raise _at_via_point(InvalidInputError(
                f'{name} has {counted(len(point.positions), "position")}, must have one for each '
                f'of {", ".join(names)}'), i)
        for field, instead in (('velocities', ' (stop_at asks for a stop)'),
                               ('accelerations', ''), ('effort', '')):
            if len(getattr(point, field)):
                raise _at_via_point(InvalidInputError(
                    f'{name} has {field}, must have positions only: the planner chooses the '
                    f'rest{instead}'), i)
        if point.time_from_start.sec or point.time_from_start.nanosec:
            raise _at_via_point(InvalidInputError(
                f'{name} has time_from_start {seconds(point.time_from_start):g} s, must be 0: '
                'segment_durations prescribe times'), i)
    q = np.array([point.positions for point in points])
    for i, j in np.argwhere(~np.isfinite(q)).tolist():
        raise _at_via_point(InvalidInputError(
            f'via point {i}: {names[j]} is at {q[i, j]:g} rad, must be finite'), i)
    return q


def _array_or_none(values: Any) -> Array | None:
    return np.array(values) if len(values) else None


def _at_via_point(error: InvalidInputError, via_point: int) -> InvalidInputError:
    error.via_point = via_point
    return error


class _StartState(NamedTuple):
    """Joint positions in the model's order, and how they change where the arm moves."""

    position: Array | None = None      # [rad]
    velocity: Array | None = None      # [rad/s]
    acceleration: Array | None = None  # [rad/s^2]


def _start(message: PlanTrajectory.Request, config: PlannerConfig) -> _StartState:
    """Return the start state; without velocity and acceleration where the arm rests."""
    model, state = config.model, message.start_state
    names, given = list(state.name), {
        'position': list(state.position), 'velocity': list(state.velocity),
        'acceleration': list(message.start_acceleration)}
    if not (names or given['position'] or given['velocity']):
        if given['acceleration']:
            raise StartStateError('start_acceleration is given without a start_state')
        return _StartState()
    for name in model.joint_names:
        if names.count(name) != 1:
            raise StartStateError(f'start state names {name} {names.count(name)} times, must '
                                  f"name each of {', '.join(model.joint_names)} once")
    if len(given['position']) != len(names) or len(given['velocity']) not in (0, len(names)):
        raise StartStateError(
            f'start state has {counted(len(names), "name")}, '
            f'{counted(len(given["position"]), "position")} and '
            f'{counted(len(given["velocity"]), "velocity", "velocities")}, must have a position '
            'for each name, and a velocity for each or none')
    if len(given['acceleration']) not in (0, len(names)):
        raise StartStateError(
            f'start_acceleration has {counted(len(given["acceleration"]), "value")}, must have '
            f'one for each of the {counted(len(names), "name")} in start_state, or none')
    order = [names.index(n) for n in model.joint_names]
    q, qd, qdd = (np.array([f[i] for i in order] if f else [0.0] * len(order))
                  for f in given.values())
    for what, values, unit in (('is at', q, 'rad'), ('moves at', qd, 'rad/s'),
                               ('accelerates with', qdd, 'rad/s^2')):
        for name, x in zip(model.joint_names, values):
            if not isfinite(x):
                raise StartStateError(f'start state: {name} {what} {x:g} {unit}, must be finite')
    rests = (np.abs(qd) <= config.start_state_tolerance).all() and (
        np.abs(qdd) <= ACCELERATION_ROUNDING).all()
    return _StartState(q) if rests else _StartState(q, qd, qdd)
