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
Time scaling of motions so that torque limits hold.

Scaling time by z divides the torque beside gravity's by z^2 (Hollerbach, Dynamic scaling of
manipulator trajectories, ASME J. Dynamic Systems, Measurement, and Control 106, 1984).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import LimitViolationError
from rrr_traj_planner.core.trajectory.torque import (
    peak_holding_torque,
    time_scale_for_torque,
    torque_sweep,
)
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.via_points import holding_error

Side = Literal['left', 'right']


def torque_time_scale(task: JointTask, trajectory: Trajectory) -> float:
    """
    Return the least factor on all times with which torque limits hold; at most 1: as it is.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    trajectory : Trajectory
        The motion.

    Returns
    -------
    float
        Infinite where gravity alone exceeds a limit.

    """
    return float(time_scale_for_torque(task.model, task.limits, trajectory).value.max())


def feasible_time_scale(task: JointTask, trajectory: Trajectory) -> float:
    """
    Return the least factor on all times with which torque limits hold, as `torque_time_scale`.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    trajectory : Trajectory
        The motion.

    Returns
    -------
    float
        Finite; at most 1 where they hold as it is.

    Raises
    ------
    LimitViolationError
        If gravity alone exceeds an effort limit along the path.

    """
    factor = torque_time_scale(task, trajectory)
    if np.isinf(factor):
        raise cannot_hold(task, trajectory)
    return factor


def slowed_for_torque(task: JointTask, trajectory: Trajectory) -> Trajectory:
    """
    Return the motion slowed as a whole until its torques are within their limits.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    trajectory : Trajectory
        The motion.

    Returns
    -------
    Trajectory
        The same where they are already.

    Raises
    ------
    LimitViolationError
        If gravity alone exceeds an effort limit along the path.

    """
    factor = feasible_time_scale(task, trajectory)
    return trajectory.time_scaled(factor) if factor > 1.0 else trajectory


def squared_time_scale_by_segment(task: JointTask, trajectory: Trajectory,
                                  sides: Sequence[Side]) -> Array:
    """
    Return the square of each segment's least time scaling by sampled torques.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    trajectory : Trajectory
        The motion.
    sides : sequence of {'left', 'right'}
        To which segments a sample at a via point counts: that before it, that after it, or both.

    Returns
    -------
    ndarray, shape (n,)
        Below 1 where torque is below its limits, infinite where gravity alone exceeds one.

    """
    sweep = torque_sweep(task.model, trajectory)
    squared = sweep.squared_scaling(task.limits).max(axis=1)
    worst = np.zeros(len(trajectory.via_times) - 1)
    for side in sides:
        np.maximum.at(worst, np.searchsorted(
            trajectory.via_times[1:-1], sweep.times, side=side), squared)
    return worst


def cannot_hold(task: JointTask, trajectory: Trajectory) -> LimitViolationError:
    """
    Return the error of a path along which gravity's torque exceeds an effort limit.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    trajectory : Trajectory
        The motion.

    Returns
    -------
    LimitViolationError
        With segment, joint, torque and limit.

    """
    holding = peak_holding_torque(task.model, trajectory)
    joint = int((holding.value / task.limits.max_effort).argmax())
    needed, limit = float(holding.value[joint]), float(task.limits.max_effort[joint])
    name = task.model.joint_names[joint]
    segment = int(np.searchsorted(trajectory.via_times[1:-1], holding.time[joint]))
    return holding_error(
        f'segment {task.segment_number(segment)}: along the segment', name, needed, limit)
