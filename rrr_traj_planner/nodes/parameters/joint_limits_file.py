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

"""MoveIt's joint_limits.yaml, as this package's parameters."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from difflib import get_close_matches
from math import radians
import os
from pathlib import Path
from typing import Any, NamedTuple

from rrr_traj_planner.core.arm.limits import NO_RANGE
from rrr_traj_planner.core.errors import InvalidInputError, quoted, shown
from rrr_traj_planner.core.scalars import positive_fraction
from rrr_traj_planner.nodes.parameters.table import check_value, PLANNER, Row, rows_of
from rrr_traj_planner.nodes.parameters.yaml_loader import input_error, Loader
import yaml
from yaml.constructor import ConstructorError

GROUP = 'joint_limits'
SCALING = ('default_velocity_scaling_factor', 'default_acceleration_scaling_factor')

# Limits of other programs, without effect here: of controllers, and of wrapping joints.
WITHOUT_EFFECT = ('angle_wraparound', 'has_soft_limits', 'k_position', 'k_velocity',
                  'soft_lower_limit', 'soft_upper_limit')

# MoveIt's switch of a range, which has a value for none here.
HAS_POSITION = Row('has_position_limits', True, 'whether the range is limited')

# Here acceleration has one limit both ways, the smaller of the two; Pilz's decelerations are
# negative.
DECELERATION = 'max_deceleration'
HAS_DECELERATION = Row('has_deceleration_limits', True, 'whether deceleration is limited')


class MoveItLimits(NamedTuple):
    """What a joint_limits.yaml gives."""

    values: dict[str, Any]      # by names of parameters
    warnings: tuple[str, ...]   # of what is given and has no effect


def read_joint_limits(path_or_text: str | os.PathLike[str],
                      joint_names: Collection[str] | None = None) -> MoveItLimits:
    """
    Return the parameters that a joint_limits.yaml gives.

    Parameters
    ----------
    path_or_text : str or path
        The file, or its text: what has a line break.
    joint_names : collection of str, optional
        The arm's joints; others of the file are ignored, since it may describe a whole robot. If
        left out, the limits of every joint are returned.

    Returns
    -------
    MoveItLimits
        Values by names of parameters, such as joint_limits.JOINT.max_velocity [rad/s], for what
        is given and not switched off by has_..._limits; a range that is switched off has no ends.
        MoveIt's default scaling factors are warned of: here a request has its own.

    Raises
    ------
    InvalidInputError
        If the file is missing or malformed, has an unknown or a repeated key, a value is wrong, or
        it has joints and none is the arm's. Names file, joint, key, value and range.

    """
    given = os.fspath(path_or_text)
    if '\n' in given:
        return _parameters(_content(given), joint_names)
    try:
        return _parameters(_content(Path(given).read_text(encoding='utf-8-sig')), joint_names)
    except (OSError, ValueError) as error:  # InvalidInputError is a ValueError
        raise InvalidInputError(f'{given}: {" ".join(str(error).split())}') from None


class _Loader(Loader):
    """YAML with MoveIt's tags of angles; without keys that repeat."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Any, Any]:
        """
        Return a mapping with keys as they are written: a joint may be called 1, or on.

        A repeated key is refused: YAML takes the last value.
        """
        found: set[str] = set()
        for key, _ in node.value:
            if not isinstance(key, yaml.ScalarNode):
                given = shown(self.construct_object(key, deep=True))
                raise ConstructorError(
                    None, None, f'key {given} must be a text', key.start_mark)
            if key.value in found:
                raise ConstructorError(
                    None, None, f'{key.value} is repeated', key.start_mark)
            found.add(key.value)
        self.flatten_mapping(node)
        return {key.value: self.construct_object(value, deep=True) for key, value in node.value}

    def construct_angle(self, node: yaml.Node) -> float:
        """Return the number behind !radians or !degrees [rad]."""
        try:
            number = self.construct_float(node)
        except ValueError:
            raise ConstructorError(
                None, None, f'{quoted(node.value)} is not a number', node.start_mark) from None
        return radians(number) if node.tag == '!degrees' else number


_Loader.add_constructor('!radians', _Loader.construct_angle)
_Loader.add_constructor('!degrees', _Loader.construct_angle)


def _content(text: str) -> Any:
    try:
        return yaml.load(text, _Loader)  # noqa: S506, a SafeLoader
    except yaml.YAMLError as error:
        raise input_error(error) from None


def _parameters(content: Any, joint_names: Collection[str] | None) -> MoveItLimits:
    content = _mapping('the file', content)
    for name in content:
        _check_known(name, (*SCALING, GROUP), '')
    warnings = [
        f'{name} {factor:g} has no effect: a request has its own '
        f'{name.removeprefix("default_").removesuffix("_factor")}'
        for name in SCALING if name in content
        if (factor := positive_fraction(name, content[name])) < 1.0]
    joints = _mapping(GROUP, content.get(GROUP))
    chosen = [joint for joint in joints if joint_names is None or joint in joint_names]
    if joints and not chosen:
        raise InvalidInputError(
            f'{GROUP} are of {", ".join(map(shown, joints))}, must be of the arm\'s joints, '
            f'{", ".join(map(shown, joint_names or ()))}')
    found: dict[str, Any] = {}
    for joint in chosen:
        found.update(_limits(joint, _mapping(f'{GROUP}.{joint}', joints[joint])))
    return MoveItLimits(found, tuple(warnings))


def _limits(joint: str, given: Mapping[Any, Any]) -> dict[str, Any]:
    """Return the parameters of a joint."""
    prefix = f'{GROUP}.{joint}.'
    rows = {name.removeprefix(prefix): row for name, row in rows_of(PLANNER, [joint]).items()
            if name.startswith(prefix)}
    known = {**rows, **{row.name: row._replace(name=prefix + row.name)
                        for row in (HAS_POSITION, HAS_DECELERATION)}}
    for key in given:
        _check_known(key, (*known, DECELERATION, *WITHOUT_EFFECT), prefix)
    switches = {key: value for key, value in given.items()
                if key.startswith('has_') and key not in WITHOUT_EFFECT}
    for key, value in switches.items():
        check_value(known[key], value)
    off = [key.split('_')[1] for key, value in switches.items() if not value]
    limits = {key: value if key in switches else _number(rows[key], value)
              for key, value in given.items()
              if key in rows and (key in switches or key.split('_')[1] not in off)}
    if DECELERATION in given and 'deceleration' not in off:
        row = rows['max_acceleration']._replace(name=prefix + DECELERATION)
        value = given[DECELERATION]
        most = _number(row, abs(value) if type(value) in (int, float) else value)
        limits['max_acceleration'] = min(most, limits.get('max_acceleration', most))
    if 'position' in off:
        limits.update(min_position=-NO_RANGE, max_position=NO_RANGE)
    low, high = limits.get('min_position'), limits.get('max_position')
    if low is not None and high is not None and low >= high:
        raise InvalidInputError(f'{prefix}min_position is {low:g} rad, must be below '
                                f'max_position, {high:g} rad')
    return {prefix + key: value for key, value in limits.items()}


def _number(row: Row, value: Any) -> Any:
    """Return a limit as a float: unlike ROS's parameters, the file may have whole numbers."""
    try:
        number = float(value) if type(value) is int else value
    except OverflowError:
        raise InvalidInputError(f'{row.name} is {shown(value)}, must be {row.range_text}'
                                ) from None
    check_value(row, number)
    return number


def _mapping(name: str, value: Any) -> Mapping[Any, Any]:
    if value is None:
        return {}
    if not isinstance(value, dict):
        raise InvalidInputError(f'{name} is {shown(value)}, must have keys and values')
    return value


def _check_known(key: str, known: Collection[str], prefix: str) -> None:
    if key not in known:
        near, = get_close_matches(key, known, 1, 0.0)
        raise InvalidInputError(f'{prefix}{key} is unknown, the nearest known key is {near}')
