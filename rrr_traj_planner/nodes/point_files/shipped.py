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

"""The package's own via-point files."""

from __future__ import annotations

from pathlib import Path
import re

from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.parameters.configuration_files import shipped_folder
from rrr_traj_planner.nodes.point_files.reading import read_task
from rrr_traj_planner.nodes.point_files.task import Task

TASK = re.compile('^(joint_)?via_points:', re.MULTILINE)  # not in files of parameters


def shipped_tasks() -> dict[str, Path]:
    """
    Return the package's own tasks.

    Returns
    -------
    dict
        Files by their names without suffix: the thesis's tables first, then those of other arms.

    """
    folder = shipped_folder()
    files = [*sorted(folder.glob('*.yaml')), *sorted((folder / 'arms').glob('*.yaml'))]
    return {path.stem: path for path in files if TASK.search(path.read_text(encoding='utf-8'))}


def shipped_task(name: str) -> Task:
    """
    Return one of the package's own tasks.

    Parameters
    ----------
    name : str
        As in `shipped_tasks`.

    Returns
    -------
    Task
        The task.

    Raises
    ------
    InvalidInputError
        If there is none of this name any more, or it is malformed.

    """
    file = shipped_tasks().get(name)
    if file is None:
        raise InvalidInputError(f"there is no task '{name}' among the package's any more")
    return read_task(str(file))
