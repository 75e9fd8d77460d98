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

"""MoveIt's joint_limits.yaml is read as it is; what it says wrongly is named."""

from __future__ import annotations

from math import pi

import pytest
from rrr_traj_planner.core.arm.limits import NO_RANGE
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.parameters.joint_limits_file import read_joint_limits
from rrr_traj_planner.nodes.parameters.table import PLANNER, rows_of

# As MoveIt's setup assistant writes it, limits on acceleration switched off.
WRITTEN = """\
# joint_limits.yaml allows the dynamics properties specified in the URDF to be overwritten
default_velocity_scaling_factor: 0.1
default_acceleration_scaling_factor: 0.1

joint_limits:
  shoulder:
    has_velocity_limits: true
    max_velocity: 3
    has_acceleration_limits: false
    max_acceleration: 0
  finger:
    has_velocity_limits: true
    max_velocity: nonsense
"""


def values_of(*arguments):
    return read_joint_limits(*arguments).values


def of_joint(*lines):
    return '\n'.join(('joint_limits:', '  elbow:', *(f'    {line}' for line in lines), ''))


def refused(text, joints=None):
    with pytest.raises(InvalidInputError) as error:
        values_of(text, joints)
    return str(error.value)


def test_what_the_setup_assistant_writes_is_read():
    assert values_of(WRITTEN, ['shoulder', 'elbow', 'wrist']) == {
        'joint_limits.shoulder.has_velocity_limits': True,
        'joint_limits.shoulder.max_velocity': 3.0,
        'joint_limits.shoulder.has_acceleration_limits': False}


def test_every_limit_becomes_the_parameter_of_its_name():
    found = values_of(of_joint(
        'has_position_limits: true', 'min_position: -1', 'max_position: 2.5',
        *(f'has_{kind}_limits: true\n    max_{kind}: {value}' for kind, value in (
            ('velocity', 1.5), ('acceleration', '1e1'), ('jerk', '2.0e+2'), ('effort', '.5e2')))))
    assert found.keys() == {
        name for name in rows_of(PLANNER, ['elbow']) if name.startswith('joint_limits.')}
    assert [x for x in found.values() if x is not True] == [-1.0, 2.5, 1.5, 10.0, 200.0, 50.0]
    assert all(type(x) in (float, bool) for x in found.values())


def test_what_is_switched_off_is_left_out_and_a_range_is_none():
    assert values_of(of_joint(
        'has_position_limits: false', 'min_position: 0', 'max_position: 0',
        'has_effort_limits: false', 'max_effort: 0', 'max_jerk: 7')) == {
            'joint_limits.elbow.min_position': -NO_RANGE,
            'joint_limits.elbow.max_position': NO_RANGE,
            'joint_limits.elbow.has_effort_limits': False, 'joint_limits.elbow.max_jerk': 7.0}


def test_angles_may_be_in_degrees_as_moveit_reads_them():
    assert values_of(of_joint('max_velocity: !degrees 90', 'max_jerk: !radians 2')) == {
        'joint_limits.elbow.max_velocity': pytest.approx(pi / 2), 'joint_limits.elbow.max_jerk': 2}


@pytest.mark.parametrize('text', ['\n', 'joint_limits:\n', 'joint_limits: {}\n',
                                  'joint_limits:\n  a:\n'])
def test_a_file_may_say_nothing(text):
    assert values_of(text) == {}


ONES = '1' * 28 + '...' + '1' * 29  # as long numbers are shown


@pytest.mark.parametrize(('line', 'message'), [
    ('max_velocity: fast', "joint_limits.elbow.max_velocity is 'fast', must be in [1e-06, 1000] "
     'rad/s (written with a point, as 5.0)'),
    ('max_velocity: "3.0"', "joint_limits.elbow.max_velocity is '3.0', must be in"),
    ('max_jerk: true', 'joint_limits.elbow.max_jerk is True, must be in [1e-06, 1e+06] rad/s^3'),
    ('max_jerk:', 'joint_limits.elbow.max_jerk is None, must be in [1e-06, 1e+06] rad/s^3'),
    ('max_effort: .nan', 'joint_limits.elbow.max_effort is nan N m, must be in [1e-06, 100000] '
     'N m'),
    ('max_effort: .inf', 'joint_limits.elbow.max_effort is inf N m, must be in [1e-06, 100000] '
     'N m'),
    ('max_acceleration: 0', 'joint_limits.elbow.max_acceleration is 0 rad/s^2, must be in [1e-06, '
     '10000] rad/s^2'),
    ('max_acceleration: -2', 'joint_limits.elbow.max_acceleration is -2 rad/s^2, must be in'),
    ('min_position: [1]', 'joint_limits.elbow.min_position is [1], must be in [-1000, 1000] rad'),
    ('has_jerk_limits: 1', 'joint_limits.elbow.has_jerk_limits is 1, must be true or false'),
    ('has_position_limits: "no"',
     "joint_limits.elbow.has_position_limits is 'no', must be true or false"),
    ('max_speed: 1', 'joint_limits.elbow.max_speed is unknown, the nearest known key is '),
    ('max_velocty: 1', 'joint_limits.elbow.max_velocty is unknown, the nearest known key is '
     'max_velocity'),
    ('max_jerk: 1\n    max_jerk: 2', 'line 4: max_jerk is repeated'),
    ('max_jerk: ' + '1' * 401,
     f'joint_limits.elbow.max_jerk is {ONES}, must be in [1e-06, 1e+06] rad/s^3'),
    ('max_jerk: 0x' + 'f' * 400, 'joint_limits.elbow.max_jerk is '),
    ('has_jerk_limits: ' + '1' * 401,
     f'joint_limits.elbow.has_jerk_limits is {ONES}, must be true or false'),
    ('max_jerk: ' + '1' * 4400, f"line 3: '{ONES[1:-1]}' is not of type int"),
    ('max_jerk: 2001-99-99', "line 3: '2001-99-99' is not of type timestamp"),
    ('max_jerk: !!bool x', "line 3: 'x' is not of type bool"),
    ('max_jerk: !!timestamp x', "line 3: 'x' is not of type timestamp"),
    ('[max_jerk]: 1', "line 3: key ['max_jerk'] must be a text"),
    ('{max_jerk: 1}: 1', "line 3: key {'max_jerk': 1} must be a text"),
    ('max_jerk: ' + '[' * 3000, 'nested too deeply'),
    ('max_jerk: !degrees far', "line 3: 'far' is not a number"),
    ('max_jerk: [1', 'line '),
    ('min_position: 2\n    max_position: 1', 'joint_limits.elbow.min_position is 2 rad, must be '
     'below max_position, 1 rad')])
def test_what_is_wrong_is_named_with_joint_key_value_and_range(line, message):
    assert refused(of_joint(line)).startswith(message)


@pytest.mark.parametrize(('text', 'message'), [
    ('joint_limit:\n  a: {}\n', 'joint_limit is unknown, the nearest known key is joint_limits'),
    ('{[a]: 1}\n', "line 1: key ['a'] must be a text"),
    ('- 1\n- 2\n', 'the file is [1, 2], must have keys and values'),
    ('joint_limits: 3\n', 'joint_limits is 3, must have keys and values'),
    ('joint_limits:\n  a: 3\n', 'joint_limits.a is 3, must have keys and values'),
    ('default_velocity_scaling_factor: 2\n',
     'default_velocity_scaling_factor is 2.0, must be in (0, 1]'),
    ('default_velocity_scaling_factor: full\n', "default_velocity_scaling_factor is 'full', must"),
    ('a: !!python/object:os.system x\n', 'line 1: could not determine a constructor'),
    ('a: \x01\n', 'unacceptable character')])
def test_what_is_no_such_file_is_refused(text, message):
    assert refused(text).startswith(message)


def test_a_joint_may_be_called_a_number():
    assert values_of('joint_limits:\n  1: {max_jerk: 2}\n', ['1', '2', '3']) == {
        'joint_limits.1.max_jerk': 2.0}


def test_joints_of_other_names_alone_are_refused():
    assert refused(of_joint('max_jerk: 1'), ['j1', 'j2', 'j3']) == (
        "joint_limits are of 'elbow', must be of the arm's joints, 'j1', 'j2', 'j3'")


def test_a_file_is_named_in_errors(tmp_path):
    file = tmp_path / 'joint_limits.yaml'
    file.write_text('\ufeff' + WRITTEN, encoding='utf-8')
    assert values_of(str(file), ['shoulder']) == values_of(WRITTEN, ['shoulder'])
    assert refused(file).startswith(
        f"{file}: joint_limits.finger.max_velocity is 'nonsense', must be in")
    assert refused(tmp_path / 'none.yaml').startswith(f'{tmp_path / "none.yaml"}: [Errno 2]')
    assert refused(tmp_path).startswith(f'{tmp_path}: [Errno 21]')
    file.write_text('{[a]: 1}')
    assert refused(file) == f"{file}: line 1: key ['a'] must be a text"
    file.write_text(of_joint('max_jerk: ' + '1' * 401))
    assert refused(file).startswith(f'{file}: joint_limits.elbow.max_jerk is 1111')
    file.write_bytes(b'\xff\xfe')
    assert refused(file).startswith(f"{file}: 'utf-8' codec")


def test_scaling_factors_are_warned_of_unless_they_are_1():
    assert read_joint_limits(WRITTEN, ['shoulder']).warnings == (
        'default_velocity_scaling_factor 0.1 has no effect: a request has its own '
        'velocity_scaling',
        'default_acceleration_scaling_factor 0.1 has no effect: a request has its own '
        'acceleration_scaling')
    assert read_joint_limits('default_velocity_scaling_factor: 1\n').warnings == ()


@pytest.mark.parametrize(('lines', 'most'), [
    (('max_acceleration: 4.0', 'max_deceleration: -3.0'), 3.0),
    (('max_acceleration: 4', 'max_deceleration: 5'), 4.0),
    (('has_deceleration_limits: true', 'max_deceleration: 5'), 5.0),
    (('max_acceleration: 4.0', 'has_deceleration_limits: false', 'max_deceleration: -3.0'), 4.0),
    (('has_acceleration_limits: false', 'max_acceleration: 4.0', 'max_deceleration: -3.0'), 3.0)])
def test_a_deceleration_limit_is_one_of_acceleration(lines, most):
    assert values_of(of_joint(*lines))['joint_limits.elbow.max_acceleration'] == most


@pytest.mark.parametrize('value', ['soft', '0', '-0.0', '.nan', '[1.0]', 'true'])
def test_deceleration_that_is_no_limit_is_refused(value):
    assert refused(of_joint(f'max_deceleration: {value}')).startswith(
        'joint_limits.elbow.max_deceleration is ')


def test_limits_of_controllers_have_no_effect():
    assert values_of(of_joint('angle_wraparound: false', 'has_soft_limits: true', 'k_velocity: 10',
                              'soft_lower_limit: -1.0', 'max_velocity: 2')) == {
        'joint_limits.elbow.max_velocity': 2.0}


@pytest.mark.parametrize('name', ['on', 'No', '1', '0x1F', '1.50', 'null', '2026-01-01', '~'])
def test_joints_are_called_as_the_file_writes_them(name):
    assert values_of(f'joint_limits:\n  {name}: {{max_velocity: 2}}\n', [name]) == {
        f'joint_limits.{name}.max_velocity': 2.0}
