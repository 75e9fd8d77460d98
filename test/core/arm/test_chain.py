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

"""Chains of three joints: what is refused, and where links are."""

from dataclasses import replace
import pickle

from helpers.other_arms import OTHER_ARMS
from helpers.random_cases import random_states
from helpers.random_chains import random_chain
import numpy as np
import pytest
from rrr_traj_planner.core.arm.chain import UnsupportedChainError
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.kinematics.forward import jacobian

ROUNDING = 1e-12
CHAIN = random_chain(np.random.default_rng(0))
SKEW = np.array([[1.0, 0.1, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])


@pytest.mark.parametrize(('changes', 'text'), [
    ({'axis': np.eye(2)}, r'^axis has shape \(2, 2\), must have \(3, 3\)$'),
    ({'axis': [(1, 0, 0), (0, 0, 0), (0, 1, 0)]}, '^axis of joint 2 is zero$'),
    ({'axis': [(0, 0, 1), (0, 1e-4, -1), (0, 1, 0)]},
     '^joint axes 1 and 2 are parallel: planar and SCARA-like arms are not supported$'),
    *(({'tip': CHAIN.point[2] + offset + 0.5 * CHAIN.axis[2]},
       '^the tip is on joint axis 3, which does not move it$')
      for offset in (0.0, 1e-8 * np.cross(CHAIN.axis[2], (0.0, 0.0, 1.0)))),
    ({'tip': (0.0, np.nan, 0.0)}, r'^tip\[1\] is nan, must be finite$'),
    ({'mass': (1.0, -2.0, 3.0)}, r'^mass is \[1\.0, -2\.0, 3\.0\] kg, must not be negative$'),
    ({'inertia': [np.eye(3), SKEW, np.eye(3)]}, '^inertia of link 2 is not symmetric$'),
    ({'inertia': [np.eye(3), np.eye(3), np.diag((1.0, 1.0, -0.1))]},
     '^inertia of link 3 has a negative principal moment$'),
])
def test_what_is_no_arm_is_refused(changes, text):
    with pytest.raises(InvalidInputError, match=text):
        replace(CHAIN, **changes)


def turned_by(R, points):
    return np.asarray(points, dtype=float) @ R.T


@pytest.mark.parametrize('seed', range(6))
@pytest.mark.parametrize(('axis', 'point', 'text'), [
    ([(0, 0, 1), (0, 1, 0), (0, -1, 0)], [(0, 0, 0), (0.1, 0, 0.5), (0.1, 0.3, 0.5)],
     '^joint axes 2 and 3 are one line: the tip moves on a surface$'),
    ([(0, 0, 1), (0.3, 1, 0.2), (1, 0, 0.5)], [(0, 0, 0.5), (0.3, 1, 0.7), (-2, 0, -1)],
     '^joint axes 1, 2 and 3 meet in one point: the tip moves on a sphere$')])
def test_arms_whose_jacobian_is_singular_in_every_pose_are_refused(axis, point, text, seed):
    rng = np.random.default_rng(seed)
    R, tip = np.linalg.qr(rng.normal(size=(3, 3)))[0], rng.uniform(-1.0, 1.0, 3)
    shift = rng.uniform(-1.0, 1.0, 3)
    if 'meet' in text:  # in (0, 0, 0)
        point = np.array([3.0, -1.0, 2.0])[:, np.newaxis] * np.array(axis, dtype=float)
    change = {'axis': turned_by(R, axis), 'point': turned_by(R, point) + shift,
              'tip': turned_by(R, tip) + shift}
    with pytest.raises(UnsupportedChainError, match=text):
        replace(CHAIN, **change)
    # A thousandth of its size beside it is an arm, and no other arm's Jacobian is so singular.
    change['point'][2] += 2e-3 * np.cross(change['axis'][2], change['tip'] - change['point'][2])
    arm = RobotModel(replace(CHAIN, **change))
    q = rng.uniform(-np.pi, np.pi, (200, 3))
    least = np.linalg.svd(jacobian(arm, q), compute_uv=False)[:, 2]
    assert least.max() > 1e-5 * arm.chain.size


def test_a_chain_that_is_not_supported_is_told_by_joints():
    scara = {'axis': [(0, 0, 1)] * 3}  # and an arm of this kind reaches a volume, not a plane
    with pytest.raises(UnsupportedChainError) as error:
        replace(CHAIN, **scara)
    again = pickle.loads(pickle.dumps(error.value))
    assert again.joints == (1, 2)
    assert str(again.named(['a', 'b', 'c'])) == (
        "joint axes 'a' and 'b' are parallel: planar and SCARA-like arms are not supported")


def test_axes_have_length_one():
    chain = replace(CHAIN, axis=5.0 * CHAIN.axis)
    np.testing.assert_allclose(chain.axis, CHAIN.axis, rtol=0.0, atol=ROUNDING)


@pytest.mark.parametrize('seed', range(5))
def test_links_move_about_their_joints_and_no_farther_than_the_chain_s_size(seed):
    chain = random_chain(np.random.default_rng(seed))
    q = random_states(np.random.default_rng(seed), 50)[0]
    poses = chain.link_poses(q)
    directions, points = chain.axes_at(poses)
    for i, (R, t) in enumerate(poses):
        assert R @ R.swapaxes(1, 2) == pytest.approx(np.tile(np.eye(3), (50, 1, 1)), abs=ROUNDING)
        # a joint's axis moves with the links on both of its sides
        assert R @ chain.axis[i] == pytest.approx(directions[:, i], abs=ROUNDING)
        assert R @ chain.point[i] + t == pytest.approx(points[:, i], abs=ROUNDING)
    R, t = poses[2]
    from_axis_1 = np.cross(R @ chain.tip + t - chain.point[0], chain.axis[0])
    assert np.linalg.norm(from_axis_1, axis=1).max() <= chain.size


@pytest.mark.parametrize(('name', 'size'), [
    ('kr16', np.hypot(0.26, 0.675) + 0.68 + np.hypot(0.67, 0.035)), ('leg', 0.08 + 0.42),
    ('finger', 0.09)])
def test_size_is_the_way_from_the_first_joint_to_the_tip(name, size):
    assert OTHER_ARMS[name].chain.size == pytest.approx(size, abs=ROUNDING)
