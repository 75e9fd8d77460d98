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

"""Polynomial pieces: derivatives, extremes against dense samples, trajectories made of them."""

from helpers.random_cases import central_difference
import numpy as np
import pytest
from rrr_traj_planner.core.motion_laws.polynomial_piece import PolynomialPiece
from rrr_traj_planner.core.trajectory.joint_profile import JointProfile

S = np.linspace(0.0, 1.0, 20001)
BETWEEN_SAMPLES = 1e-7  # relative, of a parabola's peak between two of 20,001 samples


def random_pieces(rng, n):
    """Return pieces of which a third are cubics, and some have no jerk at all."""
    rates = rng.normal(0.0, [[1.0], [1.0], [2.0], [10.0], [40.0]], (5, n))
    rates[4, ::3] = 0.0
    rates[3, ::6] = 0.0
    return PolynomialPiece(rng.uniform(0.2, 2.0, n), *rates)


@pytest.mark.parametrize('order', range(3))
def test_each_value_is_the_rate_of_the_one_before(order):
    piece = PolynomialPiece(1.7, 0.3, -0.4, 0.9, -2.0, 5.0)
    for s in (0.1, 0.5, 0.9):
        slope = central_difference(lambda x: piece.at(x)[order], s, 1e-3) / 1.7
        assert slope == pytest.approx(piece.at(s)[order + 1], abs=1e-9)


def test_values_at_the_start_are_the_fields_and_at_the_end_taylor_s():
    piece = PolynomialPiece(2.0, 0.3, -0.4, 0.9, -2.0, 5.0)
    assert piece.at(0.0) == pytest.approx((0.3, -0.4, 0.9, -2.0))
    assert piece.at(1.0) == pytest.approx((
        0.3 - 0.8 + 0.9 * 2.0 - 2.0 * 8.0 / 6.0 + 5.0 * 16.0 / 24.0,
        -0.4 + 1.8 - 2.0 * 2.0 + 5.0 * 8.0 / 6.0, 0.9 - 4.0 + 10.0, -2.0 + 10.0))


def test_velocity_is_monotone_between_turning_points():
    pieces = random_pieces(np.random.default_rng(601), 60)
    turning = pieces.turning_points()
    assert turning.shape == (60, 4)
    assert (np.diff(turning, axis=1) >= 0.0).all()
    for k in range(60):
        one = PolynomialPiece(*(field[k] for field in pieces))
        for low, high in zip(turning[k], turning[k, 1:]):
            steps = np.diff(one.at(np.linspace(low, high, 400))[1])
            assert max(steps.min(), -steps.max()) >= -1e-12


def test_peaks_are_those_of_dense_samples():
    pieces = random_pieces(np.random.default_rng(602), 60)
    columns = PolynomialPiece(*(field[:, np.newaxis] for field in pieces))
    for exact, dense in zip(pieces.peaks(), columns.at(S)[2:]):
        largest = np.abs(dense).max(axis=1)
        assert (largest <= exact * (1.0 + 1e-14)).all()
        assert largest == pytest.approx(exact, rel=BETWEEN_SAMPLES)


def test_position_range_of_a_profile_is_that_of_dense_samples():
    pieces = random_pieces(np.random.default_rng(603), 40)
    for k in range(40):
        one = PolynomialPiece(*(field[k:k + 1] for field in pieces))
        least, most = JointProfile(one).position_range()
        q = one.at(S)[0]
        assert least <= q.min() + 1e-12
        assert most >= q.max() - 1e-12
        assert (least, most) == pytest.approx((q.min(), q.max()), abs=1e-6)


def test_stretched_piece_passes_the_same_positions_more_slowly():
    piece = PolynomialPiece(1.7, 0.3, -0.4, 0.9, -2.0, 5.0)
    slow = piece.time_scaled(2.5)
    assert slow.duration == 1.7 * 2.5
    for order, (ours, theirs) in enumerate(zip(slow.at(S), piece.at(S))):
        assert ours == pytest.approx(theirs / 2.5 ** order, abs=1e-12)
