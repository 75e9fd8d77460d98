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

"""Checks of parameter overrides by name: unknown, missing and unused parameters."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from difflib import get_close_matches
from typing import Any

from rrr_traj_planner.core.arm.model import JOINT_NAMES
from rrr_traj_planner.core.errors import did_you_mean, InvalidInputError
from rrr_traj_planner.nodes.parameters.table import ARM, MOTION, PLANNER, rows_of

KINDS = ('velocity', 'acceleration', 'jerk', 'effort')  # of limits, in names of parameters
ROS_PARAMETERS = ('use_sim_time', 'qos_overrides', 'start_type_description_service')
MAX_SHOWN = 3      # unknown names in one message
SIMILARITY = 0.75  # least ratio (difflib's; 1: equal) for a known name to be suggested


def check_given(given: Mapping[str, Any], joint_names: Sequence[str],
                in_file: Mapping[str, Any] | None = None,
                faults_of_urdf: Iterable[str] | None = None) -> None:
    """
    Refuse unknown names in the nodes' parameter groups, and renamed joints without limits.

    Parameters
    ----------
    given : mapping
        Parameter overrides by name.
    joint_names : sequence of str
        Names of the three joints.
    in_file : mapping, optional
        Limits of a file, by the parameters' names.
    faults_of_urdf : iterable of str, optional
        What contradicts the arm's URDF, which has limits too; None: it has no URDF.

    Raises
    ------
    InvalidInputError
        If there are any; with the most similar known name for each unknown one.

    """
    if faults_of_urdf is None:
        faults_of_urdf = _missing_limits({**(in_file or {}), **given}, joint_names)
    faults = [*faults_of_urdf, *_unknown(given, joint_names)]
    if faults:
        raise InvalidInputError('; '.join(faults))


def unused_warnings(given: Collection[str], joint_names: Sequence[str]) -> list[str]:
    """
    Return warnings about parameters that no node uses.

    Parameters
    ----------
    given : collection of str
        Names of parameter overrides.
    joint_names : sequence of str
        Names of the three joints.

    Returns
    -------
    list of str
        One text per unused parameter, with the similar known names if there are any.

    """
    known, texts = _known(joint_names), []
    for name in given:
        if name not in known and _group(name) not in (*map(_group, known), *ROS_PARAMETERS):
            question = did_you_mean(*_similar(name, known))
            texts.append(f'parameter {name} is used by no node'
                         + (f'; {question}' if question else ''))
    return texts


def _known(joint_names: Sequence[str]) -> list[str]:
    """Return the parameter names of all nodes: one file may serve them all."""
    return list({name: None for node in (PLANNER, ARM, MOTION)
                 for name in rows_of(node, joint_names)})


def _similar(name: str, known: Sequence[str]) -> list[str]:
    """Return the known names that are most similar, whole or without their first parts."""
    parts = name.count('.') + 1
    ends: dict[str, list[str]] = {}
    for other in known:
        for end in {other, '.'.join(other.split('.')[-parts:])}:
            ends.setdefault(end, []).append(other)
    return [other for end in get_close_matches(name, ends, 1, SIMILARITY) for other in ends[end]]


def _group(name: str) -> str:
    return name.partition('.')[0]


def _unknown(given: Mapping[str, Any], joint_names: Sequence[str]) -> Iterator[str]:
    known = _known(joint_names)
    groups = set(map(_group, known))
    unknown = [name for name in given if name not in known and _group(name) in groups]
    for name in unknown[:MAX_SHOWN]:
        near, = get_close_matches(name, [k for k in known if _group(k) == _group(name)], 1, 0.0)
        yield f'parameter {name} is unknown, the nearest known one is {near}'
    if len(unknown) > MAX_SHOWN:
        more = len(unknown) - MAX_SHOWN
        yield f'{more} more {"is" if more == 1 else "are"} unknown'


def _missing_limits(given: Mapping[str, Any], joint_names: Sequence[str]) -> Iterator[str]:
    """Yield a message for each renamed joint that lacks limits of its own."""
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
                   f"the default arm's limits of {default} do not apply to it")
