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

"""Via-point files and arms' files: found here or among the package's, and checked."""

from __future__ import annotations

from pathlib import Path

from helpers.places import CONFIG
import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.parameters.configuration_files import found_file, shipped_folder
from rrr_traj_planner.nodes.point_files.reading import read_task

POINTS = 'via_points: [[1.02, 0.59, 0.97], [0.46, 0.55, 1.44]]\n'


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    """Work in a folder of its own."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_package_s_own_files_are_found_from_anywhere():
    assert {p.name for p in CONFIG.glob('*.yaml')} <= {p.name for p in shipped_folder().iterdir()}
    task = read_task('table_6_3.yaml')
    assert (task.name, task.planner_id) == ('table_6_3', 'cycloid')
    np.testing.assert_array_equal(task.via_points, [
        (0.2, 0.8, 0.5), (0.5, 1.0, 1.0), (0.8, 1.2, 0.6)])
    assert len(task.segment_durations) == 0
    assert task.arm.name == 'thesis_arm_joint_2_250.yaml'
    assert task.arm.is_file()


def test_user_s_file_has_precedence_over_the_package_s(here):
    (here / 'table_6_1.yaml').write_text(POINTS)
    assert len(read_task('table_6_1.yaml').via_points) == 2


def test_arm_file_is_searched_in_the_folder_of_its_task(here):
    folder = here / 'tasks'
    folder.mkdir()
    (folder / 'mine.yaml').write_text('/**: {ros__parameters: {}}\n')
    (folder / 'task.yaml').write_text(POINTS + 'arm: mine.yaml\n')
    assert read_task('tasks/task.yaml').arm == (folder / 'mine.yaml').resolve()


def test_what_a_file_leaves_out_is_left_to_the_node(here):
    (here / 'task.yaml').write_text(POINTS)
    task = read_task(str(here / 'task.yaml'))
    assert (task.planner_id, task.arm.name) == ('', 'thesis_arm.yaml')
    assert len(task.segment_durations) == 0


def test_durations_are_read(here):
    (here / 'task.yaml').write_text(POINTS + 'segment_durations: [2]\n')
    assert read_task('task.yaml').segment_durations.tolist() == [2.0]


@pytest.mark.parametrize(('content', 'text'), [
    ('', 'no via_points, it is empty: must have via_points: [[x, y, z], ...] in m'),
    ('- 1\n- 2\n', 'no via_points, it has no fields: must have via_points: '),
    ('planner_id: cycloid\n', "no via_points, its fields are 'planner_id': must have "),
    ('points:\n', "no via_points, its fields are 'points': must have via_points: "),
    ('arm: x\nvia_points:\n', 'line 2: no via_points, the list is empty: must have via_points: '),
    ('via_points: []\n', 'line 1: no via_points, the list is empty: must have via_points: '),
    ('via_points: 3.0\n', 'via_points is 3.0, must be a list of points [x, y, z]'),
    ('via_points: {a: 1.0}\n', "via_points is {'a': 1.0}, must be a list of points [x, y, z]"),
    ('via_points: [1.0, 2.0, 3.0]\n',
     'line 1: via_points[0] is 1.0, must be three numbers, [x, y, z] in m'),
    ('via_points:\n  - [1.02, 0.59, 0.97]\n  # the second\n  - [0.46, 0.55]\n',
     'line 4: via_points[1] is [0.46, 0.55], must be three numbers, [x, y, z] in m: z is missing'),
    ('via_points: [[1.0, 2.0, 3.0], [1.0]]\n', 'via_points[1] is [1.0], must be three numbers, '
     '[x, y, z] in m: y and z are missing'),
    ('via_points: [[]]\n', 'via_points[0] is [], must be three numbers, [x, y, z] in m: x and y '
     'and z are missing'),
    ('via_points: [[1.0, 2.0, 3.0, 4.0]]\n', ': 4.0 is too many'),
    ('via_points: [[1.0, 2.0, 3.0, 4.0, 5.0]]\n', ': 4.0, 5.0 are too many'),
    ('via_points: [[1.0, 2.0, x]]\n', "via_points[0][2] is 'x', must be a number"),
    ('via_points: [[1.0, "1e-3", 3.0]]\n', "via_points[0][1] is '1e-3', must be a number without "
     'quotation marks'),
    ('via_points: [[1.0, 1:30, 3.0]]\n', "via_points[0][1] is '1:30', must be a number"),
    ('via_points: [[1.0, 1_000, 3.0]]\n', "via_points[0][1] is '1_000', must be a number"),
    ('via_points: [[1.0, true, 3.0]]\n', 'via_points[0][1] is True, must be a number'),
    ('via_points: [[1.0, , 3.0]]\n', 'line 1: while parsing a flow node, expected the node '
     'content, but found '),
    ('via_points: [[1.0, ~, 3.0]]\n', 'via_points[0][1] is None, must be a number'),
    ('via_points: [[1.0, [2.0], 3.0]]\n', 'via_points[0][1] is [2.0], must be a number'),
    ('via_points: [[1.0, 2.0, .nan]]\n', 'via_points[0][2] is nan, must be finite'),
    (f'via_points: [[1{"0" * 400}, 2.0, 3.0]]\n', 'via_points[0][0] is 10'),
    ('via_points: [[1.0, -.inf, 3.0]]\n', 'via_points[0][1] is -inf, must be finite'),
    (POINTS + POINTS, 'line 2: via_points is repeated (first in line 1)'),
    (POINTS + 'segment_durations: [1.0, x]\n', "segment_durations[1] is 'x', must be a number"),
    (POINTS + 'segment_durations: [.inf]\n', 'segment_durations[0] is inf, must be finite'),
    (POINTS + 'dwell: [.nan, 0.0]\n', 'dwell[0] is nan, must be finite'),
    (POINTS + 'segment_durations: 3.0\n', 'line 2: segment_durations is 3.0, must be a list of '
     'numbers'),
    (POINTS + 'planer_id: x\n', 'line 2: unknown planer_id (did you mean "planner_id"?); known '
     'are planner_id, via_points'),
    (POINTS + 'planner_id: [1]\n', 'planner_id is [1], must be a text'),
    (POINTS + 'arm: 7\n', 'arm is 7, must be a text'),
    (POINTS + 'arm: nowhere.yaml\n', "no file 'nowhere.yaml'"),
    ('via_points: [[\n', 'line 2: while parsing a flow'),
    (POINTS + ' planner_id: x\n', 'task.yaml: line '),
    (f'via_points: [[0x{"f" * 5000}, 2.0, 3.0]]\n', 'via_points[0][0] is of int and too long to '
     'show, must be finite'),
    (f'via_points: 0x{"f" * 5000}\n', 'via_points is of int and too long to show, must be a list'),
    (POINTS + f'arm: 0x{"f" * 5000}\n', 'arm is of int and too long to show, must be a text'),
    ('via_points: 2001-99-99\n', "line 1: '2001-99-99' is not of type timestamp"),
    ('via_points: ' + '[' * 3000 + '\n', 'nested too deeply'),
    ('via_points: @\n', "line 1: while scanning for the next token, found character '@'"),
    ('\xff', 'task.yaml: ')])
def test_malformed_file_is_named_with_what_is_wrong(here, content, text):
    (here / 'task.yaml').write_bytes(content.encode('latin-1'))
    with pytest.raises(InvalidInputError) as caught:
        read_task('task.yaml')
    assert text in str(caught.value)
    assert str(here / 'task.yaml') in str(caught.value)
    assert '\n' not in str(caught.value)


@pytest.mark.parametrize('find', [read_task, lambda name: found_file(name, Path.cwd())])
def test_missing_file_like_no_other_is_reported_without_a_list(here, find):
    with pytest.raises(InvalidInputError) as caught:
        find('nowhere.yaml')
    assert str(caught.value) == f"no file 'nowhere.yaml' in {here}, nor among the package's"


@pytest.mark.parametrize(('name', 'near'), [
    ('table_6_2.yaml', '"table_6_3.yaml" or "table_6_1.yaml"'), ('go1leg.yaml', '"go1_leg.yaml"'),
    ('arms/go1-leg.yaml', '"go1_leg.yaml"')])
def test_missing_file_is_reported_with_similar_ones_only(here, name, near):
    with pytest.raises(InvalidInputError, match="the package's; did you mean ") as caught:
        read_task(name)
    assert near in str(caught.value)
    assert 'thesis_arm.yaml' not in str(caught.value)


@pytest.mark.parametrize('content', [
    '1.02,0.59,0.97\n0.46,0.55,1.44\n', 'x,y,z\n1.02,0.59,0.97\n0.46,0.55,1.44\n',
    '\ufeff# measured\n\nX [m]; Y [m]; Z [m]\n1.02; 0.59; 0.97 # first\n\n0.46; 0.55; 1.44',
    'x\ty\tz\r\n1.02\t0.59\t0.97\r\n0.46\t0.55\t1.44\r\n',
    'x;y;z\n1,02;0,59;0,97\n0,46;0,55;1,44\n', '"z","x","y"\n0.97,1.02,0.59\n1.44,0.46,0.55\n',
    't, x, y, z, note\n0, 1.02, 0.59, 0.97, start\n1, 46e-2, 0.55, 1.44, end\n,,,,\n',
    'x_mm, Y_cm, z_m\n1020, 59, 0.97\n460, 55, 1.44\n',
    'pose.orientation.x,pose.position.z,pose.position.y,pose.position.x\n'
    '0,0.97,0.59,1.02\n0,1.44,0.55,0.46\n',
    '__time;/target/pose/position/x;/target/pose/position/y;/target/pose/position/z\n'
    '0,1;1,02;0,59;0,97\n0,2;0,46;0,55;1,44\n', 'point.x,point.y,point.z [mm]\n'
    '1.02,0.59,970\n0.46,0.55,1440\n'])
@pytest.mark.parametrize('name', ['points.csv', 'points.CSV'])
def test_table_of_points_is_read(here, name, content):
    (here / name).write_text(content, encoding='utf-8', newline='')
    task = read_task(name)
    assert task.via_points.tolist() == [[1.02, 0.59, 0.97], [0.46, 0.55, 1.44]]
    assert (task.name, task.planner_id, task.arm.name) == ('points', '', 'thesis_arm.yaml')
    assert len(task.segment_durations) == 0


@pytest.mark.parametrize(('content', 'text'), [
    ('', 'no via_points'), ('# nothing\n\n', 'no via_points'), ('x,y,z\n', 'no via_points'),
    ('1.0,2.0,3.0\n1.0,2.0\n',
     'line 2 is 1.0, 2.0, must be three numbers, x, y, z in m: z is missing'),
    ('1.0,2.0,3.0,4.0\n', 'line 1 is 1.0, 2.0, 3.0, 4.0, must be three numbers, x, y, z in m: '
     "'4.0' is too many"),
    ('x,y,z\n1,02,0,59,0,97\n', "the header has 3 columns, '59', '0', '97' are too many"),
    ('x,y,z\n1.0,2.0,3.0\n\n1.0,2.0\n', 'line 4: z is missing'),
    ('x,y,z\n1.0,,3.0\n', 'line 2: y is missing'),
    ('x,y,z\n1.0,2.O,3.0\n', "line 2: y is '2.O', must be a number"),
    ('1.0,2.0,nan\n', 'line 1: z is nan, must be finite'),
    ('x,y,z\n-inf,2.0,3.0\n', 'line 2: x is -inf, must be finite'),
    ('x,x_mm,y,z\n1,2,3,4\n', 'the header is x, x_mm, y, z, and must name one column x'),
    ('orientation.x,y,z\n1,2,3\n', 'line 1: the header is orientation.x, y, z, and must name one '
     'column x'),
    ('x,y\n1.0,2.0\n', 'line 1: the header is x, y, and must name one column z'),
    ('x,y,z,z\n1,2,3,4\n', 'the header is x, y, z, z, and must name one column z'),
    ('1.0 2.0 3.0\n', 'line 1: the header is 1.0 2.0 3.0, and must name one column x')])
def test_malformed_table_is_named_with_line_and_what_is_wrong(here, content, text):
    (here / 'points.csv').write_text(content)
    with pytest.raises(InvalidInputError) as caught:
        read_task('points.csv')
    assert str(caught.value) == f'{here / "points.csv"}: {text}' or text in str(caught.value)
