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

"""A YAML file of via points: its own fields, or messages as `ros2 topic echo` prints them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.errors import did_you_mean, InvalidInputError, shown
from rrr_traj_planner.nodes.parameters.yaml_loader import input_error, Loader
from rrr_traj_planner.nodes.point_files.joint_forms import is_joint_state, ListedJoints
from rrr_traj_planner.nodes.point_files.located import Located, similar
from rrr_traj_planner.nodes.point_files.point_forms import (
    common_frame,
    FramedPoint,
    is_message,
    points_in,
)
import yaml

TIPS, JOINTS = 'via_points', 'joint_via_points'
FIELDS = ('planner_id', TIPS, JOINTS, 'stop_at', 'dwell', 'segment_durations', 'arm')
MESSAGE_FIELDS = ('header', 'poses', 'pose', 'point', 'position', 'orientation', 'x', 'y', 'z',
                  'name', 'velocity', 'effort')
NEEDED = f'must have {TIPS}: [[x, y, z], ...] in m, or {JOINTS} in rad'


def document(text: str) -> dict[str, Any]:
    """
    Return the content of a file.

    Parameters
    ----------
    text : str
        A mapping with FIELDS; or messages, one after another or in place of the via points.

    Returns
    -------
    dict
        Values of `Task`'s fields; `arm` is the name of a file.

    Raises
    ------
    InvalidInputError
        If it is malformed; with the line, the field, and what is wrong.

    """
    roots = _roots(text)
    if len(roots) > 1:
        return _of_documents(roots)
    root = roots[0] if roots else None
    if root is None or not isinstance(root.value, dict):
        raise InvalidInputError(
            f'no via_points, it {"is empty" if root is None else "has no fields"}: {NEEDED}')
    if TIPS in root.value or JOINTS in root.value:
        fields = root.fields(FIELDS)
        return {**_via_points(fields), **_others(fields)}
    if not _is_message(root):
        near = similar(TIPS, list(map(str, root.value)))
        raise InvalidInputError(
            f'no via_points, its fields are {", ".join(map(shown, root.value))}: {NEEDED}'
            + (f'; {did_you_mean(TIPS, by=near)}' if near else ''))
    fields = root.fields((*FIELDS, *MESSAGE_FIELDS))
    return {**_of_messages([_without(root, FIELDS)]), **_others(fields)}


def _roots(text: str) -> list[Located]:
    """Return the documents of a file that are not empty: a `---` comes after every message."""
    try:
        loader, found = Loader(text), []
        while loader.check_node():
            node = loader.get_node()
            found.append(Located('', loader.construct_document(node), node))
    except yaml.YAMLError as error:
        raise input_error(error) from None
    return [root for root in found if root.value is not None]


def _of_documents(roots: Sequence[Located]) -> dict[str, Any]:
    """Return the content of messages, and of one document beside them with other fields."""
    others = [root for root in roots if isinstance(root.value, dict) and set(
        map(str, root.value)) <= {*FIELDS} - {TIPS, JOINTS}]
    if len(others) > 1:
        names = ', '.join(map(str, others[1].value))
        raise InvalidInputError(f'line {others[1].line}: a second document has {names}, must be '
                                f'one with those of line {others[0].line}')
    messages = _of_messages([root for root in roots if root not in others])
    return {**messages, **_others(others[0].fields())} if others else messages


def _is_message(root: Located) -> bool:
    return is_message(root.value) or is_joint_state(root.value)


def _without(root: Located, keys: Sequence[str]) -> Located:
    """Return a mapping without some of its fields."""
    node = yaml.MappingNode(root.node.tag, [
        pair for pair in root.node.value if pair[0].value not in keys], root.node.start_mark,
        root.node.end_mark)
    return Located('', {k: v for k, v in root.value.items() if k not in keys}, node)


def _of_messages(roots: Sequence[Located]) -> dict[str, Any]:
    """Return the via points of messages, one after another."""
    for root in roots:
        if not _is_message(root):
            raise InvalidInputError(
                f'line {root.line}: a document is {shown(root.value)}, must be a message with '
                'poses or joint positions, as all in a file of several documents')
    of_joints = [is_joint_state(root.value) for root in roots]
    if all(of_joints):
        return {'joint_positions': ListedJoints([
            root._replace(name=f'{JOINTS}[{i}]') for i, root in enumerate(roots)])}
    if any(of_joints):
        raise InvalidInputError('some messages have poses, others joint positions: must be of one '
                                'kind')
    return _tips([point for root in roots for point in points_in(root)])


def _tips(points: Sequence[FramedPoint]) -> dict[str, Any]:
    return {TIPS: np.array([point.position for point in points]).reshape(-1, 3),
            'frame': common_frame(points)}


def _via_points(fields: dict[str, Located]) -> dict[str, Any]:
    """Return the via points, in one of two ways."""
    if TIPS in fields and JOINTS in fields:
        raise InvalidInputError(
            f'line {max(fields[TIPS].line, fields[JOINTS].line)}: {TIPS} and {JOINTS} are both '
            'given, must be one of the two')
    given = fields[TIPS if TIPS in fields else JOINTS]
    if given.value in (None, []):
        raise InvalidInputError(
            f'line {given.line}: no {given.name}, the list is empty: {NEEDED}')
    if given.name == TIPS:
        return _tips(points_in(given))
    if not isinstance(given.value, list):
        raise given.error(f'is {shown(given.value)}, must be a list of points')
    return {'joint_positions': ListedJoints(given.items())}


def _others(fields: dict[str, Located]) -> dict[str, Any]:
    """Return what a file says beside its via points."""
    return {'planner_id': _text(fields, 'planner_id'), 'arm': _text(fields, 'arm'),
            'segment_durations': _numbers(fields, 'segment_durations', or_nan=True),
            'dwell': _numbers(fields, 'dwell'), 'stop_at': _flags(fields, 'stop_at')}


def _text(fields: dict[str, Located], name: str) -> str:
    return fields[name].text() if name in fields else ''


def _numbers(fields: dict[str, Located], name: str, or_nan: bool = False) -> Array:
    """Return a list of numbers, empty where there is none; NaN only where it has a meaning."""
    if name not in fields or fields[name].value is None:
        return np.zeros(0)
    given = fields[name]
    if not isinstance(given.value, list):
        raise given.error(f'is {shown(given.value)}, must be a list of numbers')
    return np.array([item.value if or_nan and item.value != item.value else item.number()
                     for item in given.items()])


def _flags(fields: dict[str, Located], name: str) -> BoolArray:
    """Return a list of truth values, empty where there is none."""
    if name not in fields or fields[name].value is None:
        return np.zeros(0, dtype=bool)
    given = fields[name]
    if not isinstance(given.value, list):
        raise given.error(f'is {shown(given.value)}, must be a list of true and false')
    for item in given.items():
        if not isinstance(item.value, bool):
            raise item.error(f'is {shown(item.value)}, must be true or false')
    return np.array(given.value, dtype=bool)
