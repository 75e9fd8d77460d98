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

"""Parameters of wrong names, and joints that would get another arm's limits."""

from __future__ import annotations

import re

from helpers.own_limits import own_limits
import pytest
from rrr_traj_planner.core.arm.model import JOINT_NAMES
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.parameters.override_checks import check_given, unused_warnings

OWN = own_limits('base', 'lift', 'bend')
NAMES = OWN['joint_names']


def without(*names):
    return {name: value for name, value in OWN.items() if name not in names}


@pytest.mark.parametrize(('name', 'nearest'), [
    ('joint_limits.joint_1.max_velocty', 'joint_limits.joint_1.max_velocity'),
    ('joint_limits.joint_2.has_jerk_limit', 'joint_limits.joint_2.has_jerk_limits'),
    ('joint_limits.joint_4.max_jerk', 'joint_limits.joint_[123].max_jerk'),
    ('joint_limits.max_position', 'joint_limits.joint_[123].max_position'),
    ('joint_limits', 'joint_limits.joint_[123].[a-z_]+'),
    ('arm.a_2', 'arm.a2'), ('arm.masses', 'arm.mass'), ('arm', 'arm.[a-z0-9]+'),
    ('payload.mas', 'payload.mass'), ('friction.coulombs', 'friction.coulomb'),
    ('constraints.goaltime', 'constraints.goal_time'),
    ('constraints.joint_3.path', 'constraints.joint_3.[a-z]+'),
    ('controller.frequency', 'controller.natural_frequency'),
    ('encoder.noize', 'encoder.noise'), ('soft_stops.stifness', 'soft_stops.stiffness'),
    ('poly_414.tacc', 'poly_414.t_acc'), ('publish_rate.Hz', 'publish_rate')])
def test_unknown_name_in_a_group_is_refused_with_the_nearest(name, nearest):
    with pytest.raises(InvalidInputError) as caught:
        check_given({name: 1.0, 'sample_period': 0.1}, JOINT_NAMES)
    assert re.fullmatch(f'parameter {re.escape(name)} is unknown, the nearest known one is '
                        f'{nearest}', str(caught.value))


def test_many_unknown_names_are_counted():
    with pytest.raises(InvalidInputError, match='arm.c is unknown, .*; 2 more are unknown$'):
        check_given(dict.fromkeys([f'arm.{x}' for x in 'abcde'], 0.0), JOINT_NAMES)


def test_limits_given_in_full_are_taken_whatever_else_is_left_out():
    check_given(OWN, NAMES)
    check_given({}, JOINT_NAMES)
    check_given({**without('joint_limits.bend.max_jerk', 'joint_limits.bend.has_velocity_limits'),
                 'joint_limits.bend.has_jerk_limits': False}, NAMES)


@pytest.mark.parametrize(('left_out', 'text'), [
    (('joint_limits.lift.max_jerk',),
     "joint_limits.lift lacks max_jerk: joint_names[1] is 'lift'"),
    (('joint_limits.bend.min_position', 'joint_limits.bend.max_effort'),
     "joint_limits.bend lacks min_position, max_effort: joint_names[2] is 'bend'")])
def test_joint_whose_limits_would_be_another_arm_s_is_refused(left_out, text):
    with pytest.raises(InvalidInputError) as caught:
        check_given(without(*left_out), NAMES)
    assert text in str(caught.value)
    assert 'base' not in str(caught.value)


def test_joints_renamed_and_limits_not_are_refused_by_both_names():
    given = {**own_limits(*JOINT_NAMES), 'joint_names': NAMES}
    with pytest.raises(InvalidInputError) as caught:
        check_given(given, NAMES)
    for name in NAMES:
        assert f'joint_limits.{name} lacks min_position, max_position' in str(caught.value)
    assert ('parameter joint_limits.joint_1.min_position is unknown, the nearest known one is '
            'joint_limits.') in str(caught.value)


def test_joints_in_another_order_need_their_own_limits():
    with pytest.raises(InvalidInputError, match='joint_limits.joint_2 lacks .*joint_limits.jo'):
        check_given({}, ['joint_2', 'joint_1', 'joint_3'])


@pytest.mark.parametrize(('name', 'hint'), [
    ('foo', ''), ('speed.max', ''), ('sample_priod', '; did you mean "sample_period"?'),
    ('max_via_point', '; did you mean "max_via_points"?'),
    ('max_velocty', '; did you mean "joint_limits.base.max_velocity" or '
     '"joint_limits.lift.max_velocity" or "joint_limits.bend.max_velocity"?'),
    ('base.min_positions', '; did you mean "joint_limits.base.min_position"?'),
    ('d4', '; did you mean "arm.d4"?')])
def test_name_that_neither_node_uses_is_warned_of(name, hint):
    known = ['publish_rate', 'sample_period', 'joint_names']  # each of some node
    assert unused_warnings([name, *known, *OWN], NAMES) == [
        f'parameter {name} is used by no node{hint}']


@pytest.mark.parametrize('name', [
    'use_sim_time', 'qos_overrides./parameter_events.publisher.depth',
    'start_type_description_service'])
def test_ros_s_own_names_are_left_alone(name):
    check_given({name: 1}, JOINT_NAMES)
    assert unused_warnings([name], JOINT_NAMES) == []
