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

"""What parameters leave out of an arm: taken from its URDF and from a file of joint limits."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from math import isfinite
from pathlib import Path
from typing import Any, NamedTuple

from rrr_traj_planner.core.arm.limits import NO_RANGE
from rrr_traj_planner.core.arm.urdf_arm import read_urdf, UrdfArm
from rrr_traj_planner.core.arm.urdf_document import BEFORE_XML, read_document, UrdfWarning
from rrr_traj_planner.core.errors import counted, InvalidInputError, quoted, shown
from rrr_traj_planner.nodes.parameters.configuration_files import found_file
from rrr_traj_planner.nodes.parameters.joint_limits_file import read_joint_limits
from rrr_traj_planner.nodes.parameters.override_checks import check_given, KINDS, MAX_SHOWN
from rrr_traj_planner.nodes.parameters.table import ARM, check_value, rows_of

Values = Mapping[str, Any]

URDF, LIMITS = 'robot_description', 'joint_limits_file'
USED = (URDF, LIMITS, 'joint_names', 'base_frame', 'tip_frame', 'link_names')

read = lru_cache(maxsize=4)(read_urdf)  # of a text, for each change of a parameter


class ArmSource(NamedTuple):
    """
    What an arm's parameters leave out.

    Attributes
    ----------
    joint_names : list of str
        The three joints, from the base.
    values : dict
        Values by names of parameters, in place of the table's defaults; `robot_description` is the
        URDF's text.
    warnings : tuple of str
        What is odd about the URDF, and what it leaves out.

    """

    joint_names: list[str]
    values: dict[str, Any]
    warnings: tuple[str, ...]


def in_working_directory(name: str, value: str) -> Path:
    """
    Return the folder that a parameter's relative path refers to if no file names it.

    Parameters
    ----------
    name, value : str
        The parameter.

    Returns
    -------
    Path
        The working directory.

    """
    return Path.cwd()


def arm_source(given: Values, folder_of: Callable[[str, str], Path] = in_working_directory
               ) -> ArmSource:
    """
    Return what parameters leave out of an arm; refuse what contradicts its URDF.

    A value of the parameters comes before one of the file of joint limits, that before the URDF's,
    that before the table's.

    Parameters
    ----------
    given : mapping
        Parameter overrides by name.
    folder_of : callable
        Returns, for a parameter's name and value, the folder that its relative path refers to.

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
    rows = rows_of(ARM, ())
    for name in USED:
        if name in given:
            _check('parameter ', rows[name], given[name])
    used = {name: given.get(name, rows[name].default) for name in USED}
    arm = None
    if used[URDF]:
        arm = _described(used[URDF], folder_of, given)
        used.update(_names(arm, given))
    names = list(used['joint_names'])
    if len(set(names)) != len(names) or '' in names:
        raise InvalidInputError(
            f'parameter joint_names is {names}, must be {rows["joint_names"].range_text}')
    in_file = {}
    if used[LIMITS]:
        with_path = str(_file(LIMITS, used[LIMITS], folder_of))
        used[LIMITS] = with_path
        in_file = read_joint_limits(with_path, names)
    check_given(given, names, in_file, None if arm is None else _faults(given, in_file, arm))
    if arm is None:
        return ArmSource(names, {**used, **in_file, **_gravity(given)}, ())
    limits = _limits(given, in_file, arm)
    values = {
        **used, **limits, 'friction.viscous': arm.friction.viscous.tolist(),
        'friction.coulomb': arm.friction.coulomb.tolist(),
        'initial_positions': _start({**limits, **given}, names)}
    warnings = [warning.text for warning in arm.warnings
                if not _is_answered(warning, {**in_file, **given})]
    return ArmSource(names, values, (*warnings, *_lacking(limits, given, names)))


def _check(prefix: str, row: Any, value: Any) -> None:
    try:
        check_value(row, value)
    except InvalidInputError as error:
        raise InvalidInputError(f'{prefix}{error}') from None


def _file(name: str, value: str, folder_of: Callable[[str, str], Path]) -> Path:
    try:
        return found_file(value, folder_of(name, value))
    except InvalidInputError as error:
        raise InvalidInputError(f'parameter {name}: {error}') from None
    except (OSError, ValueError) as error:  # too long for a name, a null character
        why = error.strerror if isinstance(error, OSError) else str(error)
        raise InvalidInputError(f'parameter {name} is {shown(value)}: {why}') from None


def _described(value: str, folder_of: Callable[[str, str], Path], given: Values) -> UrdfArm:
    """Return the arm of a URDF's text or path; frames that are not given may have other names."""
    origin, text = f'parameter {URDF}', value
    if not value.lstrip(BEFORE_XML).startswith('<'):
        path = _file(URDF, value, folder_of)
        origin = str(path)
        try:
            text = path.read_text(encoding='utf-8-sig')
        except (OSError, UnicodeDecodeError) as error:
            raise InvalidInputError(f'{path}: {" ".join(str(error).split())}') from None
    rows = rows_of(ARM, ())
    try:
        if not text.lstrip(BEFORE_XML).startswith('<'):
            raise InvalidInputError("no URDF, whose text begins with '<'")
        links = {link.name for link in read_document(text).links}
        base, tip = (given.get(name) or (rows[name].default if rows[name].default in links else '')
                     for name in ('base_frame', 'tip_frame'))
        return read(text, base, tip)
    except InvalidInputError as error:
        raise InvalidInputError(f'{origin}: {error}') from None


def _names(arm: UrdfArm, given: Values) -> dict[str, Any]:
    """Return the URDF's text and names; refuse others."""
    found: dict[str, Any] = {
        URDF: arm.text, 'base_frame': arm.base, 'tip_frame': arm.tip,
        'joint_names': list(arm.joint_names), 'link_names': list(arm.link_names)}
    for name in ('joint_names', 'link_names'):
        if name in given and list(given[name]) != found[name]:
            raise InvalidInputError(
                f'parameter {name} is {list(given[name])}, must be {found[name]}, as in the URDF '
                f'from link {quoted(arm.base)} to link {quoted(arm.tip)}; it may be left out')
    return found


def _faults(given: Values, in_file: Values, arm: UrdfArm) -> Iterator[str]:
    """Yield what contradicts a URDF: another arm's description, and limits that nothing gives."""
    both = [name for name in given if name in rows_of(ARM, ()) and name.startswith('arm.')]
    if both:
        more = f' and {len(both) - MAX_SHOWN} more' if len(both) > MAX_SHOWN else ''
        yield (f'{URDF} and {", ".join(both[:MAX_SHOWN])}{more} are given: lengths, masses and '
               "inertias are the URDF's"
               + (', and gravity is a parameter of that name' if 'arm.gravity' in both else ''))
    for joint, kind, bound in _bounds(arm):
        has, most = (f'joint_limits.{joint}.{x}' for x in (f'has_{kind}_limits', f'max_{kind}'))
        wanted = given.get(has, in_file.get(has)) is True
        if wanted and most not in given and most not in in_file and not isfinite(bound):
            yield f'{has} is true, and {most} is missing: the URDF has none'


def _bounds(arm: UrdfArm) -> Iterator[tuple[str, str, float]]:
    """Yield joint, kind and value of the URDF's limits, infinite where it has none."""
    for i, joint in enumerate(arm.joint_names):
        for kind in KINDS:
            values = getattr(arm, f'max_{kind}', None)
            yield joint, kind, float('inf') if values is None else float(values[i])


def _is_answered(warning: UrdfWarning, limits: Values) -> bool:
    """Return whether a warning is of limits that are all given elsewhere, or switched off."""
    joint = f'joint_limits.{warning.joint}'
    return bool(warning.limits) and all(
        f'{joint}.{name}' in limits
        or limits.get(f'{joint}.has_{name.removeprefix("max_")}_limits') is False
        for name in warning.limits)


def _limits(given: Values, in_file: Values, arm: UrdfArm) -> dict[str, Any]:
    """Return the limits, where parameters do not give them."""
    found, rows = dict(in_file), rows_of(ARM, arm.joint_names)
    for i, joint in enumerate(arm.joint_names):
        for end in ('min_position', 'max_position'):
            bound = float(getattr(arm, end)[i])
            found.setdefault(f'joint_limits.{joint}.{end}', min(max(bound, -NO_RANGE), NO_RANGE))
    for joint, kind, bound in _bounds(arm):
        has, most = (f'joint_limits.{joint}.{x}' for x in (f'has_{kind}_limits', f'max_{kind}'))
        known = most in in_file or isfinite(bound)
        found[has] = most in given or in_file.get(has, known)
        found.setdefault(most, bound if isfinite(bound) else rows[most].high)
    return found


def _start(values: Values, joint_names: list[str]) -> list[float]:
    """Return zero where a range has it, else the middle of the range."""
    q = []
    for joint in joint_names:
        low, high = (values[f'joint_limits.{joint}.{end}_position'] for end in ('min', 'max'))
        numbers = isinstance(low, float) and isinstance(high, float)  # else refused later on
        q.append(0.5 * (low + high) if numbers and not low <= 0.0 <= high else 0.0)
    return q


def _lacking(limits: Values, given: Values, joint_names: list[str]) -> Iterator[str]:
    """Yield a warning of joints without an acceleration limit."""
    without = [joint for joint in joint_names if not given.get(
        name := f'joint_limits.{joint}.has_acceleration_limits', limits[name])]
    if without:
        most = given.get('default_max_acceleration',
                         rows_of('planner', ())['default_max_acceleration'].default)
        yield (f'{counted(len(without), "joint")} without acceleration limit, '
               f'{", ".join(without)}: a planner that needs one takes default_max_acceleration, '
               f'{most} rad/s^2')


def _gravity(given: Values) -> dict[str, Any]:
    """Return gravity as a vector where it is given as a number."""
    if 'arm.gravity' not in given:
        return {}
    if 'gravity' in given:
        raise InvalidInputError(
            'gravity and arm.gravity are both given: one of them must be left out')
    down = given['arm.gravity']
    return {'gravity': [0.0, 0.0, -down]} if isinstance(down, float) else {}
