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

"""The summary of a URDF's arm: geometry in words, reach, missing limits, refusals."""

from __future__ import annotations

from functools import cache
import re

from helpers.places import ROOT
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.urdf_arm import read_urdf
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque
from rrr_traj_planner.core.errors import LimitViolationError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.planners.arm_summary import summary

ARMS = ROOT / 'test/data/arms'
NONE = (np.inf,) * 3
TOLD = 1e-3      # of the arm's size or a torque, to which extremes are told
SAMPLED = 0.02   # of the same, by which many random poses may miss extremes


def described(name, gravity=(0.0, 0.0, -9.81), **limits):
    """Return an arm of a public description, its model and its limits."""
    arm = read_urdf(ARMS / f'{name}.urdf')
    model = RobotModel(arm.chain, gravity, friction=arm.friction, joint_names=arm.joint_names)
    return arm, model, JointLimits(**{
        'max_acceleration': NONE, 'max_jerk': NONE, **{kind: getattr(arm, kind) for kind in (
            'min_position', 'max_position', 'max_velocity', 'max_effort')}, **limits})


@cache
def lines(name, **more):
    return '\n'.join(summary(*described(name, **more)))


@pytest.mark.parametrize(('name', 'texts'), [  # what the descriptions' table says of them
    ('plain_arm', ('joint axes 1 and 2 meet at right angles', 'parallel, without lateral offset',
                   'joint axis 1 is vertical', 'postures have names')),
    ('kr16_2_first3', (
        'shoulder offset 0.26 m (common normal of joint axes 1 and 2), axes at right angles',)),
    ('puma560_first3', ('parallel, with a lateral offset of the tip by 0.1501 m',)),
    ('go1_leg', ('joint axis 1 is horizontal', 'with a lateral offset of the tip by 0.08 m')),
    ('tilted_arm', ('meet at 80 deg', 'joint axis 1 is tilted by 14.75 deg')),
    ('skew_arm', ('joint axes 2 and 3 are at 1.971 deg\n',)),
    ('pupper_v3_leg', ('joint axes 2 and 3 are at right angles',)),
    ('hyq_leg', ('shoulder offset 0.08 m', 'joint axis 1 is horizontal'))])
def test_geometry_is_named(name, texts):
    found = lines(name)
    for text in texts:
        assert text in found


def test_joints_have_their_limits_and_friction_and_what_is_missing():
    found = lines('go1_leg')
    assert ('  joint_1: -0.863 to 0.863 rad, 30.1 rad/s, 23.7 N m, no limit on acceleration and '
            'jerk; friction 0.01 N m s/rad and 0.2 N m\n') in found
    assert '  link_2: 1.009 kg, centre of mass with joints at zero (' in found


def reach(text, of):
    """Return the least and the largest distance from a place, as texts."""
    return re.search(rf'the tip is (\S+) to (\S+) m from {of}', text).groups()


def most_torque(text):
    return [float(x) for x in re.findall(r'joint_\d: up to (\S+)(?: of \S+)? N m', text)]


@pytest.mark.parametrize('name', ['go1_leg', 'tilted_arm', 'pupper_v3_leg', 'anymal_c_leg'])
def test_reach_and_torques_are_those_of_many_random_poses(name):
    arm, model, limits = described(name)
    found = '\n'.join(summary(arm, model, limits))
    q = np.random.default_rng(3).uniform(limits.min_position, limits.max_position, (40_000, 3))
    axis, (first, second, _) = model.chain.axis[0], model.chain.point
    # Of these arms joint axes 1 and 2 meet, at the shoulder.
    across = np.cross(axis, model.chain.axis[1])
    shoulder = first + axis * (np.cross(second - first, model.chain.axis[1]) @ across
                               / (across @ across))
    tip = forward_kinematics(model, q)
    for of, distance in (('the shoulder', np.linalg.norm(tip - shoulder, axis=1)),
                         ('joint axis 1', np.linalg.norm(np.cross(tip - first, axis), axis=1))):
        least, most = map(float, reach(found, of))
        assert least <= distance.min() + TOLD * model.chain.size
        assert most >= distance.max() - TOLD * model.chain.size
        np.testing.assert_allclose((least, most), (distance.min(), distance.max()),
                                   atol=SAMPLED * model.chain.size)
    torque = np.abs(gravity_torque(model, q)).max(axis=0)
    assert (most_torque(found) >= torque * (1.0 - TOLD)).all()
    np.testing.assert_allclose(most_torque(found), torque, rtol=SAMPLED)


def test_extremes_of_a_known_arm_are_exact():
    # Two links of 0.5 m, with 1 kg in the middle of each, up with joints at zero: stretched and
    # level, at 90 degrees of joint 2, it takes 9.81 (0.25 + 0.75) N m, in the wider range too.
    for lower, higher in ((0.3, 0.4), (1.0, 1.1)):
        found = lines('plain_arm', min_position=(-np.pi, 0.5 * np.pi - lower, -1.0),
                      max_position=(np.pi, 0.5 * np.pi + higher, 0.9))
        assert most_torque(found) == pytest.approx([0.0, 9.81, 9.81 * 0.25], abs=TOLD)
        assert reach(found, 'the shoulder')[1] == '1'


@pytest.mark.parametrize('name', ['kr16_2_first3', 'trifinger', 'heavy_com_arm', 'uarm_swift_pro',
                                  'hyq_leg', 'eezybotarm_mk2'])
def test_a_tip_that_comes_to_joint_axis_1_is_at_zero_from_it(name):
    assert reach(lines(name), 'joint axis 1')[0] == '0'


@pytest.mark.parametrize('name', sorted(path.stem for path in ARMS.glob('*.urdf')
                                        if path.stem != 'planar_arm'))
def test_nothing_is_told_to_rounding(name):
    assert not re.search(r'\de-\d', '\n'.join(
        line for line in lines(name).splitlines() if 'm from' in line or 'up to' in line))


def test_a_torque_next_to_its_limit_is_told_apart_from_it():
    found = lines('plain_arm', max_effort=(100.0, 9.8101, 100.0))
    assert '  joint_2: up to 9.81 of 9.8101 N m\n' in found
    assert 'cannot be held' not in found
    assert 'less than 1 % of the poses cannot be held' in lines(
        'plain_arm', max_effort=(100.0, 9.8099, 100.0))


def test_poses_that_cannot_be_held_are_counted():
    assert 'cannot be held' not in lines('go1_leg')
    assert re.search(r'  about \d+ % of the poses cannot be held',
                     lines('go1_leg', max_effort=(0.5, 0.5, 0.5)))


def test_arm_without_masses_or_gravity_is_summarised():
    found = lines('eezybotarm_mk2')
    assert 'torque is not checked, and the arm cannot be simulated: no link has a mass' in found
    assert 'torque to hold' not in found
    assert 'there is no gravity' in lines('go1_leg', gravity=(0.0, 0.0, 0.0))


def test_joints_without_range_are_summarised():
    found = lines('go1_leg', min_position=(-np.inf,) * 3, max_position=(np.inf,) * 3)
    assert 'joint_1: no range' in found
    assert 'to 0.4334 m from the shoulder' in found  # sqrt(0.08^2 + 0.426^2) m, stretched


def test_friction_that_leaves_no_torque_is_refused():
    with pytest.raises(LimitViolationError, match='joint_3 has a Coulomb friction of 0.2 N m'):
        lines('go1_leg', max_effort=(23.0, 23.0, 0.1))
