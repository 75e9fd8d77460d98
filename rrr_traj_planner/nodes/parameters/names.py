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

"""The names of parameters that are given: mistaken ones, missing ones, ones that nobody uses."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from difflib import get_close_matches
from typing import Any

from rrr_traj_planner.core.arm.model import JOINT_NAMES
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.parameters.table import ARM, PLANNER, rows_of

KINDS = ('velocity', 'acceleration', 'jerk', 'effort')
ROS_S_OWN = ('use_sim_time', 'qos_overrides', 'start_type_description_service')
SHOWN = 3        # names of many that are alike
LIKENESS = 0.75  # of a name that nobody uses to the one that is suggested, 1 for equal


def check_given(given: Mapping[str, Any], joint_names: Sequence[str]) -> None:
    """
    Refuse unknown names in the groups of both nodes, and joints that would get another's limits.

    Parameters
    ----------
    given : mapping
        The value of each parameter that a file, the command line or a program gives.
    joint_names : sequence of str
        The three joints.

    Raises
    ------
    InvalidInputError
        Naming them, and for each unknown name the nearest known one.

    """
    faults = [*_missing_limits(given, joint_names), *_unknown(given, joint_names)]
    if faults:
        raise InvalidInputError('; '.join(faults))


def unused(given: Collection[str], joint_names: Sequence[str]) -> list[str]:
    """
    Return what is to be said of parameters that neither node uses.

    Parameters
    ----------
    given : collection of str
        Names.
    joint_names : sequence of str
        The three joints.

    Returns
    -------
    list of str
        A text for each, with the known name that it may have been meant for.

    """
    known, texts = _known(joint_names), []
    for name in given:
        if name not in known and _group(name) not in (*map(_group, known), *ROS_S_OWN):
            near = get_close_matches(name, known, 1, LIKENESS)
            texts.append(f'parameter {name} is used by neither node'
                         + ''.join(f'; is {other} meant?' for other in near))
    return texts


def _known(joint_names: Sequence[str]) -> list[str]:
    """Return the names of both nodes' parameters: one file serves both."""
    return list({**rows_of(PLANNER, joint_names), **rows_of(ARM, joint_names)})


def _group(name: str) -> str:
    return name.partition('.')[0]


def _unknown(given: Mapping[str, Any], joint_names: Sequence[str]) -> Iterator[str]:
    known = _known(joint_names)
    groups = set(map(_group, known))
    unknown = [name for name in given if name not in known and _group(name) in groups]
    for name in unknown[:SHOWN]:
        near, = get_close_matches(name, [k for k in known if _group(k) == _group(name)], 1, 0.0)
        yield f'parameter {name} is unknown, the nearest known one is {near}'
    if len(unknown) > SHOWN:
        yield f'{len(unknown) - SHOWN} more are unknown'


def _missing_limits(given: Mapping[str, Any], joint_names: Sequence[str]) -> Iterator[str]:
    """Yield what joints that are not the default arm's lack."""
    for index, (joint, default) in enumerate(zip(joint_names, JOINT_NAMES)):
        if joint == default:
            continue
        limits = f'joint_limits.{joint}'
        needed = ['min_position', 'max_position', *(
            f'max_{kind}' for kind in KINDS
            if given.get(f'{limits}.has_{kind}_limits') is not False)]
        missing = [name for name in needed if f'{limits}.{name}' not in given]
        if missing:
            yield (f'{limits} lacks {", ".join(missing)}: joint_names[{index}] is {joint!r}, and '
                   f"those of the default arm's {default} are not its own")
