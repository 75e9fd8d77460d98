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

"""The script `demo`: plan, execution, table, plot, exit code."""

from __future__ import annotations

import re

from helpers.scripts import Script, script
from helpers.urdf_texts import arm, joint, Z
from matplotlib.image import imread
import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.branch_factors import has_named_postures
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.solutions import solutions

PNG = b'\x89PNG\r\n\x1a\n'


@pytest.mark.parametrize(('arguments', 'name', 'seconds'), [
    ((), 'table_6_1', 2.850), (('table_6_3.yaml',), 'table_6_3', 3.490)])
def test_demo_runs_its_task_and_shows_it(tmp_path, arguments, name, seconds):
    with Script(script('demo'), *arguments, cwd=tmp_path) as demo:
        demo.read_until('executing:')
        children = demo.started(2)
        code, output, errors = demo.ended()
        assert all(child.has_ended() for child in children)
    assert code == 0, errors
    shown = float(re.search(rf'^{name}: (\S+) s$', output, re.MULTILINE)[1])
    assert shown == pytest.approx(seconds, abs=5e-3)  # the reference solution's
    for text in ('tip error [mm]', 'at rest', 'executed torque [N m]', 'joint_3',
                 'residual vibration [rad/s^2] at 16 / 32 / 64 Hz: 0.',
                 '22 of 22 figures are inside their bounds', f'plot: demo_{name}.png'):
        assert text in output
    assert 'Traceback' not in errors
    file = tmp_path / f'demo_{name}.png'
    assert file.read_bytes().startswith(PNG)
    picture = imread(file)
    assert min(picture.shape[:2]) >= 1000
    assert (picture[..., :3].min(axis=2) < 0.9).mean() > 0.02  # more than an empty frame
    assert [f.name for f in tmp_path.iterdir()] == [file.name]


@pytest.mark.parametrize('name', ['go1_leg', 'kr16_2_first3', 'tilted_arm'])
def test_demo_runs_arms_of_urdfs(tmp_path, name):
    with Script(script('demo'), f'{name}.yaml', '--plot', '', cwd=tmp_path) as demo:
        code, output, errors = demo.ended()
    assert code == 0, errors
    assert re.search(rf'^{name}: \S+ s$', output, re.MULTILINE)
    assert 'moving to the first via point' in output  # from the middle of the ranges
    assert '26 of 26 figures are inside their bounds' in output
    assert 'none' not in output  # every limit is there
    assert 'Traceback' not in errors


def test_demo_runs_a_plan_that_takes_a_motor_s_whole_torque(tmp_path):
    free = [a for j in (1, 2, 3) for a in (
        '-p', f'joint_limits.joint_{j}.has_acceleration_limits:=false')]
    with Script(script('demo'), 'table_6_3.yaml', '--planner', 'time_optimal', '--plot', '',
                '--ros-args', *free, cwd=tmp_path) as demo:
        code, output, errors = demo.ended()
    assert code == 0, errors
    peaks, = re.findall(r'^torque \[N m\] .*$', output, re.MULTILINE)
    assert ' 250 / 250 ' in peaks


def test_demo_moves_an_arm_to_the_plan_s_posture_also_where_that_has_no_name(tmp_path):
    text = arm(j3=joint('j3', 'revolute', 'b', 'c', Z, (0.5, 0.0, 0.0)))
    model = RobotModel.from_urdf(text)
    assert not has_named_postures(model)
    start = np.array((0.4, -0.9, -0.9))
    q = start + np.array(((0.0, 0.0, 0.0), (0.4, 0.3, -0.2), (0.8, 0.6, 0.1)))
    other, = (x for x in solutions(model, forward_kinematics(model, q[0])).q
              if np.abs(x - q[0]).max() > 0.1 and (np.abs(x) < 2.0).all())
    points = forward_kinematics(model, q).tolist()
    (tmp_path / 'my.urdf').write_text(text)
    (tmp_path / 'task.yaml').write_text(f'arm: arm.yaml\nvia_points: {points}\n')
    moved = []
    for initial in (start, other):  # the tip is at the first via point
        (tmp_path / 'arm.yaml').write_text(
            '/**:\n  ros__parameters: {robot_description: my.urdf, initial_positions: '
            f'{initial.round(6).tolist()}}}\n')
        with Script(script('demo'), 'task.yaml', '--plot', '', cwd=tmp_path) as demo:
            code, output, errors = demo.ended()
        assert code == 0, errors
        assert 'inside their bounds' in output
        moved.append('moving to the first via point' in output)
    assert sorted(moved) == [False, True]


def test_demo_runs_taught_positions_with_stops(tmp_path):
    (tmp_path / 'taught.csv').write_text(
        'joint_3,joint_2 [deg],joint_1,stop_at,dwell\n0.25,54,0.52,,\n0.2,57,0.55,yes,0.2\n'
        '0.15,54,0.52,,0.1\n')
    with Script(script('demo'), 'taught.csv', '--plot', '', cwd=tmp_path) as demo:
        code, output, errors = demo.ended()
    assert code == 0, errors
    assert '22 of 22 figures are inside their bounds' in output
    rows = [line.split() for line in output.splitlines() if re.match(r'[012]  \(', line)]
    assert [''.join(row[1:4]) for row in rows] == [
        '(0.52,0.9425,0.25)', '(0.55,0.9948,0.2)', '(0.52,0.9425,0.15)']
    assert [float(row[6]) for row in rows] == [0.0, 0.2, 0.1]


@pytest.mark.parametrize(('task', 'planner_id'), [
    ('table_6_1', 'line_arc'), ('table_6_3', 'line_polynomial')])
def test_demo_moves_the_tip_along_paths_of_both_tables(tmp_path, task, planner_id):
    arguments = ('--planner', planner_id, '--plot', '', f'{task}.yaml')
    with Script(script('demo'), *arguments, cwd=tmp_path) as demo:
        code, output, errors = demo.ended()
    assert code == 0, errors  # tip at the via points to 2 mm, within the deviation, in all limits
    planned, executed, allowed = map(float, re.search(
        r'distance from the polyline: planned (\S+) mm, executed (\S+) mm, allowed (\S+) mm',
        output).groups())
    assert allowed == 50.0
    assert 10.0 <= planned <= allowed
    assert executed == pytest.approx(planned, abs=0.1)
    assert '24 of 24 figures are inside their bounds' in output
    assert ('joint accelerations step' in output) == (planner_id == 'line_arc')
