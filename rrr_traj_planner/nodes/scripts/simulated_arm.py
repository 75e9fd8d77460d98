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

"""The script `simulated_arm`: an arm with physics and a controller, on ROS topics."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import TYPE_CHECKING

from rrr_traj_planner.nodes.process.node_runner import create_node, end_ros, run_node, start_ros

if TYPE_CHECKING:
    from rrr_traj_planner.nodes.arm_node.node import SimulatedArm

DESCRIPTION = """\
Simulate the arm: it follows the trajectories that it receives by the rules of
joint_trajectory_controller, and holds its position otherwise.

  subscribes  joint_trajectory (trajectory_msgs/JointTrajectory)
              disturbance (sensor_msgs/JointState: names and efforts)
  action      ~/follow_joint_trajectory (control_msgs/FollowJointTrajectory)
  publishes   joint_states, desired_joint_states, ~/tracking_error (sensor_msgs/JointState)
              ~/controller_state (control_msgs/JointTrajectoryControllerState)
              diagnostics (diagnostic_msgs/DiagnosticArray), once a second
              robot_description (std_msgs/String), markers (visualization_msgs/MarkerArray)
              /tf, /tf_static (tf2_msgs/TFMessage), with publish_tf
              /clock (rosgraph_msgs/Clock), with publish_clock
  services    ~/reset, ~/hold, ~/step (std_srvs/Trigger), ~/pause (std_srvs/SetBool)
  parameters  config/thesis_arm.yaml lists them all"""


def main(arguments: Sequence[str] | None = None) -> int:
    """
    Run the simulated arm until SIGINT or SIGTERM.

    Parameters
    ----------
    arguments : sequence of str, optional
        The command line without the script's name; None: `sys.argv`'s.

    Returns
    -------
    int
        Exit code.

    """
    return run_node('simulated_arm', DESCRIPTION, _load, arguments, _add_options, _instead)


def _add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('--urdf', action='store_true',
                        help='print the URDF of the arm that the parameters describe, and end')


def _instead(options: argparse.Namespace, ros_arguments: list[str]) -> int | None:
    return _print_urdf(ros_arguments) if options.urdf else None


def _print_urdf(ros_arguments: list[str]) -> int:
    """Print the URDF for the node's parameters, without running the node."""
    from rclpy.node import Node
    from rrr_traj_planner.nodes.parameters.configuration import ArmConfig
    from rrr_traj_planner.nodes.parameters.declared import DeclaredParameters
    from rrr_traj_planner.nodes.parameters.parameter_files import files_given
    from rrr_traj_planner.nodes.parameters.table import ARM

    node = None
    try:
        start_ros(ros_arguments)
        node = create_node(lambda: Node(
            'simulated_arm', enable_rosout=False, start_parameter_services=False))
        print(DeclaredParameters(
            node, ARM, ArmConfig.from_values, lambda config: None,
            files_given(ros_arguments)).config.urdf, end='')
    finally:
        if node is not None:
            node.destroy_node()
        end_ros()
    return 0


def _load() -> type[SimulatedArm]:
    from rrr_traj_planner.nodes.arm_node.node import SimulatedArm
    return SimulatedArm


if __name__ == '__main__':
    raise SystemExit(main())
