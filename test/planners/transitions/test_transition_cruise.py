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

"""Segments of approach (a): the cruise that arrives, and how the last one comes to rest."""

import numpy as np
import pytest
from rrr_traj_planner.planners.transitions.transition_cruise import (
    can_stop,
    cruise_velocity,
    stopping_time,
)
from rrr_traj_planner.planners.transitions.transition_law import SegmentLimits, TransitionLaw

SEEDS = range(10)
BRUTE_FORCE = 5e-3  # steps of duration are 0.3 %; steps of cruise cost 0.1 %
LIMIT = np.array([1.0, 2.0, 0.7])


def law_of(rng):
    return TransitionLaw(rng.uniform(0.5, 3.0, 3),
                         rng.uniform(0.0, 1.5, 3) * (rng.random(3) < 0.6))


def covered(law, v0, v, T):
    """Return what a shortest transition to v and a cruise at v cover."""
    t = law.least_time(v - v0)
    return 0.5 * (v0 + v) * t + v * (T - t)


@pytest.mark.parametrize('seed', SEEDS)
def test_cruise_velocity_is_the_one_that_made_the_displacement(seed):
    rng = np.random.default_rng(1100 + seed)
    law = law_of(rng)
    v0, v = rng.uniform(-1.0, 1.0, (2, 50, 3)) * LIMIT
    T = law.least_time(v - v0).max(axis=1, keepdims=True) * rng.uniform(1.001, 3.0, (50, 1))
    found = cruise_velocity(SegmentLimits(law, LIMIT), v0, T, covered(law, v0, v, T))
    assert found == pytest.approx(v, abs=1e-8)


@pytest.mark.parametrize('seed', SEEDS)
def test_displacement_beyond_every_cruise_has_no_velocity(seed):
    rng = np.random.default_rng(1200 + seed)
    law = law_of(rng)
    v0 = rng.uniform(-1.0, 1.0, 3) * LIMIT
    T = np.array([rng.uniform(0.1, 3.0)])
    v = np.linspace(-LIMIT, LIMIT, 4001)
    in_time = law.least_time(v - v0) <= T
    D = np.where(in_time, covered(law, v0, v, T), -np.inf).max(axis=0)
    limits = SegmentLimits(law, LIMIT)
    assert np.isnan(cruise_velocity(limits, v0, T, D + 0.01 * LIMIT * T)).all()
    assert np.isfinite(cruise_velocity(limits, v0, T, D - 0.01 * LIMIT * T)).any()


@pytest.mark.parametrize('seed', SEEDS)
def test_stopping_time_is_the_least_that_a_fine_scan_finds(seed):
    rng = np.random.default_rng(1300 + seed)
    law = law_of(rng)
    v0 = rng.uniform(-1.0, 1.0, (1, 3)) * LIMIT * rng.choice([0.0, 0.5, 1.0])
    D = rng.uniform(0.05, 1.0, 3) * np.where(v0[0] < 0.0, -1.0, 1.0)
    grid = np.geomspace(0.2, 60.0, 60)
    found = stopping_time(SegmentLimits(law, LIMIT), v0, D, grid)[0]
    fine = np.geomspace(0.2, 60.0, 2001)
    fits = np.array([_stops_by_hand(law, v0[0], T, D) for T in fine])
    if not fits.any():
        assert np.isinf(found)
        return
    # The first duration that fits may lie between the coarse grid's, never above the next.
    first = fine[fits.argmax()]
    assert found >= first * (1.0 - BRUTE_FORCE)
    if fits[fits.argmax():].all():
        assert found == pytest.approx(first, rel=BRUTE_FORCE)


def _stops_by_hand(law, v0, T, D):
    """Return whether some cruise covers D between v0 and rest: the extremes of brute force."""
    u = np.linspace(-LIMIT, LIMIT, 801)
    t0, t1 = law.least_time(u - v0), law.least_time(u)
    s = 0.5 * (v0 + u) * t0 + 0.5 * u * t1 + u * (T - t0 - t1)
    fits = t0 + t1 <= T
    low = np.where(fits, s, np.inf).min(axis=0)
    high = np.where(fits, s, -np.inf).max(axis=0)
    return bool((fits.any(axis=0) & (low <= D) & (D <= high)).all())


def test_a_joint_at_rest_that_stays_can_always_stop():
    law, rest = TransitionLaw(np.full(3, 2.0), np.zeros(3)), np.zeros(3)
    assert can_stop(SegmentLimits(law, LIMIT), rest, np.array([1e-3]), rest)


def test_stop_from_1_rad_s_takes_its_two_seconds_and_covers_one_rad():
    # At 1 rad/s^2: the transition from 1 rad/s lasts 2 s and covers 1 rad.
    law, limit = TransitionLaw(np.full(3, 2.0), np.zeros(3)), np.full(3, 5.0)
    v0, D = np.ones(3), np.ones(3)
    limits = SegmentLimits(law, limit)
    assert can_stop(limits, v0, np.array([2.0 + 1e-12]), D)
    assert not can_stop(limits, v0, np.array([1.99]), D)
    assert stopping_time(limits, v0[np.newaxis], D, np.geomspace(0.5, 9.0, 30)) == (
        pytest.approx([2.0], rel=1e-6))
