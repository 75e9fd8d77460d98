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

"""A command line's arguments for ROS without its parameters."""

from __future__ import annotations

from rrr_traj_planner.nodes.parameters.ros_arguments import without_parameters


def test_parameters_and_their_files_are_left_out_and_names_stay():
    assert without_parameters([
        '--ros-args', '-p', 'payload.mass:=2.0', '-r', 'joint_states:=other', '--params-file',
        '-p', '--param', 'a:=1', '--log-level', 'warn', '--']) == [
            '--ros-args', '-r', 'joint_states:=other', '--log-level', 'warn', '--']


def test_nothing_is_left_out_where_there_are_no_parameters():
    assert without_parameters([]) == []
    assert without_parameters(['--ros-args', '-r', '__ns:=/a']) == ['--ros-args', '-r', '__ns:=/a']
