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

"""A node's process: files that it refuses, and signals that end it."""

from __future__ import annotations

import gc
import signal
from time import sleep
from types import SimpleNamespace

from helpers.arm_process import arm_process, ended
from helpers.places import ROOT
import pytest
from rrr_traj_planner.nodes.process.node_runner import create_node, DELIVERY_TIME, finish
from sensor_msgs.msg import JointState


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


def test_what_is_loaded_when_a_node_is_created_is_exempt_from_garbage_collection():
    made = [object()]
    try:
        assert create_node(lambda: made) is made
        assert gc.get_freeze_count() > 0
        assert not any(found is made for found in gc.get_objects())
    finally:
        gc.unfreeze()


@pytest.mark.parametrize('answers', [[True], [False, False, True]])
def test_what_a_node_has_sent_gets_time_to_arrive(answers):
    to_come, after = list(answers), []

    def spin_once(duration):
        sleep(duration)
        if not to_come:
            after.append(duration)

    finish(SimpleNamespace(spin_once=spin_once), SimpleNamespace(finish=lambda: to_come.pop(0)))
    assert not to_come
    assert sum(after) >= DELIVERY_TIME


def test_file_that_is_missing_stops_the_node():
    code, _, errors = ended(arm_process('--ros-args', '--params-file', '/no/such/file.yaml'))
    assert code == 1
    assert 'simulated_arm: ROS refuses to start: ' in errors
    assert 'Traceback' not in errors


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize('arm', ['thesis_arm.yaml', 'thesis_arm_joint_2_250.yaml'])
def test_signal_ends_a_running_arm_in_order(ros, number, arm):
    states = ros.listen(JointState, 'joint_states')
    process = arm_process('--ros-args', '--params-file', str(ROOT / 'config' / arm),
                          '--log-level', 'error')  # a busy machine is warned of
    try:
        assert states.wait_for().name == ['joint_1', 'joint_2', 'joint_3']
        process.send_signal(number)
        code, _, errors = ended(process)
    finally:
        process.kill()
    assert (code, errors) == (0, '')
