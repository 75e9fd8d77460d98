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

"""The frames of a URDF's links are where Pinocchio has them, at any joint positions."""

from __future__ import annotations

from helpers.pinocchio_urdf import PinocchioUrdf
from helpers.places import CONFIG
from helpers.urdf_texts import arm, axis, joint, limit, link, RandomTree
import numpy as np
import pinocchio
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.urdf import urdf
from rrr_traj_planner.core.arm.urdf_arm import read_urdf
from rrr_traj_planner.core.arm.urdf_frames import urdf_frames
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from scipy.spatial.transform import Rotation

ROUNDING = 1e-12
NAMES = ('j1', 'j2', 'j3')


def matrix(placement):
    found = np.eye(4)
    found[:3, :3] = Rotation.from_quat(placement.turn).as_matrix()
    found[:3, 3] = placement.origin
    return found


def poses(frames, q):
    """Return the poses of all links in the root, by their names."""
    placed = {x.child: (x.parent, matrix(x.placement)) for x in frames.fixed}
    placed.update((x.child, (x.parent, matrix(x.at(q)))) for x in frames.moving)

    def pose(name):
        parent, own = placed.get(name, (None, np.eye(4)))
        return own if parent is None else pose(parent) @ own

    return {name: pose(name) for name in placed}


def agree_with_pinocchio(text, names, positions, q):
    """Compare all links; other joints than the arm's are at some positions, or at zero."""
    model = pinocchio.buildModelFromXML(text)
    at = {**positions, **dict(zip(names, q))}
    data = model.createData()
    pinocchio.framesForwardKinematics(model, data, PinocchioUrdf.configuration(
        model, [at.get(name, 0.0) for name in list(model.names)[1:]]))
    found = poses(urdf_frames(text, names), q)
    assert len(found) == text.count('<joint name=')
    for name, pose in found.items():
        expected = data.oMf[model.getFrameId(name, pinocchio.FrameType.BODY)].homogeneous
        np.testing.assert_allclose(pose, expected, rtol=0.0, atol=ROUNDING, err_msg=name)


@pytest.mark.parametrize('seed', range(12))
def test_frames_of_random_trees(seed):
    tree = RandomTree(seed)
    agree_with_pinocchio(tree.text, tree.names, tree.locked, tree.rng.uniform(-3.0, 3.0, 3))


@pytest.mark.parametrize('file', sorted((CONFIG / 'arms').glob('*.urdf')), ids=lambda f: f.stem)
def test_frames_of_the_example_arms(file):
    names = read_urdf(file).joint_names
    agree_with_pinocchio(file.read_text(), names, {}, (0.3, -0.7, 1.1))


def test_frames_of_the_document_that_parameters_make():
    text, q = urdf(RobotModel(), JointLimits()), (0.3, 0.7, -0.4)
    agree_with_pinocchio(text, RobotModel().joint_names, {}, q)
    frames = urdf_frames(text, RobotModel().joint_names)
    assert [(x.parent, x.child) for x in frames.moving] == [
        ('base_link', 'link_1'), ('link_1', 'link_2'), ('link_2', 'link_3')]
    assert [(x.parent, x.child) for x in frames.fixed] == [('link_3', 'tip')]
    np.testing.assert_allclose(
        poses(frames, q)['tip'][:3, 3], forward_kinematics(RobotModel(), q), atol=ROUNDING)


def with_finger(kind, mimic):
    """Return an arm with a finger that mimics a joint, by a hinge that mimics another."""
    return arm(
        link('finger'), link('nail'),
        joint('hinge', kind, 'c', 'finger', axis(0.0, 1.0, 1.0) + limit()
              + f'<mimic joint="{mimic}" multiplier="-2" offset="0.1"/>', (0.1, 0.2, 0.3)),
        joint('bend', 'continuous', 'finger', 'nail',
              axis(1.0, 0.0, 0.0) + '<mimic joint="hinge" multiplier="0.5"/>'))


@pytest.mark.parametrize('kind', ['revolute', 'prismatic'])
def test_joints_that_mimic_one_of_the_arm_s_move_with_it(kind):
    text, q = with_finger(kind, 'j2'), (0.3, -0.7, 1.1)
    hinge = -2.0 * q[1] + 0.1
    agree_with_pinocchio(text, NAMES, {'hinge': hinge, 'bend': 0.5 * hinge}, q)


@pytest.mark.parametrize('mimic', ['no_such', 'bend'])
def test_joints_that_mimic_none_rest(mimic):
    agree_with_pinocchio(with_finger('revolute', mimic), NAMES, {}, (0.3, -0.7, 1.1))


def test_joint_without_an_axis_that_is_to_move_is_refused():
    text = arm(link('part'), joint('hinge', 'revolute', 'c', 'part', axis(0, 0, 0) + limit()
                                   + '<mimic joint="j1"/>'))
    with pytest.raises(InvalidInputError, match="joint 'hinge': its axis is zero"):
        urdf_frames(text, NAMES)
