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

"""Publication of the arm's states, all with the same stamp."""

from __future__ import annotations

from control_msgs.msg import JointTrajectoryControllerState
from rclpy.node import Node
from rrr_traj_planner.core.simulation.controlled_arm import ControlledArm
from rrr_traj_planner.nodes.arm_node.arm_messages import JointStateMessage
from rrr_traj_planner.nodes.arm_node.arm_time import QUEUE_DEPTH
from rrr_traj_planner.nodes.arm_node.controller_messages import ControllerMessages
from sensor_msgs.msg import JointState


class ArmStates:
    """
    Publishes measured state, reference and tracking error, and the controller's state.

    The last contains the other three; it takes longer than they do, and is published only if
    somebody listens.

    Parameters
    ----------
    node : Node
        The arm node.
    arm : ControlledArm
        The arm.
    messages : ControllerMessages
        Of this arm.

    """

    def __init__(self, node: Node, arm: ControlledArm, messages: ControllerMessages) -> None:
        self._arm, self._messages = arm, messages
        self._topics = [
            (JointStateMessage(arm.settings.model.joint_names),
             node.create_publisher(JointState, topic, QUEUE_DEPTH).publish)
            for topic in ('joint_states', 'desired_joint_states', '~/tracking_error')]
        self._controller_state = node.create_publisher(
            JointTrajectoryControllerState, '~/controller_state', QUEUE_DEPTH)

    def publish(self, stamp: int) -> None:
        """
        Publish the present states.

        Parameters
        ----------
        stamp : int
            Their time [ns].

        """
        arm = self._arm
        q, qd, desired = arm.measured[:3], arm.measured[3:], arm.desired
        fields = ((q, qd, arm.torque), (desired[:3], desired[3:6]), (
            [a - b for a, b in zip(desired, q)], [a - b for a, b in zip(desired[3:6], qd)]))
        for (message, publish), values in zip(self._topics, fields):
            publish(message.filled(stamp, *values))
        if self._controller_state.get_subscription_count():
            self._controller_state.publish(self._messages.state(stamp))
