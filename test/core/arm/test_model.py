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

"""The arm's description: the thesis's values, and the arms that are refused."""

from dataclasses import FrozenInstanceError
import itertools

from helpers import thesis_cases as thesis
import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.rigid_body import inertia_matrix
from rrr_traj_planner.core.errors import InvalidInputError


def test_default_arm_is_the_thesis_s():
    arm = RobotModel()
    assert (arm.d1, arm.a2, arm.d4, arm.l2, arm.l3) == (
        thesis.D1, thesis.A2, thesis.D4, thesis.L2, thesis.L3)
    assert arm.mass.tolist() == list(thesis.MASS)
    assert arm.inertia.tolist() == [list(row) for row in thesis.INERTIA]
    assert arm.gravity == 9.81
    assert arm.joint_names == ('joint_1', 'joint_2', 'joint_3')


def test_reach_is_the_sum_and_the_difference_of_the_two_arms():
    assert RobotModel().reach == pytest.approx((0.2, 1.6), abs=1e-15)
    assert RobotModel(a2=0.4, d4=0.7).reach == pytest.approx((0.3, 1.1), abs=1e-15)


def test_model_cannot_be_changed():
    masses = np.array([1.0, 2.0, 3.0])
    arm = RobotModel(mass=masses)
    masses[0] = 9.0
    assert arm.mass.tolist() == [1.0, 2.0, 3.0]
    for array in (arm.mass, arm.inertia):
        with pytest.raises(ValueError, match='read-only'):
            array[0] = 5.0
    with pytest.raises(FrozenInstanceError):
        arm.d1 = 1.0


def test_models_do_not_share_their_default_arrays():
    assert RobotModel().mass is not RobotModel().mass


@pytest.mark.parametrize(('changes', 'text'), [
    ({'a2': 0.0}, r'^a2 is 0\.0 m, must be positive$'),
    ({'d4': -0.7}, r'^d4 is -0\.7 m, must be positive$'),
    ({'d1': np.nan}, r'^d1 is nan m, must be finite$'),
    ({'gravity': np.inf}, r'^gravity is inf m/s\^2, must be finite$'),
    ({'l2': [0.5]}, r'^l2 is \[0\.5\], must be a number$'),
    ({'mass': (1.0, 2.0)}, r'^mass has shape \(2,\), must have \(3\)$'),
    ({'mass': (40.0, -16.0, 12.0)}, r'^mass is \[ ?40\. -16\. +12\.\], must not be negative$'),
    ({'inertia': np.zeros((2, 3))}, r'^inertia has shape \(2, 3\), must have \(3, 3\)$'),
    ({'inertia': -np.eye(3)}, r'^inertia is .*-1\..*, must not be negative$'),
    ({'joint_names': ('a', 'b', 'a')}, r"^joint_names is \['a', 'b', 'a'\], must be 3 distinct"),
    ({'joint_names': ('a', 'b')}, r"^joint_names is \['a', 'b'\], must be 3 distinct names$"),
    ({'joint_names': ('a', '', 'c')}, r"^joint_names is \['a', '', 'c'\], must be 3 distinct"),
])
def test_malformed_arm_is_refused_by_name(changes, text):
    with pytest.raises(InvalidInputError, match='(?s)' + text):
        RobotModel(**changes)


@pytest.mark.parametrize(('changes', 'text'), [
    # A forearm without mass and inertia: joint 3 turns nothing.
    ({'mass': (40.0, 16.0, 0.0), 'inertia': ((1.5, 0.1, 1.5), (0.1, 0.1, 0.1), (0, 0, 0))},
     '^link 3 has no inertia about joint axis 3$'),
    # A point mass at the end of a bare rod: with the elbow at a right angle, joints 2 and 3 can
    # turn against each other without moving it.
    ({'mass': (40.0, 0.0, 12.0), 'inertia': ((1.5, 0.1, 1.5), (0.1, 0.1, 0.0), (0.0, 0.0, 0.0))},
     '^links 2 and 3 have no inertia about joint axis 2$'),
    # Two thin rods pointing straight up turn about joint axis 1 for nothing.
    ({'inertia': ((1.5, 0.0, 1.5), (0.0, 0.12, 0.12), (0.12, 0.12, 0.0))},
     '^the arm can have no inertia about joint axis 1$'),
])
def test_arm_that_a_torque_could_accelerate_without_bound_is_refused(changes, text):
    with pytest.raises(InvalidInputError, match=text):
        RobotModel(**changes)


def test_arm_of_point_masses_on_a_heavy_column_is_accepted():
    arm = RobotModel(inertia=((0.0, 0.1, 0.0), (0, 0, 0), (0, 0, 0)))
    assert np.linalg.eigvalsh(inertia_matrix(arm, [0.0, np.pi / 2, np.pi / 2])).min() > 0.0


def test_forearm_s_inertia_stands_in_for_a_massless_upper_arm_s():
    arm = RobotModel(mass=(40.0, 0.0, 12.0), inertia=(
        (1.5, 0.1, 1.5), (0.1, 0.1, 0.0), (0.12, 0.12, 0.01)))
    assert np.linalg.eigvalsh(inertia_matrix(arm, [0.0, 0.3, np.pi / 2])).min() > 0.0


def test_every_accepted_arm_has_inertia_in_every_pose():
    # All combinations of present and missing masses and inertias, in poses where terms vanish.
    right_angles = np.arange(-2, 3) * np.pi / 2
    q = np.array([(0.0, b, c) for b in right_angles for c in right_angles])
    accepted = 0
    for present in itertools.product((0.0, 1.0), repeat=8):
        i1y, i2x, i2y, i2z, i3x, i3y, m2, m3 = present
        try:
            arm = RobotModel(mass=(0.0, m2, m3), inertia=(
                (0.0, i1y, 0.0), (i2x, i2y, i2z), (i3x, i3y, 0.0)))
        except InvalidInputError:
            continue
        accepted += 1
        # Straight angles are exact to 1e-16 only, and a vanishing inertia shows as that squared.
        assert np.linalg.eigvalsh(inertia_matrix(arm, q)).min() > 1e-3, present
    assert accepted > 50
