"""Scripts as processes: help without ROS, wrong files, missing packages, signals."""

from __future__ import annotations

import os
from pathlib import Path
import signal
import subprocess
import sys

import pytest
from rrr_traj_planner.nodes.entry import split_ros_arguments
from sensor_msgs.msg import JointState

ROOT = Path(__file__).parents[2]
DEADLINE = 20.0

RUN = 'import sys; from rrr_traj_planner.nodes.simulated_arm import main; sys.exit(main())'


def arm_process(*arguments, code=RUN):
    path = os.pathsep.join(p for p in (str(ROOT), os.environ.get('PYTHONPATH')) if p)
    return subprocess.Popen(
        [sys.executable, '-c', code, *arguments], text=True, stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, env={**os.environ, 'PYTHONPATH': path})


def ended(process):
    try:
        output, errors = process.communicate(timeout=DEADLINE)
        return process.returncode, output, errors
    finally:
        process.kill()


def without(module):
    """Return the script where a module cannot be imported."""
    return f'import sys; sys.modules[{module!r}] = None; ' + RUN


def test_help_needs_no_ros():
    code, output, errors = ended(arm_process('--help', code=without('rclpy')))
    assert (code, errors) == (0, '')
    for text in ('joint_trajectory', '~/reset', '--ros-args'):
        assert text in output


def test_unknown_option_is_refused():
    code, _, errors = ended(arm_process('--fast'))
    assert code == 2
    assert 'unrecognized arguments: --fast' in errors


def test_missing_ros_is_said_in_one_line():
    code, _, errors = ended(arm_process(code=without('rclpy')))
    assert code == 1
    assert errors.startswith('simulated_arm: ROS 2 is not in this environment')
    assert errors.count('\n') == 1


def test_missing_interfaces_are_said_in_one_line():
    code, _, errors = ended(arm_process(code=(
        'import sys; from rrr_traj_planner.nodes.entry import run_node\n'
        'def load():\n    sys.modules["rrr_traj_planner_interfaces"] = None\n'
        '    import rrr_traj_planner_interfaces\n'
        'sys.exit(run_node("planner", "", load))')))
    assert code == 1
    assert 'ln -s rrr_traj_planner/rrr_traj_planner_interfaces' in errors
    assert errors.count('\n') == 1


@pytest.mark.parametrize(('yaml', 'text'), [
    ('arm: {d1: 5}', 'parameter arm.d1 is 5, must be in [-100, 100] m (written with a point'),
    ('arm: {mass: [1.0, -1.0, 1.0]}', 'arm.mass[1] is -1 kg, must be in [0, 100000] kg'),
    ('physics_step: 1.0', 'parameter physics_step is 1 s, must be in [1e-05, 0.01] s'),
    ('joint_limits: {joint_3: {max_position: -4.0}}',
     'joint_limits.joint_3.min_position is -3.14159 rad, must be below')])
def test_wrong_file_stops_the_node_with_one_line(tmp_path, yaml, text):
    file = tmp_path / 'arm.yaml'
    file.write_text(f'/**:\n  ros__parameters: {{{yaml}}}\n')
    code, _, errors = ended(arm_process('--ros-args', '--params-file', str(file)))
    assert code == 1
    assert text in errors
    assert errors.startswith('simulated_arm: ')
    assert errors.count('\n') == 1


def test_file_that_is_missing_stops_the_node():
    code, _, errors = ended(arm_process('--ros-args', '--params-file', '/no/such/file.yaml'))
    assert code == 1
    assert 'simulated_arm: ROS refuses to start: ' in errors
    assert 'Traceback' not in errors


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize('arm', ['thesis_arm.yaml', 'thesis_arm_joint_2_250.yaml'])
def test_signal_ends_a_running_arm_in_order(ros, number, arm):
    states = ros.listen(JointState, 'joint_states')
    process = arm_process('--ros-args', '--params-file', str(ROOT / 'config' / arm))
    try:
        assert states.wait_for().name == ['joint_1', 'joint_2', 'joint_3']
        process.send_signal(number)
        code, _, errors = ended(process)
    finally:
        process.kill()
    assert (code, errors) == (0, '')


@pytest.mark.parametrize(('line', 'own', 'ros'), [
    ('', '', ''), ('--plot x', '--plot x', ''),
    ('a --ros-args -p x:=1', 'a', '--ros-args -p x:=1'),
    ('--ros-args -p x:=1 -- b --ros-args -r y:=z', 'b',
     '--ros-args -p x:=1 -- --ros-args -r y:=z')])
def test_arguments_are_shared_between_script_and_ros(line, own, ros):
    assert split_ros_arguments(line.split()) == (own.split(), ros.split())
