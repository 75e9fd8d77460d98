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

"""Parameters among a command line's arguments for ROS, read without ROS."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from rrr_traj_planner.core.arm.urdf_xml import is_xml
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.parameters.configuration_files import found_file
from rrr_traj_planner.nodes.parameters.parameter_files import (
    files_given,
    gives,
    NODES,
    planner_values,
)
from rrr_traj_planner.nodes.parameters.yaml_loader import RosLoader
import yaml

PARAMETER = ('-p', '--param')
FILE = '--params-file'


def describes_an_arm(ros_arguments: Sequence[str]) -> bool:
    """
    Return whether arguments for ROS have a parameter `robot_description`.

    Parameters
    ----------
    ros_arguments : sequence of str
        The user's.

    Returns
    -------
    bool
        True for `-p [NODE:]robot_description:=...`, and for a parameter file that has it.

    """
    return any(name == 'robot_description' for _, name, _ in _assigned(ros_arguments)) or any(
        gives(file, 'robot_description') for file in files_given(ros_arguments))


def parameters_in(ros_arguments: Sequence[str]) -> Iterator[tuple[dict[str, Any], Path]]:
    """
    Yield the planner node's parameters in arguments for ROS; later ones take precedence.

    Parameters
    ----------
    ros_arguments : sequence of str
        With `--params-file FILE` and `-p [NODE:]NAME:=VALUE`; others, on names of topics and on
        logging, are left out.

    Yields
    ------
    values : dict
        By name.
    folder : Path
        That relative paths among them refer to.

    Raises
    ------
    InvalidInputError
        If a file is missing or malformed; names it.

    """
    for file in files_given(ros_arguments):
        yield planner_values(file), file.absolute().parent
    nodes = {node.strip('/') for node in NODES}
    for node, name, text in _assigned(ros_arguments):
        if not node or node.strip('/') in nodes:
            try:
                content = yaml.load(text, RosLoader)  # noqa: S506, a SafeLoader
                yield {name: content}, Path.cwd()
            except yaml.YAMLError as error:
                raise InvalidInputError(
                    f'parameter {name}: {" ".join(str(error).split())}') from None


def without_parameters(ros_arguments: Sequence[str]) -> list[str]:
    """
    Return arguments for ROS without parameters and their files.

    Parameters
    ----------
    ros_arguments : sequence of str
        The user's.

    Returns
    -------
    list of str
        The rest.

    """
    found: list[str] = []
    is_value = False
    for argument in ros_arguments:
        is_option = not is_value and argument in (*PARAMETER, FILE)
        if not is_option and not is_value:
            found.append(argument)
        is_value = is_option
    return found


def description_folder(ros_arguments: Sequence[str]) -> Path:
    """
    Return the folder of the URDF that arguments for ROS name.

    Parameters
    ----------
    ros_arguments : sequence of str
        Of the nodes.

    Returns
    -------
    Path
        The present folder where there is no URDF, or where its text is given.

    """
    found = Path.cwd()
    for values, folder in parameters_in(ros_arguments):
        description = values.get('robot_description', '')
        if isinstance(description, str) and description:
            found = Path.cwd() if is_xml(description) else found_file(description, folder).parent
    return found


def _assigned(ros_arguments: Sequence[str]) -> Iterator[tuple[str, str, str]]:
    """Yield node, name and value of each `-p`."""
    for option, text in zip(ros_arguments, ros_arguments[1:]):
        if option in PARAMETER and ':=' in text:
            name, _, value = text.partition(':=')
            node, _, name = name.rpartition(':')
            yield node, name, value
