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

"""A running planner node for tests, its service and its parameters."""

from __future__ import annotations

from threading import enumerate as threads

from helpers.plan_requests import patient, plan_request
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters, SetParameters
from rrr_traj_planner.nodes.planner_node.node import TrajectoryPlanner
from rrr_traj_planner_interfaces.srv import PlanTrajectory


def start_planner(ros, cli_args=None, **overrides):
    return ros.add(TrajectoryPlanner(
        context=ros.context, cli_args=cli_args, parameter_overrides=patient(**overrides)))


def plan(ros, *points, **fields):
    return ros.call(PlanTrajectory, 'plan_trajectory', plan_request(*points, **fields))


def parameter_value(ros, name='sample_period'):
    return ros.call(GetParameters, 'trajectory_planner/get_parameters',
                    GetParameters.Request(names=[name])).values[0]


def set_parameter(ros, name, value):
    kind = ({'type': ParameterType.PARAMETER_STRING, 'string_value': value}
            if isinstance(value, str) else
            {'type': ParameterType.PARAMETER_DOUBLE, 'double_value': value})
    answer = ros.call(SetParameters, 'trajectory_planner/set_parameters', SetParameters.Request(
        parameters=[ParameterMessage(name=name, value=ParameterValue(**kind))]))
    return answer.results[0]


def planning_threads():
    return [thread for thread in threads() if thread.name == 'planning']
