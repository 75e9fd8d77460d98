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

import re

from helpers.places import ROOT
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.urdf_arm import read_urdf
from rrr_traj_planner.core.errors import LimitViolationError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.planners.arm_summary import summary

ARMS = ROOT / 'test/data/arms'
NONE = (np.inf,) * 3


def described(name, gravity=(0.0, 0.0, -9.81), **limits):
    """Return an arm of a public description, its model and its limits."""
    arm = read_urdf(ARMS / f'{name}.urdf')
    model = RobotModel(arm.chain, gravity, friction=arm.friction, joint_names=arm.joint_names)
    return arm, model, JointLimits(**{
        'max_acceleration': NONE, 'max_jerk': NONE, **{kind: getattr(arm, kind) for kind in (
            'min_position', 'max_position', 'max_velocity', 'max_effort')}, **limits})


def lines(name, **more):
    return '\n'.join(summary(*described(name, **more)))


@pytest.mark.parametrize(('name', 'texts'), [  # what the descriptions' table says of them
    ('plain_arm', ('joint axes 1 and 2 meet at right angles', 'parallel, without lateral offset',
                   'joint axis 1 is vertical', 'postures have names')),
    ('kr16_2_first3', ('radial offset: joint axis 2 passes joint axis 1 at 0.26 m',)),
    ('puma560_first3', ('parallel, with a lateral offset of the tip by 0.1501 m',)),
    ('go1_leg', ('joint axis 1 is horizontal', 'with a lateral offset of the tip by 0.08 m')),
    ('tilted_arm', ('meet at 80 deg', 'joint axis 1 is tilted by 14.75 deg')),
    ('skew_arm', ('joint axes 2 and 3 are skew, at 1.971 deg',)),
    ('pupper_v3_leg', ('joint axes 2 and 3 are perpendicular',)),
    ('hyq_leg', ('radial offset', 'joint axis 1 is horizontal'))])
def test_geometry_is_named(name, texts):
    found = lines(name)
    for text in texts:
        assert text in found


def test_joints_have_their_limits_and_friction_and_what_is_missing():
    found = lines('go1_leg')
    assert ('  joint_1: -0.863 to 0.863 rad, 30.1 rad/s, 23.7 N m, no limit on acceleration and '
            'jerk; friction 0.01 N m s/rad and 0.2 N m\n') in found
    assert '  link_2: 1.009 kg, centre of mass with joints at zero (' in found


def test_reach_is_that_of_random_poses_in_the_ranges():
    arm, model, limits = described('go1_leg')
    found = '\n'.join(summary(arm, model, limits))
    least, most = map(float, re.search(r'the tip is (\S+) to (\S+) m from the shoulder',
                                       found).groups())
    q = np.random.default_rng(3).uniform(limits.min_position, limits.max_position, (20000, 3))
    distance = np.linalg.norm(forward_kinematics(model, q) - (0.1881, 0.04675, 0.0), axis=1)
    # the shoulder, where joint axes 1 and 2 meet, is the hip's point: so the URDF
    np.testing.assert_allclose((least, most), (distance.min(), distance.max()), rtol=2e-3)


def test_poses_that_cannot_be_held_are_counted():
    assert 'cannot be held' not in lines('go1_leg')
    assert re.search(r'some \d+ % of the poses cannot be held',
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
