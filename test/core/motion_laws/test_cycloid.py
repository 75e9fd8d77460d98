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

"""Cycloid pieces: end states, peaks, derivatives, and the corrected 4.6."""

from helpers.random_cases import (
    central_difference,
    pieces_of_every_kind,
    random_general_transition,
)
import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.motion_laws.cycloid import cruise, general_transition, ramp, transition
from scipy.integrate import quad

# Values are of the order of 1 to 100.
ROUNDING = 1e-12
# A peak between two of 20,001 samples differs from theirs by (pi / 20,000)^2 / 2 at most.
DENSE = np.linspace(0.0, 1.0, 20001)
BETWEEN_SAMPLES = 2e-8


def test_transition_goes_from_one_velocity_to_the_other_with_acceleration_and_jerk_zero():
    rng = np.random.default_rng(61)
    for _ in range(200):
        T, position, v0, v1 = rng.uniform(0.1, 5.0), *rng.normal(0.0, 2.0, 3)
        piece = transition(T, position, v0, v1)
        assert piece.at(0.0) == pytest.approx((position, v0, 0.0, 0.0), abs=ROUNDING)
        assert piece.at(1.0) == pytest.approx(
            (position + 0.5 * T * (v0 + v1), v1, 0.0, 0.0), abs=ROUNDING)


def test_transition_s_peaks_are_twice_the_mean_acceleration_and_two_pi_of_it_over_duration():
    rng = np.random.default_rng(62)
    for _ in range(100):
        T, position, v0, v1 = rng.uniform(0.1, 5.0), *rng.normal(0.0, 2.0, 3)
        acceleration, jerk = transition(T, position, v0, v1).at(DENSE)[2:]
        assert np.abs(acceleration).max() == pytest.approx(2.0 * abs(v1 - v0) / T, rel=1e-12)
        assert np.abs(jerk).max() == pytest.approx(2.0 * np.pi * abs(v1 - v0) / T ** 2, rel=1e-12)


def test_transition_of_4_10_s_duration_just_reaches_the_largest_acceleration():
    # t_j = 2 |end - start| / alpha_max, for braking as for speeding up.
    for v0, v1 in ((0.2, 1.0), (1.0, -0.6)):
        piece = transition(2.0 * abs(v1 - v0) / 1.5, 0.0, v0, v1)
        assert float(piece.at(0.5)[2]) == pytest.approx(np.sign(v1 - v0) * 1.5, abs=ROUNDING)


def test_transition_obeys_the_thesis_s_4_3_to_4_9():
    # In the thesis's own constants: a = 1/(2 pi), b = c = t_j (end - start), d = t_j start,
    # e = position - b a^2, with the corrections of 4.3 and 4.13.
    T, position, v0, v1 = 1.7, 0.4, -0.3, 0.9
    a, b = 1.0 / (2.0 * np.pi), T * (v1 - v0)
    s = np.linspace(0.0, 1.0, 11)
    q, qd, qdd, qddd = transition(T, position, v0, v1).at(s)
    assert qdd == pytest.approx((b - b * np.cos(s / a)) / T ** 2, abs=ROUNDING)
    assert qd == pytest.approx((b * s - b * a * np.sin(s / a) + T * v0) / T, abs=ROUNDING)
    assert q == pytest.approx(0.5 * b * s ** 2 + b * a ** 2 * np.cos(s / a) + T * v0 * s
                              + position - b * a ** 2, abs=ROUNDING)
    assert qddd == pytest.approx(b / a * np.sin(s / a) / T ** 3, abs=ROUNDING)


def test_cruise_moves_on_at_its_velocity():
    q, qd, qdd, qddd = cruise(2.0, 0.5, -0.75).at(np.array([0.0, 0.25, 1.0]))
    assert q == pytest.approx([0.5, 0.125, -1.0], abs=ROUNDING)
    assert qd.tolist() == [-0.75, -0.75, -0.75]
    assert qdd.tolist() == [0.0, 0.0, 0.0]
    assert (qddd == 0.0).all()


def test_ramp_follows_its_formulae():
    rng = np.random.default_rng(63)
    for _ in range(100):
        T, position, v0, a0, a1 = rng.uniform(0.1, 5.0), *rng.normal(0.0, 2.0, 4)
        piece = ramp(T, position, v0, a0, a1)
        s = rng.uniform(0.0, 1.0, 20)
        assert piece.at(s)[2] == pytest.approx(
            a0 + 0.5 * (a1 - a0) * (1.0 - np.cos(np.pi * s)), abs=ROUNDING)
        assert piece.at(0.0) == pytest.approx((position, v0, a0, 0.0), abs=ROUNDING)
        displacement = v0 * T + T ** 2 * (0.5 * a0 + (a1 - a0) * (0.25 - 1.0 / np.pi ** 2))
        assert piece.at(1.0) == pytest.approx(
            (position + displacement, v0 + 0.5 * T * (a0 + a1), a1, 0.0), abs=10 * ROUNDING)
        jerk = np.abs(piece.at(DENSE)[3]).max()
        assert jerk == pytest.approx(0.5 * np.pi * abs(a1 - a0) / T, rel=1e-12)


def test_velocity_acceleration_and_jerk_are_derivatives_of_position():
    rng = np.random.default_rng(67)
    for piece in pieces_of_every_kind(68, 100):
        s = rng.uniform(0.01, 0.99, 10)
        for order in range(3):
            by_differences = central_difference(
                lambda x, p=piece, n=order: p.at(x)[n], s, 1e-3) / piece.duration
            # Jerk and its derivatives grow with the inverse of a short duration.
            scale = np.abs(piece.at(DENSE)[order + 1]).max() + 1.0
            assert piece.at(s)[order + 1] == pytest.approx(by_differences, abs=1e-8 * scale)


def test_velocity_and_position_are_integrals_of_acceleration():
    for piece in pieces_of_every_kind(69, 20):
        T, (position, velocity) = piece.duration, piece.at(0.0)[:2]
        gained = quad(lambda s, p=piece: p.at(s)[2], 0.0, 1.0, epsabs=1e-12)[0] * T
        # Position by Cauchy's formula for repeated integration.
        moved = quad(lambda s, p=piece: (1.0 - s) * p.at(s)[2], 0.0, 1.0, epsabs=1e-12)[0] * T ** 2
        assert piece.at(1.0)[1] == pytest.approx(velocity + gained, abs=1e-10)
        assert piece.at(1.0)[0] == pytest.approx(position + velocity * T + moved, abs=1e-10)


def test_motion_just_after_the_start_is_exact_to_all_digits():
    # 1 - cos(x) = x^2 / 2 for small x: written as a difference it would be 0 here.
    s, T, change = 1e-9, 2.0, 3.0
    q, _, acceleration, _ = transition(T, 0.0, 0.0, change).at(s)
    assert acceleration == pytest.approx(change / T * 0.5 * (2.0 * np.pi * s) ** 2, rel=1e-12)
    assert abs(q) < 1e-25  # true value 4e-35 rad


def test_general_transition_meets_its_accelerations_velocities_and_peak():
    rng = np.random.default_rng(64)
    for _ in range(300):
        piece, ends = random_general_transition(rng)
        start, end = piece.at(0.0), piece.at(1.0)
        assert start[:3] == pytest.approx(
            (ends['position'], ends['velocity'], ends['start_acceleration']), abs=ROUNDING)
        assert end[1:3] == pytest.approx(
            (ends['end_velocity'], ends['end_acceleration']), abs=ROUNDING)
        acceleration = np.sign(ends['peak_acceleration']) * piece.at(DENSE)[2]
        peak = abs(ends['peak_acceleration'])
        assert acceleration.max() <= peak + ROUNDING
        assert acceleration.max() == pytest.approx(peak, rel=BETWEEN_SAMPLES * 10)


def test_general_transition_s_phase_is_4_6_corrected():
    # cos(1/a) = 1 - 2 (end - start) / (peak - start), past the peak: 1/a in [pi, 2 pi].
    rng = np.random.default_rng(65)
    for _ in range(100):
        piece, ends = random_general_transition(rng)
        start = ends['start_acceleration']
        fraction = (ends['end_acceleration'] - start) / (ends['peak_acceleration'] - start)
        assert np.cos(piece.w) == pytest.approx(1.0 - 2.0 * fraction, abs=ROUNDING)
        assert np.pi <= piece.w <= 2.0 * np.pi


def test_general_transition_between_equal_accelerations_is_a_full_period():
    rng = np.random.default_rng(66)
    for _ in range(50):
        piece, ends = random_general_transition(rng, fraction=0.0)
        mean = 0.5 * (ends['start_acceleration'] + ends['peak_acceleration'])
        assert piece.w == 2.0 * np.pi
        assert piece.duration == pytest.approx(
            (ends['end_velocity'] - ends['velocity']) / mean, rel=1e-12)
        assert piece.at(1.0)[2] == pytest.approx(ends['start_acceleration'], abs=ROUNDING)


def test_general_transition_from_rest_to_rest_of_acceleration_is_the_plain_one():
    piece = general_transition(0.3, -0.2, 0.7, 0.0, 0.0, 1.5)
    plain = transition(2.0 * 0.9 / 1.5, 0.3, -0.2, 0.7)
    assert list(piece) == pytest.approx(list(plain), abs=ROUNDING)


def test_general_transition_that_ends_at_its_peak_is_a_ramp():
    for sign in (-1.0, 1.0):
        piece = general_transition(0.3, -0.2, -0.2 + sign * 0.9, sign * 0.25, sign * 1.5,
                                   sign * 1.5)
        half_period = ramp(0.9 / (0.5 * (0.25 + 1.5)), 0.3, -0.2, sign * 0.25, sign * 1.5)
        assert piece.w == np.pi
        assert list(piece) == pytest.approx(list(half_period), abs=ROUNDING)


@pytest.mark.parametrize(('start', 'end', 'peak'), [
    (0.5, 1.0, 0.8),      # the end beyond the peak
    (-0.5, -1.0, -0.8),
    (0.5, 0.2, 1.0),      # the end behind the start
    (0.5, 1.0, 0.2),      # the peak on the other side
    (0.5, 0.5, 0.5)])     # no peak
def test_end_acceleration_that_the_function_never_takes_is_refused(start, end, peak):
    text = (rf'^end acceleration {end} rad/s\^2 must lie between the start, {start} rad/s\^2, '
            rf'and the peak beyond it, {peak} rad/s\^2$')
    with pytest.raises(InvalidInputError, match=text):
        general_transition(0.0, 0.0, 1.0, start, end, peak)


@pytest.mark.parametrize('end_velocity', [-0.5, 0.5])
def test_change_of_velocity_against_the_accelerations_is_refused(end_velocity):
    with pytest.raises(InvalidInputError, match=(
            r'^a change of velocity of -?[\d.]+ rad/s has no transition of mean acceleration '
            r'0\.75 rad/s\^2$')):
        general_transition(0.0, 0.5, end_velocity, 0.0, 0.0, 1.5)
