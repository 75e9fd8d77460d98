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

"""The scene: what is added to it once, and what is changed there afterwards."""

from __future__ import annotations

from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest
from rrr_traj_planner.nodes.output.arm_shape import ArmShape
from rrr_traj_planner.nodes.studio.figures import SPEED
from rrr_traj_planner.nodes.studio.planned import Planned
from rrr_traj_planner.nodes.studio.session import Refusal

pytest.importorskip('viser', reason='viser is not installed: make studio installs it')
scene = import_module('rrr_traj_planner.nodes.studio.scene.scene')


class Drawn:
    """Keeps what is added, in the order in which it is, and how the scene is configured."""

    def __init__(self):
        self.added, self.configured = [], {}

    def __getattr__(self, kind):
        def add(name, *_, **how):
            self.added.append(SimpleNamespace(name=name, **how))
            return self.added[-1]

        def configure(*given, **how):
            self.configured[kind] = (*given, *how.items())

        return add if kind.startswith('add_') else configure

    def node(self, name):
        """Return the only one of a name."""
        node, = (node for node in self.added if node.name == name)
        return node


class Controls(Drawn):
    """Keeps handles too, whose events nobody causes."""

    def add_transform_controls(self, *_, position, **__):
        return SimpleNamespace(position=np.array(position), on_update=lambda _: None)

    def add_icosphere(self, *_, **__):
        return SimpleNamespace(on_click=lambda _: None)

    def add_label(self, name, text, **__):
        self.added.append(SimpleNamespace(name=name, text=text, visible=True))
        return self.added[-1]

    def seen(self):
        return [node.text for node in self.added if '/label' in node.name and node.visible]


def plan_of(path):
    path = np.array(path, dtype=float).reshape(-1, 3)
    return Planned('cycloid', 1.0, 0.0, '', path, np.ones(len(path) - 1), np.arange(len(path)),
                   path, path, ())


@pytest.fixture
def drawn():
    return Drawn()


@pytest.fixture
def shown(drawn):
    return scene.Scene(drawn, 2.0, None, ArmShape((), ()))


def test_paths_are_changed_and_not_added_again(drawn, shown):
    names = [node.name for node in drawn.added]
    for path in ([[0, 0, 0], [1, 0, 0], [1, 2, 0]], [[3, 0, 0], [3, 4, 0]]):
        shown.show_plan(plan_of(path), True, SPEED)
        shown.show_arm([0.0] * 3, [tuple(place) for place in path])
    assert [node.name for node in drawn.added] == names
    for name in ('/plan', '/driven'):
        assert drawn.node(name).points.tolist() == [[[3, 0, 0], [3, 4, 0]]]


def test_segments_of_a_path_are_not_shorter_than_can_be_seen(drawn, shown):
    slow = np.linspace(0.0, 0.1, 400)
    fast = np.linspace(0.1, 1.1, 21)[1:]
    path = np.zeros((420, 3))
    path[:, 0] = np.concatenate((slow, fast))
    shown.show_plan(plan_of(path), True, SPEED)
    points = drawn.node('/plan').points
    np.testing.assert_array_equal(points[1:, 0], points[:-1, 1])  # without a gap
    np.testing.assert_allclose(points[[0, -1], [0, 1], 0], (0.0, 1.1), atol=1e-6)
    lengths = np.diff(points[..., 0], axis=1).ravel()
    assert len(points) <= 25 and (lengths[:-1] > 0.01).all()


def test_every_end_of_a_path_has_a_colour(drawn, shown):
    path = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 2.0, 0.0)]
    shown.show_plan(plan_of(path), True, SPEED)
    shown.show_arm([0.0] * 3, path)
    for name in ('/plan', '/driven'):
        assert drawn.node(name).colors.shape == drawn.node(name).points.shape == (2, 2, 3)


@pytest.mark.parametrize('driven', [[], [(1.0, 2.0, 3.0)]])
def test_a_path_of_less_than_two_points_is_not_to_be_seen(drawn, shown, driven):
    shown.show_arm([0.0] * 3, [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0)])
    shown.show_arm([0.0] * 3, driven)
    begin, end = drawn.node('/driven').points[0].tolist()
    assert begin == end


def test_via_points_at_one_place_have_one_label():
    labels = Controls()
    shown = scene.Scene(labels, 2.0, None, ArmShape((), ()))
    shown.show_points(np.array([[1.0, 0, 1], [0, 1, 1], [1.001, 0, 1]]), None)
    assert labels.seen() == ['0, 2', '1']
    shown.show_points(np.array([[1.0, 0, 1], [0, 1, 1], [0.5, 0, 1]]), None)
    assert labels.seen() == ['0', '1', '2']
    shown.show_points(np.array([[1.0, 0, 1], [0, 1, 1], [0, 1, 1]]), Refusal('too far', 2))
    assert labels.seen() == ['0', '1, 2', 'too far']


def test_nothing_is_reflected_and_no_shadows_are_drawn(drawn, shown):
    assert drawn.configured == {
        'configure_default_lights': (('cast_shadow', False),),
        'configure_environment_map': (None,)}
    assert drawn.node('/light').position[2] > 0.0
