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

"""The limits of a URDF's joint, of which many are placeholders."""

from __future__ import annotations

from math import inf
from typing import NamedTuple

from rrr_traj_planner.core.arm.limits import NO_EFFORT, NO_RANGE, NO_VELOCITY
from rrr_traj_planner.core.arm.urdf_document import Joint, UrdfWarning
from rrr_traj_planner.core.errors import InvalidInputError

RANGE = ('min_position', 'max_position')


class UrdfLimits(NamedTuple):
    """Limits of one joint; infinite for none."""

    lower: float      # [rad]
    upper: float
    velocity: float   # [rad/s]
    effort: float     # [N m]


def limits_of(joint: Joint, warnings: list[UrdfWarning]) -> UrdfLimits:
    """
    Return a moving joint's limits.

    Parameters
    ----------
    joint : Joint
        Revolute or continuous.
    warnings : list of UrdfWarning
        Gets one for each limit that there is not.

    Returns
    -------
    UrdfLimits
        Infinite where there is none, or a placeholder.

    Raises
    ------
    InvalidInputError
        If the range is empty.

    """
    lower, upper = _range(joint, warnings)
    return UrdfLimits(
        lower, upper, _bound(joint, 'velocity', joint.velocity, NO_VELOCITY, 'rad/s', warnings),
        _bound(joint, 'effort', joint.effort, NO_EFFORT, 'N m', warnings))


def _range(joint: Joint, warnings: list[UrdfWarning]) -> tuple[float, float]:
    if joint.kind == 'continuous':
        return -inf, inf
    if joint.position_range in (None, (0.0, 0.0)):
        text = ('is revolute and has no range' if joint.position_range is None
                else 'is revolute and has the range [0, 0] rad, which is taken for none')
        warnings.append(UrdfWarning(f'{joint.label} {text}', joint.name, RANGE))
        return -inf, inf
    lower, upper = joint.position_range
    if lower >= upper:
        raise InvalidInputError(f'{joint.label}: lower is {_end(joint.lower)}, must be below '
                                f'upper, {_end(joint.upper)}')
    if lower <= -NO_RANGE:
        warnings.append(_placeholder(joint, 'lower', lower, 'rad', RANGE[0]))
        lower = -inf
    if upper >= NO_RANGE:
        warnings.append(_placeholder(joint, 'upper', upper, 'rad', RANGE[1]))
        upper = inf
    return lower, upper


def _bound(joint: Joint, name: str, value: float | None, none: float, unit: str,
           warnings: list[UrdfWarning]) -> float:
    if value is not None and 0.0 < value < none:
        return value
    limit = f'max_{name}'
    if value is None:
        warnings.append(UrdfWarning(f'{joint.label} has no {name} limit', joint.name, (limit,)))
    else:
        warnings.append(_placeholder(joint, name, value, unit, limit))
    return inf


def _placeholder(joint: Joint, name: str, value: float, unit: str, limit: str) -> UrdfWarning:
    return UrdfWarning(f'{joint.label}: {name} {value:g} {unit} is taken for no limit', joint.name,
                       (limit,))


def _end(value: float | None) -> str:
    return '0 rad by default' if value is None else f'{value:g} rad'
