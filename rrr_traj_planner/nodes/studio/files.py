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

from pathlib import Path
from tempfile import TemporaryDirectory

from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.point_files.reading import read_task
from rrr_traj_planner.nodes.point_files.task import Task
from rrr_traj_planner.nodes.studio.wanted import Wanted


def saved(wanted: Wanted) -> str:
    """
    Return a via-point file; the scalings are not in it.

    Parameters
    ----------
    wanted : Wanted
        What is planned.

    Returns
    -------
    str
        YAML.

    """
    task = wanted.task
    lines = [f'planner_id: {task.planner_id}', 'via_points:',
             *(f'  - {point}' for point in wanted.points.tolist())]
    if len(task.stop_at):
        stops = ', '.join(str(stop).lower() for stop in task.stop_at.tolist())
        lines.append(f'stop_at: [{stops}]')
    if len(task.dwell):
        lines.append(f'dwell: {task.dwell.tolist()}')
    return '\n'.join(lines) + '\n'


def loaded(name: str, content: bytes) -> Task:
    """
    Return what a file says.

    Parameters
    ----------
    name : str
        Its name; the suffix tells its format.
    content : bytes
        Its content.

    Returns
    -------
    Task
        Its arm is of no meaning here.

    Raises
    ------
    InvalidInputError
        If it is malformed; the message names the file.

    """
    with TemporaryDirectory() as folder:
        file = Path(folder, Path(name).name)
        file.write_bytes(content)
        try:
            return read_task(str(file))
        except InvalidInputError as error:
            raise InvalidInputError(str(error).replace(f'{folder}/', '')) from None
