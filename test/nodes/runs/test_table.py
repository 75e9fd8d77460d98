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

"""A run's table, for runs that are known."""

from __future__ import annotations

from dataclasses import replace

from helpers.runs import executed, stopping
import numpy as np
import pytest
from rrr_traj_planner.nodes.point_files.reading import read_task
from rrr_traj_planner.nodes.runs.table import table


@pytest.fixture(scope='module')
def task():
    return read_task('table_6_1.yaml')


def test_table_shows_every_via_point_joint_and_limit(task):
    run = executed(task, **{'joint_limits.joint_1.has_jerk_limits': False})
    lines = table(run).splitlines()
    assert [line.split()[0] for line in lines if line[:1].isdigit()] == ['0', '1', '2']
    jerk, = (line for line in lines if line.startswith('jerk'))
    assert ' / none' in jerk and ' / 10' in jerk
    assert max(map(len, lines)) <= 99


def test_table_shows_the_residual_vibration_of_the_planned_motion(task):
    run = executed(task)
    line, = (x for x in table(run).splitlines() if 'vibration' in x)
    label, values = line.split(' Hz: ')
    assert label == 'residual vibration [rad/s^2] at 16 / 32 / 64'
    assert [float(x) for x in values.split(' / ')] == pytest.approx(
        (0.057, 0.005, 0.002), abs=6e-4)  # the cycloid's, by a program of its own


def test_table_shows_rests(task):
    run = executed(stopping(task))
    rows = [line.split() for line in table(run).splitlines()
            if line[:1].isdigit()]
    assert [row[-3] for row in rows[:3]] == ['0.1', '0.5', '0.2']
    assert float(rows[0][-4]) == 0.0
    plain = executed(task)  # which rests nowhere before the end
    assert [line.split()[-3] for line in table(plain).splitlines()
            if line[:1].isdigit()][:3] == ['0', '1.680', '0']


def test_table_shows_joint_positions(task):
    taught = np.array([[0.52, 0.94, 0.25], [0.87, 1.35, -0.4], [0.7, 1.36, -0.8]])
    run = executed(stopping(task, via_points=np.zeros((0, 3)),
                            joint_positions=lambda names: taught))
    lines = table(run).splitlines()
    assert any(line.startswith('1  (0.87, 1.35, -0.4) rad ') for line in lines)
    assert max(map(len, lines)) <= 99


def test_table_of_an_arm_that_publishes_no_torques_lacks_that_row_alone(task):
    run = executed(task)
    without = table(replace(run, torque=None)).splitlines()
    assert [line for line in table(run).splitlines() if line not in without] == [
        line for line in table(run).splitlines() if line.startswith('executed torque')]


def test_table_of_a_motion_that_starts_elsewhere_shows_no_rest_at_the_first_via_point(task):
    run = executed(task)
    rows = [line.split() for line in table(replace(run, started=True)).splitlines()
            if line[:1].isdigit()]
    assert [len(row) for row in rows] == [8, 8, 9]  # the last one alone has a rest
