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

"""The via-point problem of a task: transition law, velocity bounds, distance to the ranges."""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.errors import InvalidInputError, LimitViolationError
from rrr_traj_planner.core.motion_laws.cycloid_transitions import CYCLOID
from rrr_traj_planner.core.trajectory.pieces import TransitionFunction
from rrr_traj_planner.core.trajectory.torque import peak_holding_torque, stretch_for_torque
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.request import JointTask
from rrr_traj_planner.planners.transitions.transition_law import TransitionLaw
from rrr_traj_planner.planners.transitions.via_problem import LEAST_VELOCITY, ViaProblem
from rrr_traj_planner.planners.via_points import holding_error

# A transition at full acceleration lasts at least so many samples, so that the quintic through
# them keeps the limits: it is a limit on jerk, of a cycloid's pi / 5 of acceleration / period.
SAMPLES_PER_TRANSITION = 5.0


def via_problem_of(task: JointTask, function: TransitionFunction = CYCLOID) -> ViaProblem:
    """
    Return the optimisation problem of a task; the joints' ranges bound the via velocities.

    Parameters
    ----------
    task : JointTask
        What is asked.
    function : TransitionFunction
        What transitions are made of.

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
    fastest = np.sqrt(2.0 * np.abs(D).sum(axis=0) / law.slope) + 1.0  # no motion is faster
    velocity = np.minimum(limits.max_velocity, fastest)
    inner = task.points[1:-1]
    room = np.minimum(inner - limits.min_position, limits.max_position - inner)
    highest = np.clip(np.sqrt(2.0 * np.maximum(room, 0.0) / law.slope), LEAST_VELOCITY, velocity)
    return ViaProblem(D, law, velocity, -highest, highest, function)


def torque_stretch(task: JointTask, trajectory: Trajectory) -> float:
    """
    Return by how much torque asks the whole motion to be slowed down; at most 1: not at all.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    trajectory : Trajectory
        The motion.

    Returns
    -------
    float
        Infinite where gravity alone is too much.

    """
    return float(stretch_for_torque(task.model, task.limits, trajectory).value.max())


def slowed_for_torque(task: JointTask, trajectory: Trajectory) -> Trajectory:
    """
    Return the motion run through as a whole just as slowly as its torques ask for.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    trajectory : Trajectory
        The motion.

    Returns
    -------
    Trajectory
        The same where there is torque enough.

    Raises
    ------
    LimitViolationError
        If gravity alone exceeds an effort limit on the way.

    """
    stretch = torque_stretch(task, trajectory)
    if np.isinf(stretch):
        raise cannot_hold(task, trajectory)
    return trajectory.stretched(stretch) if stretch > 1.0 else trajectory


def cannot_hold(task: JointTask, trajectory: Trajectory) -> LimitViolationError:
    """
    Return the error of a path on which gravity takes more than a motor has.

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
        f'segment {task.segment_number(segment)}: on its way', name, needed, limit)
