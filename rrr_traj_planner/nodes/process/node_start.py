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

"""A node's log messages at its start, and its warning of another node of the same name."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
import sys
from typing import Any

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.nodes.parameters.declared import DeclaredParameters
from rrr_traj_planner.nodes.parameters.override_checks import unused_warnings
from rrr_traj_planner.nodes.parameters.parameter_files import files_given, has_section_for
from rrr_traj_planner.nodes.process.node_claim import claim

FIRST_DELAY = 0.001  # s, until the first spin
WATCH_PERIOD = 1.0   # s, between two checks for nodes of the same name

KEEP_APART = ('end one, or give it a namespace (--ros-args -r __ns:=/NAME) or another '
              'ROS_DOMAIN_ID')
NO_FILE = 'no parameter file'
DEFAULT, OF_URDF = 'the default arm', 'the arm of robot_description'


class NodeStart:
    """
    Logs a line when the node is first spun, and warns of other nodes of the same name.

    Parameters
    ----------
    node : Node
        The node, fully set up.
    parameters : DeclaredParameters
        The node's parameters.
    limits : JointLimits, optional
        The joints' limits, for the log line; None: the node has no arm.
    offer : str
        The node's main interface, for the log line.
    arguments : sequence of str, optional
        ROS arguments of this node alone (`cli_args`).

    """

    def __init__(self, node: Node, parameters: DeclaredParameters[Any], limits: JointLimits | None,
                 offer: str, arguments: Sequence[str] | None = None) -> None:
        self._node, self._parameters = node, parameters
        self._name = node.get_fully_qualified_name()
        files = files_given([*sys.argv, *(arguments or ())])
        self._unused = [] if limits is None else [
            file for file in files if not has_section_for(file, self._name)]
        default = OF_URDF if parameters.given.get('robot_description') else DEFAULT
        source = ', '.join(str(f) for f in files if f not in self._unused) or (
            NO_FILE if limits is None else f'{NO_FILE}, {default}')
        arm = [] if limits is None else [_limits_text(limits, parameters.joint_names)]
        self._text = f'{self._name}: {"; ".join([source, *arm, offer])}; ready'
        self._claim = claim(node.context.get_domain_id(), self._name)
        self._others = 0
        self._timer = node.create_timer(
            FIRST_DELAY, self._begin, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def _begin(self) -> None:
        """Log the start line and warnings of unused parameters and files; then start watching."""
        self._timer.timer_period_ns = round(WATCH_PERIOD * SECOND)
        self._timer.callback = self._watch
        log, given = self._node.get_logger(), self._parameters.given
        log.info(self._text)
        undeclared = [name for name in given if not self._node.has_parameter(name)]
        for text in (*self._parameters.warnings,
                     *unused_warnings(undeclared, self._parameters.joint_names)):
            log.warning(text)
        for file in self._unused:
            log.warning(f'parameter file {file} has no parameters for this node, {self._name}')
        self._warn_of(int(self._claim is None))

    def _watch(self) -> None:
        """Check for nodes of the same name on any machine."""
        own = self._node.get_name(), self._node.get_namespace()
        self._warn_of(self._node.get_node_names_and_namespaces().count(own) - 1)
        if self._claim is None:
            self._claim = claim(self._node.context.get_domain_id(), self._name)

    def _warn_of(self, others: int) -> None:
        """Warn once of another node of the same name: both would answer every request."""
        if others > self._others:
            self._node.get_logger().warning(
                f'another node is named {self._name}: they share topics and services; '
                f'{KEEP_APART}')
        self._others = max(others, int(self._claim is None))

    def end(self) -> None:
        """Release the name."""
        if self._claim is not None:
            self._claim.close()


def _limits_text(limits: JointLimits, joint_names: Sequence[str]) -> str:
    """
    Return the joints' limits as one line of text.

    Parameters
    ----------
    limits : JointLimits
        The limits; infinite ones are left out.
    joint_names : sequence of str
        Names of the joints.

    Returns
    -------
    str
        Range and limits of each joint, with units.

    """
    units = (('max_velocity', 'rad/s'), ('max_acceleration', 'rad/s^2'), ('max_jerk', 'rad/s^3'),
             ('max_effort', 'N m'))
    return '; '.join(
        f'{joint} {_range_text(limits.min_position[i], limits.max_position[i])}' + ''.join(
            f', {value:.4g} {unit}' for name, unit in units
            if (value := getattr(limits, name)[i]) < inf)
        for i, joint in enumerate(joint_names))


def _range_text(low: float, high: float) -> str:
    return 'without range' if low == -inf and high == inf else f'{low:.4g} to {high:.4g} rad'
