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

"""Arms read from URDFs are those that Pinocchio reads, and what is no such arm is refused."""

from __future__ import annotations

from dataclasses import replace
import pickle
import sys
from xml.etree import ElementTree

from helpers.pinocchio_urdf import PinocchioUrdf
from helpers.places import ROOT
from helpers.random_cases import ARMS, random_states
from helpers.urdf_texts import arm, axis, joint, limit, link, PARTS, RandomTree, texts, Y, Z
import numpy as np
import pytest
from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.arm.limits import JointLimits, UNITS
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.urdf import urdf
from rrr_traj_planner.core.arm.urdf_arm import read_urdf
from rrr_traj_planner.core.dynamics.rigid_body import inertia_matrix, inverse_dynamics
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics

FILES = {path.stem: path for path in sorted((ROOT / 'test/data/arms').glob('*.urdf'))}
READ = [name for name in FILES if name != 'planar_arm']
STATES = 30
GEOMETRY = 1e-12  # of the arm's size: rounding
RELATIVE = 1e-10  # of the largest torque or inertia: rounding of sums in another order


def agrees_with_pinocchio(found, locked=None):
    """Compare tip, inertia matrix and torque at random states."""
    reference = PinocchioUrdf(found.text, found.joint_names, found.base, found.tip, locked)
    ours = RobotModel(found.chain, reference.gravity)
    q, qd, qdd = states = random_states(np.random.default_rng(5), STATES)
    tip = np.array([reference.tip_position(x) for x in q])
    M = np.array([reference.inertia_matrix(x) for x in q])
    tau = np.array([reference.inverse_dynamics(*x) for x in zip(q, qd, qdd)])
    assert np.abs(forward_kinematics(ours, q) - tip).max() <= GEOMETRY * found.chain.size
    assert np.abs(inertia_matrix(ours, q) - M).max() <= RELATIVE * np.abs(M).max()
    assert np.abs(inverse_dynamics(ours, *states) - tau).max() <= RELATIVE * np.abs(tau).max()


def refused(text, base='base', tip='tip'):
    """Return why a URDF is refused."""
    with pytest.raises(InvalidInputError) as error:
        read_urdf(text, base, tip)
    return str(error.value)


@pytest.mark.parametrize('name', READ)
def test_public_descriptions_are_read_as_pinocchio_reads_them(name):
    found = read_urdf(FILES[name], 'base', 'tip')
    agrees_with_pinocchio(found)
    assert found.joint_names == ('joint_1', 'joint_2', 'joint_3')
    assert found.link_names == ('link_1', 'link_2', 'link_3')
    assert found.text == FILES[name].read_text()


@pytest.mark.parametrize('name', READ)
def test_limits_and_friction_are_those_of_the_file(name):
    found = read_urdf(FILES[name])
    joints = ElementTree.parse(FILES[name]).getroot().findall('joint')[:3]
    for key, values in (('lower', found.min_position), ('upper', found.max_position),
                        ('velocity', found.max_velocity), ('effort', found.max_effort)):
        written = [float(j.find('limit').get(key)) for j in joints]
        if key == 'velocity':
            written = [np.inf if x == 1000.0 else x for x in written]
        assert values.tolist() == written
    dynamics = [j.find('dynamics') for j in joints]
    for key, values in (('damping', found.friction.viscous), ('friction', found.friction.coulomb)):
        assert values.tolist() == [0.0 if d is None else float(d.get(key)) for d in dynamics]


def test_an_arm_whose_axes_are_all_parallel_is_refused_by_names():
    assert refused(str(FILES['planar_arm'])) == (
        f"{FILES['planar_arm']}: joint axes 'joint_1' and 'joint_2' are parallel: planar and "
        'SCARA-like arms are not supported')


@pytest.mark.parametrize('name', ['geomagic_touch', 'eezybotarm_mk2'])
def test_an_arm_without_masses_is_read_with_a_warning(name):
    found = read_urdf(FILES[name])
    assert not found.has_masses
    assert texts(found)[-1] == 'no link has a mass'
    assert read_urdf(FILES['go1_leg']).has_masses


def test_an_ordinary_description_gives_no_warning_and_no_noise(capfd):
    noise = ('<gazebo foo="1"><b/></gazebo><transmission name="t"/><material name="m"/>'
             '<ros2_control name="x" type="system"/>')
    found = read_urdf(arm(noise, a=link('a', '<visual/><sensor/>').replace('>', ' odd="1">', 1)))
    assert texts(found) == ("1 link without mass: 'a'",)
    assert read_urdf(arm()).warnings == ()
    assert capfd.readouterr() == ('', '')


@pytest.mark.parametrize('model', ARMS)
def test_the_urdf_that_the_package_writes_is_read_back(model):
    limits = JointLimits(max_velocity=(1.1, np.inf, 0.3), max_effort=(np.inf, 200.0, 1e-5))
    friction = Friction((0.1, 0.2, 0.3), (0.0, 1.0 / 3.0, 2.0))
    model = replace(model, friction=friction)
    found = read_urdf(urdf(model, limits), 'base_link', 'tip')
    agrees_with_pinocchio(found)
    q = np.array((0.3, 0.4, 0.5))
    ours = RobotModel(found.chain, model.gravity)
    assert forward_kinematics(ours, q) == pytest.approx(forward_kinematics(model, q), abs=1e-12)
    assert inverse_dynamics(ours, q, q, q) == pytest.approx(inverse_dynamics(model, q, q, q))
    for name in UNITS.keys() & vars(found).keys():
        assert getattr(found, name).tolist() == getattr(limits, name).tolist()
    assert found.friction.coulomb.tolist() == friction.coulomb.tolist()


@pytest.mark.parametrize(('low', 'high', 'kinds'), [
    ((-1.0, -np.inf, -np.inf), (np.inf, 2.0, np.inf), ['revolute', 'revolute', 'continuous']),
    ((-np.inf,) * 3, (np.inf,) * 3, ['continuous'] * 3)])
def test_ranges_without_ends_are_written_for_every_parser_and_read_back(low, high, kinds):
    text = urdf(RobotModel(), JointLimits(low, high, max_effort=(np.inf, 1.0, np.inf)))
    joints = ElementTree.fromstring(text).findall('joint')[:3]
    assert [joint.get('type') for joint in joints] == kinds
    written = [value for joint in joints for value in joint.find('limit').attrib.values()]
    assert np.isfinite(np.array(written, dtype=float)).all()
    found = read_urdf(text)
    assert (found.min_position.tolist(), found.max_position.tolist()) == (list(low), list(high))
    assert found.max_effort.tolist() == [np.inf, 1.0, np.inf]
    agrees_with_pinocchio(found)


@pytest.mark.parametrize('seed', range(60))
def test_random_trees_are_read_as_pinocchio_reads_them(seed):
    tree = RandomTree(seed)
    found = read_urdf(tree.text, tree.base, tree.tip)
    assert found.joint_names == tuple(tree.names)
    agrees_with_pinocchio(found, tree.locked)


def test_the_base_may_be_in_the_middle_of_the_tree_behind_turned_links():
    above = (link('world'), link('cart', '<inertial><mass value="9"/></inertial>'),
             joint('rail', 'prismatic', 'world', 'cart', limit(), (1, 2, 3), (0.3, 0.2, 0.1)),
             joint('stand', 'fixed', 'cart', 'base', '', (0.1, 0.2, 0.3), (1.0, 0.5, 0.2)))
    found, alone = read_urdf(arm(*above), 'base', 'tip'), read_urdf(arm(), 'base', 'tip')
    agrees_with_pinocchio(found)
    for name in ('axis', 'point', 'tip', 'mass', 'centre', 'inertia'):
        assert getattr(found.chain, name).tolist() == getattr(alone.chain, name).tolist()


def test_fixed_offsets_between_base_and_joint_1_are_counted():
    found = read_urdf(arm(link('foot'), joint('plate', 'fixed', 'foot', 'base', '', (1, 2, 3),
                                              (0.0, 0.0, np.pi / 2.0))), 'foot', 'tip')
    assert found.chain.point[0] == pytest.approx((1.0, 2.0, 3.3))
    assert found.chain.tip == pytest.approx((1.0, 3.0, 3.6))
    agrees_with_pinocchio(found)


@pytest.mark.parametrize('name', READ)
def test_limits_of_an_arm_are_the_file_s_and_those_that_are_given(name):
    found = read_urdf(FILES[name])
    limits = found.joint_limits(2.0, [10.0, 20.0, np.inf])
    for key in ('min_position', 'max_position', 'max_velocity', 'max_effort'):
        assert getattr(limits, key).tolist() == getattr(found, key).tolist()
    assert limits.max_acceleration.tolist() == [2.0] * 3
    assert limits.max_jerk.tolist() == [10.0, 20.0, np.inf]
    none = found.joint_limits()
    assert none.max_acceleration.tolist() == none.max_jerk.tolist() == [np.inf] * 3


@pytest.mark.parametrize(('value', 'message'), [
    (-1.0, r'max_jerk is [-1.0, -1.0, -1.0] rad/s^3, must be positive'),
    ([1.0, 2.0], 'max_jerk has shape (2,), must have (3)'),
    ([[1.0], [2.0, 3.0]], 'max_jerk has rows of 1, 2'), ('fast', "max_jerk is 'fast'"),
    (None, 'max_jerk is '),
    (np.nan, 'max_jerk is nan, must be a number')])
def test_limits_that_are_none_are_refused(value, message):
    with pytest.raises(InvalidInputError) as error:
        read_urdf(arm()).joint_limits(max_jerk=value)
    assert str(error.value).startswith(message)


def test_a_missing_parser_is_said_with_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, 'urdf_parser_py.urdf', None)
    assert refused(arm()).startswith('reading a URDF needs urdf_parser_py (')
    with pytest.raises(InvalidInputError, match=r'urdfdom-py \(apt\), or urdf-parser-py \(pip\)'):
        RobotModel.from_urdf(arm())


def test_empty_names_are_the_root_and_the_only_leaf():
    found = read_urdf(arm())
    assert (found.base, found.tip) == ('base', 'tip')
    more = arm(link('x'), joint('more', 'fixed', 'c', 'x'))
    assert refused(more.replace('"tip"', '"hand"'), '', '') == (
        "the tip frame is not given, and the tree below link 'base' has several leaves: 'hand', "
        "'x'")


def test_empty_names_are_base_link_and_tip_where_there_are_such_links():
    text = arm(link('x'), joint('more', 'fixed', 'c', 'x', '', (0.3, 0.0, 0.0)), link('world'),
               joint('stand', 'fixed', 'world', 'base')).replace('"base"', '"base_link"')
    found = read_urdf(text)
    assert (found.base, found.tip) == ('base_link', 'tip')
    assert read_urdf(text, 'world', 'x').chain.tip == pytest.approx((0.9, 0.0, 0.5))


@pytest.mark.parametrize(('changed', 'message'), [
    ({'j3': joint('j3', 'fixed', 'b', 'c')},
     "2 joints between base and tip can turn: 'j1', 'j2'; must be 3"),
    ({'end': joint('j4', 'continuous', 'c', 'tip')},
     "4 joints between base and tip can turn: 'j1', 'j2', 'j3', 'j4'; must be 3"),
    *(({'j3': joint('j3', kind, 'b', 'c', Y)},
       f"joint 'j3', between base and tip, is {kind}: must be revolute, continuous or fixed")
      for kind in ('prismatic', 'planar', 'floating')),
    ({'j2': joint('j2', 'revolute', 'a', 'b', Y + '<mimic joint="j1"/>')},
     "joint 'j2', between base and tip, mimics 'j1': must move by itself"),
    ({'j2': joint('j2', 'revolute', 'a', 'b', Z)},
     "joint axes 'j1' and 'j2' are parallel: planar and SCARA-like arms are not supported"),
    ({'j2': joint('j2', 'revolute', 'a', 'b', axis(0, 0, 0) + limit())},
     "joint 'j2': its axis is zero, must have a direction"),
    ({'end': joint('end', 'fixed', 'c', 'tip', '', (0, 1, 0))},
     "the tip is on joint axis 'j3', which does not move it"),
    ({'end': joint('end', 'fixed', 'c', 'tip', '', (1e-9, 1, 0))},
     "the tip is on joint axis 'j3', which does not move it"),
    ({'j1': joint('j1', 'revolute', 'base', 'a', Z + '<dynamics damping="-1"/>')},
     "joint 'j1': damping is -1 N m s/rad, must not be negative")])
def test_what_is_no_arm_of_three_joints_is_refused_by_name(changed, message):
    assert refused(arm(**changed)) == message


def test_base_as_tip_is_refused():
    assert refused(arm(), 'base', 'base') == '0 joints between base and tip can turn; must be 3'


def test_damping_and_friction_are_the_arm_s():
    found = read_urdf(arm(j2=joint('j2', 'revolute', 'a', 'b', Y + '<dynamics friction="2"/>')))
    assert found.friction.coulomb.tolist() == [0.0, 2.0, 0.0]
    assert found.friction.viscous.tolist() == [0.0, 0.0, 0.0]


def test_a_file_is_read_as_its_text_is_and_named_in_errors(tmp_path):
    file = tmp_path / 'arm.urdf'
    file.write_text('\ufeff\n' + arm(), encoding='utf-8')
    assert read_urdf(file).joint_names == read_urdf(f'\ufeff \n{arm()}').joint_names
    file.write_text('<robot name="r">\n<link name="a"></robot>')
    assert refused(str(file)).startswith(f'{file}: line 2, column ')


def test_a_file_is_read_in_the_encoding_that_it_declares(tmp_path):
    file, text = tmp_path / 'arm.urdf', arm().replace('j2', 'Gelenk-Größe')
    for encoding in ('ISO-8859-1', 'windows-1252', 'UTF-8', 'utf-16'):
        declared = f'<?xml version="1.0" encoding="{encoding}"?>\n{text}'
        file.write_bytes(declared.encode(encoding))
        if encoding == 'utf-16':  # its declaration is no ASCII
            assert 'utf-8' in refused(str(file))
        else:
            assert read_urdf(file).joint_names[1] == 'Gelenk-Größe'
    file.write_bytes(f'<?xml version="1.0" encoding="latin-77"?>{text}'.encode('latin-1'))
    assert 'unknown encoding: latin-77' in refused(str(file))


def test_a_namespace_of_the_whole_document_changes_nothing():
    text = arm()
    text = text.replace('<robot', '<robot xmlns="http://drake.mit.edu"')
    assert read_urdf(text).joint_names == read_urdf(arm()).joint_names
    other = arm().replace('<robot', '<robot xmlns:x="http://other"').replace(
        '</robot>', '<x:joint name="more"/></robot>')
    assert read_urdf(other).joint_names == read_urdf(arm()).joint_names


def test_what_is_no_file_is_refused(tmp_path):
    for path in ('no_such.urdf', str(tmp_path), '\0', 'x' * 5000):
        assert "is neither a URDF, whose text begins with '<', nor a file" in refused(path)
    assert refused(' ') == "the URDF is empty, must be its text or a file's path"
    binary = tmp_path / 'binary.urdf'
    binary.write_bytes(b'\xff\xfe\x00')
    assert 'utf-8' in refused(str(binary))


def test_an_arm_is_pickled_read_only():
    found = pickle.loads(pickle.dumps(read_urdf(arm())))
    assert texts(found) == () and found.text == arm()
    for array in (found.min_position, found.max_effort, found.chain.mass, found.friction.viscous):
        with pytest.raises(ValueError, match='read-only'):
            array[0] = 1.0


@pytest.mark.parametrize('value', [None, 3, b'<robot/>', ['<robot/>']])
def test_what_is_no_text_is_refused(value):
    assert refused(value) == f'text_or_path is {value!r}, must be a text'
    assert refused(PARTS['base'], value) == f'base is {value!r}, must be a text'
