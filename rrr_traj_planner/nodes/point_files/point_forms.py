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

"""The forms in which a YAML file may give tip positions: lists, mappings, messages."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from rrr_traj_planner.core.errors import InvalidInputError, shown
from rrr_traj_planner.nodes.point_files.located import Located

AXES = ('x', 'y', 'z')
WANTED = 'three numbers, [x, y, z] in m'
FORMS = (f'{WANTED}, a mapping with x, y and z, or a Point, Pose or PoseStamped message')

# Keys by which a mapping is told to be a message with points, and all that it may have.
MESSAGE_KEYS = ('poses', 'pose', 'point', 'position', 'x')
POINT_KEYS = (*AXES, 'position', 'orientation', 'pose', 'point', 'header')
ARRAY_KEYS = ('poses', 'header')
HEADER_KEYS = ('stamp', 'frame_id', 'seq')


class FramedPoint(NamedTuple):
    """A tip position [m], and its frame; empty: not given."""

    position: list[float]
    frame: str = ''


def is_message(value: object) -> bool:
    """
    Return whether a value seems to be a message with tip positions.

    Parameters
    ----------
    value : object
        As parsed.

    Returns
    -------
    bool
        Whether it has one of its keys.

    """
    return isinstance(value, dict) and any(key in value for key in MESSAGE_KEYS)


def points_in(given: Located) -> list[FramedPoint]:
    """
    Return the points of a list or of a message.

    Parameters
    ----------
    given : Located
        A list of points in any form, a PoseArray or Path message, or a single point's message.

    Returns
    -------
    list of FramedPoint
        In order.

    Raises
    ------
    InvalidInputError
        If it is none of these; names line, point, and what is missing or wrong.

    """
    if isinstance(given.value, list):
        return [_point(item) for item in given.items()]
    if not is_message(given.value):
        raise given.error(f'is {shown(given.value)}, must be a list of points [x, y, z], or a '
                          'PoseArray message')
    if 'poses' not in given.value:
        return [_point(given)]
    fields = given.fields(ARRAY_KEYS)
    frame = _frame(fields)
    poses = fields['poses']
    if not isinstance(poses.value, list):
        raise poses.error(f'is {shown(poses.value)}, must be a list of poses')
    if not poses.value:
        raise poses.error('is empty, must have a pose for each via point')
    return [FramedPoint(point.position, point.frame or frame) for point in points_in(poses)]


def common_frame(points: Sequence[FramedPoint]) -> str:
    """
    Return the frame of all points.

    Parameters
    ----------
    points : sequence of FramedPoint
        The points.

    Returns
    -------
    str
        Empty where none is given.

    Raises
    ------
    InvalidInputError
        If two points are in different frames.

    """
    frames = [point.frame for point in points]
    for i, frame in enumerate(frames):
        if frame != frames[0]:
            raise InvalidInputError(
                f'via point {i} is in frame {shown(frame)}, via point 0 in frame '
                f'{shown(frames[0])}: must be in one frame')
    return frames[0] if frames else ''


def _point(given: Located) -> FramedPoint:
    """Return a point in any form."""
    if isinstance(given.value, list):
        return FramedPoint(_listed(given))
    if not isinstance(given.value, dict):
        hint = (': ros2 topic echo leaves out what is long, but for --full-length'
                if given.value == '...' else '')
        raise given.error(f'is {shown(given.value)}, must be {FORMS}{hint}')
    fields = given.fields(POINT_KEYS)
    inner = next((fields[key] for key in ('pose', 'point', 'position') if key in fields), None)
    if inner is None:
        return FramedPoint(_of_axes(given, fields))
    if 'orientation' in fields:
        _check_orientation(fields['orientation'])
    if not isinstance(inner.value, dict):
        raise inner.error(f'is {shown(inner.value)}, must be a mapping with x, y and z')
    return FramedPoint(_point(inner).position, _frame(fields))


def _listed(given: Located) -> list[float]:
    if len(given.value) != len(AXES):
        raise given.error(f'is {shown(given.value)}, must be {WANTED}: {difference(given.value)}')
    return [item.number() for item in given.items()]


def _of_axes(given: Located, fields: dict[str, Located]) -> list[float]:
    missing = [axis for axis in AXES if axis not in fields]
    if missing:
        raise given.error(
            f'has {", ".join(fields) or "no fields"}, must have x, y and z: '
            f'{" and ".join(missing)} {"is" if len(missing) == 1 else "are"} missing')
    return [fields[axis].number() for axis in AXES]


def _check_orientation(orientation: Located) -> None:
    """Refuse an orientation that is none; it is not used: the arm has three degrees of freedom."""
    if not isinstance(orientation.value, dict):
        raise orientation.error(
            f'is {shown(orientation.value)}, must be a mapping with x, y, z and w')
    for number in orientation.fields((*AXES, 'w')).values():
        number.number()


def _frame(fields: dict[str, Located]) -> str:
    """Return the frame of a message's header; its stamp is that of an old message."""
    if 'header' not in fields:
        return ''
    header = fields['header']
    if not isinstance(header.value, dict):
        raise header.error(f'is {shown(header.value)}, must be a mapping with frame_id')
    found = header.fields(HEADER_KEYS)
    return found['frame_id'].text() if 'frame_id' in found else ''


def difference(point: Sequence[object]) -> str:
    """
    Return what a point lacks, or has too many of.

    Parameters
    ----------
    point : sequence
        Other than three values.

    Returns
    -------
    str
        For a message.

    """
    if len(point) < len(AXES):
        missing = AXES[len(point):]
        return f'{" and ".join(missing)} {"is" if len(missing) == 1 else "are"} missing'
    more = ', '.join(map(shown, point[len(AXES):]))
    return f'{more} {"is" if len(point) == len(AXES) + 1 else "are"} too many'
