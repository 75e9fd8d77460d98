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

"""Scripts begin and end: help without ROS, wrong options, missing packages."""

from __future__ import annotations

from helpers.arm_process import arm_process, ended, RUN
import pytest
from rrr_traj_planner.nodes.process.entry import split_ros_arguments


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


def test_missing_ros_is_reported_in_one_line():
    code, _, errors = ended(arm_process(code=without('rclpy')))
    assert code == 1
    assert errors.startswith('simulated_arm: ROS 2 is not in this environment')
    assert errors.count('\n') == 1


def test_missing_interfaces_are_reported_in_one_line():
    code, _, errors = ended(arm_process(code=(
        'import sys; from rrr_traj_planner.nodes.process.node_runner import run_node\n'
        'def load():\n    sys.modules["rrr_traj_planner_interfaces"] = None\n'
        '    import rrr_traj_planner_interfaces\n'
        'sys.exit(run_node("planner", "", load))')))
    assert code == 1
    assert 'ln -s rrr_traj_planner/rrr_traj_planner_interfaces' in errors
    assert errors.count('\n') == 1


@pytest.mark.parametrize('package', ['control_msgs', 'tf2_msgs'])
def test_missing_messages_are_reported_in_one_line(package):
    code, _, errors = ended(arm_process(code=without(package)))
    assert code == 1
    assert errors.startswith(f"simulated_arm: ROS's package {package} is not installed: call ")
    assert errors.count('\n') == 1


@pytest.mark.parametrize(('line', 'own', 'ros'), [
    ('', '', ''), ('--plot x', '--plot x', ''),
    ('a --ros-args -p x:=1', 'a', '--ros-args -p x:=1'),
    ('--ros-args -p x:=1 -- b --ros-args -r y:=z', 'b',
     '--ros-args -p x:=1 -- --ros-args -r y:=z')])
def test_arguments_are_shared_between_script_and_ros(line, own, ros):
    assert split_ros_arguments(line.split()) == (own.split(), ros.split())
