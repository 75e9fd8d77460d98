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

"""The planner's configuration, as its client has it from the planner's parameters."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from rcl_interfaces.srv import GetParameters
from rclpy.parameter import parameter_value_to_python
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.parameters.table import PLANNER, rows_of
from rrr_traj_planner.nodes.runs.spun_node import SpunNode

PLANNER_NODE = 'trajectory_planner'


def planner_config(node: SpunNode, planner_id: str) -> PlannerConfig:
    """
    Return the configuration of a running planner.

    Parameters
    ----------
    node : SpunNode
        Asks for the planner's parameters.
    planner_id : str
        The planner whose limits are wanted; empty: the default one.

    Returns
    -------
    PlannerConfig
        With the limits that hold for this planner.

    Raises
    ------
    StartError
        If there is no answer.

    """
    config = PlannerConfig.from_values(planner_values(node))
    return replace(config, limits=config.limits_for(planner_id))


def planner_values(node: SpunNode) -> dict[str, Any]:
    """
    Return the parameters of a running planner.

    Parameters
    ----------
    node : SpunNode
        Asks for them.

    Returns
    -------
    dict
        Values by name.

    Raises
    ------
    StartError
        If there is no answer.

    """
    joint_names = values_of(node, PLANNER_NODE, ['joint_names'])['joint_names']
    return values_of(node, PLANNER_NODE, list(rows_of(PLANNER, joint_names)))


def values_of(node: SpunNode, name: str, parameters: list[str]) -> dict[str, Any]:
    """
    Return parameters of a running node.

    Parameters
    ----------
    node : SpunNode
        Asks for them.
    name : str
        The other node's name.
    parameters : list of str
        Their names.

    Returns
    -------
    dict
        Values by name.

    Raises
    ------
    StartError
        If there is no answer.

    """
    client = node.create_client(GetParameters, f'{name}/get_parameters')
    answer = node.answer(client, GetParameters.Request(names=parameters))
    return dict(zip(parameters, map(parameter_value_to_python, answer.values)))
