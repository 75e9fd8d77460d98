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

"""The forms in which a YAML file may give joint positions: lists, mappings, messages."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import counted, did_you_mean, shown
from rrr_traj_planner.nodes.point_files.located import Located, similar

FORMS = ('a list of joint positions in rad, a mapping of joint names to positions, or a '
         'JointState message')

# Of messages, beside the names and the positions.
STATE_KEYS = ('name', 'position', 'velocity', 'effort', 'header')


def is_joint_state(value: object) -> bool:
    """
    Return whether a value seems to be a JointState message.

    Parameters
    ----------
    value : object
        As parsed.

    Returns
    -------
    bool
        Whether it has names and positions.

    """
    return isinstance(value, dict) and 'name' in value and isinstance(value.get('position'), list)


class ListedJoints:
    """
    Joint positions of a YAML file, in the order of an arm's joints on request.

    Parameters
    ----------
    points : sequence of Located
        Via points, each in any form.

    Raises
    ------
    InvalidInputError
        If one has none of the forms; names line, point, and what is missing or wrong.

    """

    def __init__(self, points: Sequence[Located]) -> None:
        self._points = [(point, *_named(point)) for point in points]

    def __len__(self) -> int:
        """Return the number of via points."""
        return len(self._points)

    def __call__(self, joint_names: Sequence[str]) -> Array:
        """
        Return joint positions.

        Parameters
        ----------
        joint_names : sequence of str
            The arm's joints.

        Returns
        -------
        ndarray, shape (n, 3)
            In their order [rad].

        Raises
        ------
        InvalidInputError
            If a point has no position of a joint; with its line.

        """
        return np.array([_in_order(*point, joint_names) for point in self._points])


def _named(point: Located) -> tuple[list[str], list[float]]:
    """Return a point's joint names and positions; no names: they are in the arm's order."""
    if isinstance(point.value, list):
        return [], [item.number() for item in point.items()]
    if not isinstance(point.value, dict):
        raise point.error(f'is {shown(point.value)}, must be {FORMS}')
    if not is_joint_state(point.value):
        fields = point.fields()
        return list(fields), [field.number() for field in fields.values()]
    fields = point.fields(STATE_KEYS)
    names, positions = fields['name'], fields['position']
    if not isinstance(names.value, list) or len(names.value) != len(positions.value):
        number = len(names.value) if isinstance(names.value, list) else 0
        raise names.error(f'has {counted(number, "name")} for '
                          f'{counted(len(positions.value), "position")}')
    return [item.text() for item in names.items()], [
        item.number() for item in positions.items()]


def _in_order(point: Located, names: list[str], positions: list[float],
              joint_names: Sequence[str]) -> list[float]:
    """Return a point's positions in the order of the arm's joints."""
    if not names:
        if len(positions) != len(joint_names):
            raise point.error(f'is {shown(point.value)}, must have {len(joint_names)} numbers: '
                              f'the positions of {", ".join(joint_names)} in rad')
        return positions
    found = dict(zip(names, positions))
    for joint in joint_names:
        if names.count(joint) != 1:
            near = similar(joint, [name for name in names if name not in joint_names])
            raise point.error(f'names {", ".join(names)}, must name {joint} once'
                              + (f'; {did_you_mean(joint, by=near)}' if near else ''))
    return [found[joint] for joint in joint_names]
