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

"""Arguments for ROS: without parameters, and the folder of the arm's URDF that they name."""

from __future__ import annotations

from pathlib import Path

from helpers.places import CONFIG
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.parameters.ros_arguments import description_folder, without_parameters


def test_folder_is_that_of_the_urdf_s_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / 'urdf'
    folder.mkdir()
    (folder / 'arm.urdf').write_text('<robot/>')
    file = tmp_path / 'arm.yaml'
    file.write_text('/**: {ros__parameters: {robot_description: urdf/arm.urdf}}')
    in_file = ['--ros-args', '--params-file', str(file)]
    assert description_folder(in_file) == folder
    assert description_folder(['--ros-args', '-p', 'robot_description:=urdf/arm.urdf']) == folder
    # the later one takes precedence
    shipped = description_folder([*in_file, '-p', 'robot_description:=tilted_arm.urdf'])
    assert (shipped / 'tilted_arm.urdf').read_text() == (
        CONFIG / 'arms' / 'tilted_arm.urdf').read_text()


def test_folder_is_the_present_one_without_a_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert description_folder([]) == Path(tmp_path)
    assert description_folder(
        ['--ros-args', '-p', 'robot_description:=<robot name="arm"/>']) == Path(tmp_path)


def test_missing_file_is_refused():
    with pytest.raises(InvalidInputError, match='no_such_arm'):
        description_folder(['--ros-args', '-p', 'robot_description:=no_such_arm.urdf'])


def test_parameters_and_their_files_are_left_out_and_names_stay():
    assert without_parameters([
        '--ros-args', '-p', 'payload.mass:=2.0', '-r', 'joint_states:=other', '--params-file',
        '-p', '--param', 'a:=1', '--log-level', 'warn', '--']) == [
            '--ros-args', '-r', 'joint_states:=other', '--log-level', 'warn', '--']


def test_nothing_is_left_out_where_there_are_no_parameters():
    assert without_parameters([]) == []
    assert without_parameters(['--ros-args', '-r', '__ns:=/a']) == ['--ros-args', '-r', '__ns:=/a']
