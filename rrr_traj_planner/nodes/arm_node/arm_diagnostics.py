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

"""Diagnostics of the arm node: saturation, stops, tracking error, real-time factor."""

from __future__ import annotations

from time import monotonic_ns

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.core.simulation.controlled_arm import ControlledArm
from rrr_traj_planner.core.simulation.saturation_and_contact import (
    NONE_RECORDED,
    SaturationAndContact,
)
from rrr_traj_planner.nodes.arm_node.arm_time import FollowedClock, LATE, OwnClock
from rrr_traj_planner.nodes.output.diagnostics import diagnostics, PERIOD

LARGE_ERROR = 0.02  # rad, tracking error of a joint above which there is a warning
OUTSIDE = 1e-6      # rad, least distance outside a range that is reported; less is rounding


class ArmDiagnostics:
    """
    Publishes `diagnostics` of the arm for the time since the last message.

    Parameters
    ----------
    node : Node
        The arm node.
    arm : ControlledArm
        The arm.
    time : FollowedClock or OwnClock
        The arm's time.

    """

    def __init__(self, node: Node, arm: ControlledArm, time: FollowedClock | OwnClock) -> None:
        self._node, self._arm, self._time = node, arm, time
        self._publish = node.create_publisher(DiagnosticArray, 'diagnostics', 10).publish
        self._begin()
        node.create_timer(PERIOD, self._report, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def update(self, condition: SaturationAndContact) -> None:
        """
        Record the arm's condition and its present tracking error.

        Parameters
        ----------
        condition : SaturationAndContact
            Saturation and contact with stops since the last call.

        """
        if condition is not NONE_RECORDED:
            self._condition = self._condition.joined(condition)
        errors = (abs(a - b) for a, b in zip(self._arm.desired, self._arm.measured[:3]))
        self._errors = [max(pair) for pair in zip(self._errors, errors)]

    def _begin(self) -> None:
        self._condition, self._errors = NONE_RECORDED, [0.0, 0.0, 0.0]
        self._since, self._steps, self._reached = monotonic_ns(), self._arm.steps, self._arm.now

    def _report(self) -> None:
        """Publish what was recorded since the last message, and clear it."""
        arm, names = self._arm, self._arm.settings.model.joint_names
        saturated = [n / max(arm.steps - self._steps, 1) for n in self._condition.saturated]
        outside = [_outside(*x) for x in zip(
            arm.state, arm.settings.limits.min_position, arm.settings.limits.max_position)]
        factor = (arm.now - self._reached) / max(monotonic_ns() - self._since, 1)
        warnings = self._warnings(saturated, outside)
        values = [('real-time factor', f'{factor:.3f}'),
                  ('behind the clock [s]', f'{self._time.behind / SECOND:.3f}')]
        for name, *of_joint in zip(names, saturated, self._condition.hit,
                                   self._condition.pressed, self._errors, outside):
            keys = ('saturated [share]', 'stop hit at [rad/s]', 'pressed against stop [N m]',
                    'tracking error [rad]', 'outside range [rad]')
            values += [(f'{name} {key}', f'{x:.6g}') for key, x in zip(keys, of_joint)]
        text = 'follows a trajectory' if arm.now < arm.motion.end_ns else 'holds its position'
        self._publish(diagnostics(
            f'{self._node.get_name()}: arm',
            DiagnosticStatus.WARN if warnings else DiagnosticStatus.OK,
            '; '.join(warnings) or text, values, self._node.get_clock().now().to_msg()))
        self._begin()

    def _warnings(self, saturated: list[float], outside: list[float]) -> list[str]:
        """Return a text for each warning; arguments as in `_report`."""
        arm, names = self._arm, self._arm.settings.model.joint_names
        texts = [f'{name} saturated {100.0 * fraction:.3g} % of the time'
                 for name, fraction in zip(names, saturated) if fraction > 0.0]
        texts += [finding.text for finding in self._condition.stops(names, arm.settings.limits)]
        texts += [f'{name} {abs(x):.3g} rad outside its range'
                  for name, x in zip(names, outside) if abs(x) > OUTSIDE]
        texts += [f'{name} tracking error up to {x:.3g} rad'
                  for name, x in zip(names, self._errors) if x > LARGE_ERROR]
        if self._time.behind > LATE:
            texts.append(f'simulated time is {self._time.behind / SECOND:.3f} s behind')
        return texts


def _outside(q: float, low: float, high: float) -> float:
    """Return how far a joint is beyond its range; negative below it [rad]."""
    return min(q - low, 0.0) + max(q - high, 0.0)
