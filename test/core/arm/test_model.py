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

from dataclasses import fields, FrozenInstanceError, replace
import itertools

from helpers import thesis_cases as thesis
from helpers.places import ROOT
from helpers.random_chains import random_arm
from helpers.thesis_arm import ThesisArm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.chain import Chain
from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.arm.lengths import ArmLengths
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.urdf_arm import read_urdf
from rrr_traj_planner.core.dynamics.rigid_body import inertia_matrix
from rrr_traj_planner.core.errors import InvalidInputError


def without_inertia(arm, *links):
    """Return an arm without the inertia of some links, and without their masses."""
    chain = arm.chain
    kept = np.array([i not in links for i in range(3)], dtype=float)
    return RobotModel(Chain(chain.axis, chain.point, chain.tip, chain.mass * kept, chain.centre,
                            chain.inertia * kept[:, np.newaxis, np.newaxis]))


def test_default_arm_is_the_thesis_s():
    lengths, arm = ArmLengths(), RobotModel()
    assert (lengths.d1, lengths.a2, lengths.d4, lengths.l2, lengths.l3) == (
        thesis.D1, thesis.A2, thesis.D4, thesis.L2, thesis.L3)
    assert lengths.mass.tolist() == list(thesis.MASS)
    assert lengths.inertia.tolist() == [list(row) for row in thesis.INERTIA]
    assert arm.gravity.tolist() == [0.0, 0.0, -9.81]
    assert arm.rotor_inertia.tolist() == [0.0, 0.0, 0.0]
    assert arm.friction.is_none
    assert arm.joint_names == ('joint_1', 'joint_2', 'joint_3')
    for field in fields(Chain):
        ours, expected = (getattr(chain, field.name) for chain in (arm.chain, lengths.chain()))
        assert ours.tolist() == expected.tolist()


def test_lengths_lay_the_arm_along_x_and_its_forearm_down():
    chain = ArmLengths(d1=0.4, a2=0.8, d4=0.6, l2=0.3, l3=0.2, inertia=np.arange(9).reshape(
        3, 3)).chain()
    assert chain.axis.tolist() == [[0, 0, 1], [0, -1, 0], [0, -1, 0]]
    assert chain.point.tolist() == [[0, 0, 0.4], [0, 0, 0.4], [0.8, 0, 0.4]]
    assert chain.tip == pytest.approx((0.8, 0.0, -0.2), abs=1e-15)
    assert chain.centre == pytest.approx(
        np.array(((0.0, 0.0, 0.4), (0.3, 0.0, 0.4), (0.8, 0.0, 0.2))), abs=1e-15)
    # z of frames 1 and 2 is -y of the base; frame 3 is turned by half a turn about x
    assert [np.diag(tensor).tolist() for tensor in chain.inertia] == [
        [0, 2, 1], [3, 5, 4], [6, 7, 8]]


def test_model_cannot_be_changed():
    masses = np.array([1.0, 2.0, 3.0])
    lengths = ArmLengths(mass=masses)
    arm = RobotModel.from_lengths(lengths)
    masses[0] = 9.0
    assert lengths.mass.tolist() == arm.chain.mass.tolist() == [1.0, 2.0, 3.0]
    for array in (lengths.mass, lengths.inertia, arm.chain.axis, arm.chain.inertia, arm.gravity,
                  arm.rotor_inertia, arm.friction.viscous):
        with pytest.raises(ValueError, match='read-only'):
            array[0] = 5.0
    with pytest.raises(FrozenInstanceError):
        arm.gravity = np.zeros(3)
    with pytest.raises(FrozenInstanceError):
        lengths.d1 = 1.0


def test_models_do_not_share_their_default_arrays():
    assert RobotModel().gravity is not RobotModel().gravity
    assert RobotModel().chain is not RobotModel().chain
    assert ArmLengths().mass is not ArmLengths().mass


def test_chains_and_other_fields_are_kept_as_they_are():
    arm = random_arm(4)
    other = RobotModel(arm.chain, [1.0, 2.0, -3.0], [0.1, 0.0, 0.2], Friction([1.0, 2.0, 3.0]))
    assert other.chain is arm.chain
    assert other.gravity.tolist() == [1.0, 2.0, -3.0]
    assert other.rotor_inertia.tolist() == [0.1, 0.0, 0.2]
    assert other.friction.viscous.tolist() == [1.0, 2.0, 3.0]


@pytest.mark.parametrize(('changes', 'text'), [
    ({'a2': 0.0}, r'^a2 is 0\.0 m, must be positive$'),
    ({'d4': -0.7}, r'^d4 is -0\.7 m, must be positive$'),
    ({'d1': np.nan}, r'^d1 is nan m, must be finite$'),
    ({'l2': [0.5]}, r'^l2 is \[0\.5\], must be a number$'),
    ({'l2': 1e300}, r'^l2 is 1e\+300 m: the inertia of 16\.0 kg there is not finite$'),
    ({'mass': (1.0, 2.0)}, r'^mass has shape \(2,\), must have \(3\)$'),
    ({'mass': (40.0, -16.0, 12.0)}, r'^mass is \[ ?40\. -16\. +12\.\], must not be negative$'),
    ({'inertia': np.zeros((2, 3))}, r'^inertia has shape \(2, 3\), must have \(3, 3\)$'),
    ({'inertia': -np.eye(3)}, r'^inertia is .*-1\..*, must not be negative$'),
])
def test_malformed_lengths_are_refused_by_name(changes, text):
    with pytest.raises(InvalidInputError, match='(?s)' + text):
        ArmLengths(**changes)


@pytest.mark.parametrize(('changes', 'text'), [
    ({'chain': None}, '^chain is None, must be of Chain$'),
    ({'chain': ArmLengths()}, r'^chain is ArmLengths\(.*\), must be of Chain$'),
    ({'friction': (1.0, 2.0, 3.0)}, r'^friction is \(1\.0, 2\.0, 3\.0\), must be of Friction$'),
    ({'gravity': 9.81}, r'^gravity has shape \(\), must have \(3\)$'),
    ({'gravity': (0.0, 0.0, -np.inf)}, r'^gravity\[2\] is -inf, must be finite$'),
    ({'rotor_inertia': (0.1, 0.2)}, r'^rotor_inertia has shape \(2,\), must have \(3\)$'),
    ({'rotor_inertia': (0.1, -0.2, 0.0)},
     r'^rotor_inertia is \[0\.1, -0\.2, 0\.0\] kg m\^2, must not be negative$'),
    ({'joint_names': ('a', 'b', 'a')}, r"^joint_names is \['a', 'b', 'a'\], must be 3 distinct"),
    ({'joint_names': ('a', 'b')}, r"^joint_names is \['a', 'b'\], must be 3 distinct names$"),
    ({'joint_names': ('a', '', 'c')}, r"^joint_names is \['a', '', 'c'\], must be 3 distinct"),
])
def test_malformed_arm_is_refused_by_name(changes, text):
    with pytest.raises(InvalidInputError, match='(?s)' + text):
        RobotModel(**changes)


def test_gravity_that_is_not_finite_is_refused_with_lengths():
    with pytest.raises(InvalidInputError, match=r'^gravity is inf m/s\^2, must be finite$'):
        RobotModel.from_lengths(ArmLengths(), np.inf)


@pytest.mark.parametrize(('changes', 'text'), [
    # A forearm without mass and inertia: joint 3 turns nothing.
    ({'mass': (40.0, 16.0, 0.0), 'inertia': ((1.5, 0.1, 1.5), (0.1, 0.1, 0.1), (0, 0, 0))},
     'link 3 has no inertia about joint axis 3'),
    # A point mass at the end of a bare rod: with the elbow at a right angle, joints 2 and 3 can
    # turn against each other without moving it.
    ({'mass': (40.0, 0.0, 12.0), 'inertia': ((1.5, 0.1, 1.5), (0.1, 0.1, 0.0), (0.0, 0.0, 0.0))},
     'links 2 and 3 have no inertia about joint axis 2'),
    # Two thin rods pointing straight up turn about joint axis 1 for nothing.
    ({'inertia': ((1.5, 0.0, 1.5), (0.0, 0.12, 0.12), (0.12, 0.12, 0.0))},
     'the arm can have no inertia about joint axis 1'),
])
def test_arm_that_a_torque_could_accelerate_without_bound_is_refused(changes, text):
    lengths = ArmLengths(**changes)
    with pytest.raises(InvalidInputError, match=f'^{text}$'):
        RobotModel.from_lengths(lengths)
    assert RobotModel(lengths.chain()).singular_inertia_reason == text
    # With motors of some inertia, each joint has its own.
    assert RobotModel(lengths.chain(), rotor_inertia=[0.1, 0.1, 0.1]).singular_inertia_reason == ''


@pytest.mark.parametrize('seed', range(5))
def test_chains_lack_inertia_where_links_have_none(seed):
    arm = random_arm(seed)
    assert arm.singular_inertia_reason == without_inertia(arm).singular_inertia_reason == ''
    assert without_inertia(arm, 0, 1).singular_inertia_reason == ''  # a body hangs on joint 3
    assert without_inertia(arm, 2).singular_inertia_reason == (
        'link 3 has no inertia about joint axis 3')
    bare = without_inertia(arm, 0, 1, 2)
    assert bare.singular_inertia_reason == 'no link has a mass'
    assert replace(bare, rotor_inertia=[0.1, 0.1, 0.0]).singular_inertia_reason == (
        'link 3 has no inertia about joint axis 3')
    assert replace(bare, rotor_inertia=[0.1, 0.1, 0.1]).singular_inertia_reason == ''


def test_arm_of_point_masses_on_a_heavy_column_is_accepted():
    arm = ThesisArm(inertia=((0.0, 0.1, 0.0), (0, 0, 0), (0, 0, 0)))
    assert np.linalg.eigvalsh(inertia_matrix(arm, [0.0, np.pi / 2, np.pi / 2])).min() > 0.0


def test_forearm_s_inertia_stands_in_for_a_massless_upper_arm_s():
    arm = ThesisArm(mass=(40.0, 0.0, 12.0), inertia=(
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
            arm = ThesisArm(mass=(0.0, m2, m3), inertia=(
                (0.0, i1y, 0.0), (i2x, i2y, i2z), (i3x, i3y, 0.0)))
        except InvalidInputError:
            continue
        accepted += 1
        # Straight angles are exact to 1e-16 only, and a vanishing inertia shows as that squared.
        assert np.linalg.eigvalsh(inertia_matrix(arm, q)).min() > 1e-3, present
    assert accepted > 50


def test_a_urdf_gives_chain_names_and_friction():
    file = ROOT / 'test/data/arms/go1_leg.urdf'
    for arm in (RobotModel.from_urdf(file), RobotModel.from_urdf(file.read_text(), 'base', 'tip')):
        assert arm.chain.axis.tolist() == [[1, 0, 0], [0, 1, 0], [0, 1, 0]]
        assert arm.chain.tip == pytest.approx((0.1881, 0.04675 + 0.08, -2 * 0.213))
        assert arm.joint_names == ('joint_1', 'joint_2', 'joint_3')
        assert arm.friction.viscous.tolist() == [0.01] * 3
        assert arm.friction.coulomb.tolist() == [0.2] * 3
        assert arm.gravity.tolist() == [0.0, 0.0, -9.81]


def test_a_urdf_s_arm_may_have_its_gravity_and_motors():
    file = ROOT / 'test/data/arms/go1_leg.urdf'
    gravity, rotors = [0.0, 3.0, 4.0], [0.1, 0.2, 0.3]
    for arm in (RobotModel.from_urdf(file, gravity=gravity, rotor_inertia=rotors),
                read_urdf(file).model(gravity=gravity, rotor_inertia=rotors)):
        assert (arm.gravity.tolist(), arm.rotor_inertia.tolist()) == (gravity, rotors)
        assert arm.friction.coulomb.tolist() == [0.2] * 3
        assert arm.joint_names == ('joint_1', 'joint_2', 'joint_3')
    for name in ('gravity', 'rotor_inertia'):
        with pytest.raises(InvalidInputError, match=rf'^{name} has shape \(2,\)'):
            RobotModel.from_urdf(file, **{name: [1.0, 2.0]})


def test_a_urdf_of_another_arm_is_refused():
    with pytest.raises(InvalidInputError, match=r'planar_arm.urdf: joint axes .* are parallel'):
        RobotModel.from_urdf(ROOT / 'test/data/arms/planar_arm.urdf')
