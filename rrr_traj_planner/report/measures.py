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

"""Measures of a plan: time, peaks, jerk at the ends of pieces, via-point error, coefficients."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.inverse import nearest_solution
from rrr_traj_planner.core.path.path_trajectory import PathTrajectory
from rrr_traj_planner.core.trajectory.joint_profile import JointProfile
from rrr_traj_planner.core.trajectory.paused import motions_of
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.report.attempts import Planned
from rrr_traj_planner.report.coefficients import Coefficients, coefficients
from rrr_traj_planner.report.motion_samples import BEFORE


class Measures(NamedTuple):
    """Measures of a plan; arrays have a value for each joint."""

    total_time: float         # [s]
    velocity: Array           # peaks [rad/s]
    acceleration: Array       # [rad/s^2]
    jerk: Array               # [rad/s^3]
    torque: Array             # [N m]
    jerk_at_ends: Array       # largest at the beginnings and ends of pieces [rad/s^3]
    via_error: float          # largest error of a joint at a via point [rad]
    via_distance: float       # largest distance of the tip from a via point [m]
    coefficients: Coefficients


def measures(of: Planned) -> Measures:
    """
    Return the measures of a plan.

    Parameters
    ----------
    of : Planned
        The plan.

    Returns
    -------
    Measures
        Its measures.

    """
    peaks = of.plan.peaks
    errors, distances = via_errors(of)
    return Measures(
        float(of.plan.trajectory.duration), peaks.velocity, peaks.acceleration, peaks.jerk,
        of.plan.effort, jerk_at_ends(of.plan.trajectory), float(errors.max()),
        float(distances.max()), coefficients(of.plan.trajectory))


def jerk_at_ends(trajectory: Trajectory) -> Array:
    """
    Return the largest jerk of each joint at the ends of its pieces.

    Parameters
    ----------
    trajectory : Trajectory
        The motion.

    Returns
    -------
    ndarray, shape (3,)
        Jerk [rad/s^3]; for a motion along a path of the tip, at the ends of the pieces of s(t).

    """
    return np.asarray(np.max([_end_jerks(motion) for motion in motions_of(trajectory)], axis=0))


def _end_jerks(motion: Trajectory) -> Array:
    """Return the same for a motion without pauses."""
    if isinstance(motion, PiecewiseTrajectory):
        return np.array([_end_jerk(profile) for profile in motion.profiles])
    knots = motion.knots
    if isinstance(motion, PathTrajectory):
        times = np.concatenate((knots[:-1], knots[1:] - BEFORE))
        return np.asarray(np.abs(motion(times)[3]).max(axis=0))
    raise TypeError(f'a {type(motion).__name__} has no pieces')


def via_errors(of: Planned) -> tuple[Array, Array]:
    """
    Return a plan's errors at the via points, at their times.

    Parameters
    ----------
    of : Planned
        The plan.

    Returns
    -------
    tuple of ndarray, shape (n,)
        Largest error of a joint [rad], and distance of the tip [m].

    """
    q, given = of.plan.trajectory(of.plan.via_times)[0], of.task.request.joint_via_points
    return (joint_errors(of.task.model, of.task.via_points, q) if given is None
            else np.asarray(np.abs(q - given).max(axis=1)),
            tip_errors(of.task.model, of.task.via_points, q))


def joint_errors(model: RobotModel, via_points: Array, q: Array) -> Array:
    """
    Return the largest error of a joint at each via point.

    Parameters
    ----------
    model : RobotModel
        The arm.
    via_points : ndarray, shape (n, 3)
        Positions of the tip [m].
    q : ndarray, shape (n, 3)
        Joint positions of the arm at the via points' times [rad].

    Returns
    -------
    ndarray, shape (n,)
        Errors [rad], from the nearest inverse solution.

    """
    return np.asarray(np.abs(via_positions(model, via_points, q) - q).max(axis=1))


def tip_errors(model: RobotModel, via_points: Array, q: Array) -> Array:
    """
    Return the distance of the tip from each via point.

    Parameters
    ----------
    model, via_points, q
        As in `joint_errors`.

    Returns
    -------
    ndarray, shape (n,)
        Distances [m].

    """
    return np.linalg.norm(forward_kinematics(model, q) - via_points, axis=1)


def via_positions(model: RobotModel, via_points: Array, q: Array) -> Array:
    """
    Return the joint positions of via points that are nearest to given ones.

    Parameters
    ----------
    model, via_points, q
        As in `joint_errors`.

    Returns
    -------
    ndarray, shape (n, 3)
        The nearest inverse solution for each via point [rad].

    """
    return np.array([nearest_solution(model, point, near) for point, near in zip(via_points, q)])


def time_at_limit(use: Array, times: Array, least: float) -> float:
    """
    Return the fraction of a motion's time in which the use of a limit is above a threshold.

    Parameters
    ----------
    use : ndarray, shape (n,)
        Magnitude / limit.
    times : ndarray, shape (n,)
        Increasing times [s].
    least : float
        The threshold.

    Returns
    -------
    float
        From 0 to 1.

    """
    middle = 0.5 * (use[:-1] + use[1:])
    widths = np.diff(times)
    return float(widths[middle >= least].sum() / widths.sum())


def _end_jerk(profile: JointProfile) -> float:
    """Return the largest jerk of one joint at both ends of its pieces."""
    pieces = profile.pieces
    return max(float(np.abs(pieces.at(s)[3]).max()) for s in (0.0, 1.0))
