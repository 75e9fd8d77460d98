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

"""The barrier over via velocities: derivatives against differences, steps by a dense solve."""

from dataclasses import replace

from helpers.random_cases import central_difference
import numpy as np
import pytest
from rrr_traj_planner.planners.solver.library import KERNELS
from rrr_traj_planner.planners.solver.via_barrier import ViaBarrier
from rrr_traj_planner.planners.transitions.transition_law import TransitionLaw
from rrr_traj_planner.planners.transitions.via_problem import ViaProblem

SEEDS = range(8)


def problem_and_point(seed):
    """Return a problem, least durations or none, and a strictly feasible point."""
    rng = np.random.default_rng(1500 + seed)
    n = int(rng.integers(2, 6))
    law = TransitionLaw(rng.uniform(0.5, 3.0, 3),
                        rng.uniform(0.3, 1.5, 3) * (rng.random(3) < 0.5))
    highest = rng.uniform(0.5, 1.0, (n - 1, 3))
    problem = ViaProblem(rng.normal(0.0, 0.5, (n, 3)), law, np.full(3, 1.2), -highest, highest)
    T = problem.rest_to_rest_times() * rng.uniform(1.3, 2.0, n)
    v = 0.05 * rng.uniform(-1.0, 1.0, (n - 1, 3))
    return problem, 0.8 * T if seed % 2 else None, v, T


def value(problem, least_T, x):
    """Return the barrier at a point."""
    n = len(problem.displacements)
    barrier = ViaBarrier(problem, x[:3 * n - 3].reshape(-1, 3), x[3 * n - 3:], least_T)
    return barrier.arrays['before'].sum()


def dense(barrier):
    """Return gradient and damped Hessian by all unknowns: via velocities, then durations."""
    a, n = barrier.arrays, len(barrier.durations)
    stiff, size = 1.0 + a['damping'], 4 * n - 3
    g, H = np.zeros(size), np.zeros((size, size))
    for k, j in np.ndindex(n, 3):
        own = [3 * (k - 1) + j, 3 * k + j, 3 * n - 3 + k]
        kept = [i for i in range(3) if not (i == 0 and k == 0 or i == 1 and k == n - 1)]
        at = [own[i] for i in kept]
        g[at] += a['gradient'][k, j, kept]
        H[np.ix_(at, at)] += stiff[3 * k + j] * a['hessian'][k, j][np.ix_(kept, kept)]
    g += a['bound'][:, 0]
    H[range(size), range(size)] += stiff[3 * n:] * a['bound'][:, 1]
    return g, H


@pytest.mark.parametrize('seed', SEEDS)
def test_value_is_the_sum_of_logarithms_of_what_is_left_of_each_limit(seed):
    # each slack by brute force over cruise velocities, as a limit on the displacement
    problem, least_T, v, T = problem_and_point(seed)
    n = len(T)
    v0, v1 = np.vstack((np.zeros(3), v)), np.vstack((v, np.zeros(3)))
    u = np.linspace(-problem.max_velocity, problem.max_velocity, 8001)[:, np.newaxis]
    t0, t1 = problem.law.least_time(u - v0), problem.law.least_time(u - v1)
    covered = 0.5 * (v0 + u) * t0 + u * (T[:, np.newaxis] - t0 - t1) + 0.5 * (u + v1) * t1
    fits = t0 + t1 <= T[:, np.newaxis]
    D = problem.displacements
    change = problem.law.largest_change(T[:, np.newaxis])
    slacks = (np.where(fits, covered, -np.inf).max(axis=0) - D,
              D - np.where(fits, covered, np.inf).min(axis=0),
              change - (v1 - v0), change + (v1 - v0))
    parts = ViaBarrier(problem, v, T, least_T).arrays['before']
    segments, velocities, durations = np.split(parts, (3 * n, 6 * n - 3))
    # the grid of cruises misses the best one by a bit, which hardly counts where much is left
    enough = np.minimum(slacks[0], slacks[1]) > 0.05
    assert enough.any()
    assert segments.reshape(n, 3)[enough] == pytest.approx(
        -sum(np.log(s) for s in slacks)[enough], abs=0.02)
    assert velocities.reshape(-1, 3) == pytest.approx(
        -np.log(v - problem.lowest) - np.log(problem.highest - v), rel=1e-12)
    assert durations == pytest.approx(
        np.zeros(n) if least_T is None else -np.log(T - least_T), rel=1e-12)


@pytest.mark.parametrize('seed', SEEDS)
def test_gradient_is_the_finite_difference_of_the_value(seed):
    problem, least_T, v, T = problem_and_point(seed)
    x, (g, _) = np.append(v, T), dense(ViaBarrier(problem, v, T, least_T))
    for k, unit in enumerate(np.eye(len(x))):
        assert g[k] == pytest.approx(central_difference(
            lambda z, unit=unit: value(problem, least_T, x + z * unit), 0.0, 1e-5),
            rel=1e-5, abs=1e-4)


@pytest.mark.parametrize('seed', SEEDS)
def test_hessian_is_the_finite_difference_of_the_gradient_where_the_barrier_is_convex(seed):
    problem, least_T, v, T = problem_and_point(seed)
    x = np.append(v, T)
    _, H = dense(ViaBarrier(problem, v, T, least_T))

    def gradient(x):
        return dense(ViaBarrier(problem, x[:v.size].reshape(v.shape), x[v.size:], least_T))[0]

    difference = np.array([central_difference(
        lambda z, unit=unit: gradient(x + z * unit), 0.0, 1e-5) for unit in np.eye(len(x))])
    assert difference == pytest.approx(difference.T, rel=1e-3, abs=1e-3)
    own = np.diag(H)
    scale = np.sqrt(np.outer(own, own))
    assert np.linalg.eigvalsh(0.5 * (difference + difference.T) / scale).min() > 1e-3
    off = np.abs(H - difference) / scale
    assert (off > 1e-4).mean() < 0.2  # single blocks may be concave where their sum is not


@pytest.mark.parametrize('seed', SEEDS)
def test_hessian_is_positive_definite_where_much_time_is_to_spare_too(seed):
    problem, least_T, v, T = problem_and_point(seed)
    for spare in (1.0, 4.0):
        _, H = dense(ViaBarrier(problem, v, spare * T, least_T))
        assert np.linalg.eigvalsh(H).min() > 0.0


@pytest.mark.parametrize('seed', SEEDS)
@pytest.mark.parametrize('common', [False, True])
def test_newton_step_is_that_of_a_dense_solve(seed, common):
    problem, least_T, v, T = problem_and_point(seed)
    barrier = ViaBarrier(problem, v, T, least_T, T if common else None)
    n, rng = len(T), np.random.default_rng(seed)
    barrier.arrays['damping'][:] = rng.choice([0.0, 0.5, 8.0], 7 * n - 3)
    weight = 7.0
    KERNELS.via_attempt(barrier.address, weight)
    squared = barrier.structure.decrement
    g, H = dense(barrier)
    # unknowns of the step: all of them, or via velocities and a common factor of durations
    basis = np.eye(4 * n - 3)
    if common:
        basis = np.column_stack((basis[:, :3 * n - 3], np.append(np.zeros(3 * n - 3), T)))
        pull = weight * np.eye(3 * n - 2)[-1]
    else:
        pull = weight * np.append(np.zeros(3 * n - 3), np.ones(n))
    g, H = basis.T @ g + pull, basis.T @ H @ basis
    step = -np.linalg.solve(H, g)
    assert barrier.arrays['step'] == pytest.approx(basis @ step, rel=1e-7, abs=1e-10)
    assert squared == pytest.approx(-g @ step, rel=1e-8)


@pytest.mark.parametrize('seed', SEEDS)
def test_an_attempt_tells_how_the_merit_changes_and_accepting_it_moves_the_iterate(seed):
    problem, least_T, v, T = problem_and_point(seed)
    barrier, weight = ViaBarrier(problem, v, T, least_T), 7.0
    start, a = np.append(v, T), barrier.arrays
    a['damping'][:] = 8.0
    change = KERNELS.via_attempt(barrier.address, weight)
    moved = start + a['step']
    assert change == pytest.approx(weight * a['step'][v.size:].sum() + value(
        problem, least_T, moved) - value(problem, least_T, start), rel=1e-9, abs=1e-12)
    assert (a['point'] == start).all()
    KERNELS.via_accept(barrier.address, 0.25)
    assert (a['point'] == moved).all() and (a['damping'] == 2.0).all()
    assert barrier.structure.objective == pytest.approx(moved[v.size:].sum())
    there = ViaBarrier(problem, barrier.velocities, barrier.durations, least_T)
    for name in ('before', 'gradient', 'hessian', 'bound'):
        assert (a[name] == there.arrays[name]).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_parts_that_an_attempt_breaks_are_damped_and_none_else_once_they_are_stiff(seed):
    problem, least_T, v, T = problem_and_point(seed)
    barrier = ViaBarrier(problem, v, T, least_T)
    a = barrier.arrays
    assert KERNELS.via_attempt(barrier.address, 1e3) == np.inf  # much too far
    broken = np.isinf(a['after'])
    KERNELS.via_damp(barrier.address, 0.75, 4.0)
    assert broken.any() and (a['damping'] > 0.0)[broken].all()
    assert set(a['damping']) <= {0.0, 1.0}
    a['damping'][:] = 1e9
    KERNELS.via_damp(barrier.address, 0.75, 4.0)
    assert ((a['damping'] > 1e9) == broken).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_value_is_infinite_where_a_constraint_is_broken(seed):
    problem, least_T, v, T = problem_and_point(seed)
    too_fast = v.copy()
    too_fast[0, 1] = 1.01 * problem.highest[0, 1]
    too_short = T.copy()
    too_short[-1] = 1e-3
    none = T.copy()
    none[0] = 0.0
    assert np.isfinite(value(problem, least_T, np.append(v, T)))
    assert value(problem, least_T, np.append(too_fast, T)) == np.inf
    assert value(problem, least_T, np.append(v, too_short)) == np.inf
    assert value(problem, least_T, np.append(v, none)) == np.inf
    assert value(problem, 1.001 * T, np.append(v, T)) == np.inf


def test_rest_to_rest_times_are_what_a_hand_calculation_gives():
    # 1 rad/s^2, 1 rad/s: 0.5 rad: sqrt(D slope) twice, 2 s. 3 rad: 2 s + 3 s. Nothing: 0.
    law = TransitionLaw(np.full(3, 2.0), np.zeros(3))
    D = np.array([[0.5, 0.1, 0.0], [0.0, -3.0, 0.2], [0.0, 0.0, 0.0]])
    none = np.zeros((2, 3))
    problem = ViaProblem(D, law, np.ones(3), none, none)
    assert problem.rest_to_rest_times() == pytest.approx([2.0, 5.0, 0.0])
    # Jerk alone, root 2: D = u t, t = 2 sqrt(u): u = (D / 2)^(2/3); 2 rad: 2 t = 4 s.
    jerky = replace(problem, law=TransitionLaw(np.full(3, 1e-9), np.full(3, 2.0)),
                    max_velocity=np.full(3, 9.0), displacements=np.full((1, 3), 2.0))
    assert jerky.rest_to_rest_times() == pytest.approx([4.0])
