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

"""Transforms of points from other frames to the base frame, by tf2 where it is installed."""

from __future__ import annotations

from typing import Any

from geometry_msgs.msg import TransformStamped
import numpy as np
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.task import Future
from rclpy.time import Time
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import quoted, RrrPlannerError
from std_msgs.msg import Header

# Each says what to do, about a frame and the base frame.
GIVEN = 'via_points are in frame {frame}'
NO_TF2 = (GIVEN + ', which is not the base frame {base}: give them in {base}, or install tf2_ros '
          '(apt: ros-jazzy-tf2-ros-py) for their transform (it cannot be imported: {why})')
NO_TRANSFORM = (GIVEN + ', and no transform to the base frame {base} has arrived in {time:g} s: '
                'give them in {base}, or publish the transform on /tf or /tf_static (tf2: {why})')
BEFORE_ZERO = (GIVEN + ', which is not the base frame {base}, with the stamp {time} s: give '
               'them in {base}, or the stamp 0, for the latest transform')
NO_ROTATION = ('the transform from frame {frame} to the base frame {base} has the rotation '
               '({r.x:g}, {r.y:g}, {r.z:g}, {r.w:g}), norm {norm:g}, and the translation '
               '({t.x:g}, {t.y:g}, {t.z:g}) m: correct who publishes it, for the norm must '
               'be 1 and every number finite')

# Norm of a rotation's quaternion, which messages have to six digits or more; chosen.
UNIT_TOLERANCE = 1e-3


class FrameError(RrrPlannerError):
    """Via points in a frame from which there is no transform to the base frame."""


class FrameTransforms:
    """
    The transforms that a node receives; it listens to them from the first request for one on.

    Parameters
    ----------
    node : Node
        The node, whose executor receives them: it must not be blocked meanwhile.

    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._buffer: Any = None  # tf2_ros.Buffer
        self._listener: Any = None

    async def to_base(self, header: Header, base_frame: str,
                      timeout: float) -> TransformStamped | None:
        """
        Return the transform from a message's frame to the base frame.

        Parameters
        ----------
        header : Header
            Frame, and the time of the transform; 0: the latest one.
        base_frame : str
            The base frame.
        timeout : float
            Time to wait for the transform [s].

        Returns
        -------
        TransformStamped or None
            None where the frame is the base frame, or empty.

        Raises
        ------
        FrameError
            If there is none in time, or tf2 is not installed.

        """
        frame = header.frame_id
        if frame in ('', base_frame):
            return None
        both = {'frame': quoted(frame), 'base': f"'{base_frame}'"}
        if header.stamp.sec < 0:
            raise FrameError(BEFORE_ZERO.format(time=header.stamp.sec, **both))
        try:
            import tf2_ros
        except ImportError as error:
            raise FrameError(NO_TF2.format(why=error, **both)) from None
        if self._buffer is None:
            self._buffer = tf2_ros.Buffer()
            self._listener = tf2_ros.TransformListener(self._buffer, self._node)
        try:
            where = base_frame, frame, Time.from_msg(header.stamp)
            await in_time(self._node, self._buffer.wait_for_transform_async(*where), timeout)
            return self._buffer.lookup_transform(*where)
        except tf2_ros.TransformException as error:
            raise FrameError(NO_TRANSFORM.format(
                time=timeout, why=' '.join(str(error).split()), **both)) from None


async def in_time(node: Node, future: Future, timeout: float) -> bool:
    """
    Wait for a future, at most for some time, while the node's executor does other work.

    Parameters
    ----------
    node : Node
        The node.
    future : Future
        The future; after the time its result is None.
    timeout : float
        The time [s], by a steady clock.

    Returns
    -------
    bool
        Whether it was done in time.

    """
    late = False

    def give_up() -> None:
        nonlocal late
        if not future.done():
            late = True
            future.set_result(None)

    timer = node.create_timer(timeout, give_up, clock=Clock(clock_type=ClockType.STEADY_TIME))
    try:
        await future
    finally:
        node.destroy_timer(timer)
    return not late


def in_base_frame(points: Array, transform: TransformStamped) -> Array:
    """
    Return points in the base frame.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        In the child frame of the transform [m].
    transform : TransformStamped
        From that frame to the base frame.

    Returns
    -------
    ndarray, shape (n, 3)
        [m].

    Raises
    ------
    FrameError
        If the transform is no rotation and translation of finite numbers.

    """
    r, t = transform.transform.rotation, transform.transform.translation
    axis, shift = np.array((r.x, r.y, r.z)), np.array((t.x, t.y, t.z))
    norm = float(np.hypot(np.linalg.norm(axis), r.w))
    if not abs(norm - 1.0) <= UNIT_TOLERANCE or not np.isfinite(shift).all():
        raise FrameError(NO_ROTATION.format(
            frame=quoted(transform.child_frame_id), base=quoted(transform.header.frame_id), r=r,
            t=t, norm=norm))
    axis, w = axis / norm, r.w / norm
    turned = 2.0 * np.cross(axis, points)  # Euler and Rodrigues' formula
    return np.asarray(points + w * turned + np.cross(axis, turned) + shift)
