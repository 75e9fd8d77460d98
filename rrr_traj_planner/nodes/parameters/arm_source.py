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

"""Defaults of the arm's parameters, from its URDF and joint-limits file."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from rrr_traj_planner.core.arm.urdf_arm import read_urdf, UrdfArm
from rrr_traj_planner.core.arm.urdf_xml import is_xml
from rrr_traj_planner.core.errors import InvalidInputError, shown
from rrr_traj_planner.nodes.parameters import urdf_defaults
from rrr_traj_planner.nodes.parameters.configuration_files import found_file
from rrr_traj_planner.nodes.parameters.joint_limits_file import read_joint_limits
from rrr_traj_planner.nodes.parameters.override_checks import check_given
from rrr_traj_planner.nodes.parameters.table import ARM, check_value, rows_of

Values = Mapping[str, Any]

URDF, LIMITS = 'robot_description', 'joint_limits_file'
USED = (URDF, LIMITS, 'joint_names', 'base_frame', 'tip_frame', 'link_names')

read = lru_cache(maxsize=4)(read_urdf)  # of a text, for each change of a parameter


class ArmSource(NamedTuple):
    """
    Defaults of an arm's parameters.

    Attributes
    ----------
    joint_names : list of str
        The three joints, from the base.
    values : dict
        Values by names of parameters, in place of the table's defaults; `robot_description` is the
        URDF's text.
    warnings : tuple of str
        What is odd about the URDF, what it leaves out, and what has no effect in the file of
        joint limits.

    """

    joint_names: list[str]
    values: dict[str, Any]
    warnings: tuple[str, ...]


def arm_source(given: Values, folder_of: Callable[[str, str], Path] = lambda *_: Path.cwd(),
               labels: Mapping[str, str] | None = None) -> ArmSource:
    """
    Return defaults of an arm's parameters; refuse what contradicts its URDF.

    A value of the parameters comes before one of the file of joint limits, that before the URDF's,
    that before the table's.

    Parameters
    ----------
    given : mapping
        Parameter overrides by name.
    folder_of : callable
        Returns, for a parameter's name and value, the folder that its relative path refers to.
    labels : mapping, optional
        What messages call `robot_description` and `joint_limits_file`, by these names; by default
        they are parameters.

    Returns
    -------
    ArmSource
        For `table.rows_of`.

    Raises
    ------
    InvalidInputError
        If a file is missing or malformed, the URDF is of no such arm, a name is unknown, or
        parameters contradict each other or the URDF.

    """
    files = _Files(folder_of, {URDF: f'parameter {URDF}', LIMITS: f'parameter {LIMITS}',
                               **(labels or {})})
    used = _used(given)
    arm = None
    if used[URDF]:
        arm = files.arm(used[URDF], given.get('base_frame', ''), given.get('tip_frame', ''))
        used.update(urdf_defaults.names_of(arm, given))
    names = _distinct(used['joint_names'])
    in_file: dict[str, Any] = {}
    warnings: tuple[str, ...] = ()
    if used[LIMITS]:
        used[LIMITS] = str(files.found(LIMITS, used[LIMITS]))
        in_file, warnings = read_joint_limits(used[LIMITS], names)
        warnings = tuple(f'{used[LIMITS]}: {text}' for text in warnings)
    if arm is None:
        check_given(given, names, in_file)
        return ArmSource(names, {**used, **in_file, **_gravity(given)}, warnings)
    check_given(given, names, in_file, urdf_defaults.faults(arm, given, in_file))
    return ArmSource(names, {**used, **urdf_defaults.values_of(arm, given, in_file)},
                     (*urdf_defaults.warnings_of(arm, given, in_file), *warnings))


class _Files(NamedTuple):
    """The files that parameters name."""

    folder_of: Callable[[str, str], Path]
    labels: Mapping[str, str]

    def found(self, name: str, value: str) -> Path:
        """Return the path of a parameter's file."""
        try:
            return found_file(value, self.folder_of(name, value))
        except InvalidInputError as error:
            raise InvalidInputError(f'{self.labels[name]}: {error}') from None
        except (OSError, ValueError) as error:  # too long for a name, a null character
            why = error.strerror if isinstance(error, OSError) else str(error)
            raise InvalidInputError(f'{self.labels[name]} is {shown(value)}: {why}') from None

    def arm(self, value: str, base: str, tip: str) -> UrdfArm:
        """Return the arm of a URDF's text or path."""
        if not is_xml(value):
            return read_urdf(self.found(URDF, value), base, tip)
        try:
            return read(value, base, tip)
        except InvalidInputError as error:
            raise InvalidInputError(f'{self.labels[URDF]}: {error}') from None


def _used(given: Values) -> dict[str, Any]:
    """Return the values that say where the arm is described, and how its parts are called."""
    rows = rows_of(ARM, ())
    for name in USED:
        if name in given:
            try:
                check_value(rows[name], given[name])
            except InvalidInputError as error:
                raise InvalidInputError(f'parameter {error}') from None
    return {name: given.get(name, rows[name].default) for name in USED}


def _distinct(joint_names: Sequence[str]) -> list[str]:
    names = list(joint_names)
    if len(set(names)) != len(names) or '' in names:
        wanted = rows_of(ARM, ())['joint_names'].range_text
        raise InvalidInputError(f'parameter joint_names is {names}, must be {wanted}')
    return names


def _gravity(given: Values) -> dict[str, Any]:
    """Return gravity as a vector where it is given as a number."""
    if 'arm.gravity' not in given:
        return {}
    if 'gravity' in given:
        raise InvalidInputError(
            'gravity and arm.gravity are both given: one of them must be left out')
    down = given['arm.gravity']
    return {'gravity': [0.0, 0.0, -down]} if isinstance(down, float) else {}
