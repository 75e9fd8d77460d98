"""The script `simulated_arm`: an arm with physics and a controller, on ROS topics."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rrr_traj_planner.nodes.entry import run_node

if TYPE_CHECKING:
    from rrr_traj_planner.nodes.arm_node import SimulatedArm

DESCRIPTION = """\
Simulate the arm: it follows the trajectories that it receives, as joint_trajectory_controller
would have it, and holds its position otherwise.

  subscribes  joint_trajectory (trajectory_msgs/JointTrajectory)
              disturbance (sensor_msgs/JointState: names and efforts)
  publishes   joint_states, desired_joint_states, ~/tracking_error (sensor_msgs/JointState)
              /clock (rosgraph_msgs/Clock), with publish_clock
  services    ~/reset, ~/hold, ~/step (std_srvs/Trigger), ~/pause (std_srvs/SetBool)
  parameters  config/thesis_arm.yaml shows them all"""


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
    return run_node('simulated_arm', DESCRIPTION, _load, arguments)


def _load() -> type[SimulatedArm]:
    from rrr_traj_planner.nodes.arm_node import SimulatedArm
    return SimulatedArm


if __name__ == '__main__':
    raise SystemExit(main())
