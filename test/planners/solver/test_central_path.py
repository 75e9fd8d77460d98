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

"""Centres of the central path, and the conditions of optimality of the last one."""

from dataclasses import replace

from helpers.random_cases import central_difference
from helpers.solving import never, solve
from helpers.spline_cases import all_free, FREE, LIMITS, NONE, random_motion
import numpy as np
import pytest
from rrr_traj_planner.planners.solver.interior_point import CentralPathPoint, minimise
from scipy.optimize import nnls

GAP = 6e-3  # relative: what counts as converged
SEEDS = range(5)
ALL = [FREE, LIMITS, replace(LIMITS, max_acceleration=NONE, max_jerk=[50.0] * 3)]
NAMES = ['free', 'all', 'torque']


def count_of(problem):
    """Return the number of constraints: no least durations."""
    return problem.arrays['slack'].size - 2 * (len(problem.points) - 1)


@pytest.mark.parametrize('limits', ALL, ids=NAMES)
@pytest.mark.parametrize('seed', SEEDS)
def test_centres_are_strictly_within_limits_slowest_first_and_as_near_as_their_barriers(
        seed, limits):
    mesh, points, _ = random_motion(seed)
    problem, start, _, outcome = solve(limits, mesh, points)
    assert len(outcome.centres) >= 2
    best = outcome.motion.T.sum()
    for motion, barrier in outcome.centres:
        assert problem.is_within(motion)
        at = mesh.states(points, motion)
        assert at.q[:, mesh.n] == pytest.approx(points[1:], abs=1e-10)
        # the optimum is a constraint's barrier away for every constraint
        assert motion.T.sum() - best <= count_of(problem) * barrier
    barriers = np.array([c.barrier for c in outcome.centres])
    assert barriers[1:] == pytest.approx(0.1 * barriers[:-1])
    assert (np.diff([c.motion.T.sum() for c in outcome.centres]) < 0.0).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_centres_have_a_larger_sum_of_logarithms_the_higher_their_barrier(seed):
    mesh, points, _ = random_motion(seed)
    problem, _, _, outcome = solve(LIMITS, mesh, points)
    logs = [np.log(problem.slacks(c.motion)).sum() for c in outcome.centres]
    assert (np.diff(logs) < 0.0).all()


@pytest.mark.parametrize('limits', ALL, ids=NAMES)
@pytest.mark.parametrize('seed', SEEDS)
def test_the_method_ends_at_the_centre_of_the_least_barrier(seed, limits):
    mesh, points, _ = random_motion(seed)
    problem, start, _, outcome = solve(limits, mesh, points)
    wanted = outcome.centres[1]
    found = minimise(problem, CentralPathPoint(start, None), all_free(len(start.T)), never,
                     wanted.barrier)
    assert [c.barrier for c in found.centres] == [c.barrier for c in outcome.centres[:2]]
    for one, other in zip(found.centres[-1].motion, wanted.motion):
        assert (one == other).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_from_a_centre_on_it_finds_the_same_optimum(seed):
    mesh, points, _ = random_motion(seed)
    problem, _, _, outcome = solve(LIMITS, mesh, points)
    again = minimise(problem, outcome.centres[0], all_free(len(outcome.motion.T)), never)
    assert again.centres[0].barrier <= outcome.centres[0].barrier
    assert again.motion.T.sum() == pytest.approx(outcome.motion.T.sum(), rel=GAP)


@pytest.mark.parametrize('limits', ALL, ids=NAMES)
@pytest.mark.parametrize('seed', SEEDS[:3])
def test_returned_motions_keep_the_conditions_of_optimality(seed, limits):
    # Those of Karush, Kuhn and Tucker, by differences of slacks and ends: as far as changes that
    # keep the ends can use it, the objective's gradient is a sum of constraints' gradients, with
    # positive multipliers whose products with the slacks are a centre's gap.
    mesh, points, _ = random_motion(seed, n=6)
    problem, _, _, outcome = solve(limits, mesh, points)
    motion, barrier = outcome.centres[-1]
    x = np.concatenate([f.ravel() for f in motion])

    def by_unknowns(function):
        return np.stack([central_difference(lambda z, unit=unit: function(
            problem.motion(x + z * unit)), 0.0, 1e-6).ravel() for unit in np.eye(len(x))], axis=1)

    def ends(m):
        at = mesh.states(points, m)
        return np.concatenate((at.q[:, mesh.n] - points[1:], at.qd[:, mesh.n] - m.v[1:],
                               at.qdd[:, mesh.n] - m.a[1:]))

    count = count_of(problem)
    E, slack = by_unknowns(ends), problem.slacks(motion)[:count]
    fixed = np.swapaxes(all_free(len(motion.T)).fixed, 0, 1).ravel()
    changing = np.ones(len(x), bool)
    changing[motion.inner.size:motion.inner.size + fixed.size] = ~fixed
    basis = np.eye(len(x))[:, changing]
    null = basis @ np.linalg.svd(E @ basis)[2][len(E):].T
    rates = by_unknowns(lambda m: problem.slacks(m)[:count]) @ null
    cost = null.T @ np.append(np.zeros(len(x) - len(motion.T)), np.ones(len(motion.T)))
    # in multiples of barrier / slack, so that a constraint far away has no say
    central = barrier / slack
    parts, residual = nnls((rates * central[:, np.newaxis]).T, cost)
    assert residual <= 1e-3 * np.linalg.norm(cost)
    assert parts.sum() * barrier <= GAP * motion.T.sum()  # multipliers times slacks
