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

"""Arms of URDFs in parameters: what comes from where, which paths refer to what, refusals."""

from __future__ import annotations

from math import inf, pi
from pathlib import Path

from helpers.places import CONFIG
from helpers.urdf_texts import arm, axis, joint, limit, Z
import numpy as np
import pytest
from rclpy.node import Node
from rclpy.parameter import Parameter
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.parameters.arm_source import arm_source
from rrr_traj_planner.nodes.parameters.configuration import ArmConfig, PlannerConfig
from rrr_traj_planner.nodes.parameters.declared import DeclaredParameters
from rrr_traj_planner.nodes.parameters.parameter_files import folder_of_value
from rrr_traj_planner.nodes.parameters.planner_config import config_of
from rrr_traj_planner.nodes.parameters.table import ARM, PLANNER
from rrr_traj_planner.planners.registration import register

TEXT = arm()
LIMITS = """
joint_limits:
  j1: {max_velocity: 2.5, max_acceleration: 6.0, max_effort: 30.0}
  j2: {has_velocity_limits: false, min_position: 0.5}
  other: {max_velocity: 1.0}
"""


def here(name, value):
    return Path.cwd()


def planner(given, folder=CONFIG):
    return config_of({'robot_description': TEXT, **given}, lambda *_: folder)


def with_limits(folder, text=LIMITS):
    (folder / 'limits.yaml').write_text(text)
    return {'joint_limits_file': 'limits.yaml'}


# What comes from where


def test_urdf_alone_gives_names_frames_limits_and_friction():
    text = arm(j1=joint('j1', 'revolute', 'base', 'a', Z + '<dynamics damping="0.3" '
                        'friction="0.2"/>', (0.0, 0.0, 0.3)))
    config = planner({'robot_description': text})
    assert config.model.joint_names == ('j1', 'j2', 'j3')
    assert (config.base_frame, config.tip_frame) == ('base', 'tip')
    assert config.model.friction.viscous.tolist() == [0.3, 0.0, 0.0]
    assert config.model.friction.coulomb.tolist() == [0.2, 0.0, 0.0]
    assert config.model.gravity.tolist() == [0.0, 0.0, -9.81]
    assert config.limits.min_position.tolist() == [-2.0] * 3
    assert config.limits.max_velocity.tolist() == [3.0] * 3
    assert config.limits.max_effort.tolist() == [40.0] * 3
    assert config.limits.max_acceleration.tolist() == config.limits.max_jerk.tolist() == [inf] * 3
    assert config.model.chain.tip == pytest.approx((0.1 + 0.5 + 0.4, 0.0, 0.3 + 0.2 + 0.1))


def test_parameters_come_before_the_file_of_limits_and_that_before_the_urdf(tmp_path):
    limits = planner({
        **with_limits(tmp_path), 'joint_limits.j1.max_effort': 20.0,
        'joint_limits.j3.max_velocity': 1.5, 'joint_limits.j3.max_position': 1.0}, tmp_path).limits
    assert limits.max_velocity.tolist() == [2.5, inf, 1.5]
    assert limits.max_acceleration.tolist() == [6.0, inf, inf]
    assert limits.max_effort.tolist() == [20.0, 40.0, 40.0]
    assert limits.min_position.tolist() == [-2.0, 0.5, -2.0]
    assert limits.max_position.tolist() == [2.0, 2.0, 1.0]


def test_a_limit_is_switched_on_and_off_by_parameters(tmp_path):
    limits = planner({
        **with_limits(tmp_path), 'joint_limits.j1.has_velocity_limits': False,
        'joint_limits.j2.has_velocity_limits': True}, tmp_path).limits
    assert limits.max_velocity.tolist() == [inf, 3.0, 3.0]


def test_the_file_of_limits_serves_the_thesis_s_arm_too(tmp_path):
    given = with_limits(tmp_path, 'joint_limits:\n  joint_2: {max_effort: 250.0}\n')
    found = config_of(given, lambda *_: tmp_path).limits
    assert found.max_effort.tolist() == [150.0, 250.0, 200.0]


def test_the_file_of_limits_serves_renamed_joints(tmp_path):
    one = ('{min_position: -1.0, max_position: 1.0, max_velocity: 1.0, max_acceleration: 2.0, '
           'max_jerk: 3.0, max_effort: 99.0}')
    given = {'joint_names': ['a', 'b', 'c'], **with_limits(
        tmp_path, 'joint_limits:\n' + ''.join(f'  {name}: {one}\n' for name in 'abc'))}
    assert config_of(given, lambda *_: tmp_path).limits.max_effort.tolist() == [99.0] * 3


def test_joints_without_range_have_none():
    text = arm(j1=joint('j1', 'continuous', 'base', 'a', axis(0, 0, 1) + limit()))
    limits = planner({'robot_description': text}).limits
    assert limits.min_position.tolist() == [-inf, -2.0, -2.0]
    assert limits.max_position.tolist() == [inf, 2.0, 2.0]


def test_a_range_that_the_file_of_limits_switches_off_is_none(tmp_path):
    given = with_limits(tmp_path, 'joint_limits:\n  j2: {has_position_limits: false}\n')
    limits = planner(given, tmp_path).limits
    assert limits.min_position.tolist() == [-2.0, -inf, -2.0]
    assert limits.max_position.tolist() == [2.0, inf, 2.0]
    limits = planner({**given, 'joint_limits.j2.max_position': 1.0}, tmp_path).limits
    assert (limits.min_position[1], limits.max_position[1]) == (-inf, 1.0)


def test_gravity_rotors_friction_and_payload_reach_the_model():
    bare, config = planner({}), planner({
        'gravity': [0.0, 3.0, 4.0], 'rotor_inertia': [0.1, 0.2, 0.3], 'payload.mass': 2.0,
        'friction.viscous': [1.0, 2.0, 3.0]})
    assert config.model.gravity.tolist() == [0.0, 3.0, 4.0]
    assert config.model.rotor_inertia.tolist() == [0.1, 0.2, 0.3]
    assert config.model.chain.mass[2] == bare.model.chain.mass[2] + 2.0
    assert config.model.friction.viscous.tolist() == [1.0, 2.0, 3.0]


def test_thesis_s_arm_takes_either_gravity():
    for given in ({'arm.gravity': 1.62}, {'gravity': [0.0, 0.0, -1.62]}):
        assert config_of(given, lambda *_: CONFIG).model.gravity.tolist() == [0.0, 0.0, -1.62]


def test_frames_of_the_contract_s_names_are_found_others_must_be_named():
    text = arm('<link name="camera"/>', joint('more', 'fixed', 'a', 'camera'))
    assert planner({'robot_description': text}).tip_frame == 'tip'
    renamed = text.replace('"tip"', '"hand"')
    with pytest.raises(InvalidInputError, match=r"not given, .* several leaves: 'hand', 'camera'"):
        planner({'robot_description': renamed})
    assert planner({'robot_description': renamed, 'tip_frame': 'hand'}).tip_frame == 'hand'


def test_arm_starts_at_zero_where_ranges_have_it_else_in_their_middle(tmp_path):
    source = arm_source({'robot_description': TEXT, 'joint_limits.j3.max_position': -1.0,
                         'joint_limits.j2.min_position': 0.5}, here)
    assert source.values['initial_positions'] == [0.0, 1.25, -1.5]
    # With one end only, half a turn from it; without any, at zero.
    source = arm_source({'robot_description': TEXT, 'joint_limits.j2.min_position': 0.5,
                         'joint_limits.j2.max_position': 1000.0,
                         'joint_limits.j3.min_position': -1000.0,
                         'joint_limits.j3.max_position': -7.0}, here)
    assert source.values['initial_positions'] == pytest.approx([0.0, 0.5 + pi, -7.0 - pi])


# Acceleration limits that are missing


@pytest.mark.parametrize(('ids', 'expected'), [
    (('cycloid',), [2.0, 5.0, 2.0]), (('',), [2.0, 5.0, 2.0]),
    (('time_optimal', 'line_arc'), [inf, 5.0, 2.0]),
    (('time_optimal', 'septic'), [2.0, 5.0, 2.0])])
def test_default_acceleration_is_taken_where_a_planner_needs_one(ids, expected):
    config = planner({'default_max_acceleration': 2.0, 'joint_limits.j2.max_acceleration': 5.0,
                      'joint_limits.j3.has_effort_limits': False})
    assert config.limits_for(*ids).max_acceleration.tolist() == expected


def test_default_acceleration_is_not_taken_for_a_new_planner_that_says_so(monkeypatch):
    monkeypatch.setattr('rrr_traj_planner.planners.registration.REGISTERED', {})
    register('limited by torque', needs_acceleration_limit=False)(lambda task: task)
    register('limited by both')(lambda task: task)
    config = planner({'default_max_acceleration': 2.0, 'default_planner_id': 'limited by both'})
    assert config.limits_for('limited by torque').max_acceleration.tolist() == [inf] * 3
    assert config.limits_for('limited by both').max_acceleration.tolist() == [2.0] * 3
    assert config.limits_for('limited by torque', '').max_acceleration.tolist() == [2.0] * 3


def test_missing_acceleration_limits_are_said_and_those_of_the_thesis_s_arm_stay_missing():
    text, = arm_source({'robot_description': TEXT, 'joint_limits.j2.max_acceleration': 5.0}
                       ).warnings
    assert text == ('2 joints without acceleration limit, j1, j3: a planner that needs one takes '
                    'default_max_acceleration, 1.0 rad/s^2')
    config = config_of({'joint_limits.joint_1.has_acceleration_limits': False}, lambda *_: CONFIG)
    assert config.limits_for('cycloid') is config.limits


def test_a_limit_that_the_urdf_lacks_is_warned_of_unless_it_is_given():
    text = arm(j2=joint('j2', 'revolute', 'a', 'b', axis(0, 1, 0) + limit(velocity=0.0)))
    most = {f'joint_limits.{name}.max_acceleration': 1.0 for name in ('j1', 'j2', 'j3')}
    given = {'robot_description': text, **most}
    assert arm_source(given).warnings == (
        "joint 'j2': velocity 0 rad/s is taken for no limit",)
    for answer in ({'max_velocity': 1.0}, {'has_velocity_limits': False}):
        named = {f'joint_limits.j2.{name}': value for name, value in answer.items()}
        assert arm_source({**given, **named}).warnings == ()


@pytest.mark.parametrize(('inside', 'answer', 'left'), [
    ('<limit velocity="3" effort="40"/>', {'min_position': -1.0, 'max_position': 1.0}, []),
    (limit(0, 0), {'min_position': -1.0, 'max_position': 1.0}, []),
    (limit(0, 0), {'max_position': 1.0}, ['is revolute and has the range [0, 0] rad, which is '
                                          'taken for none']),
    (limit(upper=1e4), {'max_position': 1.0}, []),
    (limit(upper=1e4), {'min_position': 1.0}, [': upper 10000 rad is taken for no limit']),
    ('', {'min_position': -1.0, 'max_position': 1.0, 'max_velocity': 1.0, 'max_effort': 1.0}, []),
    ('', {'min_position': -1.0, 'max_position': 1.0, 'max_velocity': 1.0},
     ['has no effort limit'])])
def test_warnings_of_limits_that_are_given_are_left_out(tmp_path, inside, answer, left):
    text = arm(j2=joint('j2', 'revolute', 'a', 'b', axis(0, 1, 0) + inside))
    most = {f'joint_limits.{name}.max_acceleration': 1.0 for name in ('j1', 'j2', 'j3')}
    (tmp_path / 'limits.yaml').write_text('joint_limits:\n  j2:\n' + ''.join(
        f'    {name}: {value}\n' for name, value in answer.items()))
    in_parameters = {f'joint_limits.j2.{name}': value for name, value in answer.items()}
    for given in (in_parameters, {'joint_limits_file': str(tmp_path / 'limits.yaml')}):
        warnings = arm_source({'robot_description': text, **most, **given}).warnings
        assert warnings == tuple(
            f"joint 'j2'{' ' * (text[0] != ':')}{text}" for text in left)


# Refusals


@pytest.mark.parametrize(('given', 'text'), [
    ({'arm.d1': 0.5, 'arm.mass': [1.0, 1.0, 1.0]},
     'robot_description and arm.d1, arm.mass are given: lengths, masses and inertias are the '
     "URDF's"),
    ({'arm.gravity': 9.81}, 'robot_description and arm.gravity are given: lengths, masses and '
     "inertias are the URDF's, and gravity is a parameter of that name"),
    ({'joint_names': ['j2', 'j1', 'j3']},
     "parameter joint_names is ['j2', 'j1', 'j3'], must be ['j1', 'j2', 'j3'], as in the URDF "
     "from link 'base' to link 'tip'; it may be left out"),
    ({'link_names': ['a', 'b', 'x']}, "parameter link_names is ['a', 'b', 'x'], must be "
     "['a', 'b', 'c'], as in the URDF from link 'base' to link 'tip'; it may be left out"),
    ({'tip_frame': 'tap'},
     "parameter robot_description: no link 'tap' for the tip, the nearest name is 'tip'"),
    ({'joint_limits.j1.has_jerk_limits': True},
     'joint_limits.j1.has_jerk_limits is true, and joint_limits.j1.max_jerk is missing: the URDF '
     'has none'),
    ({'joint_limits.joint_1.max_jerk': 1.0}, 'parameter joint_limits.joint_1.max_jerk is unknown, '
     'the nearest known one is joint_limits.j1.max_jerk'),
    ({'joint_limits.j1.min_position': 3.0}, 'joint_limits.j1.min_position is 3 rad, must be below '
     'joint_limits.j1.max_position, 2 rad'),
    ({'robot_description': 5.0}, 'parameter robot_description is 5.0, must be a text'),
    ({'robot_description': 'none.urdf'},
     f"parameter robot_description: no file 'none.urdf' in {CONFIG}, nor among the package's"),
    ({'joint_limits_file': 'none.yaml'},
     f"parameter joint_limits_file: no file 'none.yaml' in {CONFIG}, nor among the package's"),
    ({'joint_limits_file': 'thesis_arm.yaml'},
     f'{CONFIG}/thesis_arm.yaml: /** is unknown, the nearest known key is '),
    ({'robot_description': 'thesis_arm.yaml'},
     f"{CONFIG}/thesis_arm.yaml: no URDF, whose text begins with '<'"),
    ({'robot_description': '<robot name="x"/>'}, 'parameter robot_description: there is no link'),
    ({'robot_description': 'x' * 5000}, 'parameter robot_description is '),
    ({'robot_description': arm(j3=joint('j3', 'fixed', 'b', 'c'))},
     'parameter robot_description: 2 joints between base and tip can turn')])
def test_contradictions_are_refused_by_the_names(given, text):
    with pytest.raises(InvalidInputError) as caught:
        planner(given)
    assert str(caught.value).startswith(text)
    assert len(str(caught.value)) < 800


def test_two_gravities_are_refused():
    with pytest.raises(InvalidInputError, match='^gravity and arm.gravity are both given'):
        config_of({'gravity': [0.0, 0.0, -9.81], 'arm.gravity': 9.81}, lambda *_: CONFIG)


# Paths


def test_a_relative_path_refers_to_the_folder_of_the_file_that_names_it(tmp_path, monkeypatch):
    for name, urdf in (('first', 'a.urdf'), ('second', 'b.urdf')):
        (tmp_path / name).mkdir()
        (tmp_path / name / 'arm.yaml').write_text(
            f'/**:\n  ros__parameters: {{robot_description: {urdf}}}\n')
    monkeypatch.chdir(tmp_path)
    files = [Path('first/arm.yaml'), tmp_path / 'second' / 'arm.yaml', Path('nowhere.yaml')]
    for value, folder in (('a.urdf', 'first'), ('b.urdf', 'second'), ('c.urdf', '')):
        assert folder_of_value(files, '/trajectory_planner', 'robot_description', value) == (
            tmp_path / folder)


def test_sections_of_other_nodes_name_no_path(tmp_path):
    file = tmp_path / 'arm.yaml'
    file.write_text('/simulated_arm:\n  ros__parameters: {robot_description: a.urdf}\n')
    found = [folder_of_value([file], node, 'robot_description', 'a.urdf')
             for node in ('/simulated_arm', '/trajectory_planner')]
    assert found == [tmp_path, Path.cwd()]


# Running nodes


def declared(ros, role, build, files=(), **given):
    node = ros.add(Node('configured', context=ros.context, parameter_overrides=[
        Parameter(name, value=value) for name, value in given.items()]))
    return node, DeclaredParameters(node, role, build, lambda config: None, files)


def test_node_shows_the_urdf_s_text_and_the_limits_in_force(ros, tmp_path):
    (tmp_path / 'my.urdf').write_text(TEXT)
    file = tmp_path / 'arm.yaml'
    file.write_text('/**:\n  ros__parameters: {robot_description: my.urdf, joint_limits_file: '
                    'limits.yaml}\n')
    with_limits(tmp_path)
    node, parameters = declared(
        ros, ARM, ArmConfig.from_values, [file], robot_description='my.urdf',
        joint_limits_file='limits.yaml', **{'joint_limits.j3.max_effort': 9.0})
    values = {name: node.get_parameter(name).value for name in (
        'robot_description', 'joint_limits_file', 'base_frame', 'joint_limits.j1.max_velocity',
        'joint_limits.j2.has_velocity_limits', 'joint_limits.j3.max_effort')}
    assert values == {
        'robot_description': TEXT, 'joint_limits_file': str(tmp_path / 'limits.yaml'),
        'base_frame': 'base', 'joint_limits.j1.max_velocity': 2.5,
        'joint_limits.j2.has_velocity_limits': False, 'joint_limits.j3.max_effort': 9.0}
    assert list(node.get_parameter('joint_names').value) == ['j1', 'j2', 'j3']
    assert node.describe_parameter('robot_description').read_only
    config = parameters.config
    assert config.urdf == TEXT
    assert config.frames == ('base', ('a', 'b', 'c'), 'tip')
    assert config.settings.limits.max_effort.tolist() == [30.0, 40.0, 9.0]


def test_both_nodes_have_one_arm(ros):
    given = {'robot_description': TEXT, 'payload.mass': 1.0}
    _, planner_s = declared(ros, PLANNER, PlannerConfig.from_values, **given)
    _, arm_s = declared(ros, ARM, ArmConfig.from_values, **given)
    ours, theirs = planner_s.config.model.chain, arm_s.config.settings.loaded_model.chain
    for name in ('axis', 'point', 'tip', 'mass', 'centre', 'inertia'):
        np.testing.assert_array_equal(getattr(ours, name), getattr(theirs, name))


def test_arm_s_controller_may_know_the_friction(ros):
    _, parameters = declared(ros, ARM, ArmConfig.from_values, robot_description=TEXT,
                             **{'friction.known_to_controller': True})
    assert parameters.config.settings.model.friction.known_to_controller


def test_arm_without_masses_can_be_planned_for_and_not_simulated(ros):
    bare = arm(a='<link name="a"/>', b='<link name="b"/>', c='<link name="c"/>')
    _, parameters = declared(ros, PLANNER, PlannerConfig.from_values, robot_description=bare)
    assert 'no link has a mass' in parameters.warnings
    with pytest.raises(InvalidInputError, match='give masses or rotor_inertia'):
        declared(ros, ARM, ArmConfig.from_values, robot_description=bare)
    declared(ros, ARM, ArmConfig.from_values, robot_description=bare,
             rotor_inertia=[0.1, 0.1, 0.1])


def test_friction_that_leaves_no_torque_for_motion_is_refused_with_the_parameters():
    with pytest.raises(InvalidInputError, match='joint_2 has a Coulomb friction of 200 N m, limit '
                                                '200 N m, which leaves no torque for motion'):
        config_of({'friction.coulomb': [0.0, 200.0, 0.0]}, lambda *_: CONFIG)
