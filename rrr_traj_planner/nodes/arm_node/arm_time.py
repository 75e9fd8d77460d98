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

"""Simulated time: it follows the node's clock, or the arm publishes it on /clock."""

from __future__ import annotations

from collections.abc import Callable
from time import monotonic_ns

from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.core.simulation.controlled_arm import ControlledArm
from rrr_traj_planner.core.simulation.schedule import Schedule
from rrr_traj_planner.core.simulation.simulated_clock import SimulatedClock

# Largest wall time of a tick [ns], so that services are answered soon, and number of steps between
# two checks of it.
MAX_TICK, STEPS_PER_CHECK = SECOND // 50, 100

# Delay of simulated time that is reported [ns], and period of that warning [s].
LATE, WARNING_PERIOD = SECOND // 10, 2.0

# Differences between clock and arm that count as a jump of the clock [ns].
JUMP_BACK, JUMP_AHEAD = SECOND // 10, 10 * SECOND

# Least rate of ticks and of /clock, for any publish_rate [Hz].
MIN_RATE = 100.0

# Bounds on the wall time between ticks if the arm is the clock [s].
MIN_PERIOD, MAX_PERIOD = 0.001, 0.02

QUEUE_DEPTH = 10  # messages of each topic and of /clock, ROS's usual depth

# States published at once after a delay, at most: half a second at 200 Hz, some 30 ms of work.
MOST_STATES = 100


class FollowedClock:
    """
    Simulated time that follows the node's clock from the first tick on.

    Each tick simulates up to the present.

    Parameters
    ----------
    node : Node
        The arm node; its clock may be simulated time of another node (use_sim_time).
    arm : ControlledArm
        The arm.
    publish : callable
        Publishes the arm's state; called at the first step at or after each instant of
        publish_rate. If more than MOST_STATES are due at once, only for the last ones.

    """

    simulated_clock: SimulatedClock | None = None

    def __init__(self, node: Node, arm: ControlledArm, publish: Callable[[], None]) -> None:
        self._node, self._arm, self._publish = node, arm, publish
        self.epoch = self.now()  # when the arm's own time began [ns]
        self._begun = False      # what a node does before it is first spun takes no time
        self.behind = 0          # how far the arm is behind after a tick [ns]
        self._states = Schedule(MIN_RATE, arm.now)

    def now(self) -> int:
        """Return the node's clock [ns]."""
        return int(self._node.get_clock().now().nanoseconds)

    def reached(self) -> int:
        """Return the time of the arm's last step [ns]."""
        return self.epoch + self._arm.now

    def period(self, publish_rate: float, _: float) -> float:
        """Set the rate of publication, and return the wall time between ticks [s]."""
        if publish_rate != self._states.rate:
            self._states = Schedule(publish_rate, self._arm.now)
        return 1.0 / max(publish_rate, MIN_RATE)

    def tick(self) -> None:
        """Simulate up to the present in whole steps, and publish states; at most `MAX_TICK`."""
        behind = self.now() - self.reached()
        if not self._begun:
            self._begun, self.epoch, behind = True, self.epoch + behind, 0
        elif not -JUMP_BACK <= behind <= JUMP_AHEAD:
            self._node.get_logger().warning(
                f'the clock jumped by {behind / SECOND:+.3f} s; the arm and its trajectory '
                'continue from the new time', throttle_duration_sec=WARNING_PERIOD)
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

    advance_to_now = tick

    def _advance(self, due: int) -> None:
        """Simulate up to a time since the arm's start [ns], at most for `MAX_TICK`."""
        arm, step, begun = self._arm, self._arm.settings.step_ns, monotonic_ns()
        latest = MOST_STATES * SECOND / self._states.rate  # ns before the present
        while True:
            if self._states.passed(arm.now) and due - arm.now < latest:
                self._publish()
            steps = min((due - arm.now) // step, _steps(arm, self._states.next), STEPS_PER_CHECK)
            if steps <= 0 or monotonic_ns() - begun > MAX_TICK:
                return
            arm.advance(steps)


class OwnClock:
    """
    Simulated time of the arm's own, from 0 on, published on /clock; it can be paused.

    Parameters
    ----------
    node : Node
        The arm node.
    arm : ControlledArm
        The arm.
    publish : callable
        Publishes the arm's state; called at the first step at or after each instant of
        publish_rate.
    factor : float
        Simulated time per wall time; 0: as fast as possible.

    Notes
    -----
    The time of a state is on /clock before the state is published.

    """

    def __init__(self, node: Node, arm: ControlledArm, publish: Callable[[], None],
                 factor: float) -> None:
        self._node, self._arm, self._publish = node, arm, publish
        self.epoch = self.behind = 0
        self._states = self._clock = Schedule(MIN_RATE, arm.now)
        self.simulated_clock = SimulatedClock(factor, monotonic_ns())
        self._publish_clock = node.create_publisher(Clock, '/clock', QUEUE_DEPTH).publish

    def now(self) -> int:
        """Return simulated time [ns]."""
        return self._arm.now

    reached = now

    def period(self, publish_rate: float, factor: float) -> float:
        """Set the rates, and return the wall time between ticks [s]."""
        if publish_rate != self._states.rate:
            self._states = Schedule(publish_rate, self.now())
            self._clock = Schedule(max(publish_rate, MIN_RATE), self.now())
        if factor != self.simulated_clock.factor:
            self.simulated_clock.restart(monotonic_ns(), self.now(), factor=factor)
        if factor == 0.0:
            return MIN_PERIOD
        return min(max(1.0 / (self._clock.rate * factor), MIN_PERIOD), MAX_PERIOD)

    def tick(self) -> None:
        """Simulate the steps that are due, and publish; at most for `MAX_TICK`."""
        begun, step = monotonic_ns(), self._arm.settings.step_ns
        due = self.simulated_clock.due(begun, self.now(), SECOND)
        while monotonic_ns() - begun <= MAX_TICK:
            steps = _steps(self._arm, min(self._states.next, self._clock.next))
            if self.now() + steps * step > due:
                break
            self._advance(steps)
            if self._states.passed(self.now()):
                self._publish()
        self.behind = due - self.now() if self.simulated_clock.factor > 0.0 else 0
        if self.behind > LATE:
            self._node.get_logger().warning(
                f'real_time_factor {self.simulated_clock.factor:g} cannot be reached on this '
                'machine',
                throttle_duration_sec=WARNING_PERIOD)
            self.simulated_clock.restart(monotonic_ns(), self.now())

    def single_step(self) -> None:
        """Simulate one step, and publish."""
        self._advance(1)
        self._states.passed(self.now())
        self._publish()

    def advance_to_now(self) -> None:
        """Do nothing: simulated time advances only in ticks."""

    def _advance(self, steps: int) -> None:
        """Simulate some steps, and publish the time."""
        self._arm.advance(steps)
        self._clock.passed(self.now())
        message = Clock()
        message.clock.sec, message.clock.nanosec = divmod(self.now(), SECOND)
        self._publish_clock(message)


def _steps(arm: ControlledArm, instant: int) -> int:
    """Return the number of steps to the first one at or after an instant [ns]."""
    return max(-((arm.now - instant) // arm.settings.step_ns), 0)
