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

"""Numbers in YAML: by YAML 1.2's core schema in our own files, in ROS's files as ROS has them."""

from __future__ import annotations

from math import inf, isnan, nan
import os

import pytest
import rclpy
from rclpy.context import Context
from rclpy.node import Node
from rrr_traj_planner.nodes.parameters.yaml_loader import input_error, Loader, ros_value, RosLoader
import yaml

# YAML 1.2.2, 10.3.2 (and example 10.9); what its patterns do not match is a text.
CORE = {
    '1e-3': 1e-3, '1E5': 1e5, '1e+5': 1e5, '-1.5E+3': -1500.0, '.5': 0.5, '-.5': -0.5,
    '+12.': 12.0, '0.': 0.0, '010': 10, '-09': -9, '0o17': 15, '0x1F': 31, '0': 0, '+1': 1,
    '.inf': inf, '-.Inf': -inf, '+.INF': inf, '.nan': nan, '1:30': '1:30',
    '190:20:30.15': '190:20:30.15', '1_000': '1_000', '1_000.5': '1_000.5', '0b11': '0b11',
    '-0x1F': '-0x1F', '-.nan': '-.nan',
    'inf': 'inf', '1e': '1e', '.': '.', '1.2.3': '1.2.3', '0o8': '0o8', '"1"': '1'}

PLAIN = [
    *CORE, '0x10', '-010', '+0x10', '0XfF', '09', '00', '-0', '00.5', 'Infinity', '-inf', 'NaN',
    '1e400', '-1e400', '12345678901234567890', '-9223372036854775808', '9223372036854775808',
    '0x1p3', '0x1.8', '0xffffffffffffffff', '1d3', '1f', 'yes', 'No', 'on', 'OFF', 'y', 'N',
    'TRUE', 'tRUE', '~', 'null', '2001-01-01', '1,5', "'1e-3'", '"yes"', '!!str 1',
    '1e3000000', '٣']


def same(found, expected):
    return type(found) is type(expected) and (
        found == expected or (isinstance(found, float) and isnan(found) and isnan(expected)))


@pytest.mark.parametrize('text', CORE)
def test_our_own_files_have_numbers_of_the_core_schema(text):
    assert same(yaml.load(f'x: {text}', Loader)['x'], CORE[text])
    assert same(yaml.load(f'[{text}]', Loader)[0], CORE[text])


@pytest.mark.parametrize('text', ['!!int 1_000', '!!float 1_000.5', '!!float 1:30', '!!int x'])
def test_number_that_is_none_in_spite_of_its_tag_is_an_error(text):
    with pytest.raises(yaml.YAMLError, match='is not of type'):
        yaml.load(f'x: {text}', Loader)


def test_parameter_files_are_read_as_ros_reads_them(tmp_path):
    file = tmp_path / 'parameters.yaml'
    file.write_text('/**:\n  ros__parameters:\n' + ''.join(
        f'    p{i}: {text}\n' for i, text in enumerate(PLAIN)), encoding='utf-8')
    context = Context()
    rclpy.init(context=context, args=['--ros-args', '--params-file', str(file)],
               domain_id=int(os.environ['ROS_DOMAIN_ID']))
    try:
        node = Node('any', context=context, automatically_declare_parameters_from_overrides=True)
        by_ros = [node.get_parameter(f'p{i}').value for i in range(len(PLAIN))]
        node.destroy_node()
    finally:
        context.try_shutdown()
    values = yaml.load(file.read_text(encoding='utf-8'), RosLoader)['/**']['ros__parameters']
    found = {text: (values[f'p{i}'], by_ros[i]) for i, text in enumerate(PLAIN)}
    assert {text: both for text, both in found.items() if not same(*both)} == {}


def test_keys_are_texts_as_in_ros():
    assert yaml.load('{1: 1, y: y, 0x10: {on: 010}}', RosLoader) == {
        '1': 1, 'y': True, '0x10': {'on': 8}}
    with pytest.raises(yaml.YAMLError, match='a key must be a text'):
        yaml.load('{[1]: 1}', RosLoader)


def test_no_text_is_no_value():
    assert ros_value('') is None
    assert yaml.load('x:', RosLoader) == {'x': None}


def test_aliases_are_refused_as_by_ros(tmp_path):
    text = '/**:\n  ros__parameters:\n    a: &all {x: 1}\n    b: *all\n'
    with pytest.raises(yaml.YAMLError) as refused:
        yaml.load(text, RosLoader)
    assert str(input_error(refused.value)) == 'line 4: the alias *all is refused by ROS'
    file = tmp_path / 'aliases.yaml'
    file.write_text(text)
    context = Context()
    with pytest.raises(RuntimeError, match='Will not support aliasing at line 4'):
        rclpy.init(args=['--ros-args', '--params-file', str(file)], context=context)
    assert yaml.load('a: &all {x: 1}\nb: *all\n', Loader)['b'] == {'x': 1}
