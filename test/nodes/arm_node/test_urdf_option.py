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

"""`simulated_arm --urdf`: what robot_state_publisher is given."""

from __future__ import annotations

from xml.etree import ElementTree

from helpers.places import CONFIG
from helpers.scripts import Script, script
from rclpy.node import Node
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.urdf import FrameNames, urdf

COMMAND = (*script('simulated_arm'), '--urdf')


def test_option_prints_the_urdf_of_the_parameters_and_ends():
    with Script(COMMAND, '--ros-args', '--params-file', CONFIG / 'thesis_arm_joint_2_250.yaml',
                '-p', 'tip_frame:=tool', '-r', '__ns:=/left') as arm:
        code, output, errors = arm.ended()
    assert (code, errors) == (0, '')
    assert output == urdf(RobotModel(), JointLimits(max_effort=(150.0, 250.0, 200.0)),
                          FrameNames(tip='tool'))


def test_option_prints_a_urdf_that_is_given_unchanged():
    with Script(COMMAND, '--ros-args', '--params-file', CONFIG / 'arms' / 'go1_leg_arm.yaml',
                '-p', 'payload.mass:=1.0') as arm:
        code, output, errors = arm.ended()
    assert (code, errors) == (0, '')
    assert output == (CONFIG / 'arms' / 'go1_leg.urdf').read_text()


def test_wrong_parameter_is_reported_instead():
    with Script(COMMAND, '--ros-args', '-p', 'tip_frame:=base_link') as arm:
        code, output, errors = arm.ended()
    assert (code, output) == (1, '')
    assert errors.startswith("simulated_arm: the frames are 'base_link', 'link_1', ")
    assert errors.count('\n') == 1


def test_urdf_can_be_a_parameter_on_a_command_line(ros):
    text = urdf(RobotModel(), JointLimits())
    node = ros.add(Node('robot_state_publisher', context=ros.context, cli_args=[
        '--ros-args', '-p', f'robot_description:={text}']))
    value = node.declare_parameter('robot_description', '').value
    read, written = (ElementTree.canonicalize(t, strip_text=True) for t in (value, text))
    assert read == written
