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

"""The page's via-point files: read back as they were saved; refused by name and line."""

from __future__ import annotations

from helpers.places import CONFIG
import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.point_files.reading import read_task
from rrr_traj_planner.nodes.studio.files import loaded, saved
from rrr_traj_planner.nodes.studio.wanted import wanted_of


@pytest.mark.parametrize('name', ['table_6_1.yaml', 'pick_and_place.yaml'])
def test_saved_file_is_read_as_the_one_before(name):
    task = read_task(name)
    found, _ = loaded('own.yaml', saved(wanted_of(
        task, RobotModel(), 'base_link', 'cycloid'), None).encode())
    for field in ('via_points', 'stop_at', 'dwell'):
        assert np.array_equal(getattr(found, field), getattr(task, field))
    assert found.planner_id == (task.planner_id or 'cycloid')


def test_all_that_a_file_can_have_is_saved_and_read_again(tmp_path):
    """A free time, stops, a rest, joint positions, and the arm's file in a folder of its own."""
    own = tmp_path / 'own arm.yaml'
    own.write_bytes((CONFIG / 'thesis_arm.yaml').read_bytes())
    file = tmp_path / 'points.yaml'
    file.write_text('arm: own arm.yaml\nplanner_id: time_optimal\n'
                    'joint_via_points: [[0.1, 0.2, 0.3], [0.4, 0.5, 0.6], [0.7, 0.8, 1e-3]]\n'
                    'stop_at: [false, true, true]\ndwell: [0.0, 0.25, 0.0]\n'
                    'segment_durations: [.nan, 7.5]\n')
    before = read_task(str(file))
    text = saved(wanted_of(before, RobotModel(), 'base_link', 'cycloid'), before.arm)
    after, names_arm = loaded('elsewhere.yaml', text.encode())
    assert names_arm and after.arm == before.arm == own
    assert after.planner_id == 'time_optimal' and len(after.via_points) == 0
    for field in ('stop_at', 'dwell', 'segment_durations'):
        np.testing.assert_array_equal(getattr(after, field), getattr(before, field))
    names = RobotModel().joint_names
    np.testing.assert_array_equal(after.joint_via_points(names), before.joint_via_points(names))


def test_arm_of_the_package_is_saved_by_its_name():
    task = read_task('table_6_3.yaml')
    text = saved(wanted_of(task, RobotModel(), 'base_link', 'cycloid'), task.arm)
    assert text.startswith('arm: "thesis_arm_joint_2_250.yaml"\n')


def test_joint_positions_that_are_not_all_known_are_saved_as_points_of_the_tip(tmp_path):
    file = tmp_path / 'points.yaml'
    file.write_text('joint_via_points: [[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]]\n')
    wanted = wanted_of(read_task(str(file)), RobotModel(), 'base_link', 'cycloid')
    moved = wanted.moved(0, (9.0, 9.0, 9.0))
    found, _ = loaded('a.yaml', saved(moved, None).encode())
    assert found.joint_positions is None
    np.testing.assert_array_equal(found.via_points, moved.points)


def test_no_digit_is_lost():
    wanted = wanted_of(read_task('table_6_1.yaml'), RobotModel(), 'base_link', 'cycloid')
    moved = wanted.moved(0, (1 / 3, 1e-17, -2 / 7))
    found, _ = loaded('a.yaml', saved(moved, None).encode())
    assert np.array_equal(found.via_points, moved.points)


def test_table_is_loaded_by_its_suffix():
    found, names_arm = loaded('points.csv', b'1.2,0.1,1.2\n1.0,0.4,1.3\n')
    assert found.via_points.tolist() == [[1.2, 0.1, 1.2], [1.0, 0.4, 1.3]]
    assert not names_arm


def test_file_of_an_included_arm_is_loaded():
    file = CONFIG / 'table_6_3.yaml'
    task, names_arm = loaded(file.name, file.read_bytes())
    assert np.array_equal(task.via_points, read_task(str(file)).via_points)
    assert names_arm and task.arm == CONFIG / 'thesis_arm_joint_2_250.yaml'


def test_error_names_the_file_and_not_where_it_was_put():
    with pytest.raises(InvalidInputError) as error:
        loaded('../../own.yaml', b'via_points: [[1, 2]]\n')
    assert str(error.value).startswith('own.yaml')
