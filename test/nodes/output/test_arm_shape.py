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

"""What is drawn of an arm: its URDF's shapes where its links are, and rods for the others."""

from __future__ import annotations

from helpers.urdf_texts import axis, inertial, joint, limit, link, robot
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.urdf_arm import read_urdf
from rrr_traj_planner.core.arm.urdf_frames import MovingFrame
from rrr_traj_planner.core.kinematics.link_positions import link_positions
from rrr_traj_planner.nodes.output.arm_shape import arm_shape
from scipy.spatial.transform import Rotation

Q = (0.3, -0.7, 1.1)
BALL = '<visual><geometry><sphere radius="0.1"/></geometry></visual>'
MISSING = '<visual><geometry><mesh filename="missing.stl"/></geometry></visual>'


class Config:
    """As much of a `PlannerConfig` as is drawn."""

    def __init__(self, text, base):
        arm = read_urdf(text, base)
        self.urdf, self.base_frame, self.model = text, base, arm.model()
        self.limits = arm.joint_limits(1.0)


def urdf(*shapes):
    """Return an arm that stands on a table; its tip has a ball."""
    parts = [link(f'link_{i}', inertial(1.0) + shape) for i, shape in enumerate(shapes, 1)]
    turning = [joint(f'joint_{i}', 'revolute', parent, f'link_{i}', axis(*z) + limit(),
                     xyz=(0.1, 0.0, 0.4), rpy=(0.0, 0.2, 0.1))
               for i, (parent, z) in enumerate((
                   ('base', (0, 0, 1)), ('link_1', (0, 1, 0)), ('link_2', (0, 1, 0))), 1)]
    return robot(link('table', BALL), link('base', BALL), *parts, link('tip', BALL),
                 joint('stand', 'fixed', 'table', 'base', xyz=(0.0, 1.0, 0.7),
                       rpy=(0.0, 0.5, 1.0)),
                 *turning, joint('end', 'fixed', 'link_3', 'tip', xyz=(0.2, 0.0, 0.3)))


def poses(shape, q):
    """Return where all links are in the base frame, as transforms."""
    found = []
    for shown in shape.links:
        place = shown.frame.at(q) if isinstance(shown.frame, MovingFrame) else shown.frame
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = Rotation.from_quat(place.turn).as_matrix(), place.origin
        found.append(pose if shown.parent < 0 else found[shown.parent] @ pose)
    return found


def rods(shape):
    return [part for shown in shape.links for part in shown.parts if part.kind == 'cylinder']


def test_shapes_are_where_the_links_are(tmp_path):
    config = Config(urdf(BALL, BALL, BALL), 'base')
    shape = arm_shape(config, tmp_path)
    assert shape.notes == () and rods(shape) == []
    centres = [pose[:3, 3] for pose, shown in zip(poses(shape, Q), shape.links) if shown.parts]
    assert len(centres) == 6
    _, *joints, tip = link_positions(config.model, Q)
    for expected in ((0.0, 0.0, 0.0), *joints, tip):
        assert min(np.linalg.norm(centre - expected) for centre in centres) < 1e-12
    # the table is where it is as seen from the base
    table = -Rotation.from_euler('xyz', (0.0, 0.5, 1.0)).inv().apply((0.0, 1.0, 0.7))
    assert min(np.linalg.norm(centre - table) for centre in centres) < 1e-12


def test_link_whose_mesh_is_missing_has_rods_and_a_note(tmp_path):
    shape = arm_shape(Config(urdf(BALL, MISSING + MISSING, BALL), 'base'), tmp_path)
    assert len(rods(shape)) == 1
    assert shape.notes == ('link_2 is drawn as rods: missing.stl: no such file',)


def test_what_has_no_shape_has_rods_and_no_note(tmp_path):
    shape = arm_shape(Config(urdf('', BALL, BALL), 'base'), tmp_path)
    assert len(rods(shape)) == 1 and shape.notes == ()


@pytest.mark.parametrize('q', [(0.0, 0.0, 0.0), Q])
def test_without_urdf_it_is_rods_from_joint_to_joint(tmp_path, q):
    limits = JointLimits(*([-2.0] * 3, [2.0] * 3), *([1.0] * 3 for _ in range(4)))
    config = Config(urdf('', '', ''), 'base')
    config.urdf, config.base_frame, config.model, config.limits = (
        '', 'base_link', RobotModel(), limits)
    shape = arm_shape(config, tmp_path)
    places = link_positions(config.model, q)
    ends = []
    for pose, shown in zip(poses(shape, q), shape.links):
        for part in shown.parts:
            if part.kind == 'cylinder':
                centre = pose[:3, 3] + pose[:3, :3] @ np.array(part.placement.origin)
                along = pose[:3, :3] @ Rotation.from_quat(part.placement.turn).as_matrix()[:, 2]
                ends.append((centre - 0.5 * part.size[1] * along,
                             centre + 0.5 * part.size[1] * along))
    for a, b in zip(places, places[1:]):
        assert any(min(max(np.linalg.norm(s - a), np.linalg.norm(e - b)),
                       max(np.linalg.norm(s - b), np.linalg.norm(e - a))) < 1e-9 for s, e in ends)
