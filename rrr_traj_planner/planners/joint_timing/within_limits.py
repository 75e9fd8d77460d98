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

"""
Motions fitted to their limits exactly, by peaks in closed form instead of samples.

Time scaling: Hollerbach, Dynamic scaling of manipulator trajectories, 1984.
"""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.rounding import JOINT_ROUNDING, TIME_ROUNDING
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.core.trajectory.torque import peak_torque
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.tolerances import LIMIT_ROUNDING
from rrr_traj_planner.planners.torque_scaling import torque_time_scale

MOST_SLOWED = 4  # times, until no torque exceeds its limit by more than rounding; chosen


def fitted(task: JointTask, trajectory: PiecewiseTrajectory,
           may_scale: bool) -> PiecewiseTrajectory | None:
    """
    Return a motion slowed as a whole until it keeps every limit.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    trajectory : PiecewiseTrajectory
        The motion.
    may_scale : bool
        Whether it may be slowed at all.

    Returns
    -------
    PiecewiseTrajectory or None
        None where slowing does not help: a joint leaves its range, the motion passes fast through
        a pose that the motors cannot hold, or viscous friction needs more torque in a slower one.

    """
    if beyond_range(task, trajectory).any():
        return None
    by_torque = torque_time_scale(task, trajectory)
    factor = kinematic_time_scale(task, trajectory)
    # a motion may pass fast, but not slowly, where gravity alone exceeds a limit
    dynamic = np.isinf(by_torque)
    if dynamic and not torque_fits(task, trajectory):
        return None
    if not dynamic:
        factor = max(factor, by_torque)
    if factor <= 1.0 + LIMIT_ROUNDING:
        return trajectory.time_scaled(factor) if factor > 1.0 and may_scale else trajectory
    if not may_scale:
        return None
    if not (dynamic or task.model.friction.viscous.any()):
        return trajectory.time_scaled(factor)
    for _ in range(MOST_SLOWED):
        trajectory = trajectory.time_scaled(factor)
        trajectory.cache.clear()  # maxima of torque may be elsewhere in a slower motion
        factor = 1.0 if dynamic else torque_time_scale(task, trajectory)
        if factor <= 1.0 + LIMIT_ROUNDING:
            break
    # slower, inertia may take less from the torque of viscous friction and gravity
    return trajectory if torque_fits(task, trajectory) else None


def beyond_range(task: JointTask, trajectory: PiecewiseTrajectory) -> Array:
    """
    Return how far each joint leaves its range in each segment.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    trajectory : PiecewiseTrajectory
        The motion.

    Returns
    -------
    ndarray, shape (2, N, 3)
        Beyond the upper and the lower end [rad]; 0 within.

    """
    beyond = np.zeros((2, len(task.points) - 1, 3))
    starts = trajectory.via_times[1:-1] - TIME_ROUNDING
    limits = task.limits
    velocity, _, _ = trajectory.peak_rates
    for j, profile in enumerate(trajectory.profiles):
        # a piece moves at most its joint's peak velocity times its duration
        largest_step = velocity[j] * profile.pieces.duration
        begins = profile.begins
        if ((begins + largest_step <= limits.max_position[j])
                & (begins - largest_step >= limits.min_position[j])).all():
            continue
        least, most = profile.piece_ranges
        segment = np.searchsorted(starts, profile.knots[:-1], side='right')
        np.maximum.at(beyond[0, :, j], segment, most - limits.max_position[j])
        np.maximum.at(beyond[1, :, j], segment, limits.min_position[j] - least)
    return np.where(beyond > JOINT_ROUNDING, beyond, 0.0)


def kinematic_time_scale(task: JointTask, trajectory: PiecewiseTrajectory) -> float:
    """
    Return the least factor on all times by velocity, acceleration and jerk limits.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    trajectory : PiecewiseTrajectory
        The motion.

    Returns
    -------
    float
        At most 1 where they hold as it is.

    """
    return task.limits.time_scale(*trajectory.peak_rates)


def torque_fits(task: JointTask, trajectory: PiecewiseTrajectory) -> bool:
    """
    Return whether a motion keeps the torque limits at its own speed.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    trajectory : PiecewiseTrajectory
        The motion.

    Returns
    -------
    bool
        True also where there are none.

    """
    effort = task.limits.max_effort
    return bool(np.isinf(effort).all() or (peak_torque(
        task.model, trajectory, task.limits).value <= effort * (1.0 + LIMIT_ROUNDING)).all())
