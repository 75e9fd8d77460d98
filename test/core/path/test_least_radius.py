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

"""The least radius and the largest speed on an arc, against scans."""

import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.core.errors import InvalidInputError, LimitViolationError
from rrr_traj_planner.core.kinematics.forward import jacobian, jacobian_rate
from rrr_traj_planner.core.path.least_radius import largest_speed, least_radius

MODEL, INF = RobotModel(), np.full(3, np.inf)
EFFORT_ONLY = JointLimits(max_velocity=INF, max_acceleration=INF)
X, Y = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
Q = np.array([0.7, 0.9, 0.2])


def random_case(rng):
    """Return a pose off the singular ones, and two directions at a right angle."""
    q = np.array([rng.uniform(0.0, 1.5), rng.uniform(0.4, 1.6), rng.uniform(-0.7, 0.9)])
    T, N = np.linalg.qr(rng.normal(size=(3, 2)))[0].T
    return q, T, N


def keeps(limits, q, T, N, speed, radius):
    """Return whether each speed and radius (arrays alike) keeps all limits, written plainly."""
    J = jacobian(MODEL, q)
    speed, radius = np.broadcast_arrays(speed, radius)
    w = np.linalg.solve(J, T)
    qd = speed[:, np.newaxis] * w
    tip = (speed ** 2 / radius)[:, np.newaxis] * N
    Jdot_qd = np.einsum('nij,nj->ni', jacobian_rate(MODEL, np.broadcast_to(q, qd.shape), qd), qd)
    qdd = np.linalg.solve(J, (tip - Jdot_qd).T).T
    tau = inverse_dynamics(MODEL, np.broadcast_to(q, qd.shape), qd, qdd)
    return ((np.abs(qd) <= limits.max_velocity) & (np.abs(qdd) <= limits.max_acceleration)
            & (np.abs(tau) <= limits.max_effort)).all(axis=1)


@pytest.mark.parametrize('limits', [EFFORT_ONLY, JointLimits()])
def test_least_radius_is_the_one_that_a_dense_scan_finds(limits):
    rng, feasible, refused = np.random.default_rng(71), 0, 0
    radii = np.geomspace(1e-4, 1e4, 2001)
    for _ in range(300):
        q, T, N = random_case(rng)
        speed = 10.0 ** rng.uniform(-1.0, 0.5)
        ok = keeps(limits, q, T, N, speed, radii)
        try:
            least = least_radius(MODEL, limits, q, T, N, speed)
        except LimitViolationError:
            assert not ok.any()
            refused += 1
            continue
        feasible += 1
        if least.value > 1e-4:
            assert radii[ok.argmax()] == pytest.approx(least.value, rel=0.01)
            assert not ok[radii < least.value * (1.0 - 1e-9)].any()
        else:
            assert ok[0]
    assert feasible > 80
    assert refused > 10


@pytest.mark.parametrize('limits', [EFFORT_ONLY, JointLimits()])
def test_largest_speed_is_the_one_that_a_dense_scan_finds(limits):
    rng, feasible = np.random.default_rng(72), 0
    speeds = np.geomspace(1e-3, 1e2, 2001)
    for _ in range(200):
        q, T, N = random_case(rng)
        radius = 10.0 ** rng.uniform(-3.0, 1.0)
        ok = keeps(limits, q, T, N, speeds, radius)
        try:
            most = largest_speed(MODEL, limits, q, T, N, radius)
        except LimitViolationError:
            assert not ok.any()
            continue
        feasible += 1
        last = len(speeds) - 1 - ok[::-1].argmax()
        assert speeds[last] == pytest.approx(most.value, rel=0.006)
        assert ok[last]
    assert feasible > 150


def test_least_radius_at_the_largest_speed_is_the_radius():
    rng, tried = np.random.default_rng(73), 0
    for _ in range(100):
        q, T, N = random_case(rng)
        try:
            most = largest_speed(MODEL, EFFORT_ONLY, q, T, N, 0.05)
            least = least_radius(MODEL, EFFORT_ONLY, q, T, N, most.value)
        except LimitViolationError:
            continue
        assert least.value == pytest.approx(0.05, rel=1e-6)
        assert (least.joint, least.quantity) == (most.joint, most.quantity)
        tried += 1
    assert tried > 50


def test_least_radius_goes_to_zero_with_the_speed():
    values = [least_radius(MODEL, EFFORT_ONLY, Q, X, Y, v).value for v in (0.0, 0.001, 0.002)]
    assert values[0] == 0.0
    assert 0.0 < values[1] < 1e-5
    assert values[2] == pytest.approx(4.0 * values[1], rel=1e-2)


def test_speed_beyond_a_joint_s_velocity_is_refused_with_joint_value_and_limit():
    # Around joint axis 1 at a distance r the tip turns joint 1 by v / r.
    q = np.array([0.0, 0.0, 1.0])
    r = 0.9 + 0.7 * np.sin(1.0)
    with pytest.raises(LimitViolationError,
                       match=r'^at 3 m/s joint_1 would need velocity .* rad/s at the least, '
                             r'limit 1 rad/s$') as caught:
        least_radius(MODEL, JointLimits(), q, Y, -X, 3.0)
    assert caught.value.value == pytest.approx(3.0 / r, rel=1e-12)
    assert caught.value.limit == 1.0
    assert caught.value.joint == 'joint_1'


def test_pose_that_cannot_be_held_has_no_largest_speed():
    # Faster than the joints may turn, the centrifugal torque would hold it.
    weak = JointLimits(max_effort=(150.0, 10.0, 200.0), max_acceleration=INF)
    q = np.array([0.0, 0.0, 1.0])
    with pytest.raises(LimitViolationError, match='joint_2'):
        largest_speed(MODEL, weak, q, Y, X, np.inf)


# Upper arm leant back, forearm leading forward to joint axis 1: a2 c2 + d4 s23 = 0.
BACK = np.pi / 2 + 0.2
ON_AXIS = (0.3, BACK, np.arcsin(0.9 * np.sin(0.2) / 0.7) - BACK)


@pytest.mark.parametrize(('q', 'joint'), [
    # Near it, the joints' velocities are as those that leave the tip at rest: stretched,
    # 0.9 qd2 + 0.7 (qd2 + qd3) = 0, folded, 0.9 qd2 - 0.7 (qd2 + qd3) = 0.
    ((0.3, 0.5, np.pi / 2), 'joint_3'), ((0.3, 0.5, -np.pi / 2), 'joint_2'),
    (ON_AXIS, 'joint_1')])
@pytest.mark.parametrize('call', [least_radius, largest_speed])
def test_singular_pose_is_refused_by_joint(call, q, joint):
    with pytest.raises(LimitViolationError,
                       match=rf'^the arm is singular at .* rad, where {joint} would') as caught:
        call(MODEL, JointLimits(), q, X, Y, 0.5)
    assert caught.value.joint == joint


@pytest.mark.parametrize(('T', 'N', 'speed', 'text'), [
    (2.0 * X, Y, 0.1, '^tangent has length 2, must have 1$'),
    (X, 0.6 * X + 0.8 * Y, 0.1, '^tangent and normal are not at a right angle: .* 0.6$'),
    (X, Y, -0.1, '^speed is -0.1 m/s, must not be negative$')])
def test_malformed_direction_or_speed_is_refused(T, N, speed, text):
    with pytest.raises(InvalidInputError, match=text):
        least_radius(MODEL, JointLimits(), Q, T, N, speed)


@pytest.mark.parametrize('radius', [0.0, -1.0, np.nan])
def test_radius_that_is_none_is_refused(radius):
    with pytest.raises(InvalidInputError, match='^radius is .* m, must be (positive|finite)$'):
        largest_speed(MODEL, JointLimits(), Q, X, Y, radius)
