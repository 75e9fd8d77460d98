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

"""The script `report` as a process: pages, exit codes, refusals, signals, what it needs."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import time

from helpers.places import CONFIG, ROOT
from helpers.script_calls import script_calls
import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.parameters.planner_config import planner_config

DEADLINE = 120.0  # s; nothing here takes so long
PROMPT = 2.0      # s, in which a signal is to end it

RUN = 'import sys; from rrr_traj_planner.nodes.scripts.report import main; sys.exit(main())'
HEAVY = ('arm: thesis_arm.yaml\nplanner_id: line_arc\n'
         'via_points: [[0.2, 0.8, 0.5], [0.5, 1.0, 1.0], [0.8, 1.2, 0.6]]\n')


def report(*arguments, cwd, code=RUN):
    return subprocess.Popen([sys.executable, '-c', code, *map(str, arguments)], text=True, cwd=cwd,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def ended(process):
    try:
        output, errors = process.communicate(timeout=DEADLINE)
        return process.returncode, output, errors
    finally:
        process.kill()


def without(*modules):
    """Return the script where modules cannot be imported."""
    return f'import sys; sys.modules.update(dict.fromkeys({modules!r})); ' + RUN


@pytest.fixture(scope='module')
def called():
    """Give tests the script without ROS, in one process."""
    yield from script_calls('report', 'rclpy', 'ament_index_python')


def test_plan_is_drawn_without_ros_and_nothing_is_written_elsewhere(tmp_path):
    code, output, errors = ended(report(
        '--plan', 'pick_and_place.yaml', '--planner', 'cycloid', '--planner', 'septic', '--output',
        'out', cwd=tmp_path, code=without('rclpy', 'ament_index_python')))
    assert (code, errors) == (0, '')
    assert output.endswith('page: out/index.html\n')
    assert [f.name for f in tmp_path.iterdir()] == ['out']
    names = {f.name for f in (tmp_path / 'out').iterdir()}
    assert {'index.html', 'planners.csv', 'profiles_cycloid.png', 'profiles_septic.csv',
            'vibrations.csv', 'vibration.png'} <= names
    page = (tmp_path / 'out' / 'index.html').read_text()
    assert 'rests for [s]' in page  # it stops at some via points
    assert 'Peaks of septic' in page and 'Residual vibration over frequency' in page
    for planner_id in ('cycloid', 'septic'):
        assert re.search(rf'^{planner_id}: \d\.\d+ s, residual vibration \[rad/s\^2\] at 16 / 32 '
                         r'/ 64 Hz: 0\.\d+ / 0\.\d+ / 0\.\d+$', output, re.MULTILINE)


def test_plan_of_a_urdf_s_arm_is_drawn(called, tmp_path):
    limits = tmp_path / 'slow.yaml'
    limits.write_text('joint_limits:\n' + ''.join(
        f'  joint_{i}: {{max_velocity: 0.5, max_acceleration: 9.0}}\n' for i in (1, 2, 3)))
    code, _, errors = called(
        '--plan', 'go1_leg.yaml', '--joint-limits', limits, '--output', 'out', cwd=tmp_path)
    assert (code, errors) == (0, '')
    profile = np.genfromtxt(tmp_path / 'out' / 'profiles_cycloid.csv', delimiter=',', names=True)
    speed = [profile[name] for name in profile.dtype.names if 'velocity' in name]
    assert len(speed) == 3
    assert np.abs(speed).max() == pytest.approx(0.5, abs=1e-3)


def test_points_of_a_table_are_planned_for_the_arm_of_ros_arguments(called, tmp_path):
    """Without ROS; relative paths refer to the parameter file's folder."""
    (tmp_path / 'arms').mkdir()
    (tmp_path / 'arms' / 'own.urdf').write_text(
        (CONFIG / 'arms' / 'kr16_2_first3.urdf').read_text())
    (tmp_path / 'arms' / 'own.yaml').write_text(
        '/**:\n  ros__parameters:\n    robot_description: own.urdf\n'
        '    default_max_acceleration: 3.0\n')
    (tmp_path / 'points.csv').write_text('1.2,0.1,1.2\n1.0,0.4,1.3\n')

    def peak(*more):
        code, _, errors = called(
            '--plan', 'points.csv', '--planner', 'cycloid', '--output', 'out', '--ros-args',
            '--params-file', 'arms/own.yaml', *more, cwd=tmp_path)
        assert (code, errors) == (0, '')
        profile = np.genfromtxt(tmp_path / 'out' / 'profiles_cycloid.csv', delimiter=',',
                                names=True)
        return max(np.abs(profile[name]).max() for name in profile.dtype.names
                   if 'acceleration' in name and 'joint_1' in name)

    assert peak() == pytest.approx(3.0, abs=1e-2)
    assert peak('-r', 'a:=b', '-p', 'default_max_acceleration:=2.0', '-p',
                'simulated_arm:default_max_acceleration:=1.0') == pytest.approx(2.0, abs=1e-2)


@pytest.mark.parametrize(('arguments', 'text'), [
    (('-p', 'payload.mass:=bad'), "payload.mass is 'bad', must be in"),
    (('-p', 'payload.mas:=1.0'), 'parameter payload.mas is unknown, the nearest known one is '),
    (('-p', 'payload.mass:=[1'), 'report: parameter payload.mass: while parsing'),
    (('--params-file', 'nope.yaml'), 'report: nope.yaml: ')])
def test_wrong_ros_arguments_are_reported(called, tmp_path, arguments, text):
    code, _, errors = called(
        '--plan', 'table_6_1.yaml', '--ros-args', *arguments, cwd=tmp_path)
    assert code == 1
    assert text in errors
    assert errors.count('\n') == 1


def test_refused_plan_is_shown_with_its_reason(called, tmp_path):
    (tmp_path / 'heavy.yaml').write_text(HEAVY)
    code, _, errors = called('--plan', 'heavy.yaml', cwd=tmp_path)
    reason = 'via point 2: joint_2 needs 218.9 N m to hold, limit 200 N m'
    assert code == 1
    assert errors == f'report: planner line_arc refuses: {reason}\n'
    assert f'refused: {reason}' in (tmp_path / 'report_heavy' / 'index.html').read_text()


def test_one_refusal_does_not_hide_the_other_plan(called, tmp_path):
    points = tmp_path / 'timed.yaml'
    points.write_text('via_points: [[1.02, 0.59, 0.97], [0.46, 0.55, 1.44]]\n'
                      'segment_durations: [3.0]\n')
    code, _, errors = called('--plan', points, '--planner', 'cycloid', '--planner', 'line_arc',
                             '--output', 'o', cwd=tmp_path)
    page = (tmp_path / 'o' / 'index.html').read_text()
    assert code == 1
    assert 'planner line_arc takes no segment_durations' in errors
    assert 'id="profiles_cycloid"' in page and 'id="profiles_line_arc"' not in page
    assert '3.000' in page


@pytest.mark.parametrize(('arguments', 'code', 'text'), [
    (('--plan', 'nowhere.yaml'), 1, "report: no file 'nowhere.yaml' in "),
    (('--plan', '.'), 1, "report: '.' is a folder, must be a file"),
    (('--plan', 'thesis_arm.yaml'), 1, 'thesis_arm.yaml: no via_points'),
    (('--plan', 'table_6_1.yaml', '--planner', 'fast'), 1,
     "report: planner_id 'fast' is unknown, known are cycloid, "),
    (('--thesis', '/proc/report'), 1, 'report: cannot write the page: '),
    (('--plan', 'table_6_1.yaml', '--output', '/proc/report'), 1,
     'report: cannot write the page: '),
    ((), 2, 'one of the arguments --thesis --plan is required'),
    (('--thesis', 'a', '--planner', 'cycloid'), 2,
     '--planner, --output and --joint-limits go with --plan'),
    (('--thesis', 'a', '--plan', 'b'), 2, 'not allowed with argument')])
def test_wrong_arguments_are_reported(called, tmp_path, arguments, code, text):
    found, _, errors = called(*arguments, cwd=tmp_path)
    assert found == code
    assert text in errors
    assert 'Traceback' not in errors
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(('yaml', 'text'), [
    ('arm: {d1: 5}', 'arm.d1 is 5, must be in [-100, 100] m (written with a point'),
    ('joint_limits: {joint_3: {max_position: -4.0}}', 'joint_limits.joint_3.min_position is'),
    ('joint_limits: [', 'while parsing')])
def test_wrong_arm_is_reported_with_its_file(called, tmp_path, yaml, text):
    (tmp_path / 'arm.yaml').write_text(f'/**:\n  ros__parameters: {{{yaml}}}\n')
    (tmp_path / 'points.yaml').write_text(
        'arm: arm.yaml\nvia_points: [[1.02, 0.59, 0.97], [0.46, 0.55, 1.44]]\n')
    code, _, errors = called('--plan', 'points.yaml', cwd=tmp_path)
    assert code == 1
    assert errors.startswith(f'report: {tmp_path}/arm.yaml: ')
    assert 'Traceback' not in errors
    assert text in errors
    assert errors.count('\n') == 1


def test_file_with_an_unknown_key_is_refused(tmp_path):
    (tmp_path / 'arm.yaml').write_text('/**: {ros__parameters: {arm: {d2: 0.6}}}')
    with pytest.raises(InvalidInputError, match=r'arm.yaml: parameter arm.d2 is unknown, the '
                       r'nearest known one is arm.(d1|d4|a2|l2)$'):
        planner_config(tmp_path / 'arm.yaml')


@pytest.mark.parametrize('text', ['', '[1, 2]', '/left/**: {ros__parameters: {arm.d1: 0.6}}'])
def test_file_without_parameters_of_the_planner_is_refused(tmp_path, text):
    (tmp_path / 'arm.yaml').write_text(text)
    with pytest.raises(InvalidInputError, match=r'arm.yaml: no parameters of a node /\*\*, '):
        planner_config(tmp_path / 'arm.yaml')


def test_arm_of_ones_own_is_used(called, tmp_path):
    (tmp_path / 'arm.yaml').write_text(
        '/**:\n  ros__parameters:\n    joint_names: [base, shoulder, elbow]\n'
        '    joint_limits:\n' + ''.join(
            f'      {name}: {{min_position: 0.0, max_position: 3.0, max_velocity: {velocity}, '
            'max_acceleration: 1.0, max_jerk: 10.0, has_effort_limits: false}\n'
            for name, velocity in (('base', 1.0), ('shoulder', 0.3), ('elbow', 1.0))) +
        'trajectory_planner:\n  ros__parameters: {default_planner_id: septic}\n')
    (tmp_path / 'points.yaml').write_text(
        'arm: arm.yaml\nvia_points: [[1.02, 0.59, 0.97], [0.46, 0.55, 1.44]]\n')
    code, _, errors = called('--plan', 'points.yaml', '--output', 'o', cwd=tmp_path)
    assert (code, errors) == (0, '')
    text = (tmp_path / 'o' / 'peaks_septic.csv').read_text()
    assert text.startswith('peak,base,shoulder,elbow\n')
    assert '0.3 of 0.3 (100 %)' in text


def test_missing_matplotlib_is_reported_in_one_line(tmp_path):
    code, _, errors = ended(report('--thesis', 'out', cwd=tmp_path, code=without('matplotlib')))
    assert code == 1
    assert errors.startswith('report: no figures, matplotlib is missing')
    assert errors.count('\n') == 1
    assert list(tmp_path.iterdir()) == []


def test_help_needs_neither_ros_nor_matplotlib(tmp_path):
    code, output, errors = ended(report('--help', cwd=tmp_path, code=without(
        'rclpy', 'ament_index_python', 'matplotlib', 'numpy', 'yaml')))
    assert (code, errors) == (0, '')
    for text in ('--thesis OUT_DIR', '--plan FILE', '--planner ID', '--ros-args'):
        assert text in output


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize('wait', [0.3, 2.5])
def test_signal_ends_it_at_once(tmp_path, number, wait):
    process = report('--thesis', 'out', cwd=tmp_path)
    try:
        process.stdout.readline()
        time.sleep(wait)  # into the planning, and further on
        process.send_signal(number)
        sent = time.monotonic()
        code, _, errors = ended(process)
        assert time.monotonic() - sent < PROMPT
    finally:
        process.kill()
    assert (code, errors) == (0, '')
    assert not (tmp_path / 'out' / 'index.html').exists()


def test_script_is_installed_with_what_it_reads():
    setup = (ROOT / 'setup.py').read_text()
    assert "'report'" in setup
    assert '*.css' in setup and '*.js' in setup
