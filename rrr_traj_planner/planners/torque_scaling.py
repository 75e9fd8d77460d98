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

Scaling time by z divides the torque of inertia by z^2 and that of viscous friction by z
(Hollerbach, Dynamic scaling of manipulator trajectories, ASME J. Dynamic Systems, Measurement, and
Control 106, 1984; `core.trajectory.time_scaling`).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import LimitViolationError
from rrr_traj_planner.core.trajectory.time_scaling import TORQUE_ROUNDING
from rrr_traj_planner.core.trajectory.torque import peak_holding_torque, time_scale_for_torque
from rrr_traj_planner.core.trajectory.torque_sweep import torque_sweep
from rrr_traj_planner.core.trajectory.trajectory import MOST_FACTOR, Trajectory
from rrr_traj_planner.planners.effort_errors import holding_error, moving_error
from rrr_traj_planner.planners.tasks import JointTask

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
        Infinite where gravity and Coulomb friction alone exceed a limit.

    """
    factor = float(time_scale_for_torque(task.model, task.limits, trajectory).value.max())
    # With viscous friction a factor that one torque requires may be too large for another.
    while task.model.friction.viscous.any() and 1.0 < factor < MOST_FACTOR:
        slowed = trajectory.time_scaled(factor)
        further = float(time_scale_for_torque(task.model, task.limits, slowed).value.max())
        if further <= 1.0 + TORQUE_ROUNDING:
            break
        factor *= further
    return factor


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
        If gravity and Coulomb friction alone exceed an effort limit along the path.

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
    Return the error of a path along which gravity and friction exceed an effort limit.

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
    holding, limits = peak_holding_torque(task.model, trajectory), task.limits.max_effort
    joint = int((holding.value / limits).argmax())
    if holding.value[joint] > limits[joint]:
        where = _along_segment(task, trajectory, float(holding.time[joint]))
        return holding_error(where, task.model.joint_names[joint], float(holding.value[joint]),
                             float(limits[joint]))
    sweep = torque_sweep(task.model, trajectory)
    constant = np.abs(sweep.parts.constant)
    row, joint = map(int, np.unravel_index(int((constant / limits).argmax()), constant.shape))
    where = _along_segment(task, trajectory, float(sweep.times[row]))
    return moving_error(where, task.model.joint_names[joint], float(constant[row, joint]),
                        float(limits[joint]))


def _along_segment(task: JointTask, trajectory: Trajectory, time: float) -> str:
    """Return where a motion is at a time, for an error."""
    segment = int(np.searchsorted(trajectory.via_times[1:-1], time))
    return f'segment {task.segment_number(segment)}: along the segment'
