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

"""Publication of the arm's frames on /tf and /tf_static, in place of robot_state_publisher."""

from __future__ import annotations

from collections.abc import Sequence

from geometry_msgs.msg import Transform, TransformStamped
from rclpy.node import Node
from rrr_traj_planner.core.arm.urdf_frames import LinkFrame, Placement, urdf_frames
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.nodes.output.latched import LATCHED
from tf2_msgs.msg import TFMessage

QUEUE_DEPTH = 100  # messages, as in tf2's broadcaster


class ArmFrames:
    """
    Publishes the frames of all links of `robot_description`.

    Those that are fixed to their parents are published once, transient local. The topics' names
    are absolute, as for every publisher of frames; a remapping puts them into a namespace.

    Parameters
    ----------
    node : Node
        The arm node.
    urdf : str
        What it publishes on `robot_description`.
    joint_names : sequence of str
        The arm's joints.
    stamp : int
        Time of the fixed frames [ns].

    """

    def __init__(self, node: Node, urdf: str, joint_names: Sequence[str], stamp: int) -> None:
        frames = urdf_frames(urdf, joint_names)
        self._moving = frames.moving
        self._message = TFMessage(transforms=[_transform(frame) for frame in frames.moving])
        self._publish = node.create_publisher(TFMessage, '/tf', QUEUE_DEPTH).publish
        fixed = TFMessage(transforms=[_transform(frame) for frame in frames.fixed])
        for transform in fixed.transforms:
            _set_stamp(transform, stamp)
        node.create_publisher(TFMessage, '/tf_static', LATCHED).publish(fixed)

    def publish(self, stamp: int, q: Sequence[float]) -> None:
        """
        Publish the frames that move.

        Parameters
        ----------
        stamp : int
            Time of the positions [ns].
        q : sequence of 3 floats
            Measured joint positions [rad].

        """
        for frame, transform in zip(self._moving, self._message.transforms):
            _set_stamp(transform, stamp)
            _place(transform.transform, frame.at(q))
        self._publish(self._message)


def _transform(frame: LinkFrame) -> TransformStamped:
    """Return a frame's transform at zero, without a stamp."""
    message = TransformStamped(child_frame_id=frame.child)
    message.header.frame_id = frame.parent
    _place(message.transform, frame.placement)
    return message


def _set_stamp(transform: TransformStamped, stamp: int) -> None:
    time = transform.header.stamp
    time.sec, time.nanosec = divmod(stamp, SECOND)


def _place(transform: Transform, placement: Placement) -> None:
    origin, turn = transform.translation, transform.rotation
    origin.x, origin.y, origin.z = placement.origin
    turn.x, turn.y, turn.z, turn.w = placement.turn
