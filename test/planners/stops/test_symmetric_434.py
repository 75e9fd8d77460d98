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

"""The symmetric 4-3-4 law of least time: closed forms, a brute search, and what symmetry costs."""

import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.motion_laws.lin_434 import Lin434
from rrr_traj_planner.planners.stops.symmetric_434 import (
    DisplacementRatios,
    fastest_symmetric,
    least_time,
)
from rrr_traj_planner.planners.stops.torque_434 import law_for_torque, Segment

RNG = np.random.default_rng(621)
FREE = 1e-9  # a ratio that never binds

# Of displacement / limit for velocity, acceleration and jerk; a third each without limits of
# velocity or jerk.
WAYS = np.exp(RNG.uniform(-4.0, 2.0, 36))
RATIOS = DisplacementRatios(
    WAYS / np.exp(RNG.uniform(-1.0, 1.5, 36)), WAYS / np.exp(RNG.uniform(-1.0, 1.5, 36)),
    WAYS / np.exp(RNG.uniform(1.0, 4.0, 36)))
RATIOS.velocity[::3] = FREE
RATIOS.jerk[1::3] = 1e-3 * WAYS[1::3]

SYMMETRY_COSTS = 0.011  # of time, at most; see `symmetric_434`
BRUTE_PARTS = np.geomspace(1e-4, 0.49, 400)
BRUTE_BULGES = np.linspace(0.0, 1.0, 401)


def fastest(*ratios):
    return fastest_symmetric(DisplacementRatios(*(np.array([ratio]) for ratio in ratios)))


def time_of(law, *ratios):
    return least_time(law, DisplacementRatios(*ratios)).item()


def nth(ratios, k):
    return DisplacementRatios(*(ratio[k] for ratio in ratios))


def test_least_time_is_the_largest_that_a_limit_asks_for():
    thirds = Lin434(1.0 / 3.0, 1.0 / 3.0, 4.5, -4.5)  # peaks 15/8, 6 and 54
    assert time_of(thirds, 2.0, FREE, FREE) == pytest.approx(3.75)
    assert time_of(thirds, FREE, 1.5, FREE) == pytest.approx(3.0)
    assert time_of(thirds, FREE, FREE, 0.5) == pytest.approx(3.0)
    assert time_of(thirds, 2.0, 1.5, 0.5) == pytest.approx(3.75)


def test_with_a_jerk_limit_alone_it_is_the_fastest_of_all_motions():
    # Constant jerk J, -J, J from rest to rest: J T^3 / 32.
    law = fastest(FREE, FREE, 0.7)
    assert np.array(law).ravel() == pytest.approx([0.25, 0.25, 8.0, -8.0], rel=1e-5)
    assert time_of(law, FREE, FREE, 0.7) == pytest.approx(np.cbrt(32.0 * 0.7), rel=1e-7)


def test_with_an_acceleration_limit_alone_it_has_equal_thirds():
    law = fastest(FREE, 0.7, FREE)
    assert np.array(law).ravel() == pytest.approx([1.0 / 3.0, 1.0 / 3.0, 4.5, -4.5], rel=1e-3)
    assert time_of(law, FREE, 0.7, FREE) == pytest.approx(np.sqrt(6.0 * 0.7), rel=1e-7)


def test_with_a_low_velocity_limit_the_cruise_is_at_constant_velocity():
    # Paul's quartics of a duration t: displacement v (T - t), peak acceleration 1.5 v / t = a.
    D, v, a = 1.0, 0.1, 1.0
    law = fastest(D / v, D / a, FREE)
    assert law.a1.item() == pytest.approx(0.0, abs=1e-6)
    t = 1.5 * v / a
    assert time_of(law, D / v, D / a, FREE) == pytest.approx(D / v + t, rel=1e-7)
    assert law.first.item() == pytest.approx(t / (D / v + t), rel=1e-4)


def test_peaks_of_symmetric_laws_are_those_of_the_docstring():
    p, share = RNG.uniform(0.02, 0.49, 50), RNG.uniform(0.0, 1.0, 50)
    m = 6.0 / (1.0 - p)
    b = share * m
    law = Lin434(p, p, m - b, b - m)
    assert p * law.k1 == pytest.approx(b, abs=1e-9)
    assert law.velocities().max(axis=0) == pytest.approx(1.5 / (1.0 - p) - b / 12.0)
    within = (m * p + b * (1.0 - p)) ** 2 / (4.0 * b * p)
    assert np.abs(law.accelerations()).max(axis=0) == pytest.approx(
        np.where(b * (1.0 + p) < m * p, m - b, within))
    assert np.abs(law.jerks()).max(axis=0) == pytest.approx(np.maximum(
        (m + b * (1.0 / p - 1.0)) / p, (m - b) / (0.5 - p)))


def test_no_symmetric_law_of_a_fine_grid_is_faster():
    p, share = BRUTE_PARTS[:, np.newaxis], BRUTE_BULGES
    m = 6.0 / (1.0 - p)
    tried = Lin434(p + 0.0 * share, p + 0.0 * share, m * (1.0 - share), m * (share - 1.0))
    ours = least_time(fastest_symmetric(RATIOS), RATIOS)
    brute = np.array([least_time(tried, nth(RATIOS, k)).min() for k in range(len(WAYS))])
    assert (ours <= brute * (1.0 + 1e-7)).all()
    assert ours == pytest.approx(brute, rel=5e-3)  # the grid's step


def test_mean_of_a_law_and_its_reverse_has_no_higher_peaks_where_the_ends_are_equally_long():
    for p in RNG.uniform(0.05, 0.48, 40):
        law = Lin434(p, p, *RNG.normal(0.0, 5.0, 2))
        mean = Lin434(p, p, *(0.5 * (a + b) for a, b in zip(law[2:], law.backwards[2:])))
        assert mean.a1 == -mean.a2
        for peaks, most in ((mean.velocities(), law.velocities()), (mean.jerks(), law.jerks()),
                            (mean.accelerations(), law.accelerations())):
            assert np.abs(peaks).max() <= np.abs(most).max() * (1.0 + 1e-12)


def test_laws_with_unequal_ends_are_hardly_faster():
    # A second method, without torque: SLSQP over all four numbers of the law.
    limits = JointLimits(max_effort=[np.inf] * 3)
    laws, gains = fastest_symmetric(RATIOS), []
    for k in range(len(WAYS)):
        segment = Segment(RobotModel(), limits, np.zeros(3), np.ones(3), nth(RATIOS, k))
        symmetric = time_of(Lin434(*(field[k] for field in laws)), *segment.ratios)
        starts = (Lin434(0.3, 0.3, 5.0, -5.0), Lin434(0.1, 0.45, 5.0, -0.1))
        found = [law_for_torque(segment, start, symmetric, 0.5 * symmetric) for start in starts]
        gains.append(1.0 - min(time_of(law, *segment.ratios) for law in found) / symmetric)
    assert max(gains) <= SYMMETRY_COSTS
    assert max(gains) >= 0.5 * SYMMETRY_COSTS  # it does find laws with unequal ends


def test_what_does_not_move_has_a_law_too():
    laws = fastest_symmetric(DisplacementRatios(*np.array([[0.0, 1.0], [0.0, 1.0], [0.0, 1.0]])))
    assert np.isfinite(np.array(laws)).all()
