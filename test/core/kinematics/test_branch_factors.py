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

"""The factors of the Jacobian's determinant that name the branches."""

from dataclasses import replace
from itertools import product

from helpers.public_arms import DESCRIPTIONS
from helpers.random_cases import ARMS
from helpers.random_chains import random_arm, with_axes
import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.branch_factors import branch_factors, has_named_postures
from rrr_traj_planner.core.kinematics.forward import forward_kinematics, jacobian
from rrr_traj_planner.core.kinematics.link_positions import link_positions
from rrr_traj_planner.core.kinematics.postures import posture_of
from rrr_traj_planner.core.kinematics.solutions import all_solutions

EXACT = 1e-12  # of the cube of the arm's size: rounding

NAMED = {**{f'thesis {k}': arm for k, arm in enumerate(ARMS)},
         **{f'parallel {seed}': with_axes(random_arm(seed), parallel=True) for seed in range(4)},
         **{f'meeting {seed}': with_axes(random_arm(seed), 0.0) for seed in range(4)}}


def states(n=300):
    return np.random.default_rng(1).uniform(-7.0, 7.0, (n, 3))


def sine_of_axes(arm):
    return np.linalg.norm(np.cross(*arm.chain.axis[:2]))


@pytest.mark.parametrize('name', NAMED)
def test_their_product_is_the_determinant_but_for_one_sign(name):
    arm, q = NAMED[name], states()
    elbow, shoulder = branch_factors(arm, q)
    det = np.linalg.det(jacobian(arm, q))
    product = sine_of_axes(arm) * elbow * shoulder
    rounding = EXACT * arm.chain.size ** 3
    assert min(np.abs(det - product).max(), np.abs(det + product).max()) <= rounding
    assert has_named_postures(arm)


@pytest.mark.parametrize('seed', range(10))
def test_of_skew_axes_the_determinant_has_no_factors(seed):
    arm, q = random_arm(seed), states()
    elbow, shoulder = branch_factors(arm, q)
    rest = np.abs(np.linalg.det(jacobian(arm, q))) - sine_of_axes(arm) * np.abs(elbow * shoulder)
    assert np.abs(rest).max() > 1e-4 * arm.chain.size ** 3
    assert not has_named_postures(arm)


@pytest.mark.parametrize('arm', ARMS)
def test_signs_are_the_postures_of_the_thesis_s_kind_of_arm(arm):
    q = states()
    elbow, shoulder = branch_factors(arm, q)
    assert elbow == pytest.approx(arm.a2 * arm.d4 * np.cos(q[:, 2]), abs=EXACT)
    radial = arm.a2 * np.cos(q[:, 1]) + arm.d4 * np.sin(q[:, 1] + q[:, 2])  # (5.8)
    assert shoulder == pytest.approx(radial, abs=EXACT)
    for x, up, front in zip(q, elbow >= 0.0, shoulder >= 0.0):
        assert tuple(posture_of(arm, x)) == ('up' if up else 'down', 'front' if front else 'back')


@pytest.mark.parametrize('name', ['thesis 0', 'parallel 1', 'parallel 3'])
def test_no_two_solutions_have_the_same_signs_where_axes_2_and_3_are_parallel(name):
    arm = NAMED[name]
    q, count = all_solutions(arm, forward_kinematics(arm, states()))
    for solutions, n in zip(q, count):
        signs = np.stack(branch_factors(arm, solutions[:n]), axis=1) > 0.0
        assert len(np.unique(signs, axis=0)) == n


def test_front_is_the_side_of_the_tip_with_all_joints_at_zero():
    for arm in NAMED.values():
        assert branch_factors(arm, np.zeros(3))[1] >= 0.0


def with_other_signs(arm, signs):
    """Return an arm whose axes are described the other way round."""
    return RobotModel(replace(arm.chain, axis=arm.chain.axis * np.array(signs)[:, np.newaxis]))


@pytest.mark.parametrize('name', NAMED)
def test_postures_do_not_depend_on_the_signs_of_a_description_s_axes(name):
    arm, q = NAMED[name], states(30)
    for signs in product((1.0, -1.0), repeat=3):
        other = with_other_signs(arm, signs)
        for x in q:
            assert posture_of(other, x * signs) == posture_of(arm, x)


@pytest.mark.parametrize('tilt', [0.0, np.pi])  # hanging from a ceiling too
def test_elbow_is_up_where_it_is_above_the_line_from_shoulder_to_tip(tilt):
    rng = np.random.default_rng(4)
    for _ in range(20):
        # Axes 2 and 3 along y, as a base frame's y axis or against it; joint 1 upright.
        chain, radial, *heights = RobotModel().chain, *rng.uniform(-0.5, 0.5, 4)
        point = np.array([(0.0, 0.0, 0.0), (radial, 0.0, heights[0]), (0.6, 0.0, heights[1])])
        model = RobotModel(replace(
            chain, axis=np.array([(0.0, 0.0, np.cos(tilt)), *rng.choice((-1.0, 1.0), (2, 1))
                                  * (0.0, 1.0, 0.0)]),
            point=point, tip=np.array((1.1, 0.0, heights[2]))))
        for q in rng.uniform(-np.pi, np.pi, (50, 3)):
            q[0] = 0.0  # the arm in the plane of x and z
            shoulder, elbow, tip = np.array(link_positions(model, q)[-3:])
            if np.abs(np.linalg.det(jacobian(model, q))) < 1e-3:
                continue
            (x, _, z), (along, _, height) = tip - shoulder, elbow - shoulder
            above = (height * x - z * along) > 0.0  # seen with the tip on the right
            assert posture_of(model, q) == ('up' if above else 'down',
                                            'front' if tip[0] > 0.0 else 'back')


def test_elbow_of_a_real_arm_with_its_upper_arm_upright_and_forearm_level_is_up():
    model = RobotModel.from_urdf(DESCRIPTIONS / 'kr16_2_first3.urdf', 'base', 'tip')
    assert posture_of(model, np.array((0.3, -0.5 * np.pi, 0.5 * np.pi))) == ('up', 'front')


def test_factors_have_the_states_shape():
    elbow, shoulder = branch_factors(RobotModel(), np.zeros((4, 5, 3)))
    assert elbow.shape == shoulder.shape == (4, 5)
    assert branch_factors(RobotModel(), np.zeros(3))[0].shape == ()
