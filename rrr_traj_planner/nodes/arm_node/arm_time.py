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
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.core.simulation.controlled_arm import ControlledArm
from rrr_traj_planner.core.simulation.simulated_clock import Pace, Schedule

# A tick simulates for at most so long, so that services are answered meanwhile [ns]; steps between
# two looks at how long it has taken.
LONGEST_TICK, MOST_STEPS = SECOND // 50, 100

# Further behind than this the node says so [ns], and so often [s].
LATE, WARNING_PERIOD = SECOND // 10, 2.0

# The clock itself has jumped when it is so far behind or ahead of the arm [ns].
JUMP_BACK, JUMP_AHEAD = SECOND // 10, 10 * SECOND

# Ticks come, and /clock is published, at least so often, however seldom states are [Hz].
LEAST_RATE = 100.0

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
        Called at the first step at or after every instant at which states are due; where the
        clock has gone on by more instants than the topics' queues hold, after the last ones.

    """

    pace: Pace | None = None

    def __init__(self, node: Node, arm: ControlledArm, publish: Callable[[], None]) -> None:
        self._node, self._arm, self._publish = node, arm, publish
        self.epoch = self.now()  # when the arm's own time began [ns]
        self.behind = 0          # how far the arm is behind after a tick [ns]
        self._states = Schedule(LEAST_RATE, arm.now)

    def now(self) -> int:
        """Return the node's clock [ns]."""
        return int(self._node.get_clock().now().nanoseconds)

    def reached(self) -> int:
        """Return the time of the arm's last step [ns]."""
        return self.epoch + self._arm.now

    def period(self, publish_rate: float, _: float) -> float:
        """Put a rate in force, and return the wall time between ticks [s]."""
        if publish_rate != self._states.rate:
            self._states = Schedule(publish_rate, self._arm.now)
        return 1.0 / max(publish_rate, LEAST_RATE)

    def tick(self) -> None:
        """Bring the arm up to now in whole steps, and publish on the way; but not for long."""
        behind = self.now() - self.reached()
        if not -JUMP_BACK <= behind <= JUMP_AHEAD:
            self._node.get_logger().warning(
                f'the clock jumped by {behind / SECOND:+.3f} s; the arm and what it follows '
                'go on from there', throttle_duration_sec=WARNING_PERIOD)
            self.epoch += behind
            self._states = Schedule(self._states.rate, self._arm.now)
            behind = 0
        due = self._arm.now + behind
        self._advance(due)
        self.behind = due - self._arm.now
        if self.behind > LATE:
            self._node.get_logger().warning(
                f'simulated time is {self.behind / SECOND:.3f} s behind the clock: this machine '
                'is busy or too slow', throttle_duration_sec=WARNING_PERIOD)

    catch_up = tick

    def _advance(self, due: int) -> None:
        """Simulate up to a time of the arm's [ns], or as long as a tick may take."""
        arm, step, begun = self._arm, self._arm.settings.step_ns, monotonic_ns()
        unheard = QUEUE_DEPTH * SECOND / self._states.rate
        while True:
            if self._states.passed(arm.now) and due - arm.now < unheard:
                self._publish()
            steps = min((due - arm.now) // step, _steps(arm, self._states.next), MOST_STEPS)
            if steps <= 0 or monotonic_ns() - begun > LONGEST_TICK:
                return
            arm.advance(steps)


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
        Called at the first step at or after every instant at which states are due.
    factor : float
        Simulated time to wall time; 0: as fast as can be.

    Notes
    -----
    No state is published of a time that has not been on /clock.

    """

    def __init__(self, node: Node, arm: ControlledArm, publish: Callable[[], None],
                 factor: float) -> None:
        self._node, self._arm, self._publish = node, arm, publish
        self.epoch = self.behind = 0
        self._states = self._clock = Schedule(LEAST_RATE, arm.now)
        self.pace = Pace(factor, monotonic_ns())
        self._publish_clock = node.create_publisher(Clock, '/clock', QUEUE_DEPTH).publish

    def now(self) -> int:
        """Return simulated time [ns]."""
        return self._arm.now

    reached = now

    def period(self, publish_rate: float, factor: float) -> float:
        """Put rates in force, and return the wall time between ticks [s]."""
        if publish_rate != self._states.rate:
            self._states = Schedule(publish_rate, self.now())
            self._clock = Schedule(max(publish_rate, LEAST_RATE), self.now())
        if factor != self.pace.factor:
            self.pace.restart(monotonic_ns(), self.now(), factor=factor)
        if factor == 0.0:
            return SHORTEST_PERIOD
        return min(max(1.0 / (self._clock.rate * factor), SHORTEST_PERIOD), LONGEST_PERIOD)

    def tick(self) -> None:
        """Simulate what is due, from instant to instant; but not for long."""
        begun, step = monotonic_ns(), self._arm.settings.step_ns
        due = self.pace.due(begun, self.now(), SECOND)
        while monotonic_ns() - begun <= LONGEST_TICK:
            steps = _steps(self._arm, min(self._states.next, self._clock.next))
            if self.now() + steps * step > due:
                break
            self._advance(steps)
            if self._states.passed(self.now()):
                self._publish()
        self.behind = due - self.now() if self.pace.factor > 0.0 else 0
        if self.behind > LATE:
            self._node.get_logger().warning(
                f'real_time_factor {self.pace.factor:g} is too much for this machine',
                throttle_duration_sec=WARNING_PERIOD)
            self.pace.restart(monotonic_ns(), self.now())

    def single_step(self) -> None:
        """Simulate one step, and publish."""
        self._advance(1)
        self._states.passed(self.now())
        self._publish()

    def catch_up(self) -> None:
        """Do nothing: no time passes between ticks."""

    def _advance(self, steps: int) -> None:
        """Simulate some steps, and publish time."""
        self._arm.advance(steps)
        self._clock.passed(self.now())
        message = Clock()
        message.clock.sec, message.clock.nanosec = divmod(self.now(), SECOND)
        self._publish_clock(message)


def _steps(arm: ControlledArm, instant: int) -> int:
    """Return how many steps lead to the first one at or after an instant [ns]."""
    return max(-((arm.now - instant) // arm.settings.step_ns), 0)
