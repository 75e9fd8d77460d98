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

"""The script `bringup`: all nodes come up together, and end together, whatever ends first."""

from __future__ import annotations

import os
import signal
import subprocess
import sys

from helpers.places import CONFIG
from helpers.plan_requests import plan_request, TABLE_6_3
from helpers.scripts import DEADLINE, Script, script
import pytest
from rrr_traj_planner.nodes.output.latched import LATCHED
from rrr_traj_planner.nodes.process.processes import NodeProcesses
from rrr_traj_planner.nodes.process.signals import signals_blocked
from rrr_traj_planner.nodes.scripts.bringup import node_arguments
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from std_srvs.srv import Trigger
import yaml


def assert_up(ros, states):
    """Assert that planner and arm answer; return the planner's answer."""
    states.wait_for()
    assert ros.call(Trigger, 'simulated_arm/hold').success
    return ros.call(PlanTrajectory, 'plan_trajectory', plan_request(TABLE_6_3))


def test_nodes_come_up_with_their_file_and_a_signal_ends_all(ros):
    states = ros.listen(JointState, 'joint_states')
    file = CONFIG / 'thesis_arm_joint_2_250.yaml'
    with Script(script('bringup'), '--arm', file) as bringup:
        response = assert_up(ros, states)
        assert response.error_code == response.SUCCESS, response.message
        children = bringup.started(3)
        bringup.process.send_signal(signal.SIGTERM)
        assert bringup.ended()[0] == 0
        assert all(child.has_ended() for child in children)


def test_ctrl_c_in_a_terminal_reaches_all_and_ends_all(ros):
    states = ros.listen(JointState, 'joint_states')
    with Script(script('bringup'), new_group=True) as bringup:
        response = assert_up(ros, states)
        assert response.error_code == response.GOAL_CONSTRAINTS_VIOLATED  # the thesis's arm
        children = bringup.started(3)
        os.killpg(bringup.process.pid, signal.SIGINT)
        code, _, errors = bringup.ended()
        assert all(child.has_ended() for child in children)
    assert code == 0
    assert 'Traceback' not in errors


@pytest.mark.parametrize(('name', 'number', 'code', 'text'), [
    ('planner', signal.SIGKILL, 128 + signal.SIGKILL, 'planner was killed by SIGKILL'),
    ('simulated_arm', signal.SIGTERM, 0, 'simulated_arm ended with exit code 0'),
    ('motion_server', signal.SIGINT, 0, 'motion_server ended with exit code 0')])
def test_node_that_ends_takes_the_others_with_it(ros, name, number, code, text):
    states = ros.listen(JointState, 'joint_states')
    with Script(script('bringup')) as bringup:
        assert_up(ros, states)
        children = bringup.started(3)
        victim, = (c for c in children if f'rrr_traj_planner.nodes.scripts.{name}' in c.command)
        victim.send_signal(number)
        ended, _, errors = bringup.ended()
        assert all(child.has_ended() for child in children)
    assert ended == code
    assert errors.endswith(f'bringup: {text}\n')


def test_nodes_end_with_a_bringup_that_is_killed(ros):
    states = ros.listen(JointState, 'joint_states')
    with Script(script('bringup')) as bringup:
        assert_up(ros, states)
        children = bringup.started(3)
        bringup.process.kill()
        assert all(child.has_ended() for child in children)


def test_node_that_cannot_start_ends_bringup_with_its_code(tmp_path):
    file = tmp_path / 'arm.yaml'
    file.write_text('/**:\n  ros__parameters: {arm: {d1: 1000.0}}\n')
    with Script(script('bringup'), '--arm', file) as bringup:
        code, _, errors = bringup.ended()
    assert code == 1
    assert 'parameter arm.d1 is 1000 m, must be in [-100, 100] m' in errors
    assert 'ended with exit code 1' in errors
    assert 'Traceback' not in errors


@pytest.mark.parametrize('arguments', [
    ('--arm', 'go1_leg_arm.yaml'),
    ('--joint-limits', 'go1_leg_limits.yaml', '--ros-args', '-p',
     f'robot_description:={CONFIG}/arms/go1_leg.urdf'),
    ('--ros-args', '--params-file', f'{CONFIG}/arms/go1_leg_arm.yaml')])
def test_both_nodes_have_the_arm_of_a_urdf(ros, tmp_path, arguments):
    states, described = ros.listen(JointState, 'joint_states'), ros.listen(
        String, 'robot_description', LATCHED)
    points = yaml.safe_load((CONFIG / 'arms' / 'go1_leg.yaml').read_text())['via_points']
    with Script(script('bringup'), *arguments, cwd=tmp_path) as bringup:
        states.wait_for(lambda m: list(m.name) == ['joint_1', 'joint_2', 'joint_3'] and (
            m.position[2] < -1.5))  # in the middle of its range
        text = described.wait_for().data
        answer = ros.call(PlanTrajectory, 'plan_trajectory', plan_request(points))
        bringup.process.send_signal(signal.SIGINT)
        assert bringup.ended()[0] == 0
    assert text == (CONFIG / 'arms' / 'go1_leg.urdf').read_text()
    assert answer.error_code == answer.SUCCESS, answer.message
    assert answer.trajectory.header.frame_id == 'base'
    assert max(answer.peak_acceleration) == pytest.approx(150.0, rel=1e-6)  # the file's limit


def test_missing_file_is_reported_in_one_line(tmp_path):
    with Script(script('bringup'), '--arm', 'nowhere.yaml', cwd=tmp_path) as bringup:
        code, _, errors = bringup.ended()
    assert code == 1
    assert errors.startswith(f"bringup: no file 'nowhere.yaml' in {tmp_path}, nor among the ")
    assert errors.count('\n') == 1


def test_help_lists_the_options():
    with Script(script('bringup'), '--help') as bringup:
        code, output, errors = bringup.ended()
    assert (code, errors) == (0, '')
    assert '--arm FILE' in output
    assert '--ros-args' in output


def test_user_s_arguments_reach_both_nodes_after_the_file_s():
    assert node_arguments('arm.yaml', ['--ros-args', '-p', 'arm.d1:=0.4', '--']) == [
        '--ros-args', '--params-file', 'arm.yaml', '-p', 'arm.d1:=0.4']


WAITING = 'import signal; signal.pthread_sigmask(signal.SIG_UNBLOCK, [2]); input()'


def test_nothing_is_left_where_the_second_node_cannot_be_started(monkeypatch):
    started, popen = [], subprocess.Popen

    def first_only(command, **kwargs):
        if started:
            raise OSError('no more processes')
        started.append(popen([sys.executable, '-c', WAITING], stdin=subprocess.PIPE,
                             stderr=subprocess.DEVNULL))
        return started[0]

    monkeypatch.setattr(subprocess, 'Popen', first_only)
    with pytest.raises(OSError, match='no more processes'):
        with NodeProcesses(('planner', 'simulated_arm'), []):
            pass
    assert started[0].poll() is not None


def test_signal_waits_while_processes_are_started_and_they_begin_with_it_blocked():
    process, before = None, signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            with signals_blocked():
                signal.raise_signal(signal.SIGINT)
                process = subprocess.Popen([sys.executable, '-c', 'input()'],
                                           stdin=subprocess.PIPE, stderr=subprocess.DEVNULL)
        # A process that has just started blocks the signal until it handles it.
        blocked = int(next(line.split()[1] for line in open(f'/proc/{process.pid}/status')
                           if line.startswith('SigBlk')), 16)
        assert blocked & 1 << signal.SIGINT - 1
    finally:
        if process is not None:
            process.kill()
            process.communicate(timeout=DEADLINE)
        signal.signal(signal.SIGINT, before)
