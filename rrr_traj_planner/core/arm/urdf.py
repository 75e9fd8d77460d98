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

from collections.abc import Iterable
from math import isfinite, pi
from typing import NamedTuple
from xml.etree import ElementTree as ET

from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import InvalidInputError

# A URDF must have limits on velocity and effort: values that stand for none, chosen far above any
# motor's.
NO_VELOCITY_LIMIT = 1e3  # rad/s
NO_EFFORT_LIMIT = 1e6    # N m

RADIUS = 1.0 / 32.0  # of the drawn rods, over the arm's reach; chosen

# Of links, alternating; red, green, blue and opacity, chosen.
COLOURS = {'light': (0.75, 0.75, 0.78, 1.0), 'dark': (0.35, 0.37, 0.42, 1.0)}

Numbers = tuple[float, float, float]
QUARTER_TURN = (0.5 * pi, 0.0, 0.0)  # Rx(90 deg), Denavit-Hartenberg's alpha
NO_TRANSFORM = (0.0, 0.0, 0.0)       # no rotation, or no offset


class FrameNames(NamedTuple):
    """Names of the arm's links, which are frames of TF, from the base to the tip."""

    base: str = 'base_link'
    links: tuple[str, ...] = ('link_1', 'link_2', 'link_3')
    tip: str = 'tip'


class _Link(NamedTuple):
    """A link, in the frame of its joint."""

    centre: Numbers    # of mass [m]
    axes: Numbers      # roll, pitch, yaw of the Denavit-Hartenberg frame [rad]
    rod: Numbers       # far end of the drawn rod, which begins at the joint [m]
    rod_rpy: Numbers   # roll, pitch, yaw [rad]
    hub: Numbers       # centre of the drawn ball [m]


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


def urdf(model: RobotModel, limits: JointLimits, frames: FrameNames | None = None,
         friction: Friction | None = None) -> str:
    """
    Return the arm as a URDF.

    A link's frame is that of its joint, as URDF requires: the Denavit-Hartenberg frame without the
    constant transform that follows the joint's rotation. The tip's frame is frame 3 (section 5.2).
    A link's inertia is given in the axes of its Denavit-Hartenberg frame, as in the model.

    Parameters
    ----------
    model : RobotModel
        The arm. Its gravity is no part of a URDF.
    limits : JointLimits
        Ranges, velocities and efforts; infinite ones become `NO_VELOCITY_LIMIT` and
        `NO_EFFORT_LIMIT`.
    frames : FrameNames, optional
        Names of the links.
    friction : Friction, optional
        In the joints; none if left out.

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
    ET.SubElement(robot, 'link', name=frames.base)
    parents = (frames.base, *frames.links)
    origins = ((NO_TRANSFORM, NO_TRANSFORM), ((0.0, 0.0, model.d1), QUARTER_TURN),
               ((model.a2, 0.0, 0.0), NO_TRANSFORM))
    for i, (link, (xyz, rpy)) in enumerate(zip(_links(model), origins)):
        _add_link(robot, model, i, frames.links[i], link)
        joint = _add_joint(robot, model.joint_names[i], 'revolute', parents[i:i + 2], xyz, rpy)
        _add_motion(joint, limits, friction or Friction(), i)
    ET.SubElement(robot, 'link', name=frames.tip)
    _add_joint(robot, f'{frames.tip}_joint', 'fixed', (frames.links[2], frames.tip),
               (0.0, -model.d4, 0.0), QUARTER_TURN)
    ET.indent(robot)
    return '<?xml version="1.0"?>\n' + ET.tostring(robot, encoding='unicode') + '\n'


def _links(model: RobotModel) -> tuple[_Link, _Link, _Link]:
    """Return the links; z of frames 1 and 3 is -y of their joints' frames."""
    shoulder = (0.0, 0.0, model.d1)
    axis_to_x = (0.0, 0.5 * pi, 0.0)  # turns a cylinder's axis from z
    return (_Link(shoulder, QUARTER_TURN, shoulder, NO_TRANSFORM, shoulder),
            _Link((model.l2, 0.0, 0.0), NO_TRANSFORM, (model.a2, 0.0, 0.0), axis_to_x,
                  (model.a2, 0.0, 0.0)),
            _Link((0.0, -model.l3, 0.0), QUARTER_TURN, (0.0, -model.d4, 0.0), QUARTER_TURN,
                  (0.0, -model.d4, 0.0)))


def _add_link(robot: ET.Element, model: RobotModel, i: int, name: str, link: _Link) -> None:
    element = ET.SubElement(robot, 'link', name=name)
    inertial = ET.SubElement(element, 'inertial')
    _add_origin(inertial, link.centre, link.axes)
    ET.SubElement(inertial, 'mass', value=_text([model.mass[i]]))
    ixx, iyy, izz = ([_text([x]) for x in model.inertia[i]])
    ET.SubElement(inertial, 'inertia', ixx=ixx, ixy='0', ixz='0', iyy=iyy, iyz='0', izz=izz)
    radius, length = RADIUS * model.reach[1], sum(map(abs, link.rod))
    if length > 0.0:
        middle = tuple(0.5 * x for x in link.rod)
        rod = _add_visual(element, middle, link.rod_rpy, 'light')
        ET.SubElement(rod, 'cylinder', radius=_text([radius]), length=_text([length]))
    if i < 2:  # the tip is left free
        ball = _add_visual(element, link.hub, NO_TRANSFORM, 'dark')
        ET.SubElement(ball, 'sphere', radius=_text([1.4 * radius]))


def _add_visual(link: ET.Element, xyz: Iterable[float], rpy: Numbers,
                material: str) -> ET.Element:
    """Add a visual element, and return its empty geometry element."""
    visual = ET.SubElement(link, 'visual')
    _add_origin(visual, xyz, rpy)
    geometry = ET.SubElement(visual, 'geometry')
    ET.SubElement(visual, 'material', name=material)
    return geometry


def _add_joint(robot: ET.Element, name: str, kind: str, links: tuple[str, ...], xyz: Numbers,
               rpy: Numbers) -> ET.Element:
    joint = ET.SubElement(robot, 'joint', name=name, type=kind)
    ET.SubElement(joint, 'parent', link=links[0])
    ET.SubElement(joint, 'child', link=links[1])
    _add_origin(joint, xyz, rpy)
    return joint


def _add_motion(joint: ET.Element, limits: JointLimits, friction: Friction, i: int) -> None:
    """Add a joint's axis, limits and friction."""
    velocity, effort = limits.max_velocity[i], limits.max_effort[i]
    ET.SubElement(joint, 'axis', xyz='0 0 1')
    ET.SubElement(
        joint, 'limit', lower=_text([limits.min_position[i]]),
        upper=_text([limits.max_position[i]]),
        velocity=_text([velocity if isfinite(velocity) else NO_VELOCITY_LIMIT]),
        effort=_text([effort if isfinite(effort) else NO_EFFORT_LIMIT]))
    ET.SubElement(joint, 'dynamics', damping=_text([friction.viscous[i]]),
                  friction=_text([friction.coulomb[i]]))


def _add_origin(element: ET.Element, xyz: Iterable[float], rpy: Numbers) -> None:
    ET.SubElement(element, 'origin', xyz=_text(xyz), rpy=_text(rpy))


def _text(values: Iterable[float]) -> str:
    """Return numbers as text that reads back as the same numbers."""
    return ' '.join(repr(float(x) + 0.0) for x in values)
