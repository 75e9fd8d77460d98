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

"""What a controller's quintics through points do, against closed forms and Pinocchio."""

from dataclasses import replace

from helpers.pinocchio_arm import PinocchioArm
from helpers.thesis_arm import ThesisArm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.trajectory import controller_spline
from rrr_traj_planner.core.trajectory.controller_spline import (
    checked_intervals,
    checked_where_divided,
    RANGE_TOLERANCE,
    spline_excess,
    SPLINE_TOLERANCE,
)
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints

ARM = ThesisArm()
NONE = np.full(3, np.inf)
WIDE = JointLimits(min_position=-NONE, max_position=NONE, max_velocity=NONE,
                   max_acceleration=NONE, max_jerk=NONE, max_effort=NONE)
TIMES = [0.0, 0.5, 2.5, 3.0]  # the arm moves between the middle two
FROM, TO = np.array([0.3, 1.2, 0.1]), np.array([1.1, 0.7, 0.4])


def there():
    """Return points at rest: quintics from rest to rest over 2 s, and two that stand still."""
    rest = np.zeros((4, 3))
    return spline_through(TrajectoryPoints(TIMES, [FROM, FROM, TO, TO], rest, rest))


def from_rest_to_rest(x):
    """Return q, qd, qdd, qddd of the quintic from rest to rest at a share of its 2 s, by hand."""
    D, T = TO - FROM, 2.0
    return (FROM + D * (10.0 * x ** 3 - 15.0 * x ** 4 + 6.0 * x ** 5),
            D / T * (30.0 * x ** 2 - 60.0 * x ** 3 + 30.0 * x ** 4),
            D / T ** 2 * (60.0 * x - 180.0 * x ** 2 + 120.0 * x ** 3),
            D / T ** 3 * (60.0 - 360.0 * x + 360.0 * x ** 2))


@pytest.mark.parametrize('joint', range(3))
@pytest.mark.parametrize(('limit', 'largest', 'power', 'places'), [
    ('max_velocity', 15.0 / 8.0 / 2.0, 1.0, [0.5]),
    ('max_acceleration', 10.0 / np.sqrt(3.0) / 4.0, 0.5, [0.2113, 0.7887])])
def test_what_exceeds_a_limit_asks_to_be_slowed_by_its_ratio(joint, limit, largest, power, places):
    # From rest to rest: velocity 15/8 D/T at the middle, acceleration 10/sqrt(3) D/T^2.
    largest = largest * abs(TO - FROM)[joint]
    for part in (0.9993, 0.9, 0.5):  # of the largest; the first is within the tolerance
        bound = NONE.copy()
        bound[joint] = part * largest
        found = spline_excess(ARM, replace(WIDE, **{limit: bound}), there())
        expected = 1.0 if part > 0.999 else part ** -power
        assert found.time_scale == pytest.approx([1.0, expected, 1.0], rel=1e-3)
        if expected > 1.0:
            assert np.abs(found.place[1] - places).min() <= 0.02


@pytest.mark.parametrize('joint', range(3))
def test_no_peak_between_the_coarse_samples_is_missed(joint):
    # Acceleration that changes quickly near one end, as beside a singular position; the exact peak
    # of velocity is at a root of the acceleration. The second interval has the largest torques.
    rng = np.random.default_rng(joint)
    for _ in range(100):
        q, v, a = np.zeros((3, 3, 3))
        v0, v1, a0, a1, mean = np.array([-0.765, -0.949, 0.072, 1.238, -0.794]) * rng.uniform(
            0.97, 1.03, 5)
        q[1:, joint], v[:, joint], a[:2, joint] = mean, (v0, v1, v1), (a0, a1)
        a[2] = 1000.0
        spline = spline_through(TrajectoryPoints([0.0, 1.0, 1.02], q, v, a))
        velocity = np.polynomial.Polynomial(spline.coefficients[0, joint]).deriv()
        stationary = [x.real for x in velocity.deriv().roots()
                      if abs(x.imag) < 1e-12 and 0.0 < x.real < 1.0]
        peak = np.abs(velocity(np.array([0.0, 1.0, *stationary]))).max()
        bound = NONE.copy()
        bound[joint] = 0.997 * peak
        found = spline_excess(ARM, replace(WIDE, max_velocity=bound), spline)
        assert found.time_scale[0] == pytest.approx(1.0 / 0.997, rel=5e-4)


def test_largest_torque_is_pinocchio_s():
    arm = PinocchioArm(ARM)
    tau = np.array([arm.inverse_dynamics(*from_rest_to_rest(x)[:3])
                    for x in np.linspace(0.0, 1.0, 401)])
    largest = np.abs(tau).max(axis=0)
    for part in (np.inf, 1.0, 0.995):
        found = spline_excess(ARM, replace(WIDE, max_effort=part * largest), there())
        assert found.effort == pytest.approx(largest, rel=5e-5)


@pytest.mark.parametrize('seed', range(10))
def test_largest_torque_between_dense_samples_is_reported_and_slowed(seed):
    # A short step of joint 1 from rest to rest: its torque is I D/T^2 (60 x - 180 x^2 + 120 x^3)
    # but for the rise of I, largest at x = 0.2113 and 0.7887, between 64ths of the interval.
    step, duration = np.random.default_rng(seed).uniform([1e-4, 0.1], [1e-3, 1.0])
    rest = np.zeros((2, 3))
    q = np.array([FROM, FROM])
    q[1, 0] += step
    inertia = PinocchioArm(ARM).inertia_matrix(FROM)[0, 0]
    largest = inertia * step / duration ** 2 * 10.0 / np.sqrt(3.0)
    spline = spline_through(TrajectoryPoints([0.0, duration], q, rest, rest))
    for over in (1.0 + 7e-4, 1.0 + 9e-4):  # on either side of SPLINE_TOLERANCE
        bound = np.array([largest / over, np.inf, np.inf])
        found = spline_excess(ARM, replace(WIDE, max_effort=bound), spline)
        assert found.effort[0] == pytest.approx(largest, rel=5e-5)
        expected = np.sqrt(over) if over > 1.0 + SPLINE_TOLERANCE else 1.0
        assert found.time_scale[0] == pytest.approx(expected, abs=3e-5)


@pytest.mark.parametrize('joint', [0, 1])  # joint 3's gravity torque is largest here
def test_motion_beyond_a_torque_limit_is_within_it_after_the_reported_time_scaling(joint):
    arm = PinocchioArm(ARM)
    states = [from_rest_to_rest(x)[:3] for x in np.linspace(0.0, 1.0, 201)]
    largest = np.abs([arm.inverse_dynamics(*s) for s in states]).max(axis=0)
    holding = np.abs([arm.gravity_torque(s[0]) for s in states]).max(axis=0)
    limit = NONE.copy()
    limit[joint] = 0.5 * (largest[joint] + holding[joint])
    factor = spline_excess(ARM, replace(WIDE, max_effort=limit), there()).time_scale[1]
    assert factor > 1.0
    slowed = np.abs([arm.inverse_dynamics(q, qd / factor, qdd / factor ** 2)
                     for q, qd, qdd in states]).max(axis=0)
    assert slowed[joint] == pytest.approx(limit[joint], rel=1e-3)


def test_gravity_beyond_a_torque_asks_for_infinite_time():
    found = spline_excess(ARM, replace(WIDE, max_effort=[np.inf, 1.0, np.inf]), there())
    assert np.isinf(found.time_scale).all()


def test_leaving_a_range_is_reported():
    # The same position and 1 rad/s at both points, 0.5 s apart: the quintic's basis functions of
    # the two velocities, x - 6 x^3 + 8 x^4 - 3 x^5 and -4 x^3 + 7 x^4 - 3 x^5, times 0.5 rad.
    zero = np.zeros((2, 3))
    v = np.array([[1.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    x = np.linspace(0.0, 1.0, 100_001)
    beyond = 0.5 * (x - 10.0 * x ** 3 + 15.0 * x ** 4 - 6.0 * x ** 5).max()
    found = spline_excess(ARM, replace(WIDE, max_position=np.zeros(3)),
                          spline_through(TrajectoryPoints([0.0, 0.5], zero, v, zero)))
    assert found.outside == pytest.approx([beyond], rel=1e-2)
    assert found.time_scale.tolist() == [1.0]  # no slower motion would stay within


@pytest.mark.parametrize('side', [1.0, -1.0])
def test_how_far_a_joint_turns_back_outside_its_range_is_reported_to_a_nanoradian(side):
    # A parabola of 5 rad/s^2 is its own quintic; its top may be between all samples.
    a, T = -5.0 * side, 2.0
    for top in np.random.default_rng(5).uniform(0.3, 1.7, 20):
        t = np.array([0.0, T]) - top
        states = [np.outer(x, [0.0, 1.0, 0.0]) for x in (0.5 * a * t * t, a * t, [a, a])]
        beyond = 3e-6
        limits = replace(WIDE, max_position=[1.0, -beyond if side > 0.0 else 99.0, 1.0],
                         min_position=[-1.0, beyond if side < 0.0 else -99.0, -1.0])
        found = spline_excess(ARM, limits, spline_through(TrajectoryPoints([0.0, T], *states)))
        assert found.outside == pytest.approx([beyond], abs=1e-9)
        assert found.time_scale.tolist() == [1.0]


def test_a_range_is_left_by_the_cube_of_the_time_between_points():
    # From rest at 0 a jerk j, then -j: half-way the quintic through both ends differs.
    def excess(T):
        j, h = 10.0, 0.5 * T
        end = [j * h ** 3, j * h ** 2, 0.0]
        states = [np.array([[0.0] * 3, [x, 0.0, 0.0]]) for x in end]
        q = spline_through(TrajectoryPoints([0.0, T], *states)).at(h)[0][0]
        return abs(q - j * h ** 3 / 6.0)

    assert excess(0.2) == pytest.approx(8.0 * excess(0.1), rel=1e-9)
    none = spline_excess(ARM, WIDE, there())
    outside = 64.0 * RANGE_TOLERANCE * np.array([0.0, 1.0, 0.5])
    assert none._replace(outside=outside).slowing == pytest.approx(4.0, rel=1e-12)
    assert none.slowing == 1.0


def test_peak_jerk_between_points_is_found():
    # Jerk 4 J x (T - x) / T^2 is zero at both points and J half-way; integrated thrice from rest.
    J, T = np.array([2.0, -3.0, 0.5]), 0.7
    q, v, a = (J * T ** n * part for n, part in ((3, 1.0 / 10.0), (2, 1.0 / 3.0), (1, 2.0 / 3.0)))
    states = [np.array([np.zeros(3), x]) for x in (q, v, a)]
    spline = spline_through(TrajectoryPoints([0.0, T], *states))
    assert spline.peak_jerks() == pytest.approx(np.abs([J]), rel=1e-9)


def test_peak_jerk_is_exact():
    # 60 D/T^3 at the ends of a quintic from rest to rest.
    assert there().peak_jerks() == pytest.approx(
        np.outer([0.0, 1.0, 0.0], 60.0 * np.abs(TO - FROM) / 8.0), rel=1e-9, abs=1e-9)
    rng = np.random.default_rng(8)
    for _ in range(20):
        states = rng.uniform(-1.0, 1.0, (3, 2, 3))
        spline = spline_through(TrajectoryPoints([0.0, 0.7], *states))
        t = np.linspace(0.0, 0.7, 4001)
        dense = np.abs(np.gradient(spline.at(t)[2], t, axis=0, edge_order=2)).max(axis=0)
        assert spline.peak_jerks()[0] == pytest.approx(dense, rel=1e-4)


def swinging(rng, times):
    """Return quintics through points of a motion of sines, slow or quick at random."""
    amplitude, rate = rng.uniform(0.2, 0.6, (2, 3)) * [[1.0], [6.0]]
    angle = np.outer(times, rate)
    return spline_through(TrajectoryPoints(
        times, FROM + amplitude * np.sin(angle), amplitude * rate * np.cos(angle),
        -amplitude * rate ** 2 * np.sin(angle)))


@pytest.mark.parametrize('seed', range(30))
def test_checking_only_what_was_divided_finds_what_checking_everything_does(seed):
    rng = np.random.default_rng(seed)
    friction = Friction(viscous=[5.0] * 3, coulomb=[2.0] * 3)
    model = replace(ARM, friction=friction) if seed % 2 else ARM
    times = np.cumsum(rng.uniform(0.05, 1.0, 30))
    limits = replace(
        WIDE, max_velocity=rng.uniform(0.3, 2.0, 3), max_acceleration=rng.uniform(0.5, 4.0, 3),
        max_effort=rng.choice([np.inf, 60.0, 150.0]) + np.zeros(3),
        max_position=FROM + rng.uniform(0.3, 0.8, 3))
    motion = rng.bit_generator.state  # the same motion, whatever its points
    known = checked_intervals(model, limits, swinging(rng, times))
    for share in (0.5, 0.2, 0.0):
        divided = np.flatnonzero(rng.random(len(times) - 1) < share)
        times = np.insert(times, divided + 1, 0.5 * (times[divided] + times[divided + 1]))
        again = np.random.default_rng()
        again.bit_generator.state = motion
        spline = swinging(again, times)
        known = checked_where_divided(model, limits, spline, known, divided)
        for found, expected in zip(known.excess(limits), spline_excess(model, limits, spline)):
            assert found == pytest.approx(expected, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize('seed', range(6))
def test_long_motions_are_checked_block_by_block_as_at_once(seed, monkeypatch):
    rng = np.random.default_rng(seed)
    model = replace(ARM, friction=Friction(viscous=[5.0] * 3, coulomb=[2.0] * 3))
    limits = replace(WIDE, max_velocity=rng.uniform(0.3, 2.0, 3), max_effort=[60.0] * 3,
                     max_position=FROM + rng.uniform(0.3, 0.8, 3))
    spline = swinging(rng, np.cumsum(rng.uniform(0.05, 1.0, 30)))
    whole = spline_excess(model, limits, spline)
    monkeypatch.setattr(controller_spline, 'BLOCK', 7)
    monkeypatch.setattr(controller_spline, 'DENSE_BLOCK', 3)
    polled = []
    found_in_blocks = spline_excess(model, limits, spline, lambda: bool(polled.append(1)))
    for found, expected in zip(found_in_blocks, whole):
        assert found == pytest.approx(expected, rel=1e-12, abs=1e-12)
    assert len(polled) > 30 / 7 + np.count_nonzero(whole.time_scale > 1.0) / 3
