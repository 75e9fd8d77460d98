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

"""Parameter files read without ROS, with the result that the planner node would have."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
import re
from typing import Any

from rrr_traj_planner.core.arm.model import JOINT_NAMES
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.parameters.override_checks import check_given
from rrr_traj_planner.nodes.parameters.table import check_value, PLANNER, rows_of
import yaml

# Sections that apply to the planner node; values of later ones take precedence.
NODES = ('/**', 'trajectory_planner', '/trajectory_planner')


def planner_config(file: Path) -> PlannerConfig:
    """
    Return the planner node's configuration from a parameter file.

    Parameters
    ----------
    file : Path
        A ROS parameter file: `/**:` or the node's name, `ros__parameters:`, values.

    Returns
    -------
    PlannerConfig
        Checked; parameters that the file leaves out have their defaults.

    Raises
    ------
    InvalidInputError
        If the file is missing or malformed, or a value is wrong; names the file.

    """
    try:
        return _config(_values(file))
    except (OSError, UnicodeDecodeError, yaml.YAMLError, InvalidInputError) as error:
        raise InvalidInputError(f'{file}: {" ".join(str(error).split())}') from None


def has_section_for(file: Path, node: str) -> bool:
    """
    Return whether a parameter file has a section for a node.

    Parameters
    ----------
    file : Path
        A ROS parameter file.
    node : str
        The node's fully qualified name.

    Returns
    -------
    bool
        True also if the file cannot be read: ROS reports that itself.

    """
    def sections(tree: Any, path: str) -> Iterator[str]:
        for key, value in tree.items() if isinstance(tree, dict) else ():
            if key == 'ros__parameters':
                yield path
            else:
                yield from sections(value, f'{path}/{str(key).strip("/")}')

    try:
        found = list(sections(yaml.safe_load(file.read_text()), ''))
    except (OSError, UnicodeDecodeError, yaml.YAMLError):
        return True
    return any(re.fullmatch(re.escape(path).replace(r'\*\*', '.*').replace(r'\*', '[^/]*'), node)
               for path in found)


def _config(given: dict[str, Any]) -> PlannerConfig:
    rows = rows_of(PLANNER, JOINT_NAMES)
    names = given.get('joint_names', rows['joint_names'].default)
    check_value(rows['joint_names'], names)
    check_given(given, names)
    rows = rows_of(PLANNER, names)
    values = {name: given.get(name, row.default) for name, row in rows.items()}
    for name, value in values.items():
        check_value(rows[name], value)
    return PlannerConfig.from_values(values)


def _values(file: Path) -> dict[str, Any]:
    """Return a file's parameters by their full names, with dots."""
    content = yaml.safe_load(file.read_text())
    found: dict[str, Any] = {}
    for node in NODES:
        part = content.get(node) if isinstance(content, dict) else None
        parameters = part.get('ros__parameters') if isinstance(part, dict) else None
        if isinstance(parameters, dict):
            found.update(_flat(parameters))
    if not found:
        raise InvalidInputError(f'no parameters of a node {", ".join(NODES[:2])}')
    return found


def _flat(values: dict[str, Any], prefix: str = '') -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, value in values.items():
        full = f'{prefix}{name}'
        found.update(_flat(value, f'{full}.') if isinstance(value, dict) else {full: value})
    return found
