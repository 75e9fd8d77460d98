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

"""What a plan is judged by: time, peaks, jerk where pieces meet, via points, coefficients."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.inverse import nearest_solution
from rrr_traj_planner.core.path.path_trajectory import PathTrajectory
from rrr_traj_planner.core.trajectory.piecewise import JointProfile, PiecewiseTrajectory
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.report.attempts import Planned
from rrr_traj_planner.report.coefficients import Coefficients, coefficients

BEFORE = 1e-9  # s before a knot, where what steps there still has its old value


class Measures(NamedTuple):
    """The figures of a plan; arrays have a value for each joint."""

    total_time: float         # [s]
    velocity: Array           # peaks [rad/s]
    acceleration: Array       # [rad/s^2]
    jerk: Array               # [rad/s^3]
    torque: Array             # [N m]
    jerk_at_ends: Array       # largest where a piece begins or ends [rad/s^3]
    via_error: float          # largest, of any joint [rad]
    via_distance: float       # largest, of the tip [m]
    coefficients: Coefficients


def measures(of: Planned) -> Measures:
    """
    Return the figures of a plan.

    Parameters
    ----------
    of : Planned
        The plan.

    Returns
    -------
    Measures
        Its figures.

    """
    peaks = of.plan.peaks
    errors, distances = via_errors(of)
    return Measures(
        float(of.plan.trajectory.duration), peaks.velocity, peaks.acceleration, peaks.jerk,
        of.plan.effort, jerk_at_ends(of.plan.trajectory), float(errors.max()),
        float(distances.max()), coefficients(of.plan.trajectory))


def jerk_at_ends(trajectory: Trajectory) -> Array:
    """
    Return the largest jerk of each joint where one of its pieces begins or ends.

    Parameters
    ----------
    trajectory : Trajectory
        The motion.

    Returns
    -------
    ndarray, shape (3,)
        [rad/s^3]. Along a path of the tip: where a piece of the progress does.

    """
    if isinstance(trajectory, PiecewiseTrajectory):
        return np.array([_end_jerk(profile) for profile in trajectory.profiles])
    knots = trajectory.knots
    if isinstance(trajectory, PathTrajectory):
        times = np.concatenate((knots[:-1], knots[1:] - BEFORE))
        return np.asarray(np.abs(trajectory(times)[3]).max(axis=0))
    raise TypeError(f'a {type(trajectory).__name__} has no pieces')


def via_errors(of: Planned) -> tuple[Array, Array]:
    """
    Return how far a plan is from each via point at its time.

    Parameters
    ----------
    of : Planned
        The plan.

    Returns
    -------
    tuple of ndarray, shape (n,)
        Of the joint that is furthest [rad], and of the tip [m].

    """
    model = of.task.model
    passed = of.plan.trajectory(of.plan.via_times)[0]
    tips = forward_kinematics(model, passed)
    errors = [float(np.abs(nearest_solution(model, point, q) - q).max())
              for point, q in zip(of.task.via_points, passed)]
    return np.array(errors), np.linalg.norm(tips - of.task.via_points, axis=1)


def time_at_limit(shares: Array, times: Array, least: float) -> float:
    """
    Return the part of a motion's time for which a share is at least so large.

    Parameters
    ----------
    shares : ndarray, shape (n,)
        What is used of a limit, from 0 to 1.
    times : ndarray, shape (n,)
        When, increasing [s].
    least : float
        The share in question.

    Returns
    -------
    float
        From 0 to 1.

    """
    middle = 0.5 * (shares[:-1] + shares[1:])
    widths = np.diff(times)
    return float(widths[middle >= least].sum() / widths.sum())


def _end_jerk(profile: JointProfile) -> float:
    """Return the largest jerk of one joint at the beginnings and ends of its pieces."""
    pieces = profile.pieces
    return max(float(np.abs(pieces.at(s)[3]).max()) for s in (0.0, 1.0))
