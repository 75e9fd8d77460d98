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

"""Cycloid pieces of every kind: closed-form peaks, turning points, joins and arrays."""

from helpers.random_cases import joined, pieces_of_every_kind
import numpy as np
import pytest
from rrr_traj_planner.core.motion_laws.cycloid import (
    cruise,
    CycloidPiece,
    general_transition,
    ramp,
    transition,
)

# Values are of the order of 1 to 100.
ROUNDING = 1e-12
DENSE = np.linspace(0.0, 1.0, 20001)


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
    pieces = pieces_of_every_kind(71, 200)
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
    pieces = pieces_of_every_kind(72, 200)
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
    pieces = pieces_of_every_kind(73, 12)
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
