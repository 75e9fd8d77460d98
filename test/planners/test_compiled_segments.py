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

"""The compiled search for via velocities, and for cruises, against the same in NumPy."""

import numpy as np
from numpy_alone import by_numpy
import pytest
from rrr_traj_planner.planners import compiled
from rrr_traj_planner.planners.chain import Chain
from rrr_traj_planner.planners.segment import TransitionLaw
from rrr_traj_planner.planners.segment_motion import gentle_parts, quick_parts
from rrr_traj_planner.planners.via_velocities import least_stretch, least_time

pytestmark = pytest.mark.skipif(compiled.LIBRARY is None, reason='no compiled code')

SEEDS = range(12)
SAME = 1e-6  # relative: rounding adds up from step to step


def random_chain(seed):
    """Return a chain of 1 to 12 segments, with or without a jerk limit, some joints still."""
    rng = np.random.default_rng(4300 + seed)
    n = int(rng.integers(1, 13))
    root = rng.uniform(0.3, 1.5, 3) * (rng.random() < 0.7)
    law = TransitionLaw(rng.uniform(0.5, 3.0, 3), root)
    highest = rng.uniform(0.1, 1.0, (n - 1, 3))
    D = rng.normal(0.0, 0.6, (n, 3)) * (rng.random((n, 3)) < 0.8)
    D[:, 0] += (D == 0.0).all(axis=1)
    return Chain(D, law, np.full(3, 1.2), -highest, highest)


def assert_same(found, plain):
    assert found.durations == pytest.approx(plain.durations, rel=SAME)
    assert found.velocities == pytest.approx(plain.velocities, abs=10.0 * SAME)
    assert found.gap == pytest.approx(plain.gap, rel=1e-12)


@pytest.mark.parametrize('seed', SEEDS)
def test_least_time_is_the_same_with_floors_and_without(seed):
    chain = random_chain(seed)
    free = least_time(chain)
    assert_same(free, by_numpy(least_time, chain))
    floor = free.durations * np.random.default_rng(seed).uniform(0.5, 1.5, len(free.durations))
    found = least_time(chain, floor)
    assert_same(found, by_numpy(least_time, chain, floor))
    assert (found.durations > floor).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_least_stretch_is_the_same(seed):
    chain = random_chain(seed)
    T = chain.rest_to_rest_times() * np.random.default_rng(seed).uniform(
        0.5, 1.5, len(chain.displacements))
    (factor, found), (other, plain) = least_stretch(chain, T), by_numpy(least_stretch, chain, T)
    assert factor == pytest.approx(other, rel=SAME)
    assert_same(found, plain)


@pytest.mark.parametrize('steps', [0, 1, 7])
def test_it_asks_before_every_step_whether_to_stop(steps):
    def counter():
        asked = iter(range(steps + 1))
        return lambda: next(asked) == steps

    chain = random_chain(3)
    assert_same(least_time(chain, should_stop=counter()),
                by_numpy(least_time, chain, should_stop=counter()))


def test_what_the_question_raises_goes_on_to_the_caller():
    def should_stop():
        raise KeyboardInterrupt('now')

    with pytest.raises(KeyboardInterrupt, match='now'):
        least_time(random_chain(3), should_stop=should_stop)


@pytest.mark.parametrize('seed', SEEDS)
def test_cruises_that_cover_displacements_are_the_same(seed):
    chain = random_chain(seed)
    v, T, _ = least_time(chain)
    v0, v1 = np.vstack((np.zeros(3), v)), np.vstack((v, np.zeros(3)))
    case = v0, v1, 1.0001 * T[:, np.newaxis], chain.displacements
    for found, plain in (
            (gentle_parts(chain.law, chain.max_velocity, *case),
             by_numpy(gentle_parts, chain.law, chain.max_velocity, *case)),
            (quick_parts(chain.law, *case), by_numpy(quick_parts, chain.law, *case))):
        for a, b in zip(found, plain):
            assert a == pytest.approx(b, rel=1e-12, abs=1e-12)
