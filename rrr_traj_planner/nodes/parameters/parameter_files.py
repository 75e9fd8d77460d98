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

"""Parameter files, read without ROS."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
import re
from typing import Any

from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.parameters.yaml_loader import input_error, RosLoader
import yaml

# Sections that apply to the planner node; values of later ones take precedence.
NODES = ('/**', 'trajectory_planner', '/trajectory_planner')

BOTH = ('/trajectory_planner', '/simulated_arm')


def planner_values(file: Path) -> dict[str, Any]:
    """
    Return the planner node's parameters in a file.

    Parameters
    ----------
    file : Path
        A ROS parameter file: `/**:` or the node's name, `ros__parameters:`, values.

    Returns
    -------
    dict
        Values by full names, with dots.

    Raises
    ------
    InvalidInputError
        If the file is missing or malformed; names it.

    """
    try:
        return _values(file)
    except (OSError, UnicodeDecodeError, yaml.YAMLError, InvalidInputError) as error:
        text = input_error(error) if isinstance(error, yaml.YAMLError) else error
        raise InvalidInputError(f'{file}: {" ".join(str(text).split())}') from None


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

    content = yaml.load(file.read_text(), RosLoader)  # noqa: S506, a SafeLoader
    for path, values in sections(content, ''):
        if re.fullmatch(re.escape(path).replace(r'\*\*', '.*').replace(r'\*', '[^/]*'), node):
            yield values


def _values(file: Path) -> dict[str, Any]:
    """Return a file's parameters by their full names, with dots."""
    content = yaml.load(file.read_text(), RosLoader)  # noqa: S506, a SafeLoader
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
