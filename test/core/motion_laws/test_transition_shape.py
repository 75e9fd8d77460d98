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

"""Transitions of every shape: integrals, ends, symmetry, peaks, and trajectories made of them."""

from helpers.random_cases import central_difference, dense_times
import numpy as np
import pytest
from rrr_traj_planner.core.motion_laws.cycloid_transitions import CYCLOID
from rrr_traj_planner.core.motion_laws.gauss import GAUSS, gauss
from rrr_traj_planner.core.motion_laws.quartic import QUARTIC
from rrr_traj_planner.core.motion_laws.septic import SEPTIC
from rrr_traj_planner.core.trajectory.joint_profile import JointProfile
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from scipy.integrate import quad

SHAPES = [SEPTIC, QUARTIC, GAUSS, gauss(3.0), gauss(0.8), gauss(order=9)]
FUNCTIONS = [CYCLOID, *SHAPES]
ROUNDING = 1e-12
DENSE = np.linspace(0.0, 1.0, 20001)
# A peak between two of 20,001 samples: a parabola of the width of a sigma, at most 1/6 of it all.
BETWEEN_SAMPLES = 1e-6
S = np.linspace(0.05, 0.95, 7)


@pytest.fixture(params=SHAPES, ids=lambda s: f'{s.name} {s.peak_acceleration:.3f}')
def shape(request):
    return request.param


@pytest.fixture(params=FUNCTIONS, ids=lambda s: f'{s.name} {s.peak_acceleration:.3f}')
def function(request):
    return request.param


def test_velocity_and_position_are_the_integrals_of_acceleration(shape):
    for s in (*S, 1.0):
        assert quad(shape.acceleration, 0.0, s)[0] == pytest.approx(
            shape.velocity(s), abs=ROUNDING)
        assert quad(shape.velocity, 0.0, s)[0] == pytest.approx(shape.position(s), abs=ROUNDING)


def test_jerk_is_the_derivative_of_acceleration(shape):
    for s in S:
        assert central_difference(shape.acceleration, s, 1e-3) == pytest.approx(
            shape.jerk(s), abs=1e-8)


def test_ends_are_those_of_a_unit_transition(shape):
    ends = np.array([0.0, 1.0])
    assert shape.acceleration(ends) == pytest.approx([0.0, 0.0], abs=ROUNDING)
    assert shape.velocity(ends) == pytest.approx([0.0, 1.0], abs=ROUNDING)
    assert shape.position(ends) == pytest.approx([0.0, 0.5], abs=ROUNDING)


def test_acceleration_is_symmetric_and_never_negative(shape):
    values = shape.acceleration(DENSE)
    assert values == pytest.approx(values[::-1], abs=ROUNDING)
    assert values.min() >= -ROUNDING


def test_peaks_are_those_of_dense_samples(shape):
    assert shape.acceleration(DENSE).max() == pytest.approx(shape.peak_acceleration, rel=1e-12)
    steepest = np.abs(shape.jerk(DENSE)).max()
    assert steepest == pytest.approx(shape.peak_jerk, rel=BETWEEN_SAMPLES)
    assert steepest <= shape.peak_jerk * (1.0 + ROUNDING)


def test_transition_goes_from_one_velocity_to_the_other_without_acceleration_at_its_ends(function):
    rng = np.random.default_rng(501)
    for _ in range(50):
        T, position, v0, v1 = rng.uniform(0.1, 5.0), *rng.normal(0.0, 2.0, 3)
        piece = function.transition(T, position, v0, v1)
        for s, expected in ((0.0, (position, v0, 0.0)),
                            (1.0, (position + 0.5 * T * (v0 + v1), v1, 0.0))):
            assert piece.at(s)[:3] == pytest.approx(expected, abs=1e-11)


def test_derivatives_of_a_transition_are_by_time(function):
    piece = function.transition(1.7, 0.3, -0.4, 0.9)
    for s in S:
        for order in range(3):
            slope = central_difference(lambda x, n=order: piece.at(x)[n], s, 1e-3) / 1.7
            assert slope == pytest.approx(piece.at(s)[order + 1], abs=1e-7)


def test_cruise_has_constant_velocity(function):
    piece = function.cruise(2.0, 0.3, -0.4)
    assert np.array(piece.at(0.75)) == pytest.approx([0.3 - 0.4 * 1.5, -0.4, 0.0, 0.0])


def test_peaks_of_a_piece_are_its_function_s_times_change_over_duration(function):
    T, change = np.array([0.5, 2.0, 1.0]), np.array([0.6, -0.8, 0.0])
    acceleration, jerk = function.transition(T, 0.0 * T, 0.1 + 0.0 * T, 0.1 + change).peaks()
    assert acceleration == pytest.approx(
        function.peak_acceleration * np.array([1.2, 0.4, 0.0]), abs=ROUNDING)
    assert jerk == pytest.approx(function.peak_jerk * np.array([2.4, 0.2, 0.0]), abs=ROUNDING)


def random_profile(function, rng):
    """Return a profile of transitions, some of which turn back, and a cruise, between rests."""
    durations, velocities = rng.uniform(0.2, 1.5, 9), rng.uniform(-1.0, 1.0, 10)
    velocities[[0, -1]] = 0.0
    velocities[5] = velocities[4]
    position, fields = rng.uniform(-1.0, 1.0), []
    for T, v0, v1 in zip(durations, velocities[:-1], velocities[1:]):
        piece = function.transition(T, position, v0, v1) if v0 != v1 else function.cruise(
            T, position, v0)
        fields.append(list(piece.parameters().values()))
        position = piece.at(1.0)[0]
    return JointProfile(piece.with_parameters(np.array(fields).T))


@pytest.mark.parametrize('seed', range(8))
def test_exact_peaks_of_a_trajectory_bound_dense_samples_and_are_reached(function, seed):
    rng = np.random.default_rng(520 + seed)
    profile = random_profile(function, rng)
    trajectory = PiecewiseTrajectory([profile] * 3, [0.0, profile.duration])
    peaks = trajectory.peaks()
    q, qd, qdd, qddd = trajectory(dense_times(trajectory, 2000))
    for exact, dense in ((peaks.velocity, np.abs(qd).max(axis=0)),
                         (peaks.acceleration, np.abs(qdd).max(axis=0)),
                         (peaks.max_position, q.max(axis=0)),
                         (-peaks.min_position, (-q).max(axis=0)),
                         (peaks.jerk, np.abs(qddd).max(axis=0))):
        assert (dense <= exact + 1e-12).all()
        assert dense == pytest.approx(exact, rel=1e-5, abs=1e-6)


def test_position_turns_where_a_transition_changes_the_velocity_s_sign(function):
    # From -1 to 1 rad/s in 2 s, by symmetry velocity is 0 half-way: there the position is least.
    profile = JointProfile(function.transition(*(np.array([x]) for x in (2.0, 0.0, -1.0, 1.0))))
    half = quad(lambda t: profile(np.array([t]))[1][0], 0.0, 1.0)[0]
    assert profile.position_range() == pytest.approx((half, 0.0), abs=1e-10)


def test_stretched_motion_passes_the_same_positions_more_slowly(function):
    profile = random_profile(function, np.random.default_rng(540))
    slow = profile.time_scaled(2.5)
    t = np.linspace(0.0, profile.duration, 101)
    for order, (ours, theirs) in enumerate(zip(slow(2.5 * t), profile(t))):
        assert ours == pytest.approx(theirs / 2.5 ** order, abs=1e-9)
