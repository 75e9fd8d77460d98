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

"""A node that serves `plan_trajectory` and cannot plan: how fast any such node can start."""

from __future__ import annotations

from contextlib import suppress

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rrr_traj_planner_interfaces.srv import PlanTrajectory


def main() -> None:
    """Spin until SIGINT."""
    rclpy.init()
    node, executor = Node('bare'), SingleThreadedExecutor()
    answer = PlanTrajectory.Response(error_code=PlanTrajectory.Response.SUCCESS)
    node.create_service(PlanTrajectory, 'plan_trajectory', lambda request, response: answer)
    executor.add_node(node)
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        executor.spin()


if __name__ == '__main__':
    main()
