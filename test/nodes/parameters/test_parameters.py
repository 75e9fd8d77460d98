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

"""Parameters: the table, the shipped files, and what a running node accepts."""

from __future__ import annotations

from math import inf, nan

from helpers.own_limits import own_limits
from helpers.places import CONFIG
import numpy as np
import pytest
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
from rclpy.node import Node
from rclpy.parameter import Parameter
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import JOINT_NAMES, RobotModel
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.nodes.parameters.configuration import ArmConfig, PlannerConfig
from rrr_traj_planner.nodes.parameters.declared import DeclaredParameters, descriptor
from rrr_traj_planner.nodes.parameters.table import ARM, check_value, MOTION, PLANNER, rows_of
import yaml

BUILD = {PLANNER: PlannerConfig.from_values, ARM: ArmConfig.from_values}


def flat(tree, prefix=''):
    for key, value in tree.items():
        if isinstance(value, dict):
            yield from flat(value, f'{prefix}{key}.')
        else:
            yield prefix + key, value


def from_file(name):
    return dict(flat(yaml.safe_load((CONFIG / name).read_text())['/**']['ros__parameters']))


def defaults(role):
    return {name: row.default for name, row in rows_of(role, JOINT_NAMES).items()}


def declared(ros, role=ARM, changed=lambda config: None, **overrides):
    node = ros.add(Node('configured', context=ros.context, parameter_overrides=[
        Parameter(name, value=value) for name, value in overrides.items()]))
    return DeclaredParameters(node, role, BUILD[role], changed)


def double(name, value):
    return ParameterMessage(name=name, value=ParameterValue(
        type=ParameterType.PARAMETER_DOUBLE, double_value=value))


def set_one(ros, name, value):
    answer = ros.call(SetParameters, 'configured/set_parameters',
                      SetParameters.Request(parameters=[double(name, value)]))
    return answer.results[0]


# The table and the files


def test_file_names_every_parameter_with_its_default():
    every = {**defaults(PLANNER), **defaults(ARM), **defaults(MOTION)}
    assert every.pop('gravity') == [0.0, 0.0, -every['arm.gravity']]  # either, never both
    assert from_file('thesis_arm.yaml') == every


def test_stronger_arm_differs_in_joint_2_s_effort_alone():
    thesis, stronger = from_file('thesis_arm.yaml'), from_file('thesis_arm_joint_2_250.yaml')
    assert stronger == {**thesis, 'joint_limits.joint_2.max_effort': 250.0}


@pytest.mark.parametrize('name', ['table_6_1.yaml', 'table_6_3.yaml'])
def test_via_point_files_name_their_arm(name):
    task = yaml.safe_load((CONFIG / name).read_text())
    assert (CONFIG / task['arm']).is_file()
    assert task['planner_id'] == 'cycloid'
    assert np.shape(task['via_points']) == (3, 3)


def test_defaults_are_the_thesis_s_arm():
    config = ArmConfig.from_values(defaults(ARM))
    for field in ('axis', 'point', 'tip', 'mass', 'centre', 'inertia'):
        np.testing.assert_array_equal(
            getattr(config.settings.model.chain, field), getattr(RobotModel().chain, field))
    for field in ('gravity', 'joint_names'):
        np.testing.assert_array_equal(
            getattr(config.settings.model, field), getattr(RobotModel(), field))
    for field, value in vars(JointLimits()).items():
        np.testing.assert_array_equal(getattr(config.settings.limits, field), value)


def test_arm_starts_at_table_6_1_s_first_point():
    config = ArmConfig.from_values(defaults(ARM))
    tip = forward_kinematics(config.settings.model, config.initial_positions)
    np.testing.assert_allclose(tip, (1.02, 0.59, 0.97), atol=1e-12)


@pytest.mark.parametrize('role', [PLANNER, ARM])
def test_defaults_keep_their_own_rules(role):
    for row in rows_of(role, JOINT_NAMES).values():
        check_value(row, row.default)
    BUILD[role](defaults(role))


def test_every_parameter_is_described():
    for row in {**rows_of(PLANNER, JOINT_NAMES), **rows_of(ARM, JOINT_NAMES)}.values():
        shown = descriptor(row)
        assert shown.description and shown.additional_constraints
        if isinstance(row.default, float):
            if row.name not in ('controller.damping_ratio', 'real_time_factor'):
                assert shown.description.endswith(f'[{row.unit}]') and row.unit
            assert shown.floating_point_range[0].to_value == row.high < inf


# Values


@pytest.mark.parametrize(('name', 'value', 'text'), [
    ('arm.d4', -1.0, 'arm.d4 is -1 m, must be in [0.001, 100] m'),
    ('arm.d4', 5, 'arm.d4 is 5, must be in [0.001, 100] m (written with a point, as 5.0)'),
    ('arm.d4', nan, 'arm.d4 is nan m, must be in [0.001, 100] m'),
    ('arm.mass', [1.0, -2.0, 3.0], 'arm.mass[1] is -2 kg, must be in [0, 100000] kg'),
    ('arm.mass', [1.0, 2.0],
     'arm.mass has 2 values, [1.0, 2.0], must be 3 numbers in [0, 100000] kg'),
    ('arm.mass', [1, 2, 3], 'arm.mass is [1, 2, 3], must be 3 numbers in [0, 100000] kg '
     '(written with a point, as 5.0)'),
    ('arm.mass', 3.0, 'arm.mass is 3.0, must be 3 numbers in [0, 100000] kg '
     '(written with a point, as 5.0)'),
    ('joint_limits.joint_1.has_jerk_limits', 1.0,
     'joint_limits.joint_1.has_jerk_limits is 1.0, must be true or false'),
    ('encoder.seed', -1, 'encoder.seed is -1, must be in [0, 2.14748e+09]'),
    ('encoder.seed', 1.0,
     'encoder.seed is 1.0, must be in [0, 2.14748e+09] (a whole number)'),
    ('payload.mass', -2.0, 'payload.mass is -2 kg, must be in [0, 10000] kg'),
    ('joint_names', ['a'], "joint_names has 1 value, ['a'], must be 3 distinct texts")])
def test_wrong_values_are_named_with_their_range(name, value, text):
    with pytest.raises(InvalidInputError) as caught:
        check_value(rows_of(ARM, JOINT_NAMES)[name], value)
    assert str(caught.value) == text


@pytest.mark.parametrize(('changes', 'text'), [
    ({'joint_limits.joint_2.min_position': 4.0},
     'joint_limits.joint_2.min_position is 4 rad, must be below '
     'joint_limits.joint_2.max_position, 3.14159 rad'),
    ({'initial_positions': [34.0, 57.0, 17.0]},
     'initial_positions[0] is 34 rad, must be in [0, 1.5708] rad, the limits of joint_1 '
     '(in degrees?)'),
    ({'initial_positions': [0.5, 4.0, 0.0]},
     'initial_positions[1] is 4 rad, must be in [0, 3.14159] rad, the limits of joint_2'),
    ({'controller.natural_frequency': 200.0, 'controller.damping_ratio': 5.0},
     'controller.natural_frequency is 200 rad/s, must be at most 100 rad/s with '
     'controller.damping_ratio 5 and physics_step 0.001 s'),
    ({'encoder.noise': 1e-4, 'encoder.bandwidth': 50.0},
     'encoder.bandwidth is 50 rad/s, must be at least 97.082 rad/s with '
     'controller.natural_frequency 30 rad/s and controller.damping_ratio 1'),
    ({'arm.mass': [40.0, 16.0, 0.0], 'arm.inertia_3': [0.0, 0.0, 0.0]},
     'link 3 has no inertia about joint axis 3')])
def test_values_that_contradict_each_other_are_refused(changes, text):
    with pytest.raises(InvalidInputError) as caught:
        ArmConfig.from_values({**defaults(ARM), **changes})
    assert str(caught.value) == text


def test_a_limit_that_is_switched_off_does_not_bind():
    config = PlannerConfig.from_values(
        {**defaults(PLANNER), 'joint_limits.joint_2.has_effort_limits': False})
    assert config.limits.max_effort.tolist() == [150.0, inf, 200.0]


def test_options_of_the_arm_reach_its_settings_by_joint():
    config = ArmConfig.from_values({
        **defaults(ARM), 'payload.mass': 2.0, 'payload.known_to_controller': True,
        'friction.viscous': [1.0, 2.0, 3.0], 'friction.coulomb': [4.0, 5.0, 6.0],
        'soft_stops.width': 0.1, 'encoder.resolution': 1e-4, 'encoder.seed': 5,
        'constraints.joint_2.trajectory': 0.2, 'constraints.joint_3.goal': 0.3,
        'constraints.goal_time': 0.4, 'cmd_timeout': 0.5, 'allow_partial_joints_goal': True})
    settings, tolerances = config.settings, config.settings.tolerances
    assert (settings.payload.mass, settings.payload.known_to_controller) == (2.0, True)
    assert settings.model.friction.viscous.tolist() == [1.0, 2.0, 3.0]
    assert settings.model.friction.coulomb.tolist() == [4.0, 5.0, 6.0]
    assert (settings.soft_stops.width, settings.soft_stops.stiffness) == (0.1, 1e4)
    assert (settings.encoder.resolution, settings.encoder.seed) == (1e-4, 5)
    assert tolerances.trajectory.tolist() == [0.0, 0.2, 0.0]
    assert tolerances.goal.tolist() == [0.0, 0.0, 0.3]
    assert tolerances.stopped_velocity.tolist() == [0.01, 0.01, 0.01]
    assert (tolerances.goal_time, tolerances.cmd_timeout) == (0.4, 0.5)
    assert config.rules == (True, False)


# A running node


def test_node_without_a_file_has_the_defaults(ros):
    config = declared(ros, PLANNER).config
    assert (config.sample_period, config.default_planner_id) == (0.01, 'cycloid')


def test_limits_go_by_the_joints_names(ros):
    parameters = declared(ros, **{
        **own_limits('base', 'shoulder', 'elbow'), 'joint_limits.shoulder.max_effort': 250.0})
    assert parameters.config.settings.limits.max_effort.tolist() == [150.0, 250.0, 200.0]
    assert parameters.config.settings.model.joint_names == ('base', 'shoulder', 'elbow')


@pytest.mark.parametrize(('name', 'value', 'text'), [
    ('arm.d1', 1000.0, r'parameter arm.d1 is 1000 m, must be in \[-100, 100\] m'),
    ('arm.d1', 1, r'parameter arm.d1 is 1, must be .* as 5.0'),
    ('joint_names', ['a', 'a', 'b'], r"parameter joint_names is \['a', 'a', 'b'\], must be"),
    ('joint_limits.joint_1.max_position', -1.0, r'joint_1.min_position is 0 rad, must be below')])
def test_wrong_override_stops_the_node(ros, name, value, text):
    with pytest.raises(InvalidInputError, match=text):
        declared(ros, **{name: value})


def test_accepted_change_reaches_the_node(ros):
    changes = []
    parameters = declared(ros, changed=changes.append)
    assert set_one(ros, 'joint_limits.joint_2.max_effort', 250.0).successful
    assert changes == [parameters.config]
    assert parameters.config.settings.limits.max_effort[1] == 250.0


@pytest.mark.parametrize(('name', 'value', 'texts'), [
    ('publish_rate', 5000.0, ('publish_rate', 'Min: 1.0, Max: 1000.0', 'value: 5000.0')),
    ('publish_rate', nan, ('publish_rate', 'Min: 1.0, Max: 1000.0', 'value: nan')),
    ('joint_limits.joint_1.min_position', 2.0, (
        'joint_limits.joint_1.min_position is 2 rad, must be below', '1.5708 rad')),
    ('joint_limits.joint_1.min_position', 1.0, (
        'initial_positions[0] is 0.524409 rad, must be in [1, 1.5708] rad',)),
    ('arm.d1', 0.4, ('read-only', 'arm.d1'))])
def test_refused_change_says_why_and_changes_nothing(ros, name, value, texts):
    changes = []
    parameters = declared(ros, changed=changes.append)
    before = parameters.config
    result = set_one(ros, name, value)
    assert not result.successful
    for text in texts:
        assert text in result.reason
    assert parameters.config is before
    assert changes == []


def test_changes_that_fit_only_together_are_made_together(ros):
    parameters = declared(ros, PLANNER)
    names = [f'joint_limits.joint_1.{end}_position' for end in ('min', 'max')]
    answer = ros.call(
        SetParametersAtomically, 'configured/set_parameters_atomically',
        SetParametersAtomically.Request(parameters=[
            double(name, value) for name, value in zip(names, (2.0, 3.0))]))
    assert answer.result.successful, answer.result.reason
    limits = parameters.config.limits
    assert (limits.min_position[0], limits.max_position[0]) == (2.0, 3.0)
