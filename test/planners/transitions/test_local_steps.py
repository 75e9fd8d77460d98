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

"""Steps of the segments that need them: against dense solves, and steps of the whole motion."""

import numpy as np
import pytest
from rrr_traj_planner.planners.solver.barrier_method import minimise, RELATIVE_GAP, ROUGH_GAP
from rrr_traj_planner.planners.solver.via_barrier import ViaBarrier
from rrr_traj_planner.planners.transitions import via_velocities
from rrr_traj_planner.planners.transitions.local_steps import LocalSteps, minimise_locally
from rrr_traj_planner.planners.transitions.transition_law import TransitionLaw
from rrr_traj_planner.planners.transitions.via_problem import ViaProblem

SEEDS = range(8)
WEIGHT = 7.0

# By how much local optima differ, found on other ways: with a limit on jerk the problem is not
# convex. Up to 1e-4 on 48 problems, as often longer as shorter.
OTHER_OPTIMUM = 3e-4


def problem_of(seed, n, jerk=True):
    """Return a random problem of n segments; with an acceleration limit alone it has no kinks."""
    rng = np.random.default_rng(7700 + seed)
    law = TransitionLaw(rng.uniform(0.5, 2.0, 3), rng.uniform(0.3, 1.0, 3) * jerk)
    highest = rng.uniform(0.1, 1.0, (n - 1, 3))
    return ViaProblem(rng.normal(0.0, 0.6, (n, 3)), law, np.full(3, 1.2), -highest, highest)


def at_start(problem, spare=1.3, least_T=None):
    n = len(problem.displacements)
    return ViaBarrier(
        problem, np.zeros((n - 1, 3)), spare * problem.rest_to_rest_times(), least_T)


def dense(barrier):
    """Return gradient and Hessian of the barrier by via velocities, then durations."""
    a, n = barrier.arrays, len(barrier.durations)
    g, H = np.zeros(4 * n - 3), np.zeros((4 * n - 3, 4 * n - 3))
    for k, j in np.ndindex(n, 3):
        own = [3 * (k - 1) + j, 3 * k + j, 3 * n - 3 + k]
        kept = [i for i in range(3) if not (i == 0 and k == 0 or i == 1 and k == n - 1)]
        at = [own[i] for i in kept]
        g[at] += a['gradient'][k, j, kept]
        H[np.ix_(at, at)] += a['hessian'][k, j][np.ix_(kept, kept)]
    g += a['bound'][:, 0]
    H[range(len(g)), range(len(g))] += a['bound'][:, 1]
    return g, H


def moving(active):
    """Return which unknowns move: velocities between two active segments, and their durations."""
    active = np.asarray(active, dtype=bool)
    return np.concatenate((np.repeat(active[:-1] & active[1:], 3), active))


@pytest.mark.parametrize('seed', SEEDS)
def test_a_step_is_newton_s_of_the_active_segments_and_the_others_stay(seed):
    n, rng = 14, np.random.default_rng(seed)
    barrier = at_start(problem_of(seed, n), spare=2.0)
    steps = LocalSteps(barrier)
    steps.active[:] = rng.random(n) < (1.0 if seed == 0 else 0.6)
    free, before = moving(steps.active), barrier.arrays['point'].copy()
    g, H = dense(barrier)
    g[3 * n - 3:] += WEIGHT
    newton = np.zeros(4 * n - 3)
    newton[free] = -np.linalg.solve(H[np.ix_(free, free)], g[free])
    squared = steps.step(WEIGHT)
    taken = barrier.arrays['point'] - before
    assert (taken[~free] == 0.0).all()
    if not barrier.arrays['damping'].any():
        assert taken == pytest.approx(newton, rel=1e-7, abs=1e-10)
        assert squared == pytest.approx(-g @ newton, rel=1e-8)


@pytest.mark.parametrize('seed', SEEDS)
def test_what_is_known_after_a_step_is_as_if_begun_there(seed):
    problem = problem_of(seed, 12)
    least_T = 0.6 * problem.rest_to_rest_times() if seed % 2 else None
    barrier = at_start(problem, least_T=least_T)
    steps = LocalSteps(barrier)
    for weight in (1.0, 30.0, 30.0, 30.0, 30.0):
        if not steps.active.any():
            break
        steps.step(weight)
        there = ViaBarrier(problem, barrier.velocities, barrier.durations, least_T)
        assert np.isfinite(there.arrays['before']).all()
        for name in ('before', 'gradient', 'hessian', 'bound'):
            assert barrier.arrays[name] == pytest.approx(there.arrays[name], rel=1e-12, abs=1e-12)
        assert barrier.structure.objective == there.structure.objective


@pytest.mark.parametrize('seed', SEEDS)
@pytest.mark.parametrize('n', [1, 2, 5, 40, 150])
@pytest.mark.parametrize('jerk', [False, True])
def test_total_time_is_that_of_steps_of_the_whole_motion(seed, n, jerk):
    problem = problem_of(seed, n, jerk)
    found = minimise_locally(at_start(problem), lambda: False)
    expected = minimise(at_start(problem), lambda: False)
    same = OTHER_OPTIMUM if jerk else RELATIVE_GAP
    assert found.durations.sum() == pytest.approx(expected.durations.sum(), rel=same)
    there = ViaBarrier(problem, found.velocities, found.durations)
    assert np.isfinite(there.arrays['before']).all()


def test_segments_that_are_centred_take_no_further_steps():
    n, weight = 300, 100.0
    problem, middle = problem_of(1, n, jerk=False), n // 2
    barrier = at_start(problem)
    LocalSteps(barrier).centre(weight, 1e-10, lambda: False)
    barrier.durations[middle] *= 1.05  # of all, this one segment is off its centre
    steps = LocalSteps(ViaBarrier(problem, barrier.velocities, barrier.durations))
    assert steps.step(weight) > 1e-10
    active = np.flatnonzero(steps.active)
    assert len(active)
    assert np.abs(active - middle).max() <= 20


def test_long_motions_are_planned_by_local_steps_and_short_ones_are_not(monkeypatch):
    asked = []
    for name in ('minimise', 'minimise_locally'):
        monkeypatch.setattr(via_velocities, name, lambda *_, name=name: asked.append(name))
    for n in (via_velocities.FEW, via_velocities.FEW + 1):
        via_velocities.least_time(problem_of(0, n))
    assert asked == ['minimise', 'minimise_locally']


def test_planning_that_is_stopped_ends_with_a_feasible_iterate():
    problem = problem_of(3, 120)
    left = iter([False] * 20)
    found = minimise_locally(at_start(problem), lambda: next(left, True))
    assert found.gap > RELATIVE_GAP * found.durations.sum()
    there = ViaBarrier(problem, found.velocities, found.durations)
    assert np.isfinite(there.arrays['before']).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_a_solution_that_is_nearly_converged_may_turn_out_futile(seed):
    problem, seen = problem_of(seed, 30, jerk=False), []

    def never():
        return False

    def is_futile(rough):
        seen.append((rough.durations.sum(), rough.gap))
        return len(seen) == 1

    ended = minimise_locally(at_start(problem), never, is_futile)
    assert (ended.durations.sum(), ended.gap) == seen[0]
    assert ended.gap < ROUGH_GAP * ended.durations.sum()
    found = minimise_locally(at_start(problem), never, is_futile)
    assert len(seen) == 2
    assert found.gap < RELATIVE_GAP * found.durations.sum()
    assert 0.0 < ended.durations.sum() - found.durations.sum() < 1.1 * ended.gap
