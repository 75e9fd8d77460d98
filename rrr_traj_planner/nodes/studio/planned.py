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

"""A plan as the page shows it, made from the planner's answer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
import re
from typing import Any

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics.motor_torque import motor_torque, rest_speed_of
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.core.trajectory.residual_vibration import residual_vibration
from rrr_traj_planner.core.trajectory.sampling import NANOSECOND
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.nodes.output.wireframe import picked
from rrr_traj_planner.nodes.runs.messages import trajectory_points
from rrr_traj_planner.nodes.studio.session import Refusal
from rrr_traj_planner.report.excitation import IN_TEXT

MOST_POINTS = 600  # of the path, that are drawn
# Names in the panel: of a request's fields with several values, and of other fields.
NAMES = {'segment_durations': 'time', 'dwell': 'dwell', 'stop_at': 'stop'}
OTHERS = {'payload.mass': 'payload', 'max_deviation': 'deviation'}
FIELD = re.compile(rf'\b(?P<field>{"|".join(NAMES)})\[(?P<index>\d+)\](?P<nan> is nan\b)?')
# rclpy's words for a parameter out of its range, without a unit, and the package's.
RANGE = (
    re.compile(r'Parameter payload\.mass out of range Min: (\S+), Max: (\S+), value: (\S+)'),
    r'payload is \3 kg, must be in [\1, \2] kg')
OTHER = re.compile(rf'\b({"|".join(map(re.escape, OTHERS))}) is\b')
LIMITED = ('velocity', 'acceleration', 'jerk', 'torque')


@dataclass(frozen=True, eq=False)
class Planned:
    """
    A plan.

    Attributes
    ----------
    planner_id : str
        Its planner.
    duration : float
        Of the motion [s].
    planning_time : float
        [s].
    note : str
        The planner's remark; mostly empty.
    path : ndarray, shape (n, 3)
        Positions of the tip along the motion [m].
    speed : ndarray, shape (n - 1,)
        Mean speed of the tip from each of them to the next [m/s].
    times : ndarray, shape (n,)
        When the tip is there [s].
    joints : ndarray, shape (n, 3)
        Joint positions then [rad].
    via_joints : ndarray, shape (k, 3)
        Joint positions when the via points are reached [rad].
    peaks : tuple of (str, ndarray, ndarray)
        For velocity, acceleration, jerk and torque: name with unit, peaks and limits of the
        joints.
    vibration : callable
        Returns the residual vibration at the frequencies `IN_TEXT`, the largest of the joints
        [rad/s^2]; computed when it is asked for first.
    curves : dict of str to ndarray, shape (n, 3)
        For `LIMITED`, and 'position in its range': values over `times` as shares of the limits, -1
        to 1; 0 where there is none.

    """

    planner_id: str
    duration: float
    planning_time: float
    note: str
    path: Array
    speed: Array
    times: Array
    joints: Array
    via_joints: Array
    peaks: tuple[tuple[str, Array, Array], ...]
    vibration: Callable[[], tuple[float, ...]] = tuple
    curves: dict[str, Array] = field(default_factory=dict)

    @property
    def shares(self) -> Array:
        """Return the largest share of any joint's limits, for each of `times` and of `LIMITED`."""
        return np.stack([np.abs(self.curves[name]).max(axis=1) for name in LIMITED], axis=-1)

    def joints_at(self, time: float) -> list[float]:
        """
        Return joint positions at any time, for drawing.

        Parameters
        ----------
        time : float
            [s].

        Returns
        -------
        list of 3 floats
            Linear between the points that are drawn [rad].

        """
        return [float(np.interp(time, self.times, q)) for q in self.joints.T]


def planned(response: Any, planner_id: str, model: RobotModel, limits: JointLimits
            ) -> Planned | Refusal:
    """
    Return a plan, or why there is none.

    Parameters
    ----------
    response : PlanTrajectory.Response
        The planner's answer.
    planner_id : str
        The planner.
    model : RobotModel
        The arm.
    limits : JointLimits
        Of the planner.

    Returns
    -------
    Planned or Refusal
        The message in other words.

    """
    if response.error_code != response.SUCCESS:
        return Refusal(in_words_of_the_page(response.message), response.failed_via_point)
    points = trajectory_points(response.trajectory)
    at = [int(np.abs(points.times - t).argmin()) for t in response.via_times]
    jerk = np.zeros_like(points.accelerations)  # means from each point to the next
    jerk[:-1] = np.diff(points.accelerations, axis=0) / np.diff(points.times)[:, None]
    jerk[-1:] = jerk[-2:-1]
    drawn = picked(len(points.times), MOST_POINTS, np.array(at))
    path = forward_kinematics(model, points.positions[drawn])
    steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
    return Planned(
        planner_id, float(points.times[-1]), response.planning_time, response.message, path,
        steps / np.diff(points.times[drawn]), points.times[drawn], points.positions[drawn],
        points.positions[at], (
            ('velocity [rad/s]', np.array(response.peak_velocity), limits.max_velocity),
            ('acceleration [rad/s²]', np.array(response.peak_acceleration),
             limits.max_acceleration),
            ('jerk [rad/s³]', np.array(response.peak_jerk), limits.max_jerk),
            ('torque [N m]', np.array(response.peak_effort), limits.max_effort)),
        cache(lambda: _vibration(points, response.via_times[-1])),
        _curves(model, limits, *(values[drawn] for values in (
            points.positions, points.velocities, points.accelerations, jerk))))


def in_words_of_the_page(message: str, first: int = 0, first_way: int = 1) -> str:
    """
    Return a refusal with the panel's names in place of the service's fields.

    Parameters
    ----------
    message : str
        Of the service, such as 'segment_durations[0] is nan: planner cycloid takes ...'.
    first, first_way : int
        Via point of the page's that is the first of the request, and to which its first segment
        leads.

    Returns
    -------
    str
        Such as 'time of via point 1 is not given: planner cycloid takes ...'.

    """
    def named(found: re.Match[str]) -> str:
        shift = first_way if found['field'] == 'segment_durations' else first
        value = ' is not given' if found['nan'] else ''
        return f'{NAMES[found["field"]]} of via point {int(found["index"]) + shift}{value}'

    message = RANGE[0].sub(RANGE[1], FIELD.sub(named, message))
    return OTHER.sub(lambda found: f'{OTHERS[found[1]]} is', message)


def _vibration(points: TrajectoryPoints, end: float) -> tuple[float, ...]:
    """Return the residual vibration after the last motion, before a rest at the last point."""
    spline = spline_through(points)
    knots = spline.knots[spline.knots <= end + NANOSECOND]
    return tuple(residual_vibration(spline.at, knots, IN_TEXT).max(axis=1).tolist())


def _curves(model: RobotModel, limits: JointLimits, q: Array, qd: Array, qdd: Array, qddd: Array
            ) -> dict[str, Array]:
    """Return positions within their ranges, and the rest of `LIMITED`, as shares."""
    bounded = np.isfinite(limits.min_position) & np.isfinite(limits.max_position)
    low, high = (np.where(bounded, end, 0.0) for end in (
        limits.min_position, limits.max_position))
    half = np.where(bounded, 0.5 * (high - low), np.inf)
    return {'position in its range': (q - 0.5 * (low + high)) / half,
            'velocity': qd / limits.max_velocity,
            'acceleration': qdd / limits.max_acceleration,
            'jerk': qddd / limits.max_jerk,
            'torque': motor_torque(model, q, qd, qdd, rest_speed_of(qd)) / limits.max_effort}
