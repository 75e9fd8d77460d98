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

"""Joint positions along a path as an arm follows it, and their derivatives by arc length."""

from functools import cache

from helpers.arm_paths import arm_path_in, regular_path
from helpers.other_arms import OTHER_ARMS
from helpers.random_cases import ARMS
from helpers.random_chains import random_arm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.kinematics.forward import forward_kinematics, jacobian, jacobian_rate
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics
from rrr_traj_planner.core.kinematics.postures import ELBOWS
from rrr_traj_planner.core.path.design import line_arc, line_polynomial
from rrr_traj_planner.core.path.following import followed_path

FREE = JointLimits(min_position=np.full(3, -np.inf), max_position=np.full(3, np.inf))
ANY_ARM = {**{f'thesis {k} {elbow}': (arm, elbow) for k, arm in enumerate(ARMS)
              for elbow in ELBOWS},
           **{f'random {seed}': (random_arm(seed), None) for seed in range(6)},
           **{name: (arm, None) for name, arm in OTHER_ARMS.items()}}


def random_path(model, rng):
    """Return a path well inside the workspace, on one side of joint axis 1."""
    least, most = model.reach
    points = []
    while len(points) < 4:
        d = rng.normal(size=3)
        d[0] = abs(d[0]) + 1.5
        p = d / np.linalg.norm(d) * rng.uniform(0.6 * most + 0.4 * least, 0.9 * most)
        points.append(p + (0.0, 0.0, model.d1))
    return line_polynomial(points, 0.2 * most) if rng.random() < 0.5 else line_arc(
        points, 0.1 * most)


@cache
def arm_paths(name):
    """Return paths as an arm follows them."""
    arm, elbow = ANY_ARM[name]
    rng = np.random.default_rng(82)
    if elbow is not None:
        return [arm_path_in(arm, FREE, random_path(arm, rng), elbow) for _ in range(3)]
    return [followed_path(arm, *regular_path(arm, rng)) for _ in range(3)]


@pytest.mark.parametrize('arm', ARMS)
@pytest.mark.parametrize('elbow', ELBOWS)
def test_forward_kinematics_of_joint_positions_is_the_path_and_they_equal_the_inverse(arm, elbow):
    rng = np.random.default_rng(81)
    for _ in range(3):
        path = random_path(arm, rng)
        s = np.linspace(0.0, path.length, 60)
        p, q = path(s)[0], arm_path_in(arm, FREE, path, elbow)(s).q
        assert forward_kinematics(arm, q) == pytest.approx(p, abs=1e-12)
        one_by_one = np.array([inverse_kinematics(arm, x, elbow) for x in p])
        assert np.exp(1j * q) == pytest.approx(np.exp(1j * one_by_one), abs=1e-10)
        assert np.abs(np.diff(q, axis=0)).max() < 1.0


@pytest.mark.parametrize('name', ANY_ARM)
def test_derivatives_satisfy_the_jacobian_and_its_rates(name):
    for arm_path in arm_paths(name):
        arm, path = arm_path.model, arm_path.path
        s = np.linspace(0.0, path.length, 40)
        _, dp, ddp, dddp = path(s)
        q, q1, q2, q3 = arm_path(s)
        J, J1 = jacobian(arm, q), jacobian_rate(arm, q, q1)
        h = 1e-4 * min(1.0, 1.0 / np.abs(q1).max())
        step = [(k * h, jacobian_rate(arm, q + k * h * q1 + 0.5 * (k * h) ** 2 * q2,
                                      q1 + k * h * q2)) for k in (-1.0, 1.0)]
        J2 = (step[1][1] - step[0][1]) / (2.0 * h)  # second rate, by differences

        def times(M, v):
            return np.einsum('nij,nj->ni', M, v)

        assert times(J, q1) == pytest.approx(dp, abs=1e-11)
        size = 1.0 + np.abs(q2).max()
        assert times(J, q2) + times(J1, q1) == pytest.approx(ddp, abs=1e-11 * size)
        size = 1.0 + np.abs(q3).max() + np.abs(q1).max() ** 3
        assert times(J, q3) + 2.0 * times(J1, q2) + times(J2, q1) == pytest.approx(
            dddp, abs=3e-5 * size)


@pytest.mark.parametrize('name', [name for name in ANY_ARM if '0' in name or 'thesis' not in name])
@pytest.mark.parametrize('order', [0, 1, 2])
def test_each_derivative_is_that_of_the_one_before(name, order):
    for arm_path in arm_paths(name):
        knots = np.concatenate(([0.0], arm_path.path.joins, [arm_path.path.length]))
        for a, b in zip(knots[:-1], knots[1:]):
            # Polynomials through Chebyshev points of one piece, differentiated.
            at = 0.5 * (a + b) - 0.5 * (b - a) * np.polynomial.chebyshev.chebpts1(61)
            s = np.linspace(a, b, 30)[3:-3]
            own, before = arm_path(s)[order + 1], arm_path(at)[order]
            for j in range(3):
                fit = np.polynomial.Chebyshev.fit(at, before[:, j], 60, domain=[a, b])
                assert own[:, j] - fit.deriv()(s) == pytest.approx(
                    0.0, abs=1e-5 * (1.0 + np.abs(own[:, j]).max()))


@pytest.mark.parametrize('name', ANY_ARM)
def test_positions_do_not_depend_on_the_order_or_number_of_path_coordinates(name):
    arm_path = arm_paths(name)[0]
    s = np.random.default_rng(84).uniform(0.0, arm_path.path.length, 30)
    together = arm_path(s)
    for k in range(len(s)):
        for one, of_all in zip(arm_path(s[k:k + 1]), together):
            np.testing.assert_array_equal(one[0], of_all[k])


def test_whole_turns_are_added_to_all_positions():
    arm_path, turns = arm_paths('random 0')[0], 2.0 * np.pi * np.array((1.0, -2.0, 0.0))
    s = np.linspace(0.0, arm_path.path.length, 50)
    for order, (turned, own) in enumerate(zip(arm_path.turned(turns)(s), arm_path(s))):
        size = 1.0 + np.abs(own).max()
        assert turned == pytest.approx(own + (turns if order == 0 else 0.0), abs=1e-11 * size)
