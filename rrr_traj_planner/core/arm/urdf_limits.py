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
from rrr_traj_planner.core.arm.urdf_document import Joint
from rrr_traj_planner.core.errors import InvalidInputError


class UrdfLimits(NamedTuple):
    """Limits of one joint; infinite for none."""

    lower: float      # [rad]
    upper: float
    velocity: float   # [rad/s]
    effort: float     # [N m]


def limits_of(joint: Joint, warnings: list[str]) -> UrdfLimits:
    """
    Return a moving joint's limits.

    Parameters
    ----------
    joint : Joint
        Revolute or continuous.
    warnings : list of str
        Gets a text for each value that is taken for none.

    Returns
    -------
    UrdfLimits
        Infinite where there is none, or a placeholder.

    Raises
    ------
    InvalidInputError
        If the range is empty.

    """
    if joint.kind == 'revolute' and not joint.has_limit:
        warnings.append(f'{joint.label} is revolute and has no <limit>: without limits')
        return UrdfLimits(-inf, inf, inf, inf)
    lower, upper = _range(joint, warnings)
    return UrdfLimits(
        lower, upper, _bound(joint, 'velocity', NO_VELOCITY, 'rad/s', warnings),
        _bound(joint, 'effort', NO_EFFORT, 'N m', warnings))


def _range(joint: Joint, warnings: list[str]) -> tuple[float, float]:
    lower, upper = joint.lower, joint.upper
    if joint.kind == 'continuous':
        return -inf, inf
    if lower == upper == 0.0:
        warnings.append(f'{joint.label} is revolute and has the range [0, 0] rad: without range')
        return -inf, inf
    if lower >= upper:
        raise InvalidInputError(f'{joint.label}: lower is {lower:g} rad, must be below upper, '
                                f'{upper:g} rad')
    for name, value, none in (('lower', lower, lower <= -NO_RANGE),
                              ('upper', upper, upper >= NO_RANGE)):
        if none:
            warnings.append(f'{joint.label}: {name} {value:g} rad is taken for no limit')
    return -inf if lower <= -NO_RANGE else lower, inf if upper >= NO_RANGE else upper


def _bound(joint: Joint, name: str, none: float, unit: str, warnings: list[str]) -> float:
    value = float(getattr(joint, name))
    if 0.0 < value < none:
        return value
    if joint.has_limit:
        warnings.append(f'{joint.label}: {name} {value:g} {unit} is taken for no limit')
    else:
        warnings.append(f'{joint.label} has no limit on {name}')
    return inf
