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

"""The package's own via-point files: all of them, and no files of parameters."""

from __future__ import annotations

from helpers.places import CONFIG
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.point_files.shipped import shipped_task, shipped_tasks


def test_tasks_are_those_that_name_an_arm():
    named = {path.stem for path in CONFIG.rglob('*.yaml') if '\narm: ' in path.read_text()}
    assert {'table_6_1', 'table_6_3', 'pick_and_place', 'go1_leg'} <= named
    assert set(shipped_tasks()) == named


@pytest.mark.parametrize('name', ['table_6_3', 'trifinger_pro'])
def test_task_has_the_arm_of_its_file(name):
    task = shipped_task(name)
    arms = {'table_6_3': 'thesis_arm_joint_2_250', 'trifinger_pro': 'trifinger_pro_arm'}
    assert (task.name, task.arm.stem) == (name, arms[name])


def test_another_name_is_refused():
    with pytest.raises(InvalidInputError, match="no task 'thesis_arm' among"):
        shipped_task('thesis_arm')
