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

"""What time the arm's node lives in: a clock's that it follows, or its own."""

from __future__ import annotations

from collections.abc import Callable
from time import monotonic_ns

from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from rrr_traj_planner.core.controlled_arm import ControlledArm
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.core.pacing import Pace

# A tick simulates at most this much time, or takes so long where the arm is the clock, so that
# services are answered meanwhile [ns].
MOST_AT_ONCE, LONGEST_TICK = SECOND // 10, SECOND // 50

# Further behind than this the node says so [ns], and so often [s].
LATE, WARNING_PERIOD = SECOND // 10, 2.0

# The clock itself has jumped when it is so far behind or ahead of the arm [ns].
JUMP_BACK, JUMP_AHEAD = SECOND // 10, 10 * SECOND

# Wall time between ticks where the arm is the clock [s].
SHORTEST_PERIOD, LONGEST_PERIOD = 0.001, 0.02

QUEUE_DEPTH = 10


class FollowedClock:
    """
    The node's clock: at every tick the arm runs up to now, in whole steps.

    Parameters
    ----------
    node : Node
        The arm's; it may use simulated time.
    arm : ControlledArm
        The arm.
    publish : callable
        Called at every tick at which time has passed.

    """

    pace: Pace | None = None

    def __init__(self, node: Node, arm: ControlledArm, publish: Callable[[], None]) -> None:
        self._node, self._arm, self._publish = node, arm, publish
        self._step = arm.settings.step_ns
        self.epoch = self.now()  # when the arm's own time began [ns]
        self._published = -1     # the time that was published last [ns]

    def now(self) -> int:
        """Return the node's clock [ns]."""
        return int(self._node.get_clock().now().nanoseconds)

    def reached(self) -> int:
        """Return the time of the arm's last step [ns]."""
        return self.epoch + self._arm.now

    def tick(self) -> None:
        """Bring the arm up to now, and publish how it is, once for each time."""
        self.catch_up()
        if self.reached() != self._published:
            self._published = self.reached()
            self._publish()

    def period(self, publish_rate: float, _: float) -> float:
        """Return the wall time between ticks [s]."""
        return 1.0 / publish_rate

    def catch_up(self) -> None:
        """Simulate up to now in whole steps, but no more than a tick's worth at once."""
        behind = self.now() - self.reached()
        if not -JUMP_BACK <= behind <= JUMP_AHEAD:
            self._node.get_logger().warning(
                f'the clock jumped by {behind / SECOND:+.3f} s; the arm and what it follows '
                'go on from there', throttle_duration_sec=WARNING_PERIOD)
            self.epoch += behind
            return
        self._arm.advance(max(min(behind, MOST_AT_ONCE) // self._step, 0))
        if behind > MOST_AT_ONCE + LATE:
            self._node.get_logger().warning(
                f'simulated time is {(behind - MOST_AT_ONCE) / SECOND:.3f} s behind the '
                'clock: this machine is busy or too slow', throttle_duration_sec=WARNING_PERIOD)


class OwnClock:
    """
    The arm's own time, from 0 on, published on /clock: at a rate, as fast as can be, or standing.

    Parameters
    ----------
    node : Node
        The arm's.
    arm : ControlledArm
        The arm.
    publish : callable
        Called after every publication period of simulated time.
    factor : float
        Simulated time to wall time; 0: as fast as can be.

    """

    def __init__(self, node: Node, arm: ControlledArm, publish: Callable[[], None],
                 factor: float) -> None:
        self._node, self._arm, self._publish = node, arm, publish
        self._step = arm.settings.step_ns
        self._slice = 1  # steps from publication to publication
        self.epoch = 0
        self.pace = Pace(factor, monotonic_ns())
        self._publish_clock = node.create_publisher(Clock, '/clock', QUEUE_DEPTH).publish

    def now(self) -> int:
        """Return simulated time [ns]."""
        return self._arm.now

    reached = now

    def tick(self) -> None:
        """Simulate what is due, and publish on the way; but not for long."""
        begun = monotonic_ns()
        slice_ = self._slice * self._step
        due = self.pace.due(begun, self.now(), SECOND)
        while due - self.now() >= slice_:
            self.advance(self._slice)
            if monotonic_ns() - begun > LONGEST_TICK:
                break
        behind = due - self.now()
        if not self.pace.paused and behind > LATE + slice_ and self.pace.factor > 0.0:
            self._node.get_logger().warning(
                f'real_time_factor {self.pace.factor:g} is too much for this machine',
                throttle_duration_sec=WARNING_PERIOD)
            self.pace.restart(monotonic_ns(), self.now())

    def advance(self, steps: int) -> None:
        """Simulate some steps and publish time and states."""
        self._arm.advance(steps)
        message = Clock()
        message.clock.sec, message.clock.nanosec = divmod(self.now(), SECOND)
        self._publish_clock(message)
        self._publish()

    def period(self, publish_rate: float, factor: float) -> float:
        """Put rates in force, and return the wall time between ticks [s]."""
        self._slice = max(1, round(SECOND / (publish_rate * self._step)))
        if factor != self.pace.factor:
            self.pace.restart(monotonic_ns(), self.now(), factor=factor)
        if factor == 0.0:
            return SHORTEST_PERIOD
        return min(max(1.0 / (publish_rate * factor), SHORTEST_PERIOD), LONGEST_PERIOD)

    def catch_up(self) -> None:
        """Do nothing: no time passes between ticks."""
