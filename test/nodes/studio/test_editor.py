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

"""How the user changes what is wanted: choosing, dragging, typing, undo and redo."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.inverse import nearest_solution
from rrr_traj_planner.nodes.point_files.reading import read_task
from rrr_traj_planner.nodes.studio import editor as editor_module
from rrr_traj_planner.nodes.studio.editor import Editor
from rrr_traj_planner.nodes.studio.wanted import wanted_of

MODEL = RobotModel()
A, B, C = (1.02, 0.59, 0.97), (0.46, 0.55, 1.44), (0.45, 0.38, 1.45)  # table 6.1


@pytest.fixture
def shown():
    """Give a test the list of what was shown after each change."""
    return []


@pytest.fixture
def clock(monkeypatch):
    """Give a test the time, which it sets."""
    now = [100.0]
    monkeypatch.setattr(editor_module, 'monotonic', lambda: now[0])
    return now


@pytest.fixture
def editor(shown, clock):
    wanted = wanted_of(read_task('table_6_1.yaml'), MODEL, 'base_link', 'cycloid')
    made = Editor(wanted, MODEL, lambda: shown.append(made.wanted))
    return made


def points(editor):
    return [tuple(p) for p in editor.wanted.points.tolist()]


def test_a_whole_drag_is_one_step(editor, clock):
    for height in (1.0, 1.1):
        editor.drag(0, True)
        for k in range(5):
            clock[0] += 2.0
            editor.move(0, (1.02, 0.59, height + 0.001 * k))
        editor.drag(0, False)
    assert points(editor)[0] == (1.02, 0.59, 1.104)
    editor.undo()
    assert points(editor)[0] == (1.02, 0.59, 1.004)
    editor.undo()
    assert points(editor) == [A, B, C] and not editor.can_undo
    editor.redo()
    editor.redo()
    assert points(editor)[0] == (1.02, 0.59, 1.104) and not editor.can_redo


def test_a_drag_chooses_its_point_and_a_grip_alone_is_no_step(editor):
    editor.drag(2, True)
    editor.move(2, C)
    editor.drag(2, False)
    assert editor.chosen == 2 and not editor.can_undo


def test_quickly_typed_digits_are_one_step(editor, clock):
    for x in (1.0, 1.01, 1.012):
        clock[0] += 0.3
        editor.move(0, (x, 0.59, 0.97))
    clock[0] += 5.0
    editor.move(0, (1.1, 0.59, 0.97))
    editor.undo()
    assert points(editor)[0][0] == 1.012
    editor.undo()
    assert points(editor)[0][0] == 1.02


def test_planner_scalings_and_a_loaded_task_are_undone_too(editor):
    first = editor.wanted
    other = wanted_of(read_task('pick_and_place.yaml'), MODEL, 'base_link', 'cycloid')
    editor.change(first.with_planner('line_arc'))
    editor.change(editor.wanted.with_scalings(0.5, 0.25), 'scalings')
    editor.change(other.with_options(editor.wanted))
    assert (editor.wanted.velocity_scaling, editor.wanted.acceleration_scaling) == (0.5, 0.25)
    assert len(points(editor)) == 6
    editor.undo()
    assert len(points(editor)) == 3
    editor.undo()
    assert editor.wanted.velocity_scaling == 1.0
    assert editor.wanted.task.planner_id == 'line_arc'
    editor.undo()
    assert editor.wanted is first


def test_inserted_point_is_chosen_and_removed_again(editor):
    editor.choose(1)
    editor.insert()
    assert editor.chosen == 2 and len(points(editor)) == 4
    editor.remove()
    assert points(editor) == [A, B, C] and editor.chosen == 2
    editor.remove()
    assert points(editor) == [A, B] and editor.chosen == 1
    editor.remove()
    assert points(editor) == [A, B]


def test_point_is_moved_among_the_others_and_stays_chosen(editor):
    editor.shift(1)
    editor.shift(1)
    editor.shift(1)
    assert points(editor) == [B, C, A] and editor.chosen == 2
    editor.shift(-1)
    assert points(editor) == [B, A, C] and editor.chosen == 1


def test_chosen_point_is_there_after_an_undo(editor):
    editor.choose(2)
    editor.insert()
    assert editor.chosen == 3
    editor.undo()
    assert editor.chosen == 2


def test_every_change_is_shown_and_nothing_else(editor, shown):
    editor.choose(0)
    editor.change(editor.wanted)
    editor.undo()
    editor.move(7, A)
    assert shown == []
    editor.choose(1)
    editor.move(1, A)
    assert len(shown) == 2


def test_kept_joints_are_gone_through_and_follow_the_drag(editor):
    near = np.array([nearest_solution(MODEL, p, (0.5, 1.0, 0.2)) for p in (A, B, C)])
    editor.change(replace(editor.wanted, elbow='up'))
    editor.keep_joints(near + 1e-3)
    assert editor.wanted.joints_known and editor.wanted.elbow == ''
    np.testing.assert_allclose(editor.wanted.joints, near, atol=1e-9)
    editor.move(1, (9.0, 9.0, 9.0))
    assert not editor.wanted.joints_known
    editor.move(1, (0.46, 0.55, 1.4))
    np.testing.assert_allclose(
        forward_kinematics(MODEL, editor.wanted.joints[1]), (0.46, 0.55, 1.4), atol=1e-9)
    assert np.abs(editor.wanted.joints[1] - near[1]).max() < 0.1
    editor.keep_joints(None)
    assert editor.wanted.joints is None
