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

"""The frame of joint axis 1, and whether the tip stays in a plane through it."""

from helpers.arm_paths import rotated
from helpers.other_arms import OTHER_ARMS
from helpers.random_cases import ARMS
from helpers.random_chains import random_arm
import numpy as np
import pytest
from rrr_traj_planner.core.kinematics.axis_frame import axis_frame
from rrr_traj_planner.core.kinematics.branch_factors import branch_factors
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from scipy.spatial.transform import Rotation

ROUNDING = 1e-13  # of the arm's size

ROTATED = [rotated(arm, Rotation.random(random_state=seed).as_matrix())
           for seed, arm in enumerate(ARMS)]


def states(n=200):
    return np.random.default_rng(1).uniform(-np.pi, np.pi, (n, 3))


@pytest.mark.parametrize('arm', [*ARMS, *ROTATED, OTHER_ARMS['kr16'], OTHER_ARMS['finger']])
def test_without_lateral_offset_the_tip_stays_in_the_plane_of_joint_1(arm):
    frame, q = axis_frame(arm), states()
    assert frame.swings_in_plane
    x, y, _ = frame.coordinates(forward_kinematics(arm, q * (0.0, 1.0, 1.0))).T
    assert np.abs(y).max() <= ROUNDING * arm.chain.size
    assert x == pytest.approx(branch_factors(arm, q)[1], abs=ROUNDING * arm.chain.size)
    across = [(forward_kinematics(arm, p) - frame.origin) @ frame.normal(p[0]) for p in q]
    assert np.abs(across).max() <= ROUNDING * arm.chain.size


@pytest.mark.parametrize('arm', [OTHER_ARMS['leg'], *(random_arm(seed) for seed in range(6))])
def test_with_lateral_offset_it_does_not(arm):
    frame = axis_frame(arm)
    assert not frame.swings_in_plane
    _, y, _ = frame.coordinates(forward_kinematics(arm, states() * (0.0, 1.0, 1.0))).T
    assert np.abs(y).max() > 1e-3 * arm.chain.size


@pytest.mark.parametrize('arm', [*ROTATED, *OTHER_ARMS.values(), random_arm(0), random_arm(1)])
def test_frame_is_right_handed_on_joint_axis_1_with_the_tip_in_front(arm):
    frame = axis_frame(arm)
    assert frame.rotation @ frame.rotation.T == pytest.approx(np.eye(3), abs=1e-14)
    assert np.linalg.det(frame.rotation) == pytest.approx(1.0)
    assert frame.rotation[2] == pytest.approx(arm.chain.axis[0], abs=1e-14)
    assert frame.rotation[0] @ arm.chain.axis[1] == pytest.approx(0.0, abs=1e-14)
    assert frame.coordinates(arm.chain.tip)[0] >= 0.0
    on_axis = arm.chain.point[0] + 0.3 * arm.chain.axis[0]
    assert frame.coordinates(on_axis)[:2] == pytest.approx((0.0, 0.0), abs=1e-14)
