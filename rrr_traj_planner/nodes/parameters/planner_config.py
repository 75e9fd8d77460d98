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

"""The planner node's configuration without ROS, as the node would have it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.parameters.arm_source import arm_source
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.parameters.parameter_files import planner_values
from rrr_traj_planner.nodes.parameters.ros_arguments import parameters_in
from rrr_traj_planner.nodes.parameters.table import check_value, PLANNER, rows_of


def planner_config(file: Path | None, limits: Path | None = None,
                   ros_arguments: Sequence[str] = ()) -> PlannerConfig:
    """
    Return the planner node's configuration from a parameter file and arguments for ROS.

    Parameters
    ----------
    file : Path, optional
        A ROS parameter file.
    limits : Path, optional
        A file of joint limits in place of the parameter `joint_limits_file`.
    ros_arguments : sequence of str
        Their parameters take precedence over the file's.

    Returns
    -------
    PlannerConfig
        Checked; parameters that are left out have their defaults.

    Raises
    ------
    InvalidInputError
        If a file is missing or malformed, or a value is wrong; names the file, if there is one.

    """
    sources = [] if file is None else [(planner_values(file), file.absolute().parent)]
    last = [] if limits is None else [({'joint_limits_file': str(limits)}, Path.cwd())]
    given, folder_of = merged([*sources, *parameters_in(ros_arguments), *last])
    try:
        return config_of(given, folder_of)
    except InvalidInputError as error:
        if file is None:
            raise
        raise InvalidInputError(f'{file}: {error}') from None


def merged(sources: Iterable[tuple[dict[str, Any], Path]]) -> tuple[
        dict[str, Any], Callable[[str, str], Path]]:
    """
    Return the parameters of several sources.

    Parameters
    ----------
    sources : iterable of pairs
        Values by name, and the folder that their relative paths refer to; later ones take
        precedence.

    Returns
    -------
    values : dict
        By name.
    folder_of : callable
        Returns the folder for a parameter's name and value.

    """
    given: dict[str, Any] = {}
    folders: dict[str, Path] = {}
    for values, folder in sources:
        given.update(values)
        folders.update(dict.fromkeys(values, folder))
    return given, lambda name, _: folders[name]


def config_of(given: dict[str, Any], folder_of: Callable[[str, str], Path]) -> PlannerConfig:
    """
    Return the planner node's configuration from its parameters.

    Parameters
    ----------
    given : dict
        Values by name.
    folder_of : callable
        Returns, for a parameter's name and value, the folder that its relative path refers to.

    Returns
    -------
    PlannerConfig
        Checked; parameters that are left out have their defaults.

    Raises
    ------
    InvalidInputError
        If a value is wrong.

    """
    source = arm_source(given, folder_of)
    rows = rows_of(PLANNER, source.joint_names)
    values = {name: source.values.get(name, row.default) for name, row in rows.items()}
    values.update({name: value for name, value in given.items()
                   if name in rows and name not in ('robot_description', 'joint_limits_file')})
    for name, value in values.items():
        check_value(rows[name], value)
    return PlannerConfig.from_values(values)
