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

"""Excess of sampled quantities between a problem's points: against sums written plainly."""

import numpy as np
import pytest
from rrr_traj_planner.planners.solver.excess import (
    excess_near_points,
    range_excess,
    rise_between_samples,
)
from rrr_traj_planner.planners.tolerances import LIMIT_ROUNDING

SEEDS = range(6)


@pytest.mark.parametrize('seed', SEEDS)
def test_a_parabola_rises_between_samples_by_no_more_than_reported(seed):
    # its largest value between two samples is at most 1/8 of its second difference above both
    rng = np.random.default_rng(seed)
    t, (peak, top, bend) = np.arange(9.0), rng.uniform((0.0, -1.0, 0.1), (8.0, 1.0, 3.0))
    x = top - bend * (t - peak) ** 2
    rise = rise_between_samples(x[np.newaxis, :, np.newaxis])[0, :, 0]
    assert rise == pytest.approx(np.full(9, 2.0 * bend / 8.0))
    assert (x + rise).max() >= top - 1e-12


def test_the_rise_is_that_of_the_largest_second_difference_beside_a_sample():
    x = np.zeros((2, 7, 2))
    x[1, 3, 1] = 8.0  # second differences 8, -16, 8 at samples 2, 3, 4 of one quantity alone
    rise = rise_between_samples(x)
    assert rise[1, :, 1].tolist() == [0.0, 1.0, 2.0, 2.0, 2.0, 1.0, 0.0]
    rise[1, :, 1] = 0.0
    assert not rise.any()


@pytest.mark.parametrize('checks, reach', [(1, 0), (2, 2), (4, 4), (12, 6), (8, 11)])
@pytest.mark.parametrize('seed', SEEDS)
def test_excess_is_the_largest_within_reach_of_each_point(seed, checks, reach):
    rng = np.random.default_rng(seed)
    N, n, K = rng.integers(1, 4), rng.integers(1, 6), rng.integers(1, 5)
    x = rng.normal(size=(N, 2 * n * checks + 1, K))
    limit = np.where(rng.random(K) < 0.3, np.inf, rng.uniform(0.5, 3.0, K))
    found = excess_near_points(x, limit, checks, reach)
    peaks = np.abs(x) + rise_between_samples(x)
    order = [*range(0, 2 * n + 1, 2), *range(1, 2 * n, 2)]  # the nodes, then the middles
    assert found.shape == (N, 2 * n + 1, K)
    for k in range(N):
        for row, point in enumerate(order):
            near = peaks[k, max(point * checks - reach, 0):point * checks + reach + 1]
            for e in range(K):
                over = [p - limit[e] * (1.0 - LIMIT_ROUNDING)
                        for p in near[:, e] if p > limit[e]]
                assert found[k, row, e] == pytest.approx(max(over, default=0.0))


@pytest.mark.parametrize('seed', SEEDS)
def test_ranges_are_left_by_the_peaks_of_parabolas_between_samples(seed):
    # x = top -+ bend (t - peak)^2: its extreme is top, and it ends far on the other side
    rng = np.random.default_rng(seed)
    t, peak, way = np.arange(9.0), rng.uniform(0.1, 7.9, (4, 3)), rng.choice((-1.0, 1.0), (4, 3))
    bend, top = rng.uniform(0.1, 3.0, (2, 4, 3))
    from_peak = t[:, np.newaxis] - peak[:, np.newaxis]
    x = top[:, np.newaxis] - way[:, np.newaxis] * bend[:, np.newaxis] * from_peak ** 2
    v = -2.0 * way[:, np.newaxis] * bend[:, np.newaxis] * from_peak
    least, most = np.array([-0.2, -np.inf, 0.1]), np.array([0.4, 0.3, np.inf])
    upper, lower = range_excess(x, v, least, most, 0.0)
    highest = np.where(way > 0.0, top, x.max(axis=1))
    lowest = np.where(way > 0.0, x.min(axis=1), top)
    for found, true in ((upper, highest - most), (lower, least - lowest)):
        limited = np.isfinite(true)
        assert np.array_equal(np.isfinite(found), limited)
        assert (found >= true - 1e-12)[limited].all()
        # a sample beside the peak is up to bend / 4 below it, and rises by bend / 4
        assert (found <= true + 0.25 * bend + 1e-12)[limited].all()


def test_a_joint_at_rest_at_a_sample_does_not_reverse_beside_it():
    x = np.array([0.0, 0.0, 1.0, 4.0, 4.0])[np.newaxis, :, np.newaxis]
    v = np.array([-1e-9, 1e-9, 2.0, 1.0, -1e-9])[np.newaxis, :, np.newaxis]
    upper, lower = range_excess(x, v, np.zeros(1), np.full(1, 4.0), 1e-8)
    assert (upper.item(), lower.item()) == (0.0, 0.0)
    upper, lower = range_excess(x, v, np.zeros(1), np.full(1, 4.0), 0.0)
    assert upper.item() > 0.0
    assert lower.item() > 0.0
