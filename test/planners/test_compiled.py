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

"""The compiled method against the same in NumPy, step for step and as a whole."""

from dataclasses import replace

import numpy as np
from numpy_alone import by_numpy
import pytest
from ramp_cases import all_free, bounds, closer, FREE, LIMITS, NONE, random_motion, slow_start
from random_paths import never, random_case
from rrr_traj_planner.planners import compiled
from rrr_traj_planner.planners.interior_point import Centre, minimise
from rrr_traj_planner.planners.path_constraints import PathConstraints, QUANTITIES
from rrr_traj_planner.planners.path_start import paced_along
from rrr_traj_planner.planners.path_table import PathTable
from rrr_traj_planner.planners.ramp_chain import Grid
from rrr_traj_planner.planners.ramp_moves import stretched
from rrr_traj_planner.planners.ramp_newton import Freedom

pytestmark = pytest.mark.skipif(compiled.LIBRARY is None, reason='no compiled code')

SEEDS = range(10)
KINDS = {
    'free': FREE, 'all': LIMITS,
    'torque': replace(LIMITS, max_acceleration=NONE, max_jerk=[50.0] * 3),
    'range': replace(FREE, min_position=[-1.05, 0.75, -0.85], max_position=[1.05, 1.85, 0.85])}

# Derivatives by differences of 1e-7 differ by rounding over that; steps add it up. More of it
# where limits come closer, and along a path whose limits all but touch.
SAME, SAME_CLOSER, SAME_ALONG_PATHS = 5e-6, 1e-3, 1e-2


def both(constraints, start, freedom, should_stop=lambda: never, **options):
    """Return the outcomes of the compiled method and of NumPy's."""
    found = [minimise(constraints, start, freedom, should_stop(), **options)]
    found.append(by_numpy(minimise, constraints, start, freedom, should_stop(), **options))
    return found


def assert_same(found, plain, same=SAME):
    assert found.motion.T.sum() == pytest.approx(plain.motion.T.sum(), rel=1e-6)
    assert found.motion.T == pytest.approx(plain.motion.T, rel=10.0 * same)
    assert found.gap == pytest.approx(plain.gap, rel=5e-2)
    assert found.converged == plain.converged
    assert found.within == plain.within
    assert len(found.centres) == len(plain.centres)
    for a, b in zip(found.centres, plain.centres):
        assert a.barrier == pytest.approx(b.barrier, rel=1e-12)
        assert a.motion.T.sum() == pytest.approx(b.motion.T.sum(), rel=1e-6 + 0.1 * same)
    # the optimum that the last is next to may be flat
    for a, b in zip(found.centres[:-1], plain.centres):
        for x, y in zip(a.motion, b.motion):
            assert x.shape == y.shape
            assert x == pytest.approx(y, rel=same, abs=same)


@pytest.mark.parametrize('kind', KINDS)
@pytest.mark.parametrize('seed', SEEDS)
def test_chains_of_all_joints_end_at_the_same_motion_by_the_same_centres(kind, seed):
    grid, points, _ = random_motion(seed)
    constraints, m = slow_start(KINDS[kind], grid, points)
    assert_same(*both(constraints, Centre(m, None), all_free(len(m.T))))


@pytest.mark.parametrize('seed', SEEDS)
def test_durations_that_are_fixed_tied_or_have_floors_and_joints_that_stay_still(seed):
    grid, points, _ = random_motion(seed, segments=4)
    constraints, m = slow_start(LIMITS, grid, points)
    still = np.random.default_rng(seed).random((3, 3)) < 0.3
    m = m._replace(v=np.where(still, 0.0, m.v))
    for free, tie in (([1, 0, 1, 1], [0, 0, 0, 0]), ([1, 0, 0, 1], [0, 1.0, 2.0, 0])):
        freedom = Freedom(np.array(free, bool), np.array(tie, float), np.ones(4), still)
        floored = constraints_with(constraints, 0.8 * m.T)
        found, plain = both(floored, Centre(m, None), freedom)
        assert_same(found, plain)
        assert (found.motion.T >= 0.8 * m.T).all()
        assert np.abs(found.motion.v[still]).max(initial=0.0) <= 1e-30


def constraints_with(constraints, floor):
    constraints.floor = floor
    return constraints


@pytest.mark.parametrize('steady', [False, True])
@pytest.mark.parametrize('seed', SEEDS)
def test_a_chain_along_a_path_ends_at_the_same_motion(seed, steady):
    case = random_case(seed)
    table, grid = PathTable(case.arm_path), Grid(6, (0.0, 0.6)[seed % 2])
    N = len(table.ends) - 1
    pieces = np.zeros(N, bool)
    pieces[N // 2] = steady and 0 < N // 2 < N - 1
    margins = 1e-3 * np.random.default_rng(seed).random((N, 2 * grid.n + 1, QUANTITIES))
    constraints = PathConstraints(table, replace(case.limits, max_jerk=[30.0] * 3), 0.7, grid,
                                  margins, np.zeros(N, bool))
    speeds = np.full(N + 1, 0.3)
    speeds[[0, -1]] = 0.0
    m = paced_along(grid, table.ends, speeds)
    while min(s.min() for s in constraints.slacks(m)) <= 0.0:
        m = stretched(m, 1.3)
    if steady:
        constraints = PathConstraints(table, case.limits, 0.7, grid, margins, pieces)
        if min(s.min() for s in constraints.slacks(m)) <= 0.0:
            m = stretched(m, 300.0)
    freedom = Freedom(np.ones(N, bool), np.zeros(N), np.ones(N), np.zeros((N - 1, 1), bool))
    found, plain = both(constraints, Centre(m, None), freedom)
    if steady:  # rounding leads a speed that is held to 1e-3 m/s^2 from one centre to another
        assert found.motion.T.sum() == pytest.approx(plain.motion.T.sum(), rel=1e-3)
        assert found.converged == plain.converged
    else:
        assert_same(found, plain, SAME_ALONG_PATHS)


@pytest.mark.parametrize('iterations', [0, 1, 5])
def test_it_asks_before_every_iteration_whether_to_stop(iterations):
    grid, points, _ = random_motion(3)
    constraints, m = slow_start(LIMITS, grid, points)
    asked = []

    def counter():
        asked.clear()
        return lambda: asked.append(None) or len(asked) > iterations

    assert_same(*both(constraints, Centre(m, None), all_free(len(m.T)), counter))
    assert len(asked) == iterations + 1


def test_what_the_question_raises_goes_on_to_the_caller():
    grid, points, _ = random_motion(3)
    constraints, m = slow_start(LIMITS, grid, points)

    def should_stop():
        raise KeyboardInterrupt('now')

    with pytest.raises(KeyboardInterrupt, match='now'):
        minimise(constraints, Centre(m, None), all_free(len(m.T)), should_stop)


def test_it_ends_at_the_centre_of_the_least_barrier():
    grid, points, _ = random_motion(4)
    constraints, m = slow_start(LIMITS, grid, points)
    all_of_them = minimise(constraints, Centre(m, None), all_free(len(m.T)), never).centres
    least = all_of_them[1].barrier
    found, plain = both(constraints, Centre(m, None), all_free(len(m.T)), least_barrier=least)
    assert_same(found, plain)
    assert len(found.centres) == 2


def test_a_start_with_its_barrier_goes_on_from_there():
    grid, points, _ = random_motion(5)
    constraints, m = slow_start(LIMITS, grid, points)
    centre = minimise(constraints, Centre(m, None), all_free(len(m.T)), never).centres[1]
    assert_same(*both(constraints, centre, all_free(len(m.T))))


@pytest.mark.parametrize('seed', SEEDS)
def test_limits_that_come_closer_are_approached_alike(seed):
    grid, points, _ = random_motion(seed)
    wide, m = slow_start(LIMITS, grid, points)
    close = bounds(closer(LIMITS, 0.97), grid, points)
    free = all_free(len(m.T))
    for centre in minimise(wide, Centre(m, None), free, never).centres[1:-2]:
        assert_same(*both(close, centre, free, former=wide), SAME_CLOSER)
