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

"""The arm as a URDF, for robot_state_publisher, RViz and other libraries."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import isfinite
from typing import NamedTuple
from xml.etree import ElementTree as ET

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits, NO_EFFORT, NO_RANGE, NO_VELOCITY
from rrr_traj_planner.core.arm.link_frames import Frame, joint_points, link_frames, link_lines
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.urdf_tree import BASE, TIP
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.rotations import roll_pitch_yaw, rotation_z_to

RADIUS = 1.0 / 32.0  # of the drawn rods, over the arm's size; chosen

# Of links, alternating; red, green, blue and opacity, chosen.
COLOURS = {'light': (0.75, 0.75, 0.78, 1.0), 'dark': (0.35, 0.37, 0.42, 1.0)}


class FrameNames(NamedTuple):
    """Names of the arm's links, which are frames of TF, from the base to the tip."""

    base: str = BASE
    links: tuple[str, ...] = ('link_1', 'link_2', 'link_3')
    tip: str = TIP


def check_frames(frames: FrameNames) -> None:
    """
    Refuse frame names that are empty or repeat.

    Parameters
    ----------
    frames : FrameNames
        Names of base, links and tip.

    Raises
    ------
    InvalidInputError
        If a name is empty or repeats.

    """
    names = [frames.base, *frames.links, frames.tip]
    if len(frames.links) != 3 or len(set(names)) != 5 or '' in names:
        raise InvalidInputError(
            f'the frames are {", ".join(map(repr, names))}; base_frame, three link_names and '
            'tip_frame must be distinct and not empty')


def urdf(model: RobotModel, limits: JointLimits, frames: FrameNames | None = None) -> str:
    """
    Return the arm as a URDF.

    A link's frame is that of its joint, as URDF requires; z is the joint's axis (`link_frames`).

    Parameters
    ----------
    model : RobotModel
        The arm. Its gravity and its motors' inertia are no part of a URDF.
    limits : JointLimits
        Ranges, velocities and efforts. A joint without range is continuous; another end, velocity
        or effort that is infinite becomes `NO_RANGE`, `NO_VELOCITY` or `NO_EFFORT`.
    frames : FrameNames, optional
        Names of the links.

    Returns
    -------
    str
        XML.

    Raises
    ------
    InvalidInputError
        If a frame's name is empty or repeats.

    """
    frames = frames or FrameNames()
    check_frames(frames)
    robot = ET.Element('robot', name='rrr_arm')
    for name, rgba in COLOURS.items():
        ET.SubElement(ET.SubElement(robot, 'material', name=name), 'color', rgba=_text(rgba))
    names, places = (frames.base, *frames.links, frames.tip), link_frames(model.chain)
    for i, name in enumerate(names):
        link = ET.SubElement(robot, 'link', name=name)
        if 1 <= i <= 3:
            _add_inertial(link, model, i - 1, places[i])
            kind = 'revolute' if _has_range(limits, i - 1) else 'continuous'
            joint = _add_joint(robot, model.joint_names[i - 1], kind, names, places, i)
            _add_motion(joint, model, limits, i - 1)
        elif i == 4:
            _add_joint(robot, f'{name}_joint', 'fixed', names, places, i)
        _add_shapes(link, model, i, places[i])
    ET.indent(robot)
    return '<?xml version="1.0"?>\n' + ET.tostring(robot, encoding='unicode') + '\n'


def _add_inertial(link: ET.Element, model: RobotModel, i: int, frame: Frame) -> None:
    """Add a link's mass, centre of mass and inertia, in the axes of its frame."""
    chain = model.chain
    inertial = ET.SubElement(link, 'inertial')
    _add_origin(inertial, frame.inside(chain.centre[i]), np.eye(3))
    ET.SubElement(inertial, 'mass', value=_text([chain.mass[i]]))
    tensor = frame.R.T @ (0.5 * (chain.inertia[i] + chain.inertia[i].T)) @ frame.R
    ET.SubElement(inertial, 'inertia', {
        f'i{"xyz"[a]}{"xyz"[b]}': _text([tensor[a, b]]) for a in range(3) for b in range(a, 3)})


def _add_shapes(element: ET.Element, model: RobotModel, link: int, frame: Frame) -> None:
    """Add a rod along each of a link's lines, and balls at its joints' points."""
    radius = RADIUS * model.chain.size
    for line in (x for x in link_lines(model.chain) if x.link == link):
        start, end = frame.inside(line.start), frame.inside(line.end)
        length = float(np.linalg.norm(end - start))
        # A rod is symmetric: of its two directions, the one within a right angle of z.
        along = (end - start) / length * (1.0 if end[2] >= start[2] else -1.0)
        rod = ET.Element('cylinder', radius=_text([radius]), length=_text([length]))
        _add_shape(element, rod, 0.5 * (start + end), rotation_z_to(along), 'light')
    for point in (x.at for x in joint_points(model.chain) if x.link == link):
        ball = ET.Element('sphere', radius=_text([1.4 * radius]))
        _add_shape(element, ball, frame.inside(point), np.eye(3), 'dark')


def _add_shape(link: ET.Element, shape: ET.Element, xyz: Array, R: Array, material: str) -> None:
    """Add a shape to a link, to be seen and for checks of collisions."""
    for kind in ('visual', 'collision'):
        element = ET.SubElement(link, kind)
        _add_origin(element, xyz, R)
        ET.SubElement(element, 'geometry').append(shape)
        if kind == 'visual':
            ET.SubElement(element, 'material', name=material)


def _add_joint(robot: ET.Element, name: str, kind: str, links: Sequence[str],
               frames: Sequence[Frame], i: int) -> ET.Element:
    """Add the joint between links i - 1 and i."""
    parent, child = frames[i - 1], frames[i]
    joint = ET.SubElement(robot, 'joint', name=name, type=kind)
    ET.SubElement(joint, 'parent', link=links[i - 1])
    ET.SubElement(joint, 'child', link=links[i])
    _add_origin(joint, parent.inside(child.at), parent.R.T @ child.R)
    return joint


def _add_motion(joint: ET.Element, model: RobotModel, limits: JointLimits, i: int) -> None:
    """Add a joint's axis, limits and friction."""
    values = {'velocity': (limits.max_velocity[i], NO_VELOCITY),
              'effort': (limits.max_effort[i], NO_EFFORT)}
    if _has_range(limits, i):
        values['lower'] = limits.min_position[i], -NO_RANGE
        values['upper'] = limits.max_position[i], NO_RANGE
    ET.SubElement(joint, 'axis', xyz='0 0 1')
    ET.SubElement(joint, 'limit', {name: _text([value if isfinite(value) else none])
                                   for name, (value, none) in values.items()})
    ET.SubElement(joint, 'dynamics', damping=_text([model.friction.viscous[i]]),
                  friction=_text([model.friction.coulomb[i]]))


def _has_range(limits: JointLimits, i: int) -> bool:
    return isfinite(limits.min_position[i]) or isfinite(limits.max_position[i])


def _add_origin(element: ET.Element, xyz: Array, R: Array) -> None:
    ET.SubElement(element, 'origin', xyz=_text(xyz), rpy=_text(roll_pitch_yaw(R)))


def _text(values: Iterable[float]) -> str:
    """Return numbers as text that reads back as the same numbers."""
    return ' '.join(repr(float(x) + 0.0) for x in values)
