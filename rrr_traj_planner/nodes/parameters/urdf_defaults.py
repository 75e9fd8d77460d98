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

"""Defaults of parameters from an arm's URDF, and what in parameters contradicts it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import isfinite, pi
from typing import Any

from rrr_traj_planner.core.arm.limits import NO_RANGE
from rrr_traj_planner.core.arm.urdf_arm import UrdfArm
from rrr_traj_planner.core.arm.urdf_document import UrdfWarning
from rrr_traj_planner.core.errors import counted, InvalidInputError, quoted
from rrr_traj_planner.nodes.parameters.override_checks import KINDS, MAX_SHOWN
from rrr_traj_planner.nodes.parameters.table import ARM, rows_of

Values = Mapping[str, Any]


def names_of(arm: UrdfArm, given: Values) -> dict[str, Any]:
    """
    Return a URDF's text and names; refuse others.

    Parameters
    ----------
    arm : UrdfArm
        What the URDF says.
    given : mapping
        Parameter overrides by name.

    Returns
    -------
    dict
        Values by names of parameters.

    Raises
    ------
    InvalidInputError
        If names are given and are not the URDF's.

    """
    found: dict[str, Any] = {
        'robot_description': arm.text, 'base_frame': arm.base, 'tip_frame': arm.tip,
        'joint_names': list(arm.joint_names), 'link_names': list(arm.link_names)}
    for name in ('joint_names', 'link_names'):
        if name in given and list(given[name]) != found[name]:
            raise InvalidInputError(
                f'parameter {name} is {list(given[name])}, must be {found[name]}, as in the URDF '
                f'from link {quoted(arm.base)} to link {quoted(arm.tip)}; it may be left out')
    return found


def faults(arm: UrdfArm, given: Values, in_file: Values) -> Iterator[str]:
    """
    Yield what contradicts a URDF: another arm's description, and limits that nothing gives.

    Parameters
    ----------
    arm : UrdfArm
        What the URDF says.
    given : mapping
        Parameter overrides by name.
    in_file : mapping
        Limits of a file, by names of parameters.

    Yields
    ------
    str
        A message.

    """
    both = [name for name in given if name in rows_of(ARM, ()) and name.startswith('arm.')]
    if both:
        more = f' and {len(both) - MAX_SHOWN} more' if len(both) > MAX_SHOWN else ''
        yield (f'robot_description and {", ".join(both[:MAX_SHOWN])}{more} are given: lengths, '
               "masses and inertias are the URDF's"
               + (', and gravity is a parameter of that name' if 'arm.gravity' in both else ''))
    for joint, kind, bound in _bounds(arm):
        has, most = (f'joint_limits.{joint}.{x}' for x in (f'has_{kind}_limits', f'max_{kind}'))
        wanted = given.get(has, in_file.get(has)) is True
        if wanted and most not in given and most not in in_file and not isfinite(bound):
            yield f'{has} is true, and {most} is missing: the URDF has none'


def values_of(arm: UrdfArm, given: Values, in_file: Values) -> dict[str, Any]:
    """
    Return limits, friction and positions at the start, where parameters do not give them.

    Parameters
    ----------
    arm : UrdfArm
        What the URDF says.
    given : mapping
        Parameter overrides by name.
    in_file : mapping
        Limits of a file, by names of parameters.

    Returns
    -------
    dict
        Values by names of parameters.

    """
    limits = _limits(arm, given, in_file)
    return {**limits, 'friction.viscous': arm.friction.viscous.tolist(),
            'friction.coulomb': arm.friction.coulomb.tolist(),
            'initial_positions': _start({**limits, **given}, arm.joint_names)}


def warnings_of(arm: UrdfArm, given: Values, in_file: Values) -> Iterator[str]:
    """
    Yield what is odd about a URDF, and what neither it nor parameters give.

    Parameters
    ----------
    arm : UrdfArm
        What the URDF says.
    given : mapping
        Parameter overrides by name.
    in_file : mapping
        Limits of a file, by names of parameters.

    Yields
    ------
    str
        A warning.

    """
    for warning in arm.warnings:
        if not _is_answered(warning, {**in_file, **given}):
            yield warning.text
    yield from _without_acceleration(_limits(arm, given, in_file), given, arm.joint_names)


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


def _limits(arm: UrdfArm, given: Values, in_file: Values) -> dict[str, Any]:
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


def _start(values: Values, joint_names: Sequence[str]) -> list[float]:
    """
    Return zero where a range has it, else the middle of the range.

    Of a range with one end only, half a turn from it.
    """
    q = []
    for joint in joint_names:
        low, high = (values[f'joint_limits.{joint}.{end}_position'] for end in ('min', 'max'))
        if isinstance(low, float) and isinstance(high, float):  # else refused later on
            half = 0.5 * (high - low) if max(-low, high) < NO_RANGE else pi
            q.append(low + half if low > 0.0 else high - half if high < 0.0 else 0.0)
        else:
            q.append(0.0)
    return q


def _without_acceleration(limits: Values, given: Values, joint_names: Sequence[str]
                          ) -> Iterator[str]:
    """Yield a warning of joints without an acceleration limit."""
    without = [joint for joint in joint_names if not given.get(
        name := f'joint_limits.{joint}.has_acceleration_limits', limits[name])]
    if without:
        most = given.get('default_max_acceleration',
                         rows_of('planner', ())['default_max_acceleration'].default)
        yield (f'{counted(len(without), "joint")} without acceleration limit, '
               f'{", ".join(without)}: a planner that needs one takes default_max_acceleration, '
               f'{most} rad/s^2')
