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

"""A parameter file is loaded into a running node, as `ros2 param load` does it."""

from __future__ import annotations

from threading import Event

from helpers.places import CONFIG
import pytest
from rcl_interfaces.msg import ParameterType
from rcl_interfaces.srv import GetParameters
from rclpy.parameter import parameter_dict_from_yaml_file
from rclpy.parameter_client import AsyncParameterClient
from rrr_traj_planner.nodes.arm_node.node import SimulatedArm
from rrr_traj_planner.nodes.motion_server.node import MotionServer
from rrr_traj_planner.nodes.planner_node.node import TrajectoryPlanner

DEADLINE = 20.0
NODES = {'trajectory_planner': TrajectoryPlanner, 'simulated_arm': SimulatedArm,
         'motion_server': MotionServer}


def start(ros, name, *files):
    return ros.add(NODES[name](context=ros.context, cli_args=[
        '--ros-args', *(a for file in files for a in ('--params-file', str(file)))]))


def loaded(ros, name, file):
    """Return the result of each parameter, by name."""
    client, done = AsyncParameterClient(ros.node, name), Event()
    assert client.wait_for_services(DEADLINE)
    future = client.load_parameter_file(str(file), use_wildcard=True)
    future.add_done_callback(lambda _: done.set())
    assert done.wait(DEADLINE)
    return dict(zip(parameter_dict_from_yaml_file(str(file), True), future.result().results))


def values(node):
    return {name: parameter.get_parameter_value()
            for name, parameter in node.get_parameters_by_prefix('').items()}


def refused(results):
    return {name: result.reason for name, result in results.items() if not result.successful}


@pytest.mark.parametrize('name', NODES)
def test_shipped_file_loads_without_a_complaint(ros, name):
    file = CONFIG / 'thesis_arm.yaml'
    node = start(ros, name, file)
    before = values(node)
    results = loaded(ros, name, file)
    assert len(results) > 60
    assert refused(results) == {}
    ignored = {parameter for parameter, result in results.items() if result.reason}
    assert ignored == {parameter for parameter in results if not node.has_parameter(parameter)}
    assert {results[parameter].reason for parameter in ignored} == {
        f'ignored here: {parameter}' for parameter in ignored}
    assert values(node) == before


def test_file_of_an_arm_with_a_urdf_loads_again(ros):
    """The file has the path of the URDF, the parameter its text."""
    file = CONFIG / 'arms' / 'go1_leg_arm.yaml'
    start(ros, 'trajectory_planner', file)
    results = loaded(ros, 'trajectory_planner', file)
    assert 'robot_description' in results
    assert refused(results) == {}


def test_changes_are_made_where_they_may_be_and_refused_where_they_may_not(ros, tmp_path):
    start(ros, 'trajectory_planner', CONFIG / 'thesis_arm.yaml')
    file = tmp_path / 'changed.yaml'
    file.write_text(
        '/**:\n  ros__parameters:\n    sample_period: 0.02\n    base_frame: world\n'
        '    arm: {d1: 0.5, a2: 0.8}\n    joint_names: [joint_1, joint_2, joint_4]\n'
        '    publish_rate: 100.0\n    sample_time: 0.1\n')
    results = loaded(ros, 'trajectory_planner', file)
    assert refused(results).keys() == {'base_frame', 'arm.a2', 'joint_names', 'sample_time'}
    for parameter in ('base_frame', 'arm.a2', 'joint_names'):
        assert results[parameter].reason == f'Trying to set a read-only parameter: {parameter}.'
    values = ros.call(GetParameters, 'trajectory_planner/get_parameters', GetParameters.Request(
        names=['sample_period', 'base_frame', 'arm.a2'])).values
    assert [value.type for value in values] == [
        ParameterType.PARAMETER_DOUBLE, ParameterType.PARAMETER_STRING,
        ParameterType.PARAMETER_DOUBLE]
    assert (values[0].double_value, values[1].string_value, values[2].double_value) == (
        0.02, 'base_link', 0.9)


def test_parameters_stay_read_only_by_their_descriptors(ros):
    node = start(ros, 'trajectory_planner')
    assert node.describe_parameter('arm.d1').read_only
    assert not node.describe_parameter('sample_period').read_only
