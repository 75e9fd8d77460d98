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

"""Cycloid pieces: end states, closed-form peaks, derivatives."""

from helpers.random_cases import central_difference, joined, random_general_transition
import numpy as np
import pytest
from rrr_traj_planner.core.motion_laws.cycloid import (
    cruise,
    CycloidPiece,
    general_transition,
    ramp,
    transition,
)
from scipy.integrate import quad

# Values are of the order of 1 to 100.
ROUNDING = 1e-12
# A peak between two of 20,001 samples differs from theirs by (pi / 20,000)^2 / 2 at most.
DENSE = np.linspace(0.0, 1.0, 20001)
BETWEEN_SAMPLES = 2e-8


def random_transition(rng):
    return transition(rng.uniform(0.1, 5.0), *rng.normal(0.0, 2.0, 3))


def random_cruise(rng):
    return cruise(rng.uniform(0.1, 5.0), *rng.normal(0.0, 2.0, 2))


def random_ramp(rng):
    return ramp(rng.uniform(0.1, 5.0), *rng.normal(0.0, 2.0, 4))


KINDS = [random_transition, random_cruise, random_ramp,
         lambda rng: random_general_transition(rng)[0]]


def random_pieces(seed, n):
    """Return n pieces, of all kinds in turn."""
    rng = np.random.default_rng(seed)
    return [KINDS[i % len(KINDS)](rng) for i in range(n)]


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
    for piece in random_pieces(68, 100):
        s = rng.uniform(0.01, 0.99, 10)
        for order in range(3):
            by_differences = central_difference(
                lambda x, p=piece, n=order: p.at(x)[n], s, 1e-3) / piece.duration
            # Jerk and its derivatives grow with the inverse of a short duration.
            scale = np.abs(piece.at(DENSE)[order + 1]).max() + 1.0
            assert piece.at(s)[order + 1] == pytest.approx(by_differences, abs=1e-8 * scale)


def test_velocity_and_position_are_integrals_of_acceleration():
    for piece in random_pieces(69, 20):
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


def test_consecutive_pieces_join_without_a_step():
    rng = np.random.default_rng(70)
    for _ in range(50):
        v0, cruising, v1 = rng.normal(0.0, 2.0, 3)
        first = transition(rng.uniform(0.1, 2.0), 0.5, v0, cruising)
        second = cruise(rng.uniform(0.1, 2.0), first.at(1.0)[0], cruising)
        third = transition(rng.uniform(0.1, 2.0), second.at(1.0)[0], cruising, v1)
        peak = rng.uniform(0.1, 3.0)
        fourth = ramp(rng.uniform(0.1, 2.0), third.at(1.0)[0], v1, 0.0, peak)
        fifth = general_transition(*fourth.at(1.0)[:2], fourth.at(1.0)[1] + 2.0, peak,
                                   1.2 * peak, 1.5 * peak)
        pieces = (first, second, third, fourth, fifth)
        for before, after in zip(pieces[:-1], pieces[1:]):
            assert before.at(1.0)[:3] == pytest.approx(after.at(0.0)[:3], abs=ROUNDING)
        for before, after in zip(pieces[:3], pieces[1:4]):  # full periods and ramps: jerk too
            assert before.at(1.0)[3] == pytest.approx(after.at(0.0)[3], abs=1e-10)


def test_closed_form_peaks_are_those_of_dense_sampling():
    pieces = random_pieces(71, 200)
    acceleration, jerk = joined(pieces).peaks()
    for i, piece in enumerate(pieces):
        sampled = piece.at(DENSE)
        for exact, dense in ((acceleration[i], np.abs(sampled[2]).max()),
                             (jerk[i], np.abs(sampled[3]).max())):
            assert dense <= exact + ROUNDING * (1.0 + exact)
            assert dense == pytest.approx(exact, rel=1e-6, abs=ROUNDING)


@pytest.mark.parametrize('w', [0.3, 1.2, 2.5, 4.0, 5.5])
def test_closed_form_peaks_hold_for_any_part_of_a_period(w):
    piece = CycloidPiece(*(np.array([x]) for x in (1.3, 0.2, 0.4, -0.7, 1.9, w)))
    sampled = piece.at(DENSE)
    assert piece.peaks()[0][0] == pytest.approx(np.abs(sampled[2]).max(), rel=1e-6)
    assert piece.peaks()[1][0] == pytest.approx(np.abs(sampled[3]).max(), rel=1e-6)


def test_velocity_is_monotone_between_its_turning_points():
    pieces = random_pieces(72, 200)
    turning = joined(pieces).turning_points()
    assert turning.shape == (200, 4)
    assert (turning[:, 0] == 0.0).all()
    assert (turning[:, -1] == 1.0).all()
    assert (np.diff(turning, axis=1) >= 0.0).all()
    for piece, points in zip(pieces, turning):
        for low, high in zip(points[:-1], points[1:]):
            steps = np.diff(piece.at(np.linspace(low, high, 201))[1])
            assert (steps >= -ROUNDING).all() or (steps <= ROUNDING).all()


def test_pieces_at_once_equal_one_by_one():
    pieces = random_pieces(73, 12)
    s = np.linspace(0.0, 1.0, 7)
    columns = CycloidPiece(*(field[:, np.newaxis] for field in joined(pieces)))
    at_once = columns.at(s)
    for i, piece in enumerate(pieces):
        for several, single in zip(at_once, piece.at(s)):
            assert several[i] == pytest.approx(single, abs=ROUNDING)


def test_pieces_are_made_of_arrays_as_of_floats():
    rng = np.random.default_rng(74)
    T, position, v0, v1, a0 = rng.uniform(0.1, 2.0, (5, 6))
    for make, fields in ((transition, (T, position, v0, v1)), (cruise, (T, position, v0)),
                         (ramp, (T, position, v0, v1, a0))):
        several = make(*fields)
        singles = joined([make(*values) for values in zip(*fields)])
        for field, single in zip(several, singles):
            assert np.broadcast_to(field, 6) == pytest.approx(single, abs=ROUNDING)
