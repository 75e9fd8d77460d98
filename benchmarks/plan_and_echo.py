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

"""
The process that `bench_service.py` calls: the planner's node, and an echo.

    python benchmarks/plan_and_echo.py SAMPLE_PERIOD

The service `echo` answers every request with one and the same message: what the planner answers
to table 6.1 with that sample period [s], prepared before the first request.
"""

from __future__ import annotations

import sys

from bare_node import spin_until_signal
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.parameters.table import PLANNER, rows_of
from rrr_traj_planner.nodes.planner_node.node import TrajectoryPlanner
from rrr_traj_planner.nodes.planner_node.planning_answer import success
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from tasks import ARM, TIPS


def default_config() -> PlannerConfig:
    """Return the planner's parameters as they are where nothing is said."""
    return PlannerConfig.from_values(
        {name: row.default for name, row in rows_of(PLANNER, ARM.joint_names).items()})


def main() -> None:
    """Spin until SIGINT."""
    config = default_config()
    prepared = success(plan(config.model, config.limits, PlanningRequest(
        TIPS['6.1'], sample_period=float(sys.argv[1]))), config)
    rclpy.init()
    echo = Node('echo')
    echo.create_service(PlanTrajectory, 'echo', lambda request, response: prepared)
    executor = SingleThreadedExecutor()
    for node in (TrajectoryPlanner(), echo):
        executor.add_node(node)
    spin_until_signal(executor)


if __name__ == '__main__':
    main()
