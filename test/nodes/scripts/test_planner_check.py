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

from helpers.places import CONFIG, ROOT
from helpers.script_calls import script_calls
import pytest
from rrr_traj_planner.planners.method_summaries import method_summaries


@pytest.fixture(scope='module')
def check():
    yield from script_calls('planner', 'rclpy', 'rcl_interfaces')


@pytest.mark.parametrize('name', ['go1_leg', 'kr16_2_first3', 'puma560_first3', 'tilted_arm',
                                  'trifinger_pro', 'uarm_swift_pro'])
def test_the_package_s_arms_can_be_planned_for(check, tmp_path, name):
    code, output, errors = check(
        '--check', f'{name}.urdf', '--joint-limits', f'{name}_limits.yaml', cwd=tmp_path)
    assert (code, errors) == (0, '')
    assert output.startswith(f'{name}.urdf: three joints from link base to link tip\n')
    assert output.endswith('this arm can be planned for\n')
    assert 'no limit' not in output


def test_missing_limits_and_oddities_are_warned_of(check, tmp_path):
    code, output, _ = check('--check', 'puma560_first3.urdf', '--base-frame', 'base',
                            '--tip-frame', 'tip', cwd=tmp_path)
    assert code == 0
    assert "warning: joint 'joint_1': velocity 1000 rad/s is taken for no limit\n" in output
    assert "warning: link 'link_1' has an impossible inertia" in output
    assert 'a planner that needs one takes default_max_acceleration, 1.0 rad/s^2' in output


def test_parameters_beside_the_urdf_count(check, tmp_path):
    def held(*more):
        code, output, errors = check('--check', 'kr16_2_first3.urdf', *more, cwd=tmp_path)
        assert (code, errors) == (0, '')
        return output.partition('  joint_1: up to ')[2].partition(' of ')[0]

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
def test_refusals_are_one_line(check, tmp_path, arguments, code, text):
    found, output, errors = check(*arguments, cwd=tmp_path)
    assert (found, output) == (code, '')
    assert text in errors
    assert errors.count('\n') == 1


def test_help_lists_every_planner_id_in_a_line(check, tmp_path):
    lines = [line.split(maxsplit=1) for line in check('--help', cwd=tmp_path)[1].splitlines()]
    for planner_id, summary in method_summaries().items():
        assert [planner_id, summary] in lines
