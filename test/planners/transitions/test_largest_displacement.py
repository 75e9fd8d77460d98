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

"""What a segment can cover: against brute force, by symmetries and by finite differences."""

from helpers.random_cases import central_difference
import numpy as np
import pytest
from rrr_traj_planner.planners.transitions.largest_displacement import (
    derivatives,
    largest_cruise,
    largest_displacement,
)
from rrr_traj_planner.planners.transitions.transition_law import SegmentLimits, TransitionLaw

LAWS = {'acceleration': TransitionLaw(np.full(3, 2.0), np.zeros(3)),
        'jerk': TransitionLaw(np.full(3, 2.0), np.full(3, 1.6)),
        'some joints': TransitionLaw(np.array([2.0, 0.4, 1.0]), np.array([0.0, 0.9, 3.0]))}
CASES = [(name, seed) for name in LAWS for seed in range(5)]


def case(name, seed):
    """Return a law, a velocity limit, end velocities and a duration between them that will do."""
    rng = np.random.default_rng(700 + seed)
    law, limit = LAWS[name], rng.uniform(0.3, 2.0, 3)
    v0, v1 = rng.uniform(-1.0, 1.0, (2, 3)) * limit
    slack = rng.choice([1.0, 1.001, 1.5, 3.0])
    return law, limit, v0, v1, np.full(3, law.least_time(v1 - v0).max() * slack)


def by_hand(law, change):
    """Return the least durations that peaks of 2 D / t and 2 pi D / t^2 leave."""
    return np.maximum(law.slope * np.abs(change), law.root * np.abs(change) ** 0.5)


@pytest.mark.parametrize('name', LAWS)
def test_largest_change_and_least_time_are_each_other_s_inverse(name):
    change = np.geomspace(1e-6, 10.0, 50)[:, np.newaxis] * np.ones(3)
    law = LAWS[name]
    assert law.largest_change(law.least_time(change)) == pytest.approx(change, rel=1e-12)
    assert law.least_time(-change).tolist() == law.least_time(change).tolist()


@pytest.mark.parametrize(('name', 'seed'), CASES)
def test_largest_displacement_is_that_of_the_best_cruise_by_brute_force(name, seed):
    law, limit, v0, v1, T = case(name, seed)
    ours = largest_displacement(SegmentLimits(law, limit), v0, v1, T)
    u = np.linspace(-limit, limit, 4001)
    t0, t1 = by_hand(law, u - v0), by_hand(law, u - v1)
    covered = 0.5 * (v0 + u) * t0 + u * (T - t0 - t1) + 0.5 * (u + v1) * t1
    best = np.where(t0 + t1 <= T * (1.0 + 1e-9), covered, -np.inf).max(axis=0)
    assert (best <= ours + 1e-9).all()
    # The grid of cruises misses the best one by up to a two-thousandth of the limit.
    found = np.isfinite(best)
    assert (best >= ours - T * limit / 1000.0)[found].all()


@pytest.mark.parametrize(('name', 'seed'), CASES)
def test_cruise_of_the_largest_displacement_fits_in_the_time(name, seed):
    law, limit, v0, v1, T = case(name, seed)
    u = largest_cruise(SegmentLimits(law, limit), v0, v1, T)
    assert (u <= limit).all()
    assert (law.least_time(u - v0) + law.least_time(u - v1) <= T * (1.0 + 1e-9) + 1e-12).all()


@pytest.mark.parametrize(('name', 'seed'), CASES)
def test_largest_displacement_is_the_same_backwards_in_time(name, seed):
    law, limit, v0, v1, T = case(name, seed)
    forwards = largest_displacement(SegmentLimits(law, limit), v0, v1, T)
    backwards = largest_displacement(SegmentLimits(law, limit), v1, v0, T)
    assert forwards == pytest.approx(backwards, rel=1e-12)


@pytest.mark.parametrize(('name', 'seed'), CASES)
def test_derivatives_are_finite_differences(name, seed):
    law, limit, v0, v1, T = case(name, seed)
    x = np.stack((0.99 * v0, 0.99 * v1, 1.05 * T))
    limits = SegmentLimits(law, limit)
    ours = derivatives(limits, *x)
    assert ours.distance == pytest.approx(largest_displacement(limits, *x), rel=1e-12)
    for k, unit in enumerate(np.eye(3)[..., np.newaxis]):
        def distance(step, unit=unit):
            return largest_displacement(SegmentLimits(law, limit), *(x + step * unit))

        def gradient(step, unit=unit):
            return derivatives(SegmentLimits(law, limit), *(x + step * unit)).gradient.T

        first, second = ours.gradient[:, k], ours.hessian[:, k].T
        for exact, function in ((first, distance), (second, gradient)):
            coarse, fine = (central_difference(function, 0.0, step) for step in (1e-4, 1e-5))
            # no kink, where two laws or a limit meet, is near
            smooth = np.abs(coarse - fine) < 1e-6 * (1.0 + np.abs(fine))
            assert exact[smooth] == pytest.approx(fine[smooth], rel=1e-5, abs=1e-6)
            assert smooth.sum() >= 1


def test_reach_from_rest_to_rest_is_what_a_hand_calculation_gives():
    # 1 rad/s^2: a transition of u lasts 2 u. In 2 s: u = 0.5, and 0.5 rad; within 0.3 rad/s:
    # 0.3 * 2 - 0.3 * 0.6 = 0.42 rad.
    law, rest, T = LAWS['acceleration'], np.zeros(3), np.full(3, 2.0)
    for velocity, distance in ((9.0, 0.5), (0.3, 0.42)):
        limits = SegmentLimits(law, np.full(3, velocity))
        assert largest_displacement(limits, rest, rest, T) == pytest.approx([distance] * 3)


def test_jerk_alone_makes_transitions_as_long_as_its_root():
    # u with 2 root sqrt(u) = T: u = (T / (2 root))^2, distance u T / 2.
    law = TransitionLaw(np.full(3, 1e-9), np.full(3, 2.0))
    case = SegmentLimits(law, np.full(3, 9.0)), np.zeros(3), np.zeros(3), np.full(3, 4.0)
    assert largest_cruise(*case) == pytest.approx([1.0] * 3, rel=1e-6)
    assert largest_displacement(*case) == pytest.approx([2.0] * 3, rel=1e-6)
