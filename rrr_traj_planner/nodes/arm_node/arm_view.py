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

"""Visualization of the arm: its URDF on `robot_description`, and its markers."""

from __future__ import annotations

from collections.abc import Sequence
from math import dist
from time import monotonic
from typing import Any

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rrr_traj_planner.core.kinematics.link_positions import link_positions
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.nodes.output.latched import LATCHED
from rrr_traj_planner.nodes.output.marker_messages import arm_markers
from rrr_traj_planner.nodes.output.wireframe import Trail
from rrr_traj_planner.nodes.parameters.configuration import ArmConfig
from std_msgs.msg import String
from visualization_msgs.msg import MarkerArray

TRAIL_STEP = 1.0 / 80.0  # distance of the trail's points, as a fraction of the arm's size
TRAIL_POINTS = 200       # largest number of the trail's points; rclpy takes some 10 us for each
MOVED = 1e-6             # least motion that causes new markers, as a fraction of the arm's size
STILL_PERIOD = 1.0       # s between markers while the arm does not move


class ArmView:
    """
    Publishes `robot_description` when it changes, and `markers` periodically.

    Parameters
    ----------
    node : Node
        The arm node.
    config : ArmConfig
        The arm.
    q : sequence of 3 floats
        Its joint positions [rad].

    Notes
    -----
    Both topics are transient local: late subscribers get the last message. Markers are published
    in steady time, at `marker_rate`, or once a second while the arm does not move.

    """

    def __init__(self, node: Node, config: ArmConfig, q: Sequence[float]) -> None:
        self._model, self._frame = config.settings.model, config.frames.base
        size = self._model.chain.size
        self._trail = Trail(TRAIL_STEP * size, TRAIL_POINTS)
        self._moved = MOVED * size
        self._joints = link_positions(self._model, q)
        self._shown: Any = None  # the joints of the last message
        self._shown_at = 0.0     # steady time [s]
        self._description = ''
        self._describe = node.create_publisher(String, 'robot_description', LATCHED).publish
        self._draw = node.create_publisher(MarkerArray, 'markers', LATCHED).publish
        self._rate = 0.0
        self._timer = node.create_timer(STILL_PERIOD, self._show, autostart=False,
                                        clock=Clock(clock_type=ClockType.STEADY_TIME))
        self.configure(config)

    def moved(self, q: Sequence[float]) -> None:
        """
        Record the arm's position.

        Parameters
        ----------
        q : sequence of 3 floats
            Joint positions [rad].

        """
        if self._rate > 0.0:
            self._joints = link_positions(self._model, q)
            self._trail.add(self._joints[-1])

    def restart(self) -> None:
        """Clear the trail."""
        self._trail.clear()
        self._shown = None

    def configure(self, config: ArmConfig) -> None:
        """
        Apply changed parameters.

        Parameters
        ----------
        config : ArmConfig
            The arm; its model and frames must be unchanged.

        """
        if config.urdf != self._description:
            self._description = config.urdf
            self._describe(String(data=config.urdf))
        if config.marker_rate != self._rate:
            self._rate = config.marker_rate
            self._timer.cancel()
            if self._rate > 0.0:
                self._timer.timer_period_ns = round(SECOND / self._rate)
                self._timer.reset()

    def _show(self) -> None:
        """Publish the markers, unless the arm has not moved and the last ones are recent."""
        if self._shown is not None and monotonic() - self._shown_at < STILL_PERIOD and all(
                dist(a, b) <= self._moved for a, b in zip(self._shown, self._joints)):
            return
        self._shown, self._shown_at = self._joints, monotonic()
        self._draw(arm_markers(self._model, self._frame, self._joints, self._trail.places))
