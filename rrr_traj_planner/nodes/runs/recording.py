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

"""A recorder of a run, with the topics of both nodes."""

from __future__ import annotations

from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Path
from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from rrr_traj_planner.nodes.recording.bag import Bag
from rrr_traj_planner.nodes.recording.recorder import Recorder
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from trajectory_msgs.msg import JointTrajectory
from visualization_msgs.msg import MarkerArray

VOLATILE = ((JointState, 'joint_states'), (JointState, 'desired_joint_states'),
            (JointState, 'simulated_arm/tracking_error'), (JointTrajectory, 'joint_trajectory'),
            (DiagnosticArray, 'diagnostics'), (Clock, '/clock'))
LATCHED = ((JointTrajectory, 'planned_trajectory'), (Path, 'planned_path'),
           (MarkerArray, 'markers'), (String, 'robot_description'))


def run_recorder(node: Node, bag: Bag) -> Recorder:
    """
    Return a recorder of the topics of both nodes, and of every other topic with a publisher.

    Parameters
    ----------
    node : Node
        The client.
    bag : Bag
        The bag to write to.

    Returns
    -------
    Recorder
        Records as long as the node is spun.

    """
    recorder = Recorder(node, bag, VOLATILE, LATCHED)
    recorder.record_all()
    return recorder
