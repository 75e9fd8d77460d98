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

"""What nodes say when they start, and of others that have their names."""

from __future__ import annotations

import signal

from helpers.own_limits import own_limits
from helpers.places import CONFIG
from helpers.scripts import Script, script
import pytest
from rrr_traj_planner.nodes.parameters.parameter_files import has_section_for
import yaml


def arguments(file, *more):
    return ('--ros-args', '--params-file', file, *more)


def ends(started):
    started.process.send_signal(signal.SIGINT)
    return started.ended()


@pytest.mark.parametrize(('name', 'text'), [
    ('planner', '/left/trajectory_planner: {file}; {limits}; serves /left/plan_trajectory; ready'),
    ('simulated_arm', '/left/simulated_arm: {file}; {limits}; follows /left/joint_trajectory and '
     'goals of /left/simulated_arm/follow_joint_trajectory; ready')])
def test_start_is_logged_in_a_line(name, text):
    file = CONFIG / 'thesis_arm_joint_2_250.yaml'
    limits = ('joint_1 0 to 1.571 rad, 1 rad/s, 1 rad/s^2, 10 rad/s^3, 150 N m; '
              'joint_2 0 to 3.142 rad, 1 rad/s, 1 rad/s^2, 10 rad/s^3, 250 N m; '
              'joint_3 -3.142 to 6.283 rad, 1 rad/s, 1 rad/s^2, 10 rad/s^3, 200 N m')
    with Script(script(name), *arguments(file, '-r', '__ns:=/left')) as started:
        lines = started.read_errors_until('ready')
        assert lines[-1].endswith(text.format(file=file, limits=limits) + '\n')
        assert ends(started)[0] == 0
    assert len(lines) == 1  # nothing to warn of


@pytest.mark.parametrize(('sections', 'node', 'speaks'), [
    ({'/**': 1}, '/a/planner', True), ({'planner': 1}, '/planner', True),
    ({'/planner': 1}, '/a/planner', False), ({'/a/planner': 1}, '/a/planner', True),
    ({'a': {'planner': 1}}, '/a/planner', True), ({'/*/planner': 1}, '/a/planner', True),
    ({'/*/planner': 1}, '/a/b/planner', False), ({'/a/**': 1}, '/a/b/planner', True),
    ({'/b/**': 1, 'gripper': 1}, '/a/planner', False), ({'/*': 1}, '/planner', True)])
def test_file_speaks_of_a_node_by_ros_s_rules(tmp_path, sections, node, speaks):
    def with_parameters(tree):
        return {key: {'ros__parameters': {'force': 3.0}} if value == 1 else with_parameters(value)
                for key, value in tree.items()}

    file = tmp_path / 'some.yaml'
    file.write_text(yaml.safe_dump(with_parameters(sections)))
    assert has_section_for(file, node) == speaks


def test_unused_files_and_parameters_are_warned_of(tmp_path):
    file = tmp_path / 'gripper.yaml'
    file.write_text('/gripper: {ros__parameters: {force: 3.0, publish_rate: 10.0}}\n')
    with Script(script('planner'), *arguments(
            file, '-p', 'sample_priod:=0.1', '-p', 'publish_rate:=100.0')) as planner:
        line, = planner.read_errors_until('ready')
        assert ': no parameter file, the default arm; ' in line
        lines = planner.read_errors_until('no parameters for this node')
    assert ('parameter sample_priod is used by no node; did you mean "sample_period"?'
            ) in lines[0]
    assert (f'parameter file {file} has no parameters for this node, '
            '/trajectory_planner') in lines[1]


@pytest.mark.parametrize('node', ['/**', 'trajectory_planner', '/trajectory_planner'])
def test_unknown_key_stops_the_node_with_one_line(tmp_path, node):
    file = tmp_path / 'arm.yaml'
    file.write_text(yaml.safe_dump({node: {'ros__parameters': {
        'joint_limits': {'joint_1': {'max_velocty': 1.0}}}}}))
    with Script(script('planner'), *arguments(file)) as planner:
        code, output, errors = planner.ended()
    assert (code, output) == (1, '')
    assert errors == ('planner: parameter joint_limits.joint_1.max_velocty is unknown, '
                      'the nearest known one is joint_limits.joint_1.max_velocity\n')


def test_arm_of_other_names_starts_with_its_own_limits(tmp_path):
    file = tmp_path / 'arm.yaml'
    file.write_text(yaml.safe_dump({'/**': {'ros__parameters': {
        **own_limits('turn', 'lift', 'bend'), 'joint_limits.lift.max_effort': 123.0}}}))
    with Script(script('simulated_arm'), *arguments(file)) as arm:
        *_, line = arm.read_errors_until('ready')
    assert '; lift 0 to 3.142 rad, 1 rad/s, 1 rad/s^2, 10 rad/s^3, 123 N m; bend ' in line


def test_second_node_of_a_name_is_warned_of_by_both_and_one_elsewhere_by_none():
    name, warning = '/trajectory_planner', 'another node is named /trajectory_planner: '
    with Script(script('planner')) as first:
        first.read_errors_until(f'{name}: ')
        with Script(script('planner'), '--ros-args', '-r', '__ns:=/left') as elsewhere:
            assert len(elsewhere.read_errors_until('ready')) == 1
            with Script(script('planner')) as second:
                second.read_errors_until(warning)  # at once
                first.read_errors_until(warning)   # when it is discovered
            assert warning not in ends(elsewhere)[2]


def test_demo_beside_a_running_pair_says_so_and_leaves_it_alone(tmp_path):
    with Script(script('simulated_arm')) as arm:
        arm.read_errors_until('ready')
        with Script(script('demo'), '--record', 'demo.mcap', cwd=tmp_path) as demo:
            assert demo.ended() == (1, '', (
                'demo: a node /simulated_arm is already running: end one, or give it a namespace '
                '(--ros-args -r __ns:=/NAME) or another ROS_DOMAIN_ID\n'))
        assert not list(tmp_path.iterdir())
        assert 'following' not in ends(arm)[2]  # not a word of the demonstration's trajectory
