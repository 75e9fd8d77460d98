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

"""A task as it is put to the planner for an arm that may be anywhere, at via point 0 too."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import InvalidInputError, UnreachableError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.inverse import nearest_solution
from rrr_traj_planner.nodes.motion.arm_states import ArmState
from rrr_traj_planner.nodes.motion.motions import IN_MOTION
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.point_files.reading import read_task
from rrr_traj_planner.nodes.point_files.task import Task

THERE = 'the arm is at via point 0: the motion starts there'
WAY_TIME = 'the file has no duration for the way to via point 0: the planner is to choose it'
MOVING = f"the arm moves: '{IN_MOTION}' plans from there"


class FromHere(NamedTuple):
    """
    A task from where an arm is.

    Attributes
    ----------
    task : Task
        What to ask for.
    skipped : int
        How many via points have been left out at the beginning, 0 or 1.
    notes : tuple of str
        What to tell the user.

    """

    task: Task
    skipped: int = 0
    notes: tuple[str, ...] = ()


def read_task_from_here(file: str) -> Task:
    """
    Read a via-point file for a motion from where the arm is.

    Parameters
    ----------
    file : str
        See `read_task`; one via point is enough. Files for motions that start at the first via
        point are read too: with a rest there, or without a duration of the way to it.

    Returns
    -------
    Task
        The content.

    Raises
    ------
    InvalidInputError
        If the file is neither; see `read_task`.

    """
    try:
        return read_task(file, started=True)
    except InvalidInputError as error:
        try:
            return read_task(file)
        except InvalidInputError:
            raise error from None


def from_here(task: Task, config: PlannerConfig, state: ArmState | None, tolerance: float
              ) -> FromHere:
    """
    Return what to ask for.

    A via point at which the arm already is at rest is left out: the way to it would be a motion
    of its own, over what the arm is off. So is it not where the arm is to rest there.

    Parameters
    ----------
    task : Task
        The via points.
    config : PlannerConfig
        The planner's.
    state : ArmState, optional
        Where the arm is; None: it is not known, and the motion starts at the first via point.
    tolerance : float
        How far each joint may be off [rad].

    Returns
    -------
    FromHere
        The task.

    """
    if state is None:
        return FromHere(task)
    q = None if state.is_moving else _positions(state, config)
    joints = task.joint_via_points(config.model.joint_names)
    count = len(task.via_points if joints is None else joints)
    rests = len(task.dwell) and task.dwell[0] > 0.0
    if count > 1 and not rests and q is not None and _is_at(q, task, config, tolerance):
        return FromHere(_without_first(task, count), 1, (THERE,))
    notes: tuple[str, ...] = ()
    if state.is_moving and not task.planner_id:
        notes = (MOVING,)
        task = replace(task, planner_id=IN_MOTION)
    if rests:
        stops = task.stop_at if len(task.stop_at) else np.arange(count) == count - 1
        task = replace(task, stop_at=np.concatenate(([True], stops[1:])))
    if len(task.segment_durations) == count - 1 > 0:
        notes = (*notes, WAY_TIME)
        task = replace(task, segment_durations=np.append(np.nan, task.segment_durations))
    return FromHere(task, notes=notes)


def in_base_frame(task: Task, config: PlannerConfig, q: Array) -> Task:
    """
    Return a task whose via points are in the base frame.

    Parameters
    ----------
    task : Task
        Perhaps in another frame, from which the planner has transformed it.
    config : PlannerConfig
        The planner's.
    q : ndarray, shape (n, 3)
        The plan's joint positions at the via points [rad].

    Returns
    -------
    Task
        The same where it is in the base frame.

    """
    if task.frame in ('', config.base_frame):
        return task
    return replace(task, via_points=forward_kinematics(config.model, q), frame='')


def _positions(state: ArmState, config: PlannerConfig) -> Array | None:
    """Return the arm's joint positions, None where one is not known."""
    found = [state.joints[name][0] for name in config.model.joint_names if name in state.joints]
    return np.array(found) if len(found) == len(config.model.joint_names) else None


def _is_at(q: Array, task: Task, config: PlannerConfig, tolerance: float) -> bool:
    """Return whether an arm is at the first via point, as far as that is known."""
    joints = task.joint_via_points(config.model.joint_names)
    if joints is None:
        if task.frame not in ('', config.base_frame):
            return False
        try:
            first = nearest_solution(config.model, task.via_points[0], q)
        except UnreachableError:
            return False
    else:
        first = joints[0]
    return bool(np.abs(first - q).max() <= tolerance)


def _without_first(task: Task, count: int) -> Task:
    """Return a task of at least two via points without the first one."""
    joint_positions = task.joint_positions
    durations = task.segment_durations
    return replace(
        task, via_points=task.via_points[1:], stop_at=task.stop_at[1:], dwell=task.dwell[1:],
        segment_durations=durations[1:] if len(durations) == count else durations,
        joint_positions=None if joint_positions is None else lambda names: joint_positions(
            names)[1:])
