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

"""ROS's message packages that are not wheels: the same types, and hidden from workspaces."""

from __future__ import annotations

import json

from ament_index_python.packages import get_package_share_path
from catkin_pkg.packages import find_package_paths
from helpers.places import ROOT
import pytest

# From ROS 2 Jazzy: control_msgs 5.8.0, tf2_msgs 0.36. A hash covers every field of a type and of
# the types that it contains.
HASHES = {
    'control_msgs/action/FollowJointTrajectory':
        'RIHS01_738ebcb7a2d7cfa42f9f1001cc99ce3a4383d1cfe508015d9be8485e4b1c66f6',
    'control_msgs/msg/JointTrajectoryControllerState':
        'RIHS01_51d8dd89cc624cbe9daaeeb4d80d6de9b86168ffdc3be41fefc0953e3c26e480',
    'tf2_msgs/msg/TFMessage':
        'RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087'}


@pytest.mark.parametrize('name', HASHES)
def test_type_is_that_of_ros(name):
    package, folder, kind = name.split('/')
    found = json.loads((get_package_share_path(package) / folder / f'{kind}.json').read_text())
    hashes = {x['type_name']: x['hash_string'] for x in found['type_hashes']}
    assert hashes[name] == HASHES[name]


def test_workspaces_do_not_find_them():
    assert find_package_paths(str(ROOT / 'scripts' / 'ros_messages' / 'tf2_msgs')) == ['.']
    assert find_package_paths(str(ROOT / 'scripts')) == []
