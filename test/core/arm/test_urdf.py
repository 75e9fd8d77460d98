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

"""The URDF: read back by Pinocchio (urdfdom) and urdf_parser_py, it is the arm."""

from __future__ import annotations

from xml.etree import ElementTree

from helpers.other_arms import OTHER_ARMS
from helpers.random_cases import ARMS, random_states
from helpers.random_chains import random_arm
from helpers.thesis_arm import ThesisArm
from helpers.thesis_link_motion import link_motion
import numpy as np
import pinocchio
import pytest
from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.arm.limits import JointLimits, NO_EFFORT, NO_VELOCITY
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.urdf import FrameNames, urdf
from rrr_traj_planner.core.dynamics.rigid_body import inertia_matrix, inverse_dynamics
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.link_positions import link_positions
from urdf_parser_py.urdf import URDF

STATES = 50
GEOMETRY = 1e-12  # m, of arms of a few metres: rounding
RELATIVE = 1e-12  # of the largest torque or inertia: two orders to add the same numbers
ANY_ARM = [*ARMS, *(random_arm(seed) for seed in range(20)), *OTHER_ARMS.values()]
NAMES = FrameNames('floor', ('column', 'upper arm', 'fore<arm'), 'tool')


def read(arm, **options):
    model = pinocchio.buildModelFromXML(urdf(arm, JointLimits(), **options))
    model.gravity.linear = arm.gravity
    model.armature = arm.rotor_inertia
    return model, model.createData()


def rotations_and_tip(model, data, frames, q):
    pinocchio.framesForwardKinematics(model, data, q)
    placements = [data.oMf[model.getFrameId(name)] for name in (*frames.links, frames.tip)]
    return [p.rotation for p in placements], placements[-1].translation


@pytest.mark.parametrize('arm', ARMS)
def test_tip_and_its_frame_are_where_the_model_has_them(arm):
    model, data = read(arm, frames=NAMES)
    q, qd, qdd = random_states(np.random.default_rng(1), STATES)
    tips, R = forward_kinematics(arm, q), link_motion(arm, q, qd, qdd).rotation
    for i in range(STATES):
        rotations, tip = rotations_and_tip(model, data, NAMES, q[i])
        np.testing.assert_allclose(tip, tips[i], rtol=0.0, atol=GEOMETRY)
        np.testing.assert_allclose(rotations[1], R[i, 1], rtol=0.0, atol=GEOMETRY)
        np.testing.assert_allclose(rotations[-1], R[i, 2], rtol=0.0, atol=GEOMETRY)


@pytest.mark.parametrize('arm', ANY_ARM)
def test_tip_of_any_chain_is_where_the_model_has_it(arm):
    model, data = read(arm, frames=NAMES)
    q = random_states(np.random.default_rng(5), STATES)[0]
    tips = forward_kinematics(arm, q)
    for one, expected in zip(q, tips):
        rotations, tip = rotations_and_tip(model, data, NAMES, one)
        np.testing.assert_allclose(tip, expected, rtol=0.0, atol=RELATIVE * np.abs(tips).max())
        forearm = expected - link_positions(arm, one.tolist())[-2]
        np.testing.assert_allclose(rotations[-1][:, 2], forearm / np.linalg.norm(forearm),
                                   rtol=0.0, atol=GEOMETRY)


@pytest.mark.parametrize('arm', ANY_ARM)
def test_links_frames_are_at_the_joints_with_z_along_their_axes(arm):
    model, data = read(arm)
    q = np.array((0.3, -1.1, 2.0))
    pinocchio.forwardKinematics(model, data, q)
    directions, points = arm.chain.axes_at(arm.chain.link_poses(q))
    for i in range(3):
        frame = data.oMi[i + 1]
        np.testing.assert_allclose(frame.rotation[:, 2], directions[i], rtol=0.0, atol=GEOMETRY)
        np.testing.assert_allclose(
            np.cross(frame.translation - points[i], directions[i]), 0.0, atol=GEOMETRY)
        if i > 0:
            np.testing.assert_allclose(frame.translation, points[i], rtol=0.0, atol=GEOMETRY)


@pytest.mark.parametrize('arm', ANY_ARM)
def test_torques_and_inertia_matrix_are_the_model_s(arm):
    model, data = read(arm)
    states = random_states(np.random.default_rng(2), STATES)
    tau, M = inverse_dynamics(arm, *states), inertia_matrix(arm, states[0])
    for i in range(STATES):
        q, qd, qdd = (x[i] for x in states)
        np.testing.assert_allclose(pinocchio.rnea(model, data, q, qd, qdd), tau[i], rtol=0.0,
                                   atol=RELATIVE * np.abs(tau).max())
        upper = np.triu(pinocchio.crba(model, data, q))
        np.testing.assert_allclose(upper, np.triu(M[i]), rtol=0.0,
                                   atol=RELATIVE * np.abs(M).max())


@pytest.mark.parametrize('arm', ARMS)
def test_masses_centres_and_inertias_are_the_model_s(arm):
    model, data = read(arm)
    assert list(model.names)[1:] == list(arm.joint_names)
    q, qd, qdd = random_states(np.random.default_rng(3), 1)
    motion = link_motion(arm, q[0], qd[0], qdd[0])
    pinocchio.forwardKinematics(model, data, q[0])
    for i in range(3):
        link = model.inertias[i + 1]
        assert link.mass == arm.mass[i]
        np.testing.assert_allclose(data.oMi[i + 1].act(link.lever),
                                   motion.centre_of_mass.position[i], rtol=0.0, atol=GEOMETRY)
        in_base = data.oMi[i + 1].rotation @ link.inertia @ data.oMi[i + 1].rotation.T
        R = motion.rotation[i]
        np.testing.assert_allclose(R.T @ in_base @ R, np.diag(arm.inertia[i]), rtol=0.0,
                                   atol=RELATIVE * arm.inertia.max())


def test_limits_and_friction_are_read_back_to_the_last_bit():
    limits = JointLimits(max_velocity=(1.1, np.inf, 0.1 + 0.2), max_effort=(np.inf, 2e2, 1e-5))
    friction = Friction((0.1, 0.2, 0.3), (0.0, 1.0 / 3.0, 2.0))
    text = urdf(RobotModel(friction=friction), limits)
    model = pinocchio.buildModelFromXML(text)
    assert model.lowerPositionLimit.tolist() == limits.min_position.tolist()
    assert model.upperPositionLimit.tolist() == limits.max_position.tolist()
    robot = URDF.from_xml_string(text.encode())
    joints = [robot.joint_map[name] for name in RobotModel().joint_names]
    assert [j.limit.velocity for j in joints] == [1.1, NO_VELOCITY, 0.1 + 0.2]
    assert [j.limit.effort for j in joints] == [NO_EFFORT, 2e2, 1e-5]
    assert [j.dynamics.damping for j in joints] == friction.viscous.tolist()
    assert [j.dynamics.friction for j in joints] == friction.coulomb.tolist()


def test_parser_of_ros_finds_one_chain_from_base_to_tip(capfd):
    arm = RobotModel(joint_names=('a', 'b', 'c'))
    robot = URDF.from_xml_string(urdf(arm, JointLimits(), NAMES).encode())
    assert robot.get_root() == 'floor'
    assert robot.get_chain('floor', 'tool', joints=False) == [
        'floor', 'column', 'upper arm', 'fore<arm', 'tool']
    assert robot.get_chain('floor', 'tool', links=False) == ['a', 'b', 'c', 'tool_joint']
    assert [j.type for j in robot.joints] == ['revolute'] * 3 + ['fixed']
    assert capfd.readouterr() == ('', '')  # it has nothing to complain of


def ends_in_base(text, data, model, shape, kind):
    """Return the cylinders' ends, or the balls' centres, as sets of rounded points."""
    found = []
    for link in ElementTree.fromstring(text).iter('link'):
        for element in link.iter(kind):
            drawn = element.find(f'geometry/{shape}')
            if drawn is None:
                continue
            xyz, rpy = (np.array(element.find('origin').get(k).split(), dtype=float)
                        for k in ('xyz', 'rpy'))
            half = 0.5 * float(drawn.get('length', 0.0))
            along = pinocchio.rpy.rpyToMatrix(rpy) @ (0.0, 0.0, half)
            frame = data.oMf[model.getFrameId(link.get('name'))]
            found.append({rounded(frame.act(xyz + side * along)) for side in (-1.0, 1.0)})
    return found


def rounded(point):
    return tuple(np.round(point, 9) + 0.0)


@pytest.mark.parametrize('arm', [*ANY_ARM, ThesisArm(d1=0.0), ThesisArm(d1=-0.3)])
@pytest.mark.parametrize('kind', ['visual', 'collision'])
def test_shapes_reach_from_joint_to_joint(arm, kind):
    """The ends of the cylinders, carried to the base by Pinocchio, are the links' points."""
    text = urdf(arm, JointLimits())
    model = pinocchio.buildModelFromXML(text)
    data = model.createData()
    q = np.random.default_rng(4).uniform(-2.0, 2.0, 3)
    pinocchio.framesForwardKinematics(model, data, q)
    points = [rounded(p) for p in link_positions(arm, q.tolist())]
    lines = [{a, b} for a, b in zip(points, points[1:]) if a != b]
    assert ends_in_base(text, data, model, 'cylinder', kind) == lines
    assert ends_in_base(text, data, model, 'sphere', kind) == [{p} for p in points[1:-1]]


@pytest.mark.parametrize('frames', [
    FrameNames(base='tip'), FrameNames(links=('a', 'a', 'b')), FrameNames(tip=''),
    FrameNames(links=('a', 'b'))])
def test_names_that_do_not_tell_frames_apart_are_refused(frames):
    with pytest.raises(InvalidInputError, match='must be distinct and not empty'):
        urdf(RobotModel(), JointLimits(), frames)
