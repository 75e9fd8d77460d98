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
from rrr_traj_planner.nodes.point_files.task import JointPositions, Task

ARM = 'thesis_arm.yaml'  # of files that name none


def read_task(file: str) -> Task:
    """
    Read a via-point file: YAML, or comma-separated values if its suffix is .csv.

    Parameters
    ----------
    file : str
        A path, or the name of a file in the package's config/ or config/arms/.

    Returns
    -------
    Task
        The content, checked.

    Raises
    ------
    InvalidInputError
        If the file is missing or malformed; names the file, the line if known, and what is wrong.

    """
    path = found_file(file, Path.cwd())
    try:
        text = path.read_text(encoding='utf-8-sig')
        content = table(text) if path.suffix.lower() == '.csv' else document(text)
        arm = found_file(content.pop('arm', '') or ARM, path.parent)
    except (OSError, UnicodeDecodeError, InvalidInputError) as error:
        raise _in_file(path, error) from None
    task = Task(path.stem, content.pop('via_points', np.zeros((0, 3))), arm, **content)
    if task.joint_positions is None:
        return task
    return replace(task, joint_positions=_named(path, task.joint_positions))


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
