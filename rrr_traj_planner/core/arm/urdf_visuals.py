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

"""The shapes by which a URDF's links are seen: meshes, boxes, cylinders and spheres."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite
from typing import NamedTuple
from xml.etree import ElementTree as ET

import numpy as np
from rrr_traj_planner.core.arm.urdf_xml import robot_element
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import InvalidInputError, shown
from rrr_traj_planner.core.rotations import from_roll_pitch_yaw

# Of the elements in <geometry>: the attributes of their sizes, how many numbers each has, and what
# is taken where it is missing.
SIZES = {'mesh': (('scale', 3, '1 1 1'),), 'box': (('size', 3, None),),
         'cylinder': (('radius', 1, None), ('length', 1, None)), 'sphere': (('radius', 1, None),)}

Colour = tuple[float, float, float]


class Visual(NamedTuple):
    """A shape in its link's frame."""

    kind: str                     # a key of `SIZES`
    size: tuple[float, ...]       # as in `SIZES` [m]; of a mesh: factors
    pose: Array                   # shape (4, 4)
    colour: Colour | None = None  # red, green and blue, 0 to 1
    file: str = ''                # of a mesh, as it is written


class UnreadVisual(NamedTuple):
    """A shape that is malformed."""

    why: str


def urdf_visuals(text: str) -> dict[str, tuple[Visual | UnreadVisual, ...]]:
    """
    Return the shapes of a URDF's links.

    Parameters
    ----------
    text : str
        The URDF.

    Returns
    -------
    dict
        By the names of all links; empty for one that is not to be seen.

    Raises
    ------
    InvalidInputError
        If the text is no URDF.

    """
    root = robot_element(text)
    materials: dict[str, ET.Element] = {}
    for element in (*root.findall('material'), *root.iter('material')):
        if element.find('color') is not None:
            materials.setdefault(element.get('name', ''), element)
    return {link.get('name', ''): tuple(
        _visual(element, materials) for element in link.findall('visual'))
        for link in root.findall('link')}


def _visual(element: ET.Element, materials: Mapping[str, ET.Element]) -> Visual | UnreadVisual:
    try:
        shape = next(iter(element.find('geometry') or ()), None)
        if shape is None or shape.tag not in SIZES:
            what = 'nothing' if shape is None else f'<{shape.tag}>'
            raise InvalidInputError(f'<geometry> has {what}, must have one of {", ".join(SIZES)}')
        if shape.tag == 'mesh' and not shape.get('filename'):
            raise InvalidInputError('<mesh> has no filename')
        size = tuple(number for name, count, default in SIZES[shape.tag]
                     for number in _numbers(shape, name, count, default))
        return Visual(str(shape.tag), size, _pose(element.find('origin')),
                      _colour(element.find('material'), materials), shape.get('filename', ''))
    except InvalidInputError as error:
        return UnreadVisual(str(error))


def _pose(origin: ET.Element | None) -> Array:
    """Return an origin as a transform, shape (4, 4)."""
    pose = np.eye(4)
    if origin is not None:
        pose[:3, :3] = from_roll_pitch_yaw(_numbers(origin, 'rpy', 3, '0 0 0'))
        pose[:3, 3] = _numbers(origin, 'xyz', 3, '0 0 0')
    return pose


def _colour(material: ET.Element | None, materials: Mapping[str, ET.Element]) -> Colour | None:
    """Return the colour of a material; its opacity is left out."""
    if material is None:
        return None
    if material.find('color') is None:
        material = materials.get(material.get('name', ''))
    colour = None if material is None else material.find('color')
    if colour is None:
        return None
    red, green, blue, _ = (min(max(c, 0.0), 1.0) for c in _numbers(colour, 'rgba', 4, None))
    return red, green, blue


def _numbers(element: ET.Element, name: str, count: int, default: str | None) -> list[float]:
    """Return the numbers of an attribute; refuse others than so many finite ones."""
    text = element.get(name, default)
    if text is None:
        raise InvalidInputError(f'<{element.tag}> has no {name}')
    try:
        numbers = [float(part) for part in text.split()]
    except ValueError:
        numbers = []
    if len(numbers) != count or not all(map(isfinite, numbers)):
        wanted = 'a finite number' if count == 1 else f'{count} finite numbers'
        raise InvalidInputError(f'{name} of <{element.tag}> is {shown(text)}, must be {wanted}')
    return numbers
