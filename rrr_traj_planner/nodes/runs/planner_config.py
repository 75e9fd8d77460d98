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

SERVICE = 'trajectory_planner/get_parameters'


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
    client = node.create_client(GetParameters, SERVICE)

    def values(names: list[str]) -> dict[str, Any]:
        answer = node.answer(client, GetParameters.Request(names=names))
        return dict(zip(names, map(parameter_value_to_python, answer.values)))

    joint_names = values(['joint_names'])['joint_names']
    config = PlannerConfig.from_values(values(list(rows_of(PLANNER, joint_names))))
    return replace(config, limits=config.limits_for(planner_id))
