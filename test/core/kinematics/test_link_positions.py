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

"""Points between which an arm is drawn: against the thesis's frames, and Pinocchio's joints."""

from __future__ import annotations

from helpers.other_arms import OTHER_ARMS
from helpers.random_cases import ARMS, random_states
from helpers.random_chains import PinocchioChain, random_arm
from helpers.thesis_arm import ThesisArm
from helpers.thesis_link_motion import link_motion
import numpy as np
import pinocchio
import pytest
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.link_positions import link_positions

ROUNDING = 1e-12  # m


@pytest.mark.parametrize('arm', [*ARMS, ThesisArm(d1=0.0), ThesisArm(d1=-0.3)])
def test_link_positions_are_the_origins_of_the_thesis_s_frames(arm):
    q, qd, qdd = random_states(np.random.default_rng(1), 50)
    frames = link_motion(arm, q, qd, qdd).frame.position
    for one, origins in zip(q.tolist(), frames):
        base, *joints = link_positions(arm, one)
        assert base == (0.0, 0.0, 0.0)
        np.testing.assert_allclose(joints, origins, rtol=0.0, atol=ROUNDING)


def pinocchio_s_points(arm, q):
    """Return the base's origin, the joints' points and the tip."""
    reference = PinocchioChain(arm)
    pinocchio.framesForwardKinematics(reference.model, reference.data, q)
    return np.array([np.zeros(3), *(reference.data.oMi[i].translation for i in (1, 2, 3)),
                     reference.data.oMf[reference.tip].translation])


@pytest.mark.parametrize('seed', range(10))
def test_joints_of_any_chain_are_where_pinocchio_has_them(seed):
    arm = random_arm(seed)
    for q in random_states(np.random.default_rng(seed), 20)[0]:
        points = link_positions(arm, q.tolist())
        assert all(type(x) is float for point in points for x in point)
        np.testing.assert_allclose(points, pinocchio_s_points(arm, q), rtol=0.0, atol=ROUNDING)
        np.testing.assert_allclose(points[-1], forward_kinematics(arm, q), rtol=0.0,
                                   atol=ROUNDING)


@pytest.mark.parametrize(('name', 'kept'), [
    ('kr16', [0, 1, 2, 3, 4]), ('leg', [0, 1, 2, 3, 4]), ('finger', [0, 2, 3, 4])])
def test_joints_with_one_point_have_it_once(name, kept):
    arm = OTHER_ARMS[name]
    for q in random_states(np.random.default_rng(2), 20)[0]:
        np.testing.assert_allclose(link_positions(arm, q.tolist()),
                                   pinocchio_s_points(arm, q)[kept], rtol=0.0, atol=ROUNDING)
