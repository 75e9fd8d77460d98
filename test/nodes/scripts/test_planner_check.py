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

"""`planner --check`: what a URDF is understood to say, without ROS."""

from __future__ import annotations

import subprocess
import sys

from helpers.places import CONFIG, ROOT
import pytest
from rrr_traj_planner.planners.method_summaries import method_summaries

DEADLINE = 60.0  # s

# ROS's own packages cannot be imported.
RUN = ("import sys; sys.modules.update(dict.fromkeys(('rclpy', 'rcl_interfaces'))); "
       'from rrr_traj_planner.nodes.scripts.planner import main; sys.exit(main())')


def check(*arguments, cwd):
    return subprocess.run([sys.executable, '-c', RUN, *map(str, arguments)], text=True, cwd=cwd,
                          capture_output=True, timeout=DEADLINE, check=False)


@pytest.mark.parametrize('name', ['go1_leg', 'kr16_2_first3', 'puma560_first3', 'tilted_arm',
                                  'trifinger_pro', 'uarm_swift_pro'])
def test_the_package_s_arms_can_be_planned_for(tmp_path, name):
    found = check('--check', f'{name}.urdf', '--joint-limits', f'{name}_limits.yaml', cwd=tmp_path)
    assert (found.returncode, found.stderr) == (0, '')
    assert found.stdout.startswith(f'{name}.urdf: three joints from link base to link tip\n')
    assert found.stdout.endswith('this arm can be planned for\n')
    assert 'no limit' not in found.stdout


def test_missing_limits_and_oddities_are_warned_of(tmp_path):
    found = check('--check', 'puma560_first3.urdf', '--base-frame', 'base', '--tip-frame', 'tip',
                  cwd=tmp_path)
    assert found.returncode == 0
    assert "warning: joint 'joint_1': velocity 1000 rad/s is taken for no limit\n" in found.stdout
    assert "warning: link 'link_1' has an impossible inertia" in found.stdout
    assert 'a planner that needs one takes default_max_acceleration, 1.0 rad/s^2' in found.stdout


def test_parameters_beside_the_urdf_count(tmp_path):
    def held(*more):
        found = check('--check', 'kr16_2_first3.urdf', *more, cwd=tmp_path)
        assert (found.returncode, found.stderr) == (0, '')
        return found.stdout.partition('  joint_1: up to ')[2].partition(' of ')[0]

    assert held() == '0'  # its axis is vertical
    sideways = held('--ros-args', '-p', 'gravity:=[9.81, 0.0, 0.0]')
    assert float(sideways) > 100.0
    (tmp_path / 'side.yaml').write_text(
        '/**: {ros__parameters: {gravity: [9.81, 0.0, 0.0]}}')
    assert held('--ros-args', '--params-file', 'side.yaml') == sideways


@pytest.mark.parametrize(('arguments', 'code', 'text'), [
    (('--check', 'go1_leg.urdf', '--ros-args', '-p', 'gravity:=down'), 1, "gravity is 'down', "),
    (('--check', ROOT / 'test/data/arms/planar_arm.urdf'), 1,
     "planar_arm.urdf: joint axes 'joint_1' and 'joint_2' are parallel: "),
    (('--check', 'none.urdf'), 1, "planner: --check: no file 'none.urdf' in "),
    (('--check', 'x' * 5000), 1, "planner: --check is 'xxx"),
    (('--check', '<robot name="x"/>'), 1, 'planner: --check: there is no link'),
    (('--check', 'go1_leg.urdf', '--joint-limits', 'none.yaml'), 1,
     "planner: no file 'none.yaml' in "),
    (('--check', 'go1_leg.urdf', '--tip-frame', 'tap'), 1, "no link 'tap' for the tip, the "),
    (('--check', 'go1_leg.urdf', '--joint-limits', 'thesis_arm.yaml'), 1,
     'thesis_arm.yaml: /** is unknown'),
    (('--check', CONFIG / 'thesis_arm.yaml'), 1, "no URDF, whose text begins with '<'"),
    (('--tip-frame', 'tip'), 2, '--tip-frame goes with --check; the node has the parameter')])
def test_refusals_are_one_line(tmp_path, arguments, code, text):
    found = check(*arguments, cwd=tmp_path)
    assert (found.returncode, found.stdout) == (code, '')
    assert text in found.stderr
    assert found.stderr.count('\n') == 1


def test_help_lists_every_planner_id_in_a_line(tmp_path):
    lines = [line.split(maxsplit=1) for line in check('--help', cwd=tmp_path).stdout.splitlines()]
    for planner_id, summary in method_summaries().items():
        assert [planner_id, summary] in lines
