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
A node that serves `plan_trajectory` and cannot plan: how fast any such node can start.

It sends responses again that DDS drops, as our nodes do: see `ServiceNode`.
"""

from __future__ import annotations

from contextlib import suppress

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.signals import uninstall_signal_handlers
from rrr_traj_planner.nodes.process.service_node import ServiceNode
from rrr_traj_planner_interfaces.srv import PlanTrajectory


def spin_until_signal(executor: SingleThreadedExecutor) -> None:
    """Spin until SIGINT, which may shut the context down under the executor."""
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except rclpy_implementation.RCLError:
        if rclpy.ok():
            raise
    finally:
        with suppress(rclpy_implementation.RCLError):  # the signal's own is quicker
            rclpy.try_shutdown()
        uninstall_signal_handlers()  # their thread must not outlive Python


def main() -> None:
    """Spin until SIGINT."""
    rclpy.init()
    node, executor = ServiceNode('bare'), SingleThreadedExecutor()
    answer = PlanTrajectory.Response(error_code=PlanTrajectory.Response.SUCCESS)
    node.create_service(PlanTrajectory, 'plan_trajectory', lambda request, response: answer)
    executor.add_node(node)
    spin_until_signal(executor)


if __name__ == '__main__':
    main()
