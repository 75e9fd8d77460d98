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

"""How the script `demo` ends: refusals, signals, dead nodes, wrong arguments."""

from __future__ import annotations

import signal
from time import monotonic, sleep

from helpers.scripts import DEADLINE, Script, script
import pytest
import rclpy
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rrr_traj_planner.nodes.demo.client import Client
from rrr_traj_planner.nodes.process.entry import StartError

UNREACHABLE = 'via_points: [[1.02, 0.59, 0.97], [3.0, 0.0, 0.5]]\n'


def test_demo_with_points_out_of_reach_shows_the_refusal(tmp_path):
    (tmp_path / 'far.yaml').write_text(UNREACHABLE)
    with Script(script('demo'), 'far.yaml', cwd=tmp_path) as demo:
        demo.read_until('waiting for planner and arm')
        children = demo.started(2)
        code, output, errors = demo.ended()
        assert all(child.has_ended() for child in children)
    assert code == 1
    assert ('demo: the planner refuses (-31): via point 1: (3, 0, 0.5) m is out of the '
            "arm's reach: it misses by 1.4 m\n") in errors
    assert 'Traceback' not in errors
    assert not list(tmp_path.glob('*.png'))


@pytest.mark.parametrize(('number', 'when'), [
    (signal.SIGINT, 'waiting for planner and arm'), (signal.SIGTERM, 'executing:')])
def test_signal_ends_the_demo_and_its_nodes(tmp_path, number, when):
    with Script(script('demo'), cwd=tmp_path) as demo:
        demo.read_until(when)
        children = demo.started(2)
        demo.process.send_signal(number)
        code, output, errors = demo.ended()
        assert all(child.has_ended() for child in children)
    assert code == 0
    assert 'Traceback' not in errors
    assert 'figures' not in output
    assert not list(tmp_path.glob('*.png'))


def test_node_that_dies_ends_the_demo(tmp_path):
    with Script(script('demo'), '--planner', 'cycloid_approach_a', cwd=tmp_path) as demo:
        demo.read_until("planned 3 via points with 'cycloid_approach_a' in ")
        children = demo.started(2)
        arm, = (c for c in children if 'rrr_traj_planner.nodes.scripts.simulated_arm' in c.command)
        arm.kill()
        code, _, errors = demo.ended()
        assert all(child.has_ended() for child in children)
    assert code == 1
    assert errors.endswith('demo: simulated_arm was killed by SIGKILL\n')


def test_nodes_of_another_machine_are_counted(ros):
    for _ in range(2):  # such do not claim their names on this machine
        ros.add(Node('trajectory_planner', context=ros.context))
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    try:
        client, deadline = Client(), monotonic() + DEADLINE
        client.check_free()
        while client.get_node_names().count('trajectory_planner') < 2 and monotonic() < deadline:
            sleep(0.05)
        with pytest.raises(StartError, match=(
                r'^another planner or arm is running here \(2 nodes named trajectory_planner\)')):
            client.check_alone()
        client.destroy_node()
    finally:
        rclpy.shutdown()


@pytest.mark.parametrize(('arguments', 'code', 'text'), [
    (('nowhere.yaml',), 1, "demo: no file 'nowhere.yaml' in "),
    (('thesis_arm.yaml',), 1, 'thesis_arm.yaml: no via_points'),
    (('--planner',), 2, 'expected one argument')])
def test_wrong_arguments_are_reported(arguments, code, text):
    with Script(script('demo'), *arguments) as demo:
        ended, _, errors = demo.ended()
    assert ended == code
    assert text in errors
    assert 'Traceback' not in errors


def test_help_lists_the_options():
    with Script(script('demo'), '--help') as demo:
        output, errors = demo.process.communicate(timeout=DEADLINE)
    assert (demo.process.returncode, errors) == (0, '')
    for text in ('--planner ID', '--plot PNG', '--ros-args'):
        assert text in output
