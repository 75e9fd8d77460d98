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
    found = loaded('own.yaml', saved(wanted_of(
        task, RobotModel(), 'base_link', 'cycloid')).encode())
    for field in ('via_points', 'stop_at', 'dwell'):
        assert np.array_equal(getattr(found, field), getattr(task, field))
    assert found.planner_id == (task.planner_id or 'cycloid')


def test_no_digit_is_lost():
    wanted = wanted_of(read_task('table_6_1.yaml'), RobotModel(), 'base_link', 'cycloid')
    moved = wanted.moved(0, (1 / 3, 1e-17, -2 / 7))
    assert np.array_equal(loaded('a.yaml', saved(moved).encode()).via_points, moved.points)


def test_table_is_loaded_by_its_suffix():
    found = loaded('points.csv', b'1.2,0.1,1.2\n1.0,0.4,1.3\n')
    assert found.via_points.tolist() == [[1.2, 0.1, 1.2], [1.0, 0.4, 1.3]]


def test_file_of_an_included_arm_is_loaded():
    file = CONFIG / 'table_6_3.yaml'
    assert np.array_equal(
        loaded(file.name, file.read_bytes()).via_points, read_task(str(file)).via_points)


def test_error_names_the_file_and_not_where_it_was_put():
    with pytest.raises(InvalidInputError) as error:
        loaded('../../own.yaml', b'via_points: [[1, 2]]\n')
    assert str(error.value).startswith('own.yaml')
