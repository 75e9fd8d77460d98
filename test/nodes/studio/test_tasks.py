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

"""Tasks for the arm that is shown are opened at once; for others, nodes are to be started."""

from __future__ import annotations

from dataclasses import replace
import re

from helpers.places import CONFIG
import numpy as np
import pytest
from rrr_traj_planner.core.arm.payload import Payload
from rrr_traj_planner.nodes.parameters.planner_config import planner_config
from rrr_traj_planner.nodes.point_files.reading import read_task
from rrr_traj_planner.nodes.point_files.shipped import shipped_task
from rrr_traj_planner.nodes.studio.editor import Editor
from rrr_traj_planner.nodes.studio.tasks import (
    another_start,
    first_start,
    started_again,
    Tasks,
)

THESIS_ARM = CONFIG / 'thesis_arm.yaml'
POINTS = 'via_points: [[0.9, 0.3, 1.2], [0.9, 0.3, 1.0]]\n'


@pytest.fixture
def tasks():
    return of_arm(THESIS_ARM)


def of_arm(arm, can_exchange=True):
    config = planner_config(THESIS_ARM)
    start = first_start(read_task('table_6_1.yaml'), [])
    editor = Editor(start.first_wanted(config, Payload(2.0)), config.model, lambda: None)
    found = Tasks(editor, config, arm, lambda: None, can_exchange)
    found.editor = editor
    return found


def test_task_for_the_arm_that_is_shown_is_opened_with_the_options_kept(tasks):
    editor = tasks.editor
    editor.choose(2)
    editor.change(replace(editor.wanted, max_deviation=0.01, elbow='up'))
    tasks.open_shipped('pick_and_place')
    assert (tasks.next, tasks.message, editor.chosen) == (None, '', 0)
    wanted = editor.wanted
    assert (wanted.task.name, len(wanted.points)) == ('pick_and_place', 6)
    assert (wanted.max_deviation, wanted.elbow, wanted.payload) == (0.01, 'up', Payload(2.0))
    editor.undo()
    assert editor.wanted.task.name == 'table_6_1'


def test_task_for_another_arm_waits_for_its_nodes(tasks):
    before = tasks.editor.wanted
    tasks.open_shipped('kr16_2_first3')
    assert tasks.next.name == 'kr16_2_first3' and tasks.editor.wanted is before
    assert tasks.message == 'starting the nodes anew for the arm of kr16_2_first3'
    assert not tasks.is_error


def test_file_that_names_no_arm_is_for_the_one_that_is_shown(tasks):
    tasks.load('own.yaml', POINTS.encode())
    assert tasks.next is None and len(tasks.editor.wanted.points) == 2


def test_file_that_names_another_arm_waits_for_its_nodes(tasks):
    tasks.load('own.yaml', f'arm: thesis_arm_joint_2_250.yaml\n{POINTS}'.encode())
    assert tasks.next.arm == CONFIG / 'thesis_arm_joint_2_250.yaml'


@pytest.mark.parametrize('beside_the_arm', [True, False])
def test_file_s_own_arm_is_found_beside_the_one_shown_and_where_the_studio_was_started(
        tmp_path, monkeypatch, beside_the_arm):
    places = tmp_path / 'arms', tmp_path / 'here'
    for place in places:
        place.mkdir()
    shown = places[0] / 'shown.yaml'
    own = places[0 if beside_the_arm else 1] / 'own arm.yaml'
    for file in (shown, own):
        file.write_bytes(THESIS_ARM.read_bytes())
    monkeypatch.chdir(places[1])
    tasks = of_arm(shown)
    tasks.load('own.yaml', f'arm: own arm.yaml\n{POINTS}'.encode())
    assert not tasks.is_error and tasks.next.arm == own
    tasks = of_arm(shown)
    tasks.load('own.yaml', f'arm: no arm.yaml\n{POINTS}'.encode())
    assert tasks.message.startswith(
        f"own.yaml: no file 'no arm.yaml' in {places[0]} and {places[1]}, nor among the package's")


def test_arm_of_the_command_line_is_kept_where_a_file_names_another():
    tasks = of_arm(None)
    tasks.load('own.yaml', f'arm: thesis_arm_joint_2_250.yaml\n{POINTS}'.encode())
    assert tasks.next is None and len(tasks.editor.wanted.points) == 2
    tasks.open_shipped('table_6_1')
    assert tasks.next.arm == THESIS_ARM


@pytest.mark.parametrize(('content', 'message'), [
    ('via_points: [[1, 2]]\n', r'own.yaml: line 1: via_points\[0\]'),
    (f'planner_id: line_ark\n{POINTS}', 'line_ark.*line_arc'),
    (f'arm: none.yaml\n{POINTS}', "own.yaml: no file 'none.yaml'"),
    ('arm: {wrong}\n' + POINTS, 'payload.mass is -1 kg, must be in'),
    ('arm: thesis_arm_joint_2_250.yaml\njoint_via_points: [{a: 1.0}, {a: 2.0}]\n', 'joint_1'),
])
def test_wrong_file_or_arm_is_refused_before_anything_changes(
        tasks, tmp_path, content, message):
    wrong = tmp_path / 'wrong_arm.yaml'
    wrong.write_text('/**:\n  ros__parameters:\n    payload: {mass: -1.0}\n')
    before = tasks.editor.wanted
    tasks.load('own.yaml', content.replace('{wrong}', str(wrong)).encode())
    assert tasks.is_error and re.search(message, tasks.message), tasks.message
    assert tasks.next is None and tasks.editor.wanted is before
    tasks.load('own.yaml', POINTS.encode())
    assert tasks.message == ''


def test_real_arm_is_not_exchanged():
    tasks = of_arm(THESIS_ARM, can_exchange=False)
    tasks.open_shipped('go1_leg')
    assert tasks.is_error and tasks.next is None
    assert tasks.message == 'go1_leg is for go1_leg_arm, not for the arm that is connected'
    tasks.open_shipped('pick_and_place')
    assert len(tasks.editor.wanted.points) == 6


def test_start_with_another_arm_has_no_parameters_of_the_arm_before():
    first = first_start(read_task('table_6_1.yaml'), [
        '--ros-args', '-p', 'payload.mass:=2.0', '-r', 'joint_states:=others'])
    assert first.arm == THESIS_ARM
    other = another_start(shipped_task('go1_leg'), first)
    assert other.arm == CONFIG / 'arms' / 'go1_leg_arm.yaml'
    assert other.ros_arguments == ['--ros-args', '-r', 'joint_states:=others']


def test_arm_that_the_command_line_describes_is_taken_in_place_of_the_file_s():
    start = first_start(read_task('table_6_1.yaml'), [
        '--ros-args', '-p', f'robot_description:={CONFIG}/arms/go1_leg.urdf'])
    assert start.arm is None


def test_arm_that_comes_back_has_what_was_wanted_of_it(tasks):
    config = planner_config(THESIS_ARM)
    first = first_start(read_task('table_6_1.yaml'), [])
    tasks.editor.move(1, (0.46, 0.55, 1.4))
    before = replace(first, wanted=tasks.editor.wanted)
    again = started_again(before, another_start(shipped_task('go1_leg'), before), 'it broke')
    assert again.error == 'go1_leg cannot be started: it broke; see the terminal'
    assert again.arm == THESIS_ARM
    wanted = again.first_wanted(config, Payload())
    np.testing.assert_array_equal(wanted.points[1], (0.46, 0.55, 1.4))
