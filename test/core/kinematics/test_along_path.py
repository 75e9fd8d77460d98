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

"""The kernels that find joint positions along a path."""

from helpers.arm_paths import least_singular_values, regular_path
from helpers.other_arms import OTHER_ARMS
from helpers.random_cases import central_difference
from helpers.random_chains import random_arm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.along_path import (
    follow_points,
    joint_path_near,
    PathPoints,
    singular_distance,
    SINGULAR_VALUE,
)
from rrr_traj_planner.core.kinematics.forward import forward_kinematics, jacobian
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics
from rrr_traj_planner.core.path.design import line_arc
from rrr_traj_planner.core.path.following import followed_path

ANY_ARM = {'thesis': RobotModel(), **{f'random {seed}': random_arm(seed) for seed in range(4)},
           **OTHER_ARMS}


def circle(n=200):
    """Return a turn and a half about joint axis 1, at 1 m, as points and derivatives."""
    s = np.linspace(0.0, 3.0 * np.pi, n)
    c, d, zero = np.cos(s), np.sin(s), np.zeros(n)
    return PathPoints(np.stack((c, d, zero + 0.5), 1), np.stack((-d, c, zero), 1),
                      np.stack((-c, -d, zero), 1), np.stack((d, -c, zero), 1))


def followed(name):
    arm = ANY_ARM[name]
    return followed_path(arm, *regular_path(arm, np.random.default_rng(91)))


def test_joint_1_turns_on_past_half_a_turn_without_a_jump():
    arm, points, s = RobotModel(), circle(), np.linspace(0.0, 3.0 * np.pi, 200)
    first = inverse_kinematics(arm, points.p[0])
    guess = first + np.outer(s, (1.0, 0.0, 0.0)) + np.random.default_rng(90).uniform(
        -0.1, 0.1, (200, 3))
    of_follow = follow_points(arm, s, points, points, first)
    q, q1, q2, q3 = joint_path_near(arm, points, guess)[0]
    for positions in (q, of_follow.q):
        assert positions == pytest.approx(first + np.outer(s, (1.0, 0.0, 0.0)), abs=1e-12)
    assert q1[:, 0] == pytest.approx(np.ones(200), abs=1e-13)
    assert np.abs(np.concatenate((q1[:, 1:], q2, q3), axis=1)).max() < 1e-12


@pytest.mark.parametrize('name', ANY_ARM)
def test_results_do_not_depend_on_the_number_of_points(name):
    arm_path = followed(name)
    arm, path, s = arm_path.model, arm_path.path, arm_path.s
    points = PathPoints(*path(s))
    found, regularity = joint_path_near(arm, points, arm_path.q)
    of_follow = follow_points(arm, s, points, points, arm_path.q[0])
    for n in (1, 2, len(s) // 2):
        part = PathPoints(*(x[:n] for x in points[:4]))
        of_part, its_regularity = joint_path_near(arm, part, arm_path.q[:n])
        for ours, of_all in zip((*of_part, its_regularity), (*found, regularity)):
            np.testing.assert_array_equal(ours, of_all[:n])
        if n > 1:
            ours = follow_points(arm, s[:n], part, part, arm_path.q[0])
            np.testing.assert_array_equal(ours.q, of_follow.q[:n])
            np.testing.assert_array_equal(ours.rates, of_follow.rates[:, :n])
            np.testing.assert_array_equal(ours.regularity, of_follow.regularity[:, :n])
            np.testing.assert_array_equal(ours.error, of_follow.error[:n - 1])


@pytest.mark.parametrize('name', ANY_ARM)
def test_regularity_is_the_determinant_its_derivatives_and_a_bound_on_the_singular_value(name):
    arm_path = followed(name)
    arm = arm_path.model
    ends = np.concatenate(([0.0], arm_path.path.joins, [arm_path.path.length]))
    s = (ends[:-1, np.newaxis] + np.outer(np.diff(ends), np.linspace(0.1, 0.9, 9))).ravel()
    h = np.repeat(1e-3 * np.diff(ends), 9)
    q, regularity = arm_path(s).q, arm_path.regularity(s)

    def determinant(order):
        return lambda x: arm_path.regularity(x)[:, order]

    assert regularity[:, 0] == pytest.approx(
        np.linalg.det(jacobian(arm, q)), abs=1e-14 * arm.chain.size ** 3)
    for order in (0, 1):
        own = regularity[:, order + 1]
        assert own == pytest.approx(central_difference(determinant(order), s, h),
                                    abs=1e-6 * np.abs(own).max())
    sigma = least_singular_values(arm, q)
    assert (regularity[:, SINGULAR_VALUE] <= sigma * (1.0 + 1e-12)).all()
    assert (regularity[:, SINGULAR_VALUE] >= sigma / np.sqrt(3.0) * (1.0 - 1e-12)).all()


@pytest.mark.parametrize('beyond', [1e-2, 1e-3, 1e-4])
def test_distance_to_the_edge_of_the_workspace_is_told_from_near_it(beyond):
    # Outward at the shoulder's height: at 1.6 m the arm is stretched.
    arm, path = RobotModel(), line_arc([(1.0, 0.0, 0.5), (1.59999, 0.0, 0.5)], [])
    arm_path = followed_path(arm, path, inverse_kinematics(arm, path.points[0]))
    found = singular_distance(arm_path.regularity(np.array((0.6 - beyond,))))
    assert found == pytest.approx(beyond, rel=0.05)


def test_positions_are_not_sought_far_from_the_guess():
    arm = RobotModel()
    point = forward_kinematics(arm, np.array((0.3, 0.9, 0.2)))
    points = PathPoints(point[np.newaxis], *np.zeros((3, 1, 3)))
    with pytest.raises(RuntimeError, match='^no joint positions at point 0 of a path near '):
        joint_path_near(arm, points, np.array(((1.3, 0.9, 0.2),)))
