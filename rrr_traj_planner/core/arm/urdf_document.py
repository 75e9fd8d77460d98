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

"""The links and joints of a URDF's text: parsed by urdf_parser_py, every fault named."""

from __future__ import annotations

from math import inf, isfinite
from typing import Any, NamedTuple
from xml.etree import ElementTree as ET

import numpy as np
from rrr_traj_planner.core.arm.urdf_xml import robot_element
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import InvalidInputError, quoted, shown
from rrr_traj_planner.core.rotations import from_roll_pitch_yaw

KINDS = ('revolute', 'continuous', 'prismatic', 'fixed', 'floating', 'planar')
LARGEST = 1e50  # magnitude of numbers, so that products of some are finite; limits may be larger

# Of the elements that are read: attributes that are texts, those that are numbers and how many
# each has, and the elements inside. Everything else in a URDF is for others.
_TEXTS = {'robot': ('name', 'version'), 'link': ('name',), 'joint': ('name', 'type'),
          'parent': ('link',), 'child': ('link',), 'mimic': ('joint',)}
_MOMENTS = ('ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz')
_NUMBERS = {'origin': {'xyz': 3, 'rpy': 3}, 'axis': {'xyz': 3}, 'mass': {'value': 1},
            'inertia': dict.fromkeys(_MOMENTS, 1), 'dynamics': {'damping': 1, 'friction': 1},
            'limit': {'lower': 1, 'upper': 1, 'velocity': 1, 'effort': 1},
            'mimic': {'multiplier': 1, 'offset': 1}}
_INSIDE = {'robot': ('link', 'joint'), 'link': ('inertial',),
           'inertial': ('origin', 'mass', 'inertia'),
           'joint': ('origin', 'axis', 'parent', 'child', 'limit', 'dynamics', 'mimic')}
_SEVERAL = ('link', 'joint')  # of which there may be more than one

# What must be there: attributes, and elements.
_NEEDED = {'robot': ('name',), 'link': ('name',), 'joint': ('name', 'type', 'parent', 'child'),
           'parent': ('link',), 'child': ('link',), 'mimic': ('joint',), 'mass': ('value',),
           'axis': ('xyz',), 'inertial': ('mass',), 'inertia': _MOMENTS}


class Link(NamedTuple):
    """A link, in its own frame."""

    name: str
    mass: float = 0.0                    # [kg]
    centre: Array = np.zeros(3)          # of mass [m]
    inertia: Array = np.zeros((3, 3))    # about it [kg m^2]


class Joint(NamedTuple):
    """A joint; limits that its text lacks are None."""

    name: str
    kind: str
    parent: str
    child: str
    pose: Array                          # of its frame in the parent's, shape (4, 4)
    axis: Array
    lower: float | None = None           # [rad], or [m]
    upper: float | None = None
    velocity: float | None = None        # [rad/s]
    effort: float | None = None          # [N m]
    damping: float = 0.0                 # [N m s/rad]
    friction: float = 0.0                # [N m]
    mimic: tuple[str, float, float] | None = None  # joint, multiplier, offset

    @property
    def label(self) -> str:
        """Return what messages call it."""
        return f'joint {quoted(self.name)}'

    @property
    def position_range(self) -> tuple[float, float] | None:
        """Return lower and upper end, 0 for one that the text lacks; None if it lacks both."""
        if self.lower is None and self.upper is None:
            return None
        return self.lower or 0.0, self.upper or 0.0


class UrdfWarning(NamedTuple):
    """What is odd about a URDF, and what is made of it."""

    text: str
    joint: str = ''                      # whose limits are meant; empty: it is about another thing
    limits: tuple[str, ...] = ()         # as in `JointLimits`; what gives them all is the answer

    def __str__(self) -> str:
        """Return the text."""
        return self.text


class Document(NamedTuple):
    """What a URDF says, as far as it is read."""

    links: tuple[Link, ...]
    joints: tuple[Joint, ...]
    warnings: tuple[UrdfWarning, ...]


def read_document(text: str) -> Document:
    """
    Return the links and joints of a URDF.

    Parameters
    ----------
    text : str
        XML.

    Returns
    -------
    Document
        In the order of the text; whether they make a tree is not checked.

    Raises
    ------
    InvalidInputError
        If the text is no XML, no URDF, lacks something or has a number that is not one or not
        finite; names the line, or the link or joint.

    """
    warnings: list[UrdfWarning] = []
    root = _reduced(robot_element(text), 'the robot', warnings)
    URDF = _parser()
    limits = [_limits(joint) for joint in root.iter('joint')]
    _add_needed_limits(root)
    try:
        robot = URDF.from_xml_string(ET.tostring(root, encoding='unicode'))
    except Exception as error:  # it raises anything, Exception itself included
        raise InvalidInputError(f'no URDF: {" ".join(str(error).split())}') from None
    joints = [_joint(joint)._replace(**given) for joint, given in zip(robot.joints, limits)]
    return Document(tuple(map(_link, robot.links)), tuple(joints), tuple(warnings))


def _parser() -> Any:
    """Return urdf_parser_py's class; imported here, since most uses of the core read no URDF."""
    try:
        from urdf_parser_py.urdf import URDF
    except ImportError as error:
        raise InvalidInputError(
            f"reading a URDF needs urdf_parser_py ({error}): install ROS's package "
            'ros-jazzy-urdfdom-py (apt), or urdf-parser-py (pip)') from None
    return URDF


def _reduced(element: ET.Element, owner: str, warnings: list[UrdfWarning]) -> ET.Element:
    """Return a checked copy of an element without what is not read."""
    tag, found = str(element.tag), ET.Element(element.tag)
    if tag in _SEVERAL:
        owner = f'{tag} {quoted(element.get("name", ""))}'
    numbers = _NUMBERS.get(tag, {})
    for name, value in element.items():
        if name in numbers:
            _check_numbers(f'{owner}: {name} of <{tag}>', value, numbers[name],
                           inf if tag == 'limit' else LARGEST)
        elif name == 'quat_xyzw':
            raise InvalidInputError(f'{owner}: <{tag}> has quat_xyzw, must have rpy')
        elif name not in _TEXTS.get(tag, ()):
            continue
        found.set(name, value)
    for inner in element:
        if inner.tag not in _INSIDE.get(tag, ()):
            continue
        if inner.tag not in _SEVERAL and found.find(str(inner.tag)) is not None:
            warnings.append(UrdfWarning(
                f'{owner}: the first <{inner.tag}> counts, it has more than one'))
            continue
        found.append(_reduced(inner, owner, warnings))
    _check_needs(found, owner)
    return found


def _check_needs(element: ET.Element, owner: str) -> None:
    """Refuse an element that lacks something; limits may."""
    tag = str(element.tag)
    for name in _NEEDED.get(tag, ()):
        if not element.get(name) and element.find(name) is None:
            raise InvalidInputError(f'{owner}: <{tag}> has no {name}')
    if tag == 'joint' and element.get('type') not in KINDS:
        raise InvalidInputError(f'{owner} is of type {quoted(element.get("type", ""))}, must be '
                                f'{", ".join(KINDS[:-1])} or {KINDS[-1]}')


def _check_numbers(name: str, value: str, count: int, largest: float) -> None:
    """Refuse text that is not so many finite numbers, or has one that is too large."""
    # Python alone reads 1_000, and digits of other scripts.
    try:
        numbers = [float(part) for part in value.split()] if _is_plain(value) else []
    except ValueError:
        numbers = []
    if len(numbers) != count or not all(map(isfinite, numbers)):
        wanted = 'a finite number' if count == 1 else f'{count} finite numbers'
        raise InvalidInputError(f'{name} is {shown(value)}, must be {wanted}')
    if max(map(abs, numbers)) > largest:
        raise InvalidInputError(f'{name} is {shown(value)}, must be at most {largest:g}')


def _is_plain(text: str) -> bool:
    return text.isascii() and '_' not in text


def _limits(joint: ET.Element) -> dict[str, Any]:
    """Return the limits that a joint's text gives."""
    limit = joint.find('limit')
    return {} if limit is None else {name: float(value) for name, value in limit.items()}


def _add_needed_limits(root: ET.Element) -> None:
    """Add zeros for limits that a document may lack here, but not for urdf_parser_py."""
    for limit in root.iter('limit'):
        for name in ('velocity', 'effort'):
            limit.set(name, limit.get(name, '0'))


def _link(link: Any) -> Link:
    """Return a link of urdf_parser_py's; the axes of its inertia may be turned."""
    inertial = link.inertial
    if inertial is None:
        return Link(link.name)
    pose = _pose(inertial.origin)
    R, inertia = pose[:3, :3], inertial.inertia
    tensor = np.zeros((3, 3)) if inertia is None else np.array(inertia.to_matrix(), dtype=float)
    return Link(link.name, float(inertial.mass), pose[:3, 3], R @ tensor @ R.T)


def _joint(joint: Any) -> Joint:
    """Return a joint of urdf_parser_py's, without its limits."""
    axis = np.array((1.0, 0.0, 0.0) if joint.axis is None else joint.axis, dtype=float)
    found = Joint(joint.name, joint.type, joint.parent, joint.child, _pose(joint.origin), axis)
    dynamics, mimic = joint.dynamics, joint.mimic
    if dynamics is not None:
        found = found._replace(damping=dynamics.damping or 0.0, friction=dynamics.friction or 0.0)
    if mimic is not None:
        multiplier = 1.0 if mimic.multiplier is None else mimic.multiplier
        found = found._replace(mimic=(mimic.joint, multiplier, mimic.offset or 0.0))
    return found


def _pose(origin: Any) -> Array:
    """Return an origin as a transform, shape (4, 4)."""
    pose = np.eye(4)
    if origin is None:
        return pose
    pose[:3, :3] = from_roll_pitch_yaw(origin.rpy or (0.0,) * 3)
    pose[:3, 3] = origin.xyz or (0.0,) * 3
    return pose
