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

"""The via-point problem of a task, and the slowing of its motions as torque requires."""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.errors import InvalidInputError, LimitViolationError
from rrr_traj_planner.core.motion_laws.cycloid_transitions import CYCLOID
from rrr_traj_planner.core.trajectory.pieces import TransitionFunction
from rrr_traj_planner.core.trajectory.torque import peak_holding_torque, time_scale_for_torque
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.transitions.transition_law import TransitionLaw
from rrr_traj_planner.planners.transitions.via_problem import LEAST_VELOCITY, ViaProblem
from rrr_traj_planner.planners.via_points import holding_error

# Number of samples that a transition at full acceleration lasts at least, so that a controller's
# quintics through them keep the limits: a limit on jerk, for cycloids pi / 5 acceleration /
# period.
SAMPLES_PER_TRANSITION = 5.0


def via_problem_of(task: JointTask, function: TransitionFunction = CYCLOID) -> ViaProblem:
    """
    Return the via-point problem of a task.

    A via velocity is bounded so that the joint can stop before the end of its range.

    Parameters
    ----------
    task : JointTask
        Via points, the arm and its limits.
    function : TransitionFunction
        The velocity function of transitions.

    Returns
    -------
    ViaProblem
        The problem.

    Raises
    ------
    InvalidInputError
        If a joint has no acceleration limit.

    """
    limits = task.limits
    if np.isinf(limits.max_acceleration).any():
        joint = task.model.joint_names[int(np.isinf(limits.max_acceleration).argmax())]
        raise InvalidInputError(
            f'a planner of {function.name} transitions needs acceleration limits, {joint} has '
            'none')
    sharpness = function.peak_jerk / function.peak_acceleration
    jerk = np.minimum(limits.max_jerk, sharpness * limits.max_acceleration / (
        SAMPLES_PER_TRANSITION * task.sample_period))
    law = TransitionLaw(function.peak_acceleration / limits.max_acceleration,
                        np.sqrt(function.peak_jerk / jerk))
    D = np.diff(task.points, axis=0)
    fastest = np.sqrt(2.0 * np.abs(D).sum(axis=0) / law.slope) + 1.0  # above any motion's
    velocity = np.minimum(limits.max_velocity, fastest)
    inner = task.points[1:-1]
    distance = np.minimum(inner - limits.min_position, limits.max_position - inner)
    highest = np.clip(np.sqrt(2.0 * np.maximum(distance, 0.0) / law.slope), LEAST_VELOCITY,
                      velocity)
    return ViaProblem(D, law, velocity, -highest, highest, function)


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
    factor = torque_time_scale(task, trajectory)
    if np.isinf(factor):
        raise cannot_hold(task, trajectory)
    return trajectory.time_scaled(factor) if factor > 1.0 else trajectory


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
