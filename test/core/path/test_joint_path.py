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

"""Joint positions along a path, and their derivatives by arc length."""

from helpers.random_cases import ARMS
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import LimitViolationError, UnreachableError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics, jacobian, jacobian_rate
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics
from rrr_traj_planner.core.kinematics.postures import ELBOWS, Posture
from rrr_traj_planner.core.path.design import line_arc, line_polynomial
from rrr_traj_planner.core.path.joint_path import joint_path

FREE = JointLimits(min_position=np.full(3, -np.inf), max_position=np.full(3, np.inf))


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


@pytest.mark.parametrize('arm', ARMS)
@pytest.mark.parametrize('elbow', ELBOWS)
def test_forward_kinematics_of_joint_positions_is_the_path_and_they_equal_the_inverse(arm, elbow):
    rng = np.random.default_rng(81)
    for _ in range(10):
        path = random_path(arm, rng)
        d = path(np.linspace(0.0, path.length, 60))
        q = joint_path(arm, FREE, d, Posture(elbow)).q
        assert forward_kinematics(arm, q) == pytest.approx(d[0], abs=1e-12)
        one_by_one = np.array([inverse_kinematics(arm, p, elbow) for p in d[0]])
        assert np.exp(1j * q) == pytest.approx(np.exp(1j * one_by_one), abs=1e-10)
        assert np.abs(np.diff(q, axis=0)).max() < 1.0


@pytest.mark.parametrize('arm', ARMS)
@pytest.mark.parametrize('elbow', ELBOWS)
def test_derivatives_satisfy_the_jacobian_and_its_rates(arm, elbow):
    rng = np.random.default_rng(82)
    for _ in range(10):
        path = random_path(arm, rng)
        p, dp, ddp, dddp = path(np.linspace(0.0, path.length, 40))
        q, q1, q2, q3 = joint_path(arm, FREE, (p, dp, ddp, dddp), Posture(elbow))
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


@pytest.mark.parametrize('elbow', ELBOWS)
@pytest.mark.parametrize('order', [0, 1, 2])
def test_each_derivative_is_that_of_the_one_before(elbow, order):
    rng = np.random.default_rng(83)
    for _ in range(20):
        path = random_path(RobotModel(), rng)
        knots = np.concatenate(([0.0], path.joins, [path.length]))
        for a, b in zip(knots[:-1], knots[1:]):
            # A polynomial through Chebyshev points of one piece, differentiated.
            fit = np.polynomial.Chebyshev.interpolate(
                lambda s, path=path: joint_path(
                    RobotModel(), FREE, path(s), Posture(elbow))[order][:, 0],
                40, domain=[a, b])
            s = np.linspace(a, b, 30)[3:-3]
            own = joint_path(RobotModel(), FREE, path(s), Posture(elbow))[order + 1][:, 0]
            turn = own - fit.deriv()(s)
            assert turn == pytest.approx(0.0, abs=1e-5 * (1.0 + np.abs(own).max()))


def circle(n=200):
    """Return a turn and a half about joint axis 1, at 1 m, as points and derivatives."""
    s = np.linspace(0.0, 3.0 * np.pi, n)
    c, d, zero = np.cos(s), np.sin(s), np.zeros(n)
    return (np.stack((c, d, zero + 0.5), 1), np.stack((-d, c, zero), 1),
            np.stack((-c, -d, zero), 1), np.stack((d, -c, zero), 1))


def test_joint_1_turns_on_past_half_a_turn_without_a_jump():
    q, q1, q2, q3 = joint_path(RobotModel(), FREE, circle(), Posture('up'))
    assert q[:, 0] == pytest.approx(np.linspace(0.0, 3.0 * np.pi, 200), abs=1e-12)
    assert q1[:, 0] == pytest.approx(np.ones(200), abs=1e-13)
    assert np.abs(np.concatenate((q1[:, 1:], q2, q3), axis=1)).max() < 1e-12


def test_whole_turns_are_those_for_which_the_whole_path_fits():
    limits = JointLimits(min_position=(-9.0, -4.0, -4.0), max_position=(4.0, 4.0, 4.0))
    q = joint_path(RobotModel(), limits, circle(), Posture('up')).q[:, 0]
    assert q[0] == pytest.approx(-2.0 * np.pi, abs=1e-12)
    free = joint_path(RobotModel(), FREE, circle(), Posture('up'), start=(13.0, 0.0, 0.0)).q[:, 0]
    assert free[0] == pytest.approx(4.0 * np.pi, abs=1e-12)


def test_joint_that_leaves_its_range_is_refused_with_sample_value_and_limit():
    with pytest.raises(LimitViolationError,
                       match=r'^sample \d+: joint_1 would be at .* rad \(elbow up\), limits 0 to '
                             r'1\.5708 rad$') as caught:
        joint_path(RobotModel(), JointLimits(), circle(), Posture('up'))
    assert caught.value.joint == 'joint_1'


def samples(*points):
    p = np.array(points)
    return (p, np.ones_like(p), np.zeros_like(p), np.zeros_like(p))


@pytest.mark.parametrize(('point', 'error', 'text'), [
    ((1.0, 1.5, 0.5), UnreachableError, '^sample 1 is 1.80278 m from the shoulder'),
    ((1.6, 0.0, 0.5), UnreachableError, '^sample 1 is 1.6 m from the shoulder'),
    ((0.1, 0.0, 0.5), UnreachableError, '^sample 1 is 0.1 m from the shoulder'),
    ((0.0, 0.0, 1.5), LimitViolationError,
     r'^sample 1 is on joint axis 1 \(singularity\): joint_1 would need')])
def test_sample_where_the_arm_could_not_move_on_is_refused(point, error, text):
    with pytest.raises(error, match=text):
        joint_path(RobotModel(), FREE, samples((1.0, 0.0, 0.5), point), Posture('up'))
