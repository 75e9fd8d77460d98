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

from collections.abc import Iterator, Sequence
from pathlib import Path
import re
from typing import Any

from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.parameters.arm_source import arm_source
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.parameters.table import check_value, PLANNER, rows_of
from rrr_traj_planner.nodes.parameters.yaml_loader import Loader
import yaml

# Sections that apply to the planner node; values of later ones take precedence.
NODES = ('/**', 'trajectory_planner', '/trajectory_planner')

BOTH = ('/trajectory_planner', '/simulated_arm')


def planner_config(file: Path, limits: Path | None = None) -> PlannerConfig:
    """
    Return the planner node's configuration from a parameter file.

    Parameters
    ----------
    file : Path
        A ROS parameter file: `/**:` or the node's name, `ros__parameters:`, values.
    limits : Path, optional
        A file of joint limits in place of the file's own `joint_limits_file`.

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
        given = _values(file)
        if limits is not None:
            given['joint_limits_file'] = str(limits.absolute())
        return config_of(given, file.parent)
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
    try:
        return any(True for _ in _sections(file, node))
    except (OSError, UnicodeDecodeError, yaml.YAMLError):
        return True


def files_given(arguments: Sequence[str]) -> list[Path]:
    """
    Return the parameter files on a command line.

    Parameters
    ----------
    arguments : sequence of str
        The command line.

    Returns
    -------
    list of Path
        In order.

    """
    return [Path(file) for option, file in zip(arguments, arguments[1:])
            if option == '--params-file']


def gives(file: Path, name: str) -> bool:
    """
    Return whether a parameter file gives one of the two nodes a value.

    Parameters
    ----------
    file : Path
        A ROS parameter file.
    name : str
        The parameter, at the top of a section.

    Returns
    -------
    bool
        False also if the file cannot be read: ROS reports that itself.

    """
    try:
        return any(isinstance(values, dict) and bool(values.get(name)) for node in BOTH
                   for values in _sections(file, node))
    except (OSError, UnicodeDecodeError, yaml.YAMLError):
        return False


def folder_of_value(files: Sequence[Path], node: str, name: str, value: Any) -> Path:
    """
    Return the folder that a parameter's relative path refers to.

    Parameters
    ----------
    files : sequence of Path
        The node's parameter files; the last one that has a value counts.
    node : str
        The node's fully qualified name.
    name : str
        The parameter, at the top of a section.
    value : object
        Its value.

    Returns
    -------
    Path
        Of the file that gives this value; the working directory if none does.

    """
    for file in reversed(files):
        try:
            found = [section.get(name) for section in _sections(file, node)
                     if isinstance(section, dict)]
        except (OSError, UnicodeDecodeError, yaml.YAMLError):
            continue
        if value in found:
            return file.absolute().parent
    return Path.cwd()


def _sections(file: Path, node: str) -> Iterator[Any]:
    """Yield the parameters of a file's sections that apply to a node."""
    def sections(tree: Any, path: str) -> Iterator[tuple[str, Any]]:
        for key, value in tree.items() if isinstance(tree, dict) else ():
            if key == 'ros__parameters':
                yield path, value
            else:
                yield from sections(value, f'{path}/{str(key).strip("/")}')

    for path, values in sections(yaml.load(file.read_text(), Loader), ''):
        if re.fullmatch(re.escape(path).replace(r'\*\*', '.*').replace(r'\*', '[^/]*'), node):
            yield values


def config_of(given: dict[str, Any], folder: Path) -> PlannerConfig:
    """
    Return the planner node's configuration from its parameters.

    Parameters
    ----------
    given : dict
        Values by name.
    folder : Path
        The folder that relative paths refer to.

    Returns
    -------
    PlannerConfig
        Checked; parameters that are left out have their defaults.

    Raises
    ------
    InvalidInputError
        If a value is wrong.

    """
    source = arm_source(given, lambda *_: folder)
    rows = rows_of(PLANNER, source.joint_names)
    values = {name: source.values.get(name, row.default) for name, row in rows.items()}
    values.update({name: value for name, value in given.items()
                   if name in rows and name not in ('robot_description', 'joint_limits_file')})
    for name, value in values.items():
        check_value(rows[name], value)
    return PlannerConfig.from_values(values)


def _values(file: Path) -> dict[str, Any]:
    """Return a file's parameters by their full names, with dots."""
    content = yaml.load(file.read_text(), Loader)
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
