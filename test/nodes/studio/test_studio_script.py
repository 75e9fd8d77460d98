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

"""The script `studio`: help and the line without viser; with it, a page that Ctrl-C ends."""

from __future__ import annotations

from importlib import import_module
import re
import signal
import socket
from urllib.request import urlopen

from helpers.script_calls import script_calls
from helpers.scripts import Script, script
import pytest

STOP_TIME = 2.0  # s, in which all has ended after a signal


@pytest.fixture(scope='module')
def called():
    """Give tests the script without ROS and without viser, in one process."""
    yield from script_calls('studio', 'rclpy', 'viser')


def free_port():
    with socket.socket() as taken:
        taken.bind(('127.0.0.1', 0))
        return taken.getsockname()[1]


def test_help_needs_neither_ros_nor_viser(called, tmp_path):
    code, output, _ = called('--help', cwd=tmp_path)
    assert code == 0
    for text in ('--port N', '127.0.0.1', '--ros-args'):
        assert text in output


def test_without_viser_a_line_says_how_to_get_it(called, tmp_path):
    code, output, errors = called(cwd=tmp_path)
    assert (code, output) == (1, '')
    assert errors.startswith('studio: the page needs the Python package viser')
    assert 'make studio' in errors and 'pip install viser' in errors
    assert errors.count('\n') == 1


def test_page_is_served_on_this_machine_and_ctrl_c_ends_all(tmp_path):
    pytest.importorskip('viser', reason='viser is not installed: make studio installs it')
    port = free_port()
    with Script(script('studio'), '--port', port, cwd=tmp_path) as studio:
        line = studio.read_until('studio: http')[-1]
        address = re.match(r'studio: (http://127\.0\.0\.1:(\d+))', line)
        assert int(address[2]) == port
        with urlopen(address[1], timeout=10.0) as page:
            assert page.status == 200
            assert b'<html' in page.read()
        with socket.socket() as elsewhere:  # another address of this machine
            assert elsewhere.connect_ex(('127.0.0.2', port)) != 0
        children = studio.started(3)
        studio.process.send_signal(signal.SIGINT)
        assert studio.is_over_in(STOP_TIME)
        assert all(child.has_ended() for child in children)
        code, output, errors = studio.ended()
    assert (code, output) == (0, '')
    assert 'Traceback' not in errors


def test_port_in_use_is_told_and_another_one_taken(tmp_path):
    pytest.importorskip('viser', reason='viser is not installed: make studio installs it')
    with socket.create_server(('127.0.0.1', 0)) as other:
        port = other.getsockname()[1]
        with Script(script('studio'), '--port', port, cwd=tmp_path) as studio:
            line = studio.read_until('studio: http')[-1]
    assert f':{port} ' not in line and f'(port {port} is in use; Ctrl-C ends)' in line


@pytest.mark.parametrize(('host', 'opened', 'is_told'), [
    ('127.0.0.1', 'http://127.0.0.1:80', False), ('0.0.0.0', 'http://127.0.0.1:80', True),
    ('::', 'http://[::1]:80', True), ('::1', 'http://[::1]:80', False)])
def test_address_can_be_opened_in_a_browser(host, opened, is_told):
    pytest.importorskip('viser', reason='viser is not installed: make studio installs it')
    address = import_module('rrr_traj_planner.nodes.studio.web.server').address
    found = address(host, 80)
    assert found.split(',')[0] == opened and ('from the network' in found) == is_told


def test_real_arm_that_is_not_there_is_waited_for_and_none_is_simulated(tmp_path):
    pytest.importorskip('viser', reason='viser is not installed: make studio installs it')
    with Script(script('studio'), '--port', free_port(), '--controller', '/arm_controller',
                cwd=tmp_path) as studio:
        line = studio.read_until('waiting for')[-1]
        assert 'the controller (action /arm_controller/follow_joint_trajectory)' in line
        assert 'the position of joint_1, joint_2, joint_3 (topic /joint_states)' in line
        children = studio.started(2)
        studio.process.send_signal(signal.SIGINT)
        assert studio.is_over_in(STOP_TIME)
        assert all(child.has_ended() for child in children)
        code, _, errors = studio.ended()
    assert code == 0
    assert 'serves /move_through with /arm_controller/follow_joint_trajectory' in errors


def test_node_that_cannot_start_ends_the_studio(tmp_path):
    pytest.importorskip('viser', reason='viser is not installed: make studio installs it')
    with Script(script('studio'), '--ros-args', '-p', 'arm.d1:=1000.0', cwd=tmp_path) as studio:
        code, _, errors = studio.ended()
    assert code == 1
    assert re.search('studio: (planner|simulated_arm) ended with exit code 1\n$', errors)
    assert 'Traceback' not in errors


@pytest.mark.parametrize(('arguments', 'text'), [
    (['--port', '70000'], "'70000', must be 0 to 65535"), (['--port', '-1'], 'must be 0 to 65535'),
    (['--host', 'nowhere.invalid'], 'cannot serve at nowhere.invalid, port 8080: '),
    (['--host', '192.0.2.1'], 'cannot serve at 192.0.2.1, port 8080: ')])  # kept for documents
def test_address_that_cannot_be_served_at_is_refused(arguments, text):
    pytest.importorskip('viser', reason='viser is not installed: make studio installs it')
    with Script(script('studio'), *arguments) as studio:
        code, _, errors = studio.ended()
    assert code in (1, 2) and text in errors and 'Traceback' not in errors
