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

"""A node's ROS parameters: declared from the table, and checked together at each change."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Generic, TypeVar

from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from rclpy.node import Node
from rclpy.parameter import Parameter
from rrr_traj_planner.core.errors import InvalidInputError, RrrPlannerError
from rrr_traj_planner.nodes.parameters.arm_source import arm_source, LIMITS, URDF
from rrr_traj_planner.nodes.parameters.parameter_files import folder_of_value
from rrr_traj_planner.nodes.parameters.table import (
    ARM,
    check_value,
    MOTION,
    PLANNER,
    Row,
    rows_of,
)

Config = TypeVar('Config')

RESOLVED = (URDF, LIMITS)  # declared with a file's text, and an absolute path
ROLES = (PLANNER, ARM, MOTION)


class DeclaredParameters(Generic[Config]):
    """
    The parameters of one node, and the configuration built from them.

    Parameters
    ----------
    node : Node
        The node; parameters are declared on it at once.
    role : str
        `table.PLANNER`, `table.ARM` or `table.MOTION`.
    build : callable
        Returns a configuration for a mapping of values by name; raises an InvalidInputError if
        they contradict each other.
    changed : callable
        Called with the new configuration after parameters are set.
    files : sequence of Path
        The node's parameter files, in order: relative paths refer to the folder of the one that
        has them.

    Attributes
    ----------
    config : object
        The present configuration.
    given : dict
        Parameter overrides by name: from files, the command line or the program.
    joint_names : list of str
        Names of the three joints.
    warnings : tuple of str
        About the arm's URDF.

    Raises
    ------
    InvalidInputError
        If an override is out of range, a name is unknown, limits of a renamed joint are missing,
        or a file is wrong; with parameter, value and range.

    """

    def __init__(self, node: Node, role: str, build: Callable[[Mapping[str, Any]], Config],
                 changed: Callable[[Config], None], files: Sequence[Path] = ()) -> None:
        self._node, self._build, self._changed = node, build, changed
        # rclpy has no public access to overrides of undeclared parameters.
        self.given = {name: p.value for name, p in node._parameter_overrides.items()}
        name = node.get_fully_qualified_name()
        source = arm_source(self.given, lambda *value: folder_of_value(files, name, *value))
        self.joint_names, self.warnings = source.joint_names, source.warnings
        self._rows: dict[str, Row] = {}
        self._values: dict[str, Any] = {}
        for row in rows_of(role, self.joint_names).values():
            row = row._replace(default=source.values.get(row.name, row.default))
            self._values[row.name] = self._declare(row)
            self._rows[row.name] = row
        self.config = build(self._values)
        self._of_others = {name for other in ROLES for name in rows_of(other, self.joint_names)
                           if name not in self._rows}
        node.add_on_set_parameters_callback(self._check)
        node.add_post_set_parameters_callback(self._apply)
        # What the parameter services call: rclpy refuses read-only parameters before any callback.
        self._set_by_rclpy = node.set_parameters_atomically
        node.set_parameters_atomically = self._set

    def _declare(self, row: Row) -> Any:
        """Declare one parameter; return its override, or the default of the table."""
        # Dynamically typed at first: rclpy's own error messages do not contain the range.
        loose = ParameterDescriptor(dynamic_typing=True)
        value = self._node.declare_parameter(
            row.name, row.default, loose, ignore_override=row.name in RESOLVED).value
        try:
            check_value(row, value)
        except RrrPlannerError as error:
            raise InvalidInputError(f'parameter {error}') from None
        self._node.set_descriptor(row.name, descriptor(row))
        return _plain(value)

    def _set(self, parameters: list[Parameter]) -> SetParametersResult:
        """
        Set parameters as rclpy does, but for what makes a file of all nodes fail to load.

        That are read-only parameters with the value that they have, and parameters of other
        nodes: these are ignored, and the result says so.
        """
        ignored = [p.name for p in parameters if p.name in self._of_others]
        changes = [p for p in parameters if p.name not in ignored and not self._is_kept(p)]
        result = (self._set_by_rclpy(changes) if changes
                  else SetParametersResult(successful=True))
        if ignored and result.successful:
            result.reason = f'ignored here: {", ".join(ignored)}'
        return result

    def _is_kept(self, parameter: Parameter) -> bool:
        """Return whether a parameter is read-only and keeps its value."""
        name, row = parameter.name, self._rows.get(parameter.name)
        if row is None or not row.read_only:
            return False
        present, value = self._node.get_parameter(name), _plain(parameter.value)
        return parameter.type_ == present.type_ and (
            value == _plain(present.value) or (name in RESOLVED and value == self.given.get(name)))

    def _check(self, parameters: list[Parameter]) -> SetParametersResult:
        """Refuse values that are out of range or contradict others."""
        try:
            self._build(self._with(parameters))
        except RrrPlannerError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _apply(self, parameters: list[Parameter]) -> None:
        """Rebuild the configuration from checked values."""
        if any(p.name in self._rows for p in parameters):
            self._values = self._with(parameters)
            self.config = self._build(self._values)
            self._changed(self.config)

    def _with(self, parameters: Iterable[Parameter]) -> dict[str, Any]:
        """Return the present values, with some replaced."""
        values = dict(self._values)
        for parameter in parameters:
            row = self._rows.get(parameter.name)
            if row is not None:
                check_value(row, parameter.value)
                values[parameter.name] = _plain(parameter.value)
        return values


def descriptor(row: Row) -> ParameterDescriptor:
    """
    Return a parameter's descriptor, which ROS tools show.

    Parameters
    ----------
    row : Row
        The parameter.

    Returns
    -------
    ParameterDescriptor
        Type, meaning, unit, range (of single numbers), and whether it is read-only.

    """
    unit = f' [{row.unit}]' if row.unit else ''
    result = ParameterDescriptor(
        name=row.name, type=Parameter.Type.from_parameter_value(row.default).value,
        description=row.meaning + unit, additional_constraints=f'must be {row.range_text}',
        read_only=row.read_only)
    if isinstance(row.default, float):
        result.floating_point_range = [FloatingPointRange(from_value=row.low, to_value=row.high)]
    elif isinstance(row.default, int) and not isinstance(row.default, bool):
        result.integer_range = [
            IntegerRange(from_value=int(row.low), to_value=int(row.high), step=1)]
    return result


def _plain(value: Any) -> Any:
    return list(value) if isinstance(value, (array, tuple)) else value
