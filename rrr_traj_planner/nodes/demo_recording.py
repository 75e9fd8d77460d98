"""What the demonstration records."""

from __future__ import annotations

from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Path
from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from rrr_traj_planner.nodes.bag import Bag
from rrr_traj_planner.nodes.recorder import Recorder
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from trajectory_msgs.msg import JointTrajectory
from visualization_msgs.msg import MarkerArray

PASSING = ((JointState, 'joint_states'), (JointState, 'desired_joint_states'),
           (JointState, 'simulated_arm/tracking_error'), (JointTrajectory, 'joint_trajectory'),
           (DiagnosticArray, 'diagnostics'), (Clock, '/clock'))
LATCHED = ((JointTrajectory, 'planned_trajectory'), (Path, 'planned_path'),
           (MarkerArray, 'markers'), (String, 'robot_description'))


def demo_recorder(node: Node, bag: Bag) -> Recorder:
    """
    Return what records both nodes and what is sent to them.

    Parameters
    ----------
    node : Node
        The demonstration's client.
    bag : Bag
        Where it goes.

    Returns
    -------
    Recorder
        At work as long as the node is.

    """
    return Recorder(node, bag, PASSING, LATCHED)
