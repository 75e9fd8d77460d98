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

"""The motion through points: joint_trajectory_controller's interpolation, and holding."""

from __future__ import annotations

import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.core.trajectory.reference_trajectory import holding, reference_through
from rrr_traj_planner.core.trajectory.trajectory_points import segment_orders, TrajectoryPoints
from scipy.interpolate import BPoly

N = 6


def random_points(velocity, acceleration, seed=5):
    rng = np.random.default_rng(seed)
    fields = rng.uniform(-1.0, 1.0, (3, N, 3))
    return TrajectoryPoints(np.cumsum(rng.uniform(0.1, 1.0, N)), *fields,
                            np.full(N, velocity), np.full(N, acceleration))


def samples(points):
    return np.linspace(points.times[0], points.times[-1] - 1e-9, 997)


@pytest.mark.parametrize(('velocity', 'acceleration', 'order'), [
    (False, False, 1), (True, False, 3), (True, True, 5), (False, True, 1)])
def test_every_instant_equals_the_whole_trajectory_s_interpolation(
        velocity, acceleration, order):
    points = random_points(velocity, acceleration)
    assert (segment_orders(points) == order).all()
    states = (points.positions, points.velocities, points.accelerations)[:(order + 1) // 2]
    expected = BPoly.from_derivatives(points.times, np.stack(states, axis=1))
    motion, times = reference_through(points), samples(points)
    np.testing.assert_allclose([motion(t) for t in times],
                               np.hstack([expected(times, k) for k in range(3)]), atol=1e-9)


def test_each_segment_uses_what_both_its_points_carry():
    points = random_points(True, True)
    mixed = TrajectoryPoints(
        points.times, points.positions, points.velocities, points.accelerations,
        [True, True, True, False, False, True], [True, True, False, True, False, True])
    assert segment_orders(mixed).tolist() == [5, 3, 1, 1, 1]
    motion, full = reference_through(mixed), reference_through(points)
    t = 0.5 * (points.times[0] + points.times[1])
    assert motion(t) == full(t)
    t = 0.25 * points.times[3] + 0.75 * points.times[4]
    np.testing.assert_allclose(
        motion(t)[:3], 0.25 * points.positions[3] + 0.75 * points.positions[4], atol=1e-12)


def test_position_is_held_before_and_after():
    points = random_points(True, True)
    motion = reference_through(points)
    np.testing.assert_allclose(motion(points.times[0] - 5.0)[:3], points.positions[0])
    assert motion(points.times[-1]) == (*points.positions[-1], *(0.0,) * 6)
    assert motion(1e9) == motion(points.times[-1])


def test_any_order_of_times_gives_the_same_states():
    points = random_points(True, True)
    times = samples(points)
    forward, motion = reference_through(points), reference_through(points)
    expected = {t: forward(t) for t in times}
    for t in np.random.default_rng(6).permutation(times):
        assert motion(t) == expected[t]


def test_origin_shifts_the_motion_without_loss_of_precision():
    # Points a nanosecond apart, 1e9 s ahead: absolute times would coincide.
    points = TrajectoryPoints([0.0, 1e-9, 2e-9], np.eye(3), *np.zeros((2, 3, 3)),
                              *([[False] * 3] * 2))
    motion = reference_through(points, origin_ns=10 ** 18)
    assert motion.start == 1e9
    assert motion(1e9 + 1.0)[:3] == (0.0, 0.0, 1.0)
    points = random_points(True, True)
    np.testing.assert_allclose(reference_through(points, 2 * SECOND)(3.5),
                               reference_through(points)(1.5), atol=1e-12)


def test_exactly_at_a_point_the_segment_that_begins_there_is_in_force():
    """As joint_trajectory_controller compares: times in nanoseconds, t0 <= now < t1."""
    rng = np.random.default_rng(11)
    for origin in (0, 123456789, 1_764_000_000_123_456_789):
        gaps = rng.integers(1, 20_000_000, 500)
        times = np.cumsum(gaps).tolist()
        q = rng.uniform(-1.0, 1.0, (500, 3))
        motion = reference_through(TrajectoryPoints(
            np.array([n / SECOND for n in times]), q, *np.zeros((2, 500, 3)),
            *([[False] * 500] * 2)), origin)
        slopes = np.diff(q, axis=0) / (gaps[1:, np.newaxis] / SECOND)
        for i, n in enumerate(times[:-1]):
            at = motion.command(origin + n)
            assert at[:3] == tuple(q[i])
            np.testing.assert_allclose(at[3:6], slopes[i], rtol=1e-6)
            if i and gaps[i] > 1:
                before = motion.command(origin + n - 1)
                np.testing.assert_allclose(before[3:6], slopes[i - 1], rtol=1e-6)
        assert motion.command(origin + times[-1]) == (*q[-1], *(0.0,) * 6)


def test_one_point_is_held():
    motion = holding((1.0, 2.0, 3.0), now=4 * SECOND)
    assert motion.start == motion.end == 4.0
    assert motion(0.0) == motion(9.0) == (1.0, 2.0, 3.0, *(0.0,) * 6)


def test_states_are_those_at_the_knots():
    points = random_points(True, True)
    motion = reference_through(points)
    expected = [motion(t) for t in points.times[:-1]]
    np.testing.assert_allclose(np.hstack(motion.states())[:-1], expected, atol=1e-12)
    end = np.concatenate((points.positions[-1], points.velocities[-1], points.accelerations[-1]))
    np.testing.assert_allclose(np.hstack(motion.states())[-1], end, atol=1e-12)
    np.testing.assert_allclose(motion.end_state, end, atol=1e-12)
    assert motion.ends_moving


@pytest.mark.parametrize('carried', [(False, False), (True, False), (True, True)])
def test_many_instants_are_those_one_by_one(carried):
    motion = reference_through(random_points(*carried), 3_000_000_000)
    t = np.linspace(2.0, motion.end - 1e-9, 500)
    np.testing.assert_allclose(np.hstack(motion.at(t)[:3]), [motion(x) for x in t], atol=1e-12)


def test_jerk_is_the_derivative_of_acceleration():
    motion, h = reference_through(random_points(True, True)), 1e-6
    t = 0.5 * (motion.knots[1:] + motion.knots[:-1])
    difference = (motion.at(t + h)[2] - motion.at(t - h)[2]) / (2.0 * h)
    np.testing.assert_allclose(motion.at(t)[3], difference, rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize(('change', 'text'), [
    ({'times': [0.0, 0.0]}, 'times must be strictly increasing'),
    ({'times': []}, 'at least one'),
    ({'positions': np.zeros((1, 3))}, r'positions has shape \(1, 3\), must have \(2, 3\)'),
    ({'has_velocity': [True]}, r'has_velocity has shape \(1,\), must have \(2,\)')])
def test_malformed_points_are_refused(change, text):
    fields = {'times': [0.0, 1.0], **{f: np.zeros((2, 3)) for f in (
        'positions', 'velocities', 'accelerations')}, 'has_velocity': [True] * 2,
        'has_acceleration': [True] * 2}
    with pytest.raises(InvalidInputError, match=text):
        TrajectoryPoints(**{**fields, **change})
