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

"""What a URDF says of its links' shapes, and what is wrong with some."""

from __future__ import annotations

from math import pi

from helpers.urdf_texts import link, robot
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.urdf import COLOURS, urdf
from rrr_traj_planner.core.arm.urdf_visuals import UnreadVisual, urdf_visuals
from rrr_traj_planner.core.errors import InvalidInputError

GREEN = '<material name="green"><color rgba="0 0.5 0 1"/></material>'


def visual(geometry, *others):
    return f'<visual>{"".join(others)}<geometry>{geometry}</geometry></visual>'


def read(*visuals, before=''):
    """Return the shapes of a link that has these."""
    return urdf_visuals(robot(before, link('arm', ''.join(visuals)), link('rest')))['arm']


def test_shapes_have_their_sizes():
    found = read(visual('<box size="1 2 3"/>'), visual('<sphere radius="0.5"/>'),
                 visual('<cylinder length="4" radius="0.25"/>'),
                 visual('<mesh filename="a.stl" scale="0.001 0.001 0.002"/>'),
                 visual('<mesh filename="package://b/c.dae"/>'))
    assert [(shape.kind, shape.size, shape.file) for shape in found] == [
        ('box', (1.0, 2.0, 3.0), ''), ('sphere', (0.5,), ''), ('cylinder', (0.25, 4.0), ''),
        ('mesh', (0.001, 0.001, 0.002), 'a.stl'), ('mesh', (1.0,) * 3, 'package://b/c.dae')]
    np.testing.assert_array_equal(found[0].pose, np.eye(4))
    assert found[0].colour is None


def test_origin_is_turned_and_moved():
    shape, = read(visual('<sphere radius="1"/>', f'<origin xyz="1 2 3" rpy="0 0 {pi / 2}"/>'))
    np.testing.assert_allclose(
        shape.pose, [[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]], atol=1e-15)


def test_colours_are_the_shape_s_or_of_a_material_by_name():
    ball = '<sphere radius="1"/>'
    found = read(visual(ball, GREEN.replace('0.5', '0.25')),
                 visual(ball, '<material name="green"/>'),
                 visual(ball, '<material name="unknown"/>'), before=GREEN)
    assert [shape.colour for shape in found] == [(0.0, 0.25, 0.0), (0.0, 0.5, 0.0), None]


def test_links_without_shape_have_none():
    assert urdf_visuals(robot(link('rest')))['rest'] == ()


@pytest.mark.parametrize(('text', 'why'), [
    ('', 'has nothing'), ('<capsule radius="1"/>', '<capsule>'),
    ('<mesh/>', 'no filename'), ('<sphere radius="big"/>', "radius of <sphere> is 'big'"),
    ('<box size="1 2"/>', '3 finite numbers'), ('<box/>', 'has no size'),
    ('<sphere radius="inf"/>', 'a finite number')])
def test_malformed_shape_is_named_and_leaves_the_others(text, why):
    wrong, right = read(visual(text), visual('<sphere radius="1"/>'))
    assert isinstance(wrong, UnreadVisual) and why in wrong.why
    assert right.kind == 'sphere'


def test_text_that_is_no_urdf_is_refused():
    with pytest.raises(InvalidInputError, match='no URDF'):
        urdf_visuals('arm')


def test_own_urdf_has_rods_and_balls():
    limits = JointLimits(*([-1.0] * 3, [1.0] * 3), *([1.0] * 3 for _ in range(4)))
    found = urdf_visuals(urdf(RobotModel(), limits))
    shapes = [shape for link in found.values() for shape in link]
    assert {shape.kind for shape in shapes} == {'cylinder', 'sphere'}
    assert {shape.colour for shape in shapes} == {colour[:3] for colour in COLOURS.values()}
