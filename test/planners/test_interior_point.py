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

"""The interior-point method against a general solver, closed forms and its own promises."""

from dataclasses import replace
from itertools import count

import numpy as np
import pytest
from ramp_cases import (
    all_free,
    bounds,
    closer,
    FREE,
    LIMITS,
    NONE,
    random_motion,
    random_step,
    shifted,
    slow_start,
)
from rrr_traj_planner.planners import compiled, interior_step
from rrr_traj_planner.planners.interior_point import Centre, minimise
from rrr_traj_planner.planners.interior_step import Local, rate_of, Tried
from rrr_traj_planner.planners.ramp_chain import Grid, Motion
from rrr_traj_planner.planners.ramp_moves import restored, stepped
from rrr_traj_planner.planners.ramp_newton import Freedom
from scipy.optimize import minimize

GAP = 6e-3  # relative: what counts as converged
SEEDS = range(6)


def never():
    return False


@pytest.fixture
def in_numpy(monkeypatch):
    """Leave the compiled code aside: the test looks at every iterate."""
    monkeypatch.setattr(compiled, 'LIBRARY', None)


@pytest.fixture(autouse=True, params=['compiled', 'numpy'])
def method(request, monkeypatch):
    """Both ways to do the same."""
    if request.param == 'numpy':
        monkeypatch.setattr(compiled, 'LIBRARY', None)
    elif compiled.LIBRARY is None:
        pytest.skip('no compiled code')


def solve(limits, grid, points, should_stop=never, freedom=None):
    constraints, m = slow_start(limits, grid, points)
    seen = []
    linear = constraints.linear
    constraints.linear = lambda m: (seen.append(m), linear(m))[1]
    outcome = minimise(constraints, Centre(m, None), freedom or all_free(len(m.T)), should_stop)
    return constraints, m, seen, outcome


def reference(limits, grid, points, start):
    """Return the least time of one segment in which joint 1 alone moves, by SLSQP."""
    def motion(x):
        inner, rest = np.zeros((1, grid.n - 1, 3)), np.zeros((0, 3))
        inner[0, :, 0] = x[:-1]
        return Motion(inner, rest, rest, x[-1:])

    def ends(x):
        at = grid.states(points, motion(x))
        return [at.q[0, grid.n, 0] - points[1, 0], at.qd[0, grid.n, 0]]

    def room(x):
        at = grid.states(points, motion(x))
        return np.concatenate([(bound[0] - sign * value[0, :, 0]) for sign in (-1.0, 1.0)
                               for value, bound in ((at.qd, limits.max_velocity),
                                                    (at.qdd, limits.max_acceleration),
                                                    (at.jerk, limits.max_jerk))])

    x = minimize(lambda x: x[-1], np.append(start.inner[0, :, 0], start.T), method='SLSQP',
                 constraints=[{'type': 'eq', 'fun': ends}, {'type': 'ineq', 'fun': room}],
                 options={'maxiter': 500, 'ftol': 1e-10})
    assert x.success
    return x.fun


@pytest.mark.parametrize(('v', 'a', 'J'), [(9.0, 1.0, 50.0), (0.4, 1.0, 8.0), (9.0, 9.0, 3.0)])
@pytest.mark.parametrize('n', [6, 11])
def test_one_segment_takes_what_a_general_solver_finds(n, v, a, J):
    limits = replace(FREE, max_velocity=[v] * 3, max_acceleration=[a] * 3, max_jerk=[J] * 3)
    points, grid = np.array([[0.1, 1.4, 0.0], [0.8, 1.4, 0.0]]), Grid(n)
    _, start, _, outcome = solve(limits, grid, points)
    least = reference(limits, grid, points, start)
    assert outcome.converged
    assert least * (1.0 - 1e-6) <= outcome.motion.T.sum() <= least * (1.0 + GAP)
    assert outcome.motion.T.sum() - outcome.gap <= least * (1.0 + 1e-6)


@pytest.mark.parametrize('n', [8, 20])
def test_acceleration_alone_gives_full_acceleration_forth_and_back(n):
    # n ramps, nodes at +a, then -a, 0 at both ends and half-way: D = (n / 2)(n / 2 - 1) a h^2.
    limits = replace(FREE, max_velocity=NONE, max_acceleration=[1.0] * 3, max_jerk=NONE)
    points = np.array([[0.0, 1.4, 0.0], [1.0, 1.4, 0.0]])
    found = solve(limits, Grid(n), points)[3].motion
    expected = n / np.sqrt(0.5 * n * (0.5 * n - 1.0))
    assert found.T[0] == pytest.approx(expected, rel=GAP)


@pytest.mark.parametrize('limits', [FREE, LIMITS, replace(
    LIMITS, max_acceleration=NONE, max_jerk=[50.0] * 3)], ids=['free', 'all', 'torque'])
@pytest.mark.parametrize('seed', SEEDS)
def test_every_iterate_is_strictly_feasible_and_through_the_via_points(seed, limits):
    grid, points, _ = random_motion(seed)
    constraints, start, seen, outcome = solve(limits, grid, points)
    assert len(seen) > 5 or compiled.LIBRARY is not None  # of which the centres are seen
    for m in (*seen, *(c.motion for c in outcome.centres), outcome.motion):
        assert min(s.min() for s in constraints.slacks(m)) > 0.0
        at = grid.states(points, m)
        assert at.q[:, grid.n] == pytest.approx(points[1:], abs=1e-10)
        assert at.qd[:, grid.n] == pytest.approx(grid.nodes(m)[2], abs=1e-10)
    assert outcome.motion.T.sum() <= start.T.sum()


@pytest.mark.parametrize('part', [0.99, 0.9])
@pytest.mark.parametrize('limits', [FREE, LIMITS], ids=['by joint', 'torque'])
@pytest.mark.parametrize('seed', SEEDS)
def test_limits_that_come_closer_are_kept_from_the_first_centre_on(seed, limits, part):
    grid, points, _ = random_motion(seed)
    wide, _, _, passed = solve(limits, grid, points)
    close, free = bounds(closer(limits, part), grid, points), all_free(len(points) - 1)
    anew = solve(closer(limits, part), grid, points)[3].motion.T.sum()
    assert min(s.min() for s in close.slacks(passed.centres[-3].motion)) <= 0.0 or part > 0.9
    for centre in passed.centres[:-2]:  # others have next to no room to come from
        found = minimise(close, centre, free, never, former=wide)
        assert found.within
        for m in (found.motion, *(c.motion for c in found.centres)):
            assert min(s.min() for s in close.slacks(m)) > 0.0
        assert found.motion.T.sum() == pytest.approx(anew, rel=GAP)


def test_limits_that_cannot_be_kept_are_not_said_to_be():
    grid, points, _ = random_motion(1)
    wide, _, _, passed = solve(LIMITS, grid, points)
    weak = replace(LIMITS, max_effort=[0.5] * 3)  # N m: the arm would fall
    found = minimise(bounds(weak, grid, points), passed.centres[-1], all_free(len(points) - 1),
                     never, former=wide)
    assert not found.within and not found.centres and not found.converged


def test_stopped_before_closer_limits_are_kept_it_says_so():
    grid, points, _ = random_motion(2)
    wide, _, _, passed = solve(LIMITS, grid, points)
    close = bounds(closer(LIMITS, 0.9), grid, points)
    found = minimise(close, passed.centres[-1], all_free(len(points) - 1), lambda: True,
                     former=wide)
    assert not found.within and not found.centres


@pytest.mark.parametrize('seed', SEEDS)
def test_gap_bounds_what_a_longer_search_finds_where_the_problem_is_without_torque(seed):
    grid, points, _ = random_motion(seed)
    best = solve(FREE, grid, points)[3].motion.T.sum()
    for stop in (2, 5, 8):
        counter = count()
        early = solve(FREE, grid, points, lambda counter=counter, stop=stop: next(
            counter) >= stop)[3]
        assert early.motion.T.sum() - early.gap <= best * (1.0 + 1e-6)


@pytest.mark.parametrize('seed', SEEDS)
def test_stopped_at_once_it_returns_a_motion_within_limits_not_slower_than_its_start(seed):
    grid, points, _ = random_motion(seed)
    constraints, start, _, outcome = solve(FREE, grid, points, lambda: True)
    assert outcome.motion.T.sum() <= start.T.sum()
    assert min(s.min() for s in constraints.slacks(outcome.motion)) > 0.0
    assert not outcome.converged


@pytest.mark.parametrize('seed', SEEDS)
def test_fixed_durations_stay_and_tied_ones_keep_their_ratio(seed):
    grid, points, _ = random_motion(seed, segments=3)
    still = np.zeros((2, 3), bool)
    fixed = Freedom(np.array([True, False, True]), np.zeros(3), np.array([1.0, 0.0, 1.0]), still)
    _, start, _, outcome = solve(FREE, grid, points, freedom=fixed)
    assert outcome.motion.T[1] == start.T[1]
    assert outcome.motion.T[[0, 2]].sum() < start.T[[0, 2]].sum()
    tied = Freedom(np.zeros(3, bool), start.T, np.ones(3), still)
    _, start, _, outcome = solve(FREE, grid, points, freedom=tied)
    ratio = outcome.motion.T / start.T
    assert ratio == pytest.approx(np.full(3, ratio[0]), rel=1e-9)
    assert ratio[0] < 1.0


def test_velocities_that_are_still_stay_zero():
    grid, points, _ = random_motion(4, segments=3)
    still = np.array([[True, False, False], [False, False, True]])
    found = solve(FREE, grid, points, freedom=all_free(3)._replace(still=still))[3].motion
    assert np.abs(found.v[still]).max() <= 1e-12
    assert np.abs(found.v[~still]).min() > 1e-3


# --- Centres of the central path --------------------------------------------------------------

ALL = [FREE, LIMITS, replace(LIMITS, max_acceleration=NONE, max_jerk=[50.0] * 3)]
NAMES = ['free', 'all', 'torque']


def count_of(constraints, m):
    """Return the number of constraints."""
    return sum(s.size for s in constraints.slacks(m))


@pytest.mark.parametrize('limits', ALL, ids=NAMES)
@pytest.mark.parametrize('seed', SEEDS)
def test_centres_are_strictly_within_limits_slowest_first_and_as_near_as_their_barriers(
        seed, limits):
    grid, points, _ = random_motion(seed)
    constraints, start, _, outcome = solve(limits, grid, points)
    assert len(outcome.centres) >= 2
    best = outcome.motion.T.sum()
    for motion, barrier in outcome.centres:
        assert min(s.min() for s in constraints.slacks(motion)) > 0.0
        at = grid.states(points, motion)
        assert at.q[:, grid.n] == pytest.approx(points[1:], abs=1e-10)
        # the optimum is a constraint's barrier away for every constraint
        assert motion.T.sum() - best <= count_of(constraints, start) * barrier
    barriers = np.array([c.barrier for c in outcome.centres])
    assert barriers[1:] == pytest.approx(0.1 * barriers[:-1])
    assert (np.diff([c.motion.T.sum() for c in outcome.centres]) < 0.0).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_centres_leave_more_room_the_higher_their_barrier(seed):
    grid, points, _ = random_motion(seed)
    constraints, _, _, outcome = solve(LIMITS, grid, points)
    room = [min(s.min() for s in constraints.slacks(c.motion)) for c in outcome.centres]
    assert (np.diff(room) < 0.0).all()


@pytest.mark.parametrize('limits', ALL, ids=NAMES)
@pytest.mark.parametrize('seed', SEEDS)
def test_the_method_ends_at_the_centre_of_the_least_barrier(seed, limits):
    grid, points, _ = random_motion(seed)
    constraints, start, _, outcome = solve(limits, grid, points)
    wanted = outcome.centres[1]
    found = minimise(constraints, Centre(start, None), all_free(len(start.T)), never,
                     wanted.barrier)
    assert [c.barrier for c in found.centres] == [c.barrier for c in outcome.centres[:2]]
    for one, other in zip(found.centres[-1].motion, wanted.motion):
        assert (one == other).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_from_a_centre_on_it_finds_the_same_optimum(seed):
    grid, points, _ = random_motion(seed)
    constraints, _, _, outcome = solve(LIMITS, grid, points)
    again = minimise(constraints, outcome.centres[0], all_free(len(outcome.motion.T)), never)
    assert again.centres[0].barrier <= outcome.centres[0].barrier
    assert again.motion.T.sum() == pytest.approx(outcome.motion.T.sum(), rel=GAP)


# --- The bend of a step that gets nowhere -----------------------------------------------------

class Bent:
    """A step from a centre where torque's limits are curved, its bend, and weights of errors."""

    def __init__(self, seed):
        self.grid, self.points, _ = random_motion(seed)
        self.constraints, _, _, outcome = solve(ALL[2], self.grid, self.points)
        self.motion, barrier = outcome.centres[1]
        slacks = self.constraints.slacks(self.motion)
        duals = [barrier / s for s in slacks]
        self.weights = [d / s for d, s in zip(duals, slacks)]
        local = Local(self.constraints, self.motion, duals, all_free(len(self.motion.T)),
                      0.1 * barrier)
        self.slacks, self.changes = local.slacks, local.changes
        self.step = next(local.steps())
        self.rates = self.rates_of(self.step.motion)
        self.bend = lambda size: local.bend(
            self.constraints, self.motion, Tried(self.step, self.rates, size, None))

    def rates_of(self, step):
        return [rate_of(self.constraints, x, step) for x in self.changes]

    def aside(self, size, bend=None):
        """Return what slacks after the step are beside their linear prediction."""
        step = self.step.motion
        if bend is not None:
            step = shifted(step, bend, size)
        moved = stepped(self.grid, self.points, self.motion, step, size)
        return [after - s - size * r for after, s, r in zip(
            self.constraints.slacks(moved), self.slacks, self.rates)]

    def error(self, aside):
        return float(np.sqrt(sum((w * x ** 2).sum() for w, x in zip(self.weights, aside))))


@pytest.mark.parametrize('seed', SEEDS)
def test_a_bent_step_leaves_slacks_nearer_to_their_linear_prediction(seed):
    case = Bent(seed)
    plain, bent = (np.array([case.error(case.aside(size, bend)) for size, bend in (
        (size, case.bend(size) if with_bend else None) for size in (0.2, 0.1, 0.05))])
        for with_bend in (False, True))
    # of second order; the limits that are near, which count, are fewer than the unknowns
    assert plain[:-1] / plain[1:] == pytest.approx([4.0, 4.0], rel=0.1)
    assert (bent <= 0.35 * plain).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_no_other_bend_that_keeps_the_ends_leaves_less_beside_the_prediction(seed):
    case, size, tiny = Bent(seed), 0.01, 1e-6
    bend, aside = case.bend(size), case.aside(size)
    left = [w * (x / size ** 2 + r) for w, x, r in zip(
        case.weights, aside, case.rates_of(bend))]
    total = case.error([x / w for w, x in zip(case.weights, left)])
    for k in range(5):
        other = random_step(10 * seed + k, case.motion)
        inner = (restored(case.grid, case.points, shifted(case.motion, other, tiny)).inner
                 - restored(case.grid, case.points, shifted(case.motion, other, -tiny)).inner)
        rates = case.rates_of(other._replace(inner=inner / (2.0 * tiny)))
        slope = sum((x * r).sum() for x, r in zip(left, rates))
        assert abs(slope) <= 1e-5 * total * case.error(rates)


def test_a_step_whose_equations_are_singular_is_skipped(monkeypatch, in_numpy):
    grid, points, _ = random_motion(1)
    constraints, start = slow_start(LIMITS, grid, points)

    def singular(*_):
        raise np.linalg.LinAlgError('Singular matrix')

    monkeypatch.setattr(interior_step, 'newton_step', singular)
    outcome = minimise(constraints, Centre(start, None), all_free(len(start.T)), never)
    assert outcome.motion is start
    assert not outcome.converged
