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

"""Reading a via-point file: one reader for all scripts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.parameters.configuration_files import found_file
from rrr_traj_planner.nodes.point_files.document import document
from rrr_traj_planner.nodes.point_files.point_tables import table
from rrr_traj_planner.nodes.point_files.task import given, JointPositions, Task
from rrr_traj_planner.planners.request import PlanningRequest

ARM = 'thesis_arm.yaml'  # of files that name none
ANY_PERIOD = 1e9         # s, a sample_period by which no motion has too many points


def read_task(file: str, *, started: bool = False) -> Task:
    """
    Read a via-point file: YAML, or comma-separated values if its suffix is .csv.

    Parameters
    ----------
    file : str
        A path, or the name of a file in the package's config/ or config/arms/.
    started : bool
        Whether the motion starts from a state of the arm, as with the service's start_state: then
        a single via point is enough, segment_durations begins with the segment from there to the
        first via point, and the arm rests at the first only if stop_at says so.

    Returns
    -------
    Task
        The content, checked.

    Raises
    ------
    InvalidInputError
        If the file is missing or malformed, or there are too few via points, or other than one
        value for each; names the file, the line if known, and what is wrong.

    """
    path = found_file(file, Path.cwd())
    try:
        text = path.read_text(encoding='utf-8-sig')
    except (OSError, UnicodeDecodeError) as error:
        raise _in_file(path, error) from None
    return task_in(text, path, path.parent, started=started)


def task_in(text: str, path: Path, *folders: Path, started: bool = False) -> Task:
    """
    Return what the text of a via-point file says.

    Parameters
    ----------
    text : str
        The text.
    path : Path
        The file's; the suffix tells the format.
    *folders : Path
        Where the arm's parameter file is looked for.
    started : bool
        See `read_task`.

    Returns
    -------
    Task
        The content, checked.

    Raises
    ------
    InvalidInputError
        See `read_task`.

    """
    try:
        content = table(text) if path.suffix.lower() == '.csv' else document(text)
        arm = found_file(content.pop('arm', '') or ARM, *folders)
        number = len(content.get('joint_positions') or content['via_points'])
        task = Task(path.stem, content.pop('via_points', np.zeros((0, 3))), arm, **content)
        _check_counts(task, number, started)
    except InvalidInputError as error:
        raise _in_file(path, error) from None
    if task.joint_positions is None:
        return task
    return replace(task, joint_positions=_named(path, task.joint_positions))


def _check_counts(task: Task, number: int, started: bool) -> None:
    """Refuse what any request with so many via points is refused for, in the same words."""
    PlanningRequest(
        np.zeros((number, 3)), np.zeros(3) if started else None, stop_at=given(task.stop_at),
        dwell=given(task.dwell), segment_durations=given(task.segment_durations),
        sample_period=ANY_PERIOD)


def _named(path: Path, positions: JointPositions) -> JointPositions:
    """Return joint positions whose errors name the file."""
    def of_joints(joint_names: Sequence[str]) -> Array:
        try:
            return positions(joint_names)
        except InvalidInputError as error:
            raise _in_file(path, error) from None

    return of_joints


def _in_file(path: Path, error: Exception) -> InvalidInputError:
    return InvalidInputError(f'{path}: {" ".join(str(error).split())}')
