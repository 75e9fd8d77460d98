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

from helpers.solving import never, solve
from helpers.spline_cases import (
    all_free,
    bounds,
    closer,
    FREE,
    LIMITS,
    NONE,
    random_motion,
    slow_start,
)
import numpy as np
import pytest
from rrr_traj_planner.planners.solver import line_search
from rrr_traj_planner.planners.solver.interior_point import CentralPathPoint, minimise
from rrr_traj_planner.planners.solver.library import KERNELS
from rrr_traj_planner.planners.solver.limits import DurationConstraints, fixed_ends
from rrr_traj_planner.planners.solver.splines import uniform_mesh, with_stops
from scipy.optimize import minimize

GAP = 6e-3  # relative: what counts as converged
SEEDS = range(5)


def reference(limits, mesh, points, start):
    """Return the least time of one segment in which joint 1 alone moves, by SLSQP."""
    def motion(x):
        inner = np.zeros((1, mesh.n - 1, 3))
        inner[0, :, 0] = x[:-1]
        return with_stops(inner, x[-1:])

    def ends(x):
        at = mesh.states(points, motion(x))
        return [at.q[0, mesh.n, 0] - points[1, 0], at.qd[0, mesh.n, 0], at.qdd[0, mesh.n, 0]]

    def slacks(x):
        at = mesh.states(points, motion(x))
        return np.concatenate([(bound[0] - sign * value[0, :, 0]) for sign in (-1.0, 1.0)
                               for value, bound in ((at.qd, limits.max_velocity),
                                                    (at.qdd, limits.max_acceleration),
                                                    (at.jerk, limits.max_jerk))])

    x = minimize(lambda x: x[-1], np.append(start.inner[0, :, 0], start.T), method='SLSQP',
                 constraints=[{'type': 'eq', 'fun': ends}, {'type': 'ineq', 'fun': slacks}],
                 options={'maxiter': 500, 'ftol': 1e-10})
    assert x.success
    return x.fun


@pytest.mark.parametrize(('v', 'a', 'J'), [(9.0, 1.0, 50.0), (0.4, 1.0, 8.0), (9.0, 9.0, 3.0)])
@pytest.mark.parametrize('n', [6, 11])
def test_one_segment_takes_what_a_general_solver_finds(n, v, a, J):
    limits = replace(FREE, max_velocity=[v] * 3, max_acceleration=[a] * 3, max_jerk=[J] * 3)
    points, mesh = np.array([[0.1, 1.4, 0.0], [0.8, 1.4, 0.0]]), uniform_mesh(1, n)
    _, start, _, outcome = solve(limits, mesh, points)
    least = reference(limits, mesh, points, start)
    assert outcome.converged
    assert least * (1.0 - 1e-6) <= outcome.motion.T.sum() <= least * (1.0 + GAP)
    assert outcome.motion.T.sum() - outcome.gap <= least * (1.0 + 1e-6)


@pytest.mark.parametrize('n', [40, 80])
def test_acceleration_alone_gives_full_acceleration_forth_and_back(n):
    # With two intervals in which acceleration goes from 0 to its limit, or back, and four for its
    # reversal (jerk has its triangles): D is that of a bang-bang motion whose two halves are
    # shorter by two intervals each, to the order of 1 / n.
    limits = replace(FREE, max_velocity=NONE, max_acceleration=[1.0] * 3, max_jerk=NONE)
    points = np.array([[0.0, 1.4, 0.0], [1.0, 1.4, 0.0]])
    found = solve(limits, uniform_mesh(1, n), points)[3].motion
    assert 2.0 * (1.0 + 1.0 / n) < found.T[0] < 2.0 * (1.0 + 3.0 / n)


@pytest.mark.parametrize('limits', [FREE, LIMITS, replace(
    LIMITS, max_acceleration=NONE, max_jerk=[50.0] * 3)], ids=['free', 'all', 'torque'])
@pytest.mark.parametrize('seed', SEEDS)
def test_every_iterate_is_strictly_feasible_and_through_the_via_points(seed, limits):
    mesh, points, _ = random_motion(seed)
    problem, start, seen, outcome = solve(limits, mesh, points)
    assert len(seen) > 5
    for m in (*seen, *(c.motion for c in outcome.centres), outcome.motion):
        assert problem.is_within(m)
        at = mesh.states(points, m)
        assert at.q[:, mesh.n] == pytest.approx(points[1:], abs=1e-10)
        assert at.qd[:, mesh.n] == pytest.approx(m.v[1:], abs=1e-9)
        assert at.qdd[:, mesh.n] == pytest.approx(m.a[1:], abs=1e-8)
    assert outcome.motion.T.sum() <= start.T.sum()


@pytest.mark.parametrize('part', [0.99, 0.9])
@pytest.mark.parametrize('limits', [FREE, LIMITS], ids=['by joint', 'torque'])
@pytest.mark.parametrize('seed', SEEDS)
def test_limits_that_come_closer_are_kept_from_the_first_centre_on(seed, limits, part):
    mesh, points, _ = random_motion(seed)
    wide, _, _, passed = solve(limits, mesh, points)
    close, free = bounds(closer(limits, part), mesh, points).problem, all_free(len(points) - 1)
    anew = solve(closer(limits, part), mesh, points)[3].motion.T.sum()
    assert part > 0.9 or not close.is_within(passed.centres[-3].motion)
    for centre in passed.centres[:-2]:  # others are next to their limits
        found = minimise(close, centre, free, never, wider=wide.limits)
        assert found.within
        for m in (found.motion, *(c.motion for c in found.centres)):
            assert close.is_within(m)
        assert found.motion.T.sum() == pytest.approx(anew, rel=GAP)


@pytest.mark.parametrize('side', ['min_position', 'max_position', 'max_velocity', 'max_effort'])
def test_constraints_are_shifted_to_the_wider_of_two_limits_on_each_side(side):
    mesh, points, m = random_motion(3)
    other = replace(LIMITS, **{side: 0.8 * getattr(LIMITS, side)})
    for limits, previous in ((LIMITS, other), (other, LIMITS)):
        now, before = (bounds(given, mesh, points).problem for given in (limits, previous))
        alone, wider = now.slacks(m), before.slacks(m)
        now.begin(m, all_free(len(m.T)))
        now.shift(before.limits)
        assert now.slacks(m) == pytest.approx(np.maximum(alone, wider), rel=1e-12, abs=1e-12)
        assert (alone != wider).any()


def test_limits_that_cannot_be_kept_are_not_said_to_be():
    mesh, points, _ = random_motion(1)
    wide, _, _, passed = solve(LIMITS, mesh, points)
    weak = replace(LIMITS, max_effort=[0.5] * 3)  # N m: the arm would fall
    found = minimise(bounds(weak, mesh, points).problem, passed.centres[-1],
                     all_free(len(points) - 1), never, wider=wide.limits)
    assert not found.within and not found.centres and not found.converged


def test_stopped_before_closer_limits_are_kept_it_says_so():
    mesh, points, _ = random_motion(2)
    wide, _, _, passed = solve(LIMITS, mesh, points)
    close = bounds(closer(LIMITS, 0.9), mesh, points).problem
    found = minimise(close, passed.centres[-1], all_free(len(points) - 1), lambda: True,
                     wider=wide.limits)
    assert not found.within and not found.centres


@pytest.mark.parametrize('seed', SEEDS)
def test_gap_bounds_what_a_longer_search_finds_where_the_problem_is_without_torque(seed):
    mesh, points, _ = random_motion(seed)
    best = solve(FREE, mesh, points)[3].motion.T.sum()
    for stop in (2, 5, 8):
        counter = count()
        early = solve(FREE, mesh, points, lambda counter=counter, stop=stop: next(
            counter) >= stop)[3]
        assert early.motion.T.sum() - early.gap <= best * (1.0 + 1e-6)


@pytest.mark.parametrize('seed', SEEDS)
def test_stopped_at_once_it_returns_a_motion_within_limits_not_slower_than_its_start(seed):
    mesh, points, _ = random_motion(seed)
    problem, start, _, outcome = solve(FREE, mesh, points, lambda: True)
    assert outcome.motion.T.sum() <= start.T.sum()
    assert problem.is_within(outcome.motion)
    assert not outcome.converged


@pytest.mark.parametrize('seed', SEEDS)
def test_fixed_durations_stay_and_tied_ones_keep_their_ratio(seed):
    mesh, points, _ = random_motion(seed, segments=3)
    at_rest = fixed_ends(3, 3)
    fixed = DurationConstraints(np.array([True, False, True]), np.zeros(3),
                                np.array([1.0, 0.0, 1.0]), at_rest)
    _, start, _, outcome = solve(FREE, mesh, points, durations=fixed)
    assert outcome.motion.T[1] == start.T[1]
    assert outcome.motion.T[[0, 2]].sum() < start.T[[0, 2]].sum()
    tied = DurationConstraints(np.zeros(3, bool), start.T, np.ones(3), at_rest)
    _, start, _, outcome = solve(FREE, mesh, points, durations=tied)
    ratio = outcome.motion.T / start.T
    assert ratio == pytest.approx(np.full(3, ratio[0]), rel=1e-9)
    assert ratio[0] < 1.0


def test_velocities_at_rest_stay_zero():
    mesh, points, _ = random_motion(4, segments=3)
    at_rest = np.array([[True, False, False], [False, False, True]])
    durations = all_free(3)
    durations.fixed[1:-1, 0] = at_rest
    found = solve(FREE, mesh, points, durations=durations)[3].motion
    assert (found.v[1:-1][at_rest] == 0.0).all()
    assert np.abs(found.v[1:-1][~at_rest]).min() > 1e-3
    for values in found[1:4]:
        assert (values[[0, -1]] == 0.0).all()


def test_a_step_whose_equations_are_singular_is_skipped(monkeypatch):
    mesh, points, _ = random_motion(1)
    constraints, start = slow_start(LIMITS, mesh, points)

    class Singular:

        def __getattr__(self, name):
            return (lambda *_: 0) if name == 'timing_newton' else getattr(KERNELS, name)

    monkeypatch.setattr(line_search, 'KERNELS', Singular())
    outcome = minimise(
        constraints.problem, CentralPathPoint(start, None), all_free(len(start.T)), never)
    assert all((f == g).all() for f, g in zip(outcome.motion, start))
    assert not outcome.converged


def test_what_the_callback_raises_goes_on_to_the_caller():
    mesh, points, _ = random_motion(3)
    constraints, m = slow_start(LIMITS, mesh, points)

    def should_stop():
        raise KeyboardInterrupt('now')

    with pytest.raises(KeyboardInterrupt, match='now'):
        minimise(constraints.problem, CentralPathPoint(m, None), all_free(len(m.T)), should_stop)
