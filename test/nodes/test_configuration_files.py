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

import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.configuration_files import arm_file, read_task, shipped_folder
from scripts import CONFIG

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


def test_user_s_file_goes_before_the_package_s(here):
    (here / 'table_6_1.yaml').write_text(POINTS)
    assert len(read_task('table_6_1.yaml').via_points) == 2


def test_arm_is_looked_for_beside_its_task(here):
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
    ('', 'no via_points'),
    ('- 1\n- 2\n', 'no via_points'),
    ('planner_id: cycloid\n', 'no via_points'),
    ('via_points:\n', 'no via_points'),
    ('via_points: []\n', 'no via_points'),
    ('via_points: [[1.0, 2.0]]\n', 'via_points has shape (1, 2), must have (n, 3)'),
    ('via_points: [[1.0, 2.0, x]]\n', 'via_points is no array of numbers'),
    ('via_points: [[1.0, 2.0, 3.0], [1.0]]\n', 'via_points is no array of numbers'),
    ('via_points: [[1.0, 2.0, .nan]]\n', 'via_points[0][2] is nan, must be finite'),
    (POINTS + 'segment_durations: 3.0\n', 'segment_durations has shape (), must have (n)'),
    (POINTS + 'planer_id: x\n', 'unknown planer_id; known are planner_id, via_points'),
    (POINTS + 'planner_id: [1]\n', 'planner_id is [1], must be a text'),
    (POINTS + 'arm: 7\n', 'arm is 7, must be a text'),
    (POINTS + 'arm: nowhere.yaml\n', "no file 'nowhere.yaml'"),
    ('via_points: [[\n', 'while parsing a flow'),
    ('\xff', 'task.yaml: ')])
def test_malformed_file_is_named_with_what_is_wrong(here, content, text):
    (here / 'task.yaml').write_bytes(content.encode('latin-1'))
    with pytest.raises(InvalidInputError) as caught:
        read_task('task.yaml')
    assert text in str(caught.value)
    assert str(here / 'task.yaml') in str(caught.value)
    assert '\n' not in str(caught.value)


@pytest.mark.parametrize('find', [read_task, lambda name: arm_file(name, Path.cwd())])
def test_missing_file_is_told_with_the_package_s_own(here, find):
    with pytest.raises(InvalidInputError) as caught:
        find('nowhere.yaml')
    text = str(caught.value)
    assert text.startswith(f"no file 'nowhere.yaml' in {here}, nor among the package's: ")
    assert 'table_6_1.yaml, table_6_3.yaml, thesis_arm.yaml' in text
