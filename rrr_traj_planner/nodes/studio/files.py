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

"""Via-point files that the page saves and loads: those of `demo` and `move`."""

from __future__ import annotations

import json
from pathlib import Path

from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.parameters.configuration_files import found_file
from rrr_traj_planner.nodes.point_files.document import document
from rrr_traj_planner.nodes.point_files.reading import task_in
from rrr_traj_planner.nodes.point_files.task import Task
from rrr_traj_planner.nodes.studio.wanted import Wanted


def saved(wanted: Wanted, arm: Path | None) -> str:
    """
    Return a via-point file: with all that such files can have.

    Parameters
    ----------
    wanted : Wanted
        What is planned.
    arm : Path, optional
        The arm's parameter file.

    Returns
    -------
    str
        YAML.

    """
    task = wanted.task
    values, name = wanted.points, 'via_points'
    if wanted.joints is not None and wanted.joints_known:
        values, name = wanted.joints, 'joint_via_points'
    lines = [] if arm is None else [f'arm: {json.dumps(_name_of(arm), ensure_ascii=False)}']
    lines += [f'planner_id: {task.planner_id}', f'{name}:',
              *(f'  - {point}' for point in values.tolist())]
    for field in ('stop_at', 'dwell', 'segment_durations'):
        given = getattr(task, field)
        if len(given):
            lines.append(f'{field}: {_listed(given.tolist())}')
    return '\n'.join(lines) + '\n'


def _name_of(arm: Path) -> str:
    """Return the name by which a file of parameters is found from everywhere."""
    try:
        return arm.name if found_file(arm.name, Path('/')) == arm else str(arm)
    except InvalidInputError:
        return str(arm)


def _listed(values: list[bool] | list[float]) -> str:
    """Return a list as YAML has it."""
    return '[' + ', '.join('.nan' if v != v else json.dumps(v) for v in values) + ']'


def loaded(name: str, content: bytes, *folders: Path) -> tuple[Task, bool]:
    """
    Return what a file says.

    Parameters
    ----------
    name : str
        Its name; the suffix tells its format.
    content : bytes
        Its content.
    *folders : Path
        Where the arm's parameter file is looked for: a browser does not tell the file's own.

    Returns
    -------
    task : Task
        The file.
    names_arm : bool
        Whether it says which arm it is for; else `task.arm` is of no meaning.

    Raises
    ------
    InvalidInputError
        If it is malformed; the message names the file.

    """
    file = Path(Path(name).name)
    try:
        text = content.decode('utf-8-sig')
    except UnicodeDecodeError as error:
        raise InvalidInputError(f'{file}: {error}') from None
    task = task_in(text, file, *folders)
    return task, file.suffix.lower() != '.csv' and bool(document(text).get('arm'))
