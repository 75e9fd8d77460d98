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

"""The 4-3-4 law against the 14 linear conditions that define it, and hand calculations."""

import numpy as np
import pytest
from rrr_traj_planner.core.motion_laws.lin_434 import Lin434
from rrr_traj_planner.core.motion_laws.quartic import QUARTIC

RNG = np.random.default_rng(611)
# Parts of the duration, accelerations at the joins, some of them of the wrong sign, duration,
# start and displacement.
CASES = [(*RNG.uniform(0.05, 0.48, 2), *RNG.normal(0.0, 5.0, 2), RNG.uniform(0.3, 4.0),
          *RNG.normal(0.0, 1.0, 2)) for _ in range(12)]
S = np.linspace(0.0, 1.0, 20001)
ROUNDING = 1e-11


def derivative_row(t, order, terms):
    """Return the factors of a polynomial's coefficients in its derivative at t."""
    row = np.zeros(terms)
    for n in range(order, terms):
        row[n] = np.prod(np.arange(n, n - order, -1.0)) * t ** (n - order)
    return row


def solved(times, points):
    """
    Return the coefficients of Lin's 4-3-4 through four points, from its 14 conditions.

    Each polynomial's time begins at 0.
    """
    sizes, rows, right = (5, 4, 5), [], []
    offsets = (0, 5, 9)

    def condition(value, *terms):
        row = np.zeros(14)
        for piece, t, order, sign in terms:
            at = slice(offsets[piece], offsets[piece] + sizes[piece])
            row[at] += sign * derivative_row(t, order, sizes[piece])
        rows.append(row)
        right.append(value)

    for order, value in enumerate((points[0], 0.0, 0.0)):
        condition(value, (0, 0.0, order, 1.0))
    for k in (0, 1):
        condition(points[k + 1], (k, times[k], 0, 1.0))
        condition(points[k + 1], (k + 1, 0.0, 0, 1.0))
        for order in (1, 2):
            condition(0.0, (k, times[k], order, 1.0), (k + 1, 0.0, order, -1.0))
    for order, value in enumerate((points[3], 0.0, 0.0)):
        condition(value, (2, times[2], order, 1.0))
    x = np.linalg.solve(np.array(rows), np.array(right))
    return [x[o:o + n] for o, n in zip(offsets, sizes)]


@pytest.mark.parametrize('case', CASES)
def test_law_is_the_solution_of_the_14_conditions_through_its_points(case):
    first, last, a1, a2, T, start, D = case
    law = Lin434(first, last, a1, a2)
    points = start + D * np.array([0.0, law.lift_off, 1.0 - law.set_down, 1.0])
    times = T * np.array([first, law.cruise, last])
    for piece, coefficients, t in zip(law.pieces(T, start, D), solved(times, points), times):
        assert piece.duration == pytest.approx(t, rel=1e-14)
        for s in (0.0, 0.2, 0.7, 1.0):
            expected = [derivative_row(s * t, order, len(coefficients)) @ coefficients
                        for order in range(4)]
            assert np.array(piece.at(s)) == pytest.approx(expected, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize('case', CASES)
def test_position_velocity_and_acceleration_are_continuous_from_rest_to_rest(case):
    *fields, T, start, D = case
    pieces = Lin434(*fields).pieces(T, start, D)
    for before, after in zip(pieces, pieces[1:]):
        assert before.at(1.0)[:3] == pytest.approx(after.at(0.0)[:3], abs=ROUNDING)
    assert pieces[0].at(0.0)[:3] == (start, 0.0, 0.0)
    assert pieces[2].at(1.0)[:3] == pytest.approx((start + D, 0.0, 0.0), abs=ROUNDING)
    assert pieces[1].snap == 0.0


@pytest.mark.parametrize('case', CASES)
def test_peaks_are_those_of_dense_samples(case):
    law = Lin434(*case[:4])
    dense = [np.abs(np.concatenate(values)).max() for values in zip(*(
        piece.at(S)[1:] for piece in law.pieces(1.0, 0.0, 1.0)))]
    exact = [np.abs(values).max() for values in (
        law.velocities(), law.accelerations(), law.jerks())]
    assert (np.array(dense) <= np.array(exact) * (1.0 + 1e-12)).all()
    assert dense == pytest.approx(exact, rel=1e-6)


@pytest.mark.parametrize('case', CASES)
def test_least_velocity_is_among_those_that_are_looked_at(case):
    law = Lin434(*case[:4])
    dense = min(piece.at(S)[1].min() for piece in law.pieces(1.0, 0.0, 1.0))
    assert min(law.velocities().min(), 0.0) == pytest.approx(dense, abs=1e-6)


@pytest.mark.parametrize('case', CASES)
def test_reversed_law_is_the_motion_backwards(case):
    law = Lin434(*case[:4])
    for forth, back in zip(law.pieces(1.0, 0.0, 1.0), law.backwards.pieces(1.0, 0.0, 1.0)[::-1]):
        q, qd, qdd, qddd = forth.at(S)
        p, pd, pdd, pddd = back.at(1.0 - S)
        for ours, theirs in ((q, 1.0 - p), (qd, pd), (qdd, -pdd), (qddd, pddd)):
            assert np.abs(ours - theirs).max() <= 1e-9


def test_equal_thirds_by_hand():
    # With k1 = 13.5 the acceleration 4.5 x + 13.5 x (1 - x) is 6 at x = 2/3 and 4.5 at x = 1; its
    # integral over 1/3 is 1.5, and 0.375 more to the middle of the cruise.
    law = Lin434(1.0 / 3.0, 1.0 / 3.0, 4.5, -4.5)
    assert law.k1 == pytest.approx(13.5)
    assert law.v1 == law.v2 == pytest.approx(1.5)
    assert law.velocities() == pytest.approx([1.5, 1.875, 1.5])
    assert law.accelerations() == pytest.approx([6.0, 4.5, -4.5, -6.0])
    assert law.jerks() == pytest.approx([54.0, -27.0, -27.0, -27.0, 54.0])


def test_quarters_of_constant_jerk_by_hand():
    # 32 / 4 = 8, 32 / 2 / 16 = 1, 32 / 6 / 64 = 1 / 12.
    law = Lin434(0.25, 0.25, 8.0, -8.0)
    assert law.jerks() == pytest.approx([32.0, 32.0, -32.0, 32.0, 32.0])
    assert (law.v1, law.lift_off, law.set_down) == pytest.approx((1.0, 1.0 / 12.0, 1.0 / 12.0))
    assert law.velocities().max() == pytest.approx(2.0)


def test_without_acceleration_at_the_joins_the_ends_are_paul_s_quartics():
    lift, cruise, _ = Lin434(0.2, 0.3, 0.0, 0.0).pieces(2.0, 0.1, 0.6)
    velocity = 0.6 / 2.0 / (0.1 + 0.5 + 0.15)
    paul = QUARTIC.transition(0.4, 0.1, 0.0, velocity)
    for ours, theirs in zip(lift.at(S), paul.at(S)):
        assert ours == pytest.approx(theirs, abs=1e-12)
    assert np.abs(cruise.at(S)[1] - velocity).max() <= 1e-12


def test_several_laws_are_each_of_them():
    fields = np.array([case[:4] for case in CASES]).T
    together = Lin434(*fields).pieces(1.5, np.arange(12.0), np.linspace(-1.0, 1.0, 12))
    for k, case in enumerate(CASES):
        alone = Lin434(*case[:4]).pieces(1.5, float(k), np.linspace(-1.0, 1.0, 12)[k])
        for ours, theirs in zip(together, alone):
            fields_of_k = [np.broadcast_to(field, 12)[k] for field in ours]
            assert fields_of_k == pytest.approx(list(theirs), rel=1e-12)
