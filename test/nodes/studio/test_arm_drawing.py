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

"""The arm in the scene: a node for each link, shapes below them, of which the moving ones move."""

from __future__ import annotations

from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest
from rrr_traj_planner.core.arm.urdf_frames import MovingFrame, Placement
from rrr_traj_planner.nodes.output.arm_shape import ArmShape, Part, ShownLink

pytest.importorskip('viser', reason='viser is not installed: make studio installs it')
drawing = import_module('rrr_traj_planner.nodes.studio.scene.arm_drawing')

STILL = Placement((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
TURNED = Placement((1.0, 2.0, 3.0), (0.6, 0.0, 0.0, 0.8))
MESH = Part('mesh', (), STILL, None, np.eye(3), np.array([[0, 1, 2]]))
SHAPE = ArmShape((
    ShownLink(-1, STILL, (Part('box', (1.0, 2.0, 3.0), TURNED, (9, 8, 7)),)),
    ShownLink(0, MovingFrame('a', 'b', TURNED, 1, (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)), (
        MESH, Part('cylinder', (0.5, 4.0), STILL), Part('sphere', (0.25,), STILL)))), ())


class Scene:
    """Keeps what is added to it, by name."""

    def __init__(self):
        self.nodes = {}

    def __getattr__(self, kind):
        def add(name, *sizes, **how):
            self.nodes[name] = SimpleNamespace(kind=kind, sizes=sizes, **how)
            return self.nodes[name]

        return add


@pytest.fixture
def scene():
    return Scene()


def test_shapes_are_below_their_links(scene):
    drawing.ArmDrawing(scene, '/arm', SHAPE, drawing.Look((1, 2, 3)))
    assert {name: node.kind for name, node in scene.nodes.items()} == {
        '/arm': 'add_frame', '/arm/0': 'add_frame', '/arm/0/1': 'add_frame',
        '/arm/0/shape_0': 'add_box', '/arm/0/1/shape_0': 'add_mesh_simple',
        '/arm/0/1/shape_1': 'add_cylinder', '/arm/0/1/shape_2': 'add_icosphere'}
    box = scene.nodes['/arm/0/shape_0']
    assert (box.position, box.wxyz) == ((1.0, 2.0, 3.0), (0.8, 0.6, 0.0, 0.0))
    assert box.color == (9, 8, 7)
    assert scene.nodes['/arm/0/1/shape_1'].sizes == (0.5, 4.0)
    assert scene.nodes['/arm/0/1/shape_2'].color == (1, 2, 3)


def test_ghost_has_one_colour_and_shines_through(scene):
    drawing.ArmDrawing(scene, '/ghost', SHAPE, drawing.Look((1, 2, 3), False, 0.4))
    shapes = [node for node in scene.nodes.values() if node.kind != 'add_frame']
    assert {(shape.color, shape.opacity) for shape in shapes} == {((1, 2, 3), 0.4)}


def test_links_move_with_their_joints_and_the_arm_can_be_hidden(scene):
    arm = drawing.ArmDrawing(scene, '/arm', SHAPE, drawing.Look((1, 2, 3)))
    assert not scene.nodes['/arm'].visible
    arm.show((0.0, np.pi, 0.0))
    assert scene.nodes['/arm'].visible
    link = scene.nodes['/arm/0/1']
    assert link.position == (1.0, 2.0, 3.0)
    # (0.8, 0.6 i) times a half turn about z, k: 0.8 k + 0.6 i k = 0.8 k - 0.6 j
    np.testing.assert_allclose(link.wxyz, (0.0, 0.0, -0.6, 0.8), atol=1e-15)
    arm.show(None)
    assert not scene.nodes['/arm'].visible
