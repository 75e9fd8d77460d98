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

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from rclpy.parameter import parameter_value_to_python
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.parameters.table import PLANNER, rows_of

SERVICE = 'trajectory_planner/get_parameters'


def planner_config(ask: Callable[[list[str]], Sequence[Any]], planner_id: str) -> PlannerConfig:
    """
    Return the configuration of a running planner.

    Parameters
    ----------
    ask : callable
        Gets names of parameters, and returns their values (rcl_interfaces/msg/ParameterValue).
    planner_id : str
        The planner whose limits are wanted; empty: the default one.

    Returns
    -------
    PlannerConfig
        With the limits that hold for this planner.

    """
    def values(names: list[str]) -> dict[str, Any]:
        return dict(zip(names, map(parameter_value_to_python, ask(names))))

    joint_names = values(['joint_names'])['joint_names']
    config = PlannerConfig.from_values(values(list(rows_of(PLANNER, joint_names))))
    return replace(config, limits=config.limits_for(planner_id))
