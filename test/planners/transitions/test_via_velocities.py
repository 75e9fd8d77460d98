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

"""Least total time over via velocities: the thesis's tables, a second solver, scaling laws."""

from helpers.thesis_cases import POINTS
import numpy as np
import pytest
from rrr_traj_planner.planners.transitions.transition_law import TransitionLaw
from rrr_traj_planner.planners.transitions.via_problem import ViaProblem
from rrr_traj_planner.planners.transitions.via_velocities import least_time, least_time_scale
from scipy.optimize import brentq, minimize

GAP = 1e-6            # relative: the solver promises 2e-7
SECOND_SOLVER = 2e-3  # relative: a direct search stops short of the optimum's kinks


def problem_through(points, velocity=1.0, acceleration=1.0, jerk=np.inf):
    D = np.diff(np.asarray(points), axis=0)
    law = TransitionLaw(np.full(3, 2.0 / acceleration), np.full(3, np.sqrt(2.0 * np.pi / jerk)))
    highest = np.full((len(D) - 1, 3), float(velocity))
    return ViaProblem(D, law, np.full(3, float(velocity)), -highest, highest)


def random_problem(seed, n):
    rng = np.random.default_rng(1700 + seed)
    return problem_through(np.cumsum(rng.normal(0.0, 0.6, (n + 1, 3)), axis=0),
                           rng.uniform(0.4, 1.5), rng.uniform(0.5, 2.0))


def table(name):
    return np.radians([POINTS[f'{name} point {k}'][1] for k in (1, 2, 3)])


@pytest.mark.parametrize(('name', 'seconds'), [('6.1', 2.850), ('6.3', 3.490)])
def test_tables_take_the_least_times_that_are_known(name, seconds):
    assert least_time(problem_through(table(name))).durations.sum() == pytest.approx(
        seconds, abs=5.1e-4)


def covers(u, v0, v1, T, slope):
    """Return what transition to u, cruise, transition cover at full acceleration."""
    t0, t1 = slope * abs(u - v0), slope * abs(u - v1)
    return 0.5 * (v0 + u) * t0 + u * (T - t0 - t1) + 0.5 * (u + v1) * t1


def is_feasible(v0, v1, T, D, limit, slope):
    """Return whether D lies between the extremes over cruise velocities that fit the time."""
    # Both transitions fit while |u - v0| + |u - v1| <= T / slope.
    left = 0.5 * (T / slope - abs(v1 - v0))
    if left < 0.0:
        return False
    low, high = max(min(v0, v1) - left, -limit), min(max(v0, v1) + left, limit)
    # Displacement rises with u: from the lowest cruise that fits to the highest.
    return covers(low, v0, v1, T, slope) <= D <= covers(high, v0, v1, T, slope)


def least_segment_time(v0, v1, D, limit, slope):
    """Return the end of the last gap: from it on every time is feasible."""
    T = np.linspace(0.02, 12.0, 240)
    fits = np.array([is_feasible(v0, v1, t, D, limit, slope) for t in T])
    if fits.all():
        return T[0]
    k = int(np.flatnonzero(~fits)[-1])
    low, high = T[k], T[k + 1]
    for _ in range(30):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if is_feasible(v0, v1, middle, D, limit, slope) else (
            middle, high)
    return high


def direct_search(problem, seed, starts=4):
    """Return the least total time that Nelder-Mead finds from several starts."""
    limit, slope = problem.max_velocity[0], problem.law.slope[0]
    D = problem.displacements
    rng = np.random.default_rng(seed)

    def total(x):
        v = np.vstack((np.zeros(3), x.reshape(-1, 3), np.zeros(3)))
        if (np.abs(v) > limit).any():
            return 1e3
        return sum(max(least_segment_time(v[k, j], v[k + 1, j], D[k, j], limit, slope)
                       for j in range(3)) for k in range(len(D)))

    best = np.inf
    for _ in range(starts):
        x0 = rng.uniform(0.0, 0.4, 3 * (len(D) - 1)) * np.sign(D[1:]).ravel() * limit
        found = minimize(total, x0, method='Nelder-Mead',
                         options={'maxfev': 350, 'xatol': 1e-4, 'fatol': 1e-5})
        best = min(best, found.fun)
    return best


@pytest.mark.parametrize('seed', range(3))
def test_no_direct_search_finds_less_time_through_one_via_point(seed):
    problem = random_problem(seed, 2)
    assert least_time(problem).durations.sum() <= direct_search(problem, seed, 2) * (1.0 + GAP)


@pytest.mark.parametrize('seed', range(12))
def test_every_joint_can_cover_its_segments_in_the_least_durations(seed):
    problem = random_problem(20 + seed, 2 + seed % 6)
    v, T, _ = least_time(problem)
    v = np.vstack((np.zeros(3), v, np.zeros(3)))
    for k, j in np.ndindex(problem.displacements.shape):
        assert is_feasible(v[k, j], v[k + 1, j], T[k], problem.displacements[k, j],
                           problem.max_velocity[j], problem.law.slope[j])


def cone_program(problem, seed):
    """Return the least total time from SLSQP on durations, via and cruise velocities at once."""
    D, slope, limit = problem.displacements, problem.law.slope[0], problem.max_velocity[0]
    n, rng = len(D), np.random.default_rng(seed)

    def split(x):
        v = np.vstack((np.zeros(3), x[n:4 * n - 3].reshape(-1, 3), np.zeros(3)))
        return x[:n, np.newaxis], v[:-1], v[1:], x[4 * n - 3:].reshape(n, 3)

    def spare_time(x):
        T, v0, v1, u = split(x)
        return (T - slope * (np.abs(u - v0) + np.abs(u - v1))).ravel()

    def miss(x):
        T, v0, v1, u = split(x)
        return (u * T - 0.5 * slope * (np.abs(u - v0) * (u - v0) + np.abs(u - v1) * (u - v1))
                - D).ravel()

    bounds = [(1e-2, 50.0)] * n + [(-limit, limit)] * (6 * n - 3)
    best = np.inf
    for _ in range(3):
        T = problem.rest_to_rest_times() * 1.2
        u = D / T[:, np.newaxis] * rng.uniform(1.0, 1.4)
        v = 0.5 * (u[1:] + u[:-1]) * (u[1:] * u[:-1] > 0.0) * rng.uniform(0.0, 1.0)
        found = minimize(
            lambda x: x[:n].sum(), np.concatenate((T, v.ravel(), u.ravel())), method='SLSQP',
            bounds=bounds, options={'maxiter': 300, 'ftol': 1e-10},
            constraints=({'type': 'eq', 'fun': miss}, {'type': 'ineq', 'fun': spare_time}))
        if np.abs(miss(found.x)).max() < 1e-7 and spare_time(found.x).min() > -1e-7:
            best = min(best, found.fun)
    return best


@pytest.mark.parametrize('n', [2, 3, 4])
def test_slsqp_from_many_starts_finds_no_less_time(n):
    gaps = []
    for seed in range(2):
        problem = random_problem(10 * n + seed, n)
        theirs, ours = cone_program(problem, seed), least_time(problem).durations.sum()
        assert ours <= theirs * (1.0 + GAP)
        gaps.append(theirs / ours - 1.0)
    # The comparison means something: SLSQP comes close on one of them at least.
    assert min(gaps) <= SECOND_SOLVER


def test_single_segment_takes_the_rest_to_rest_time():
    for seed in range(10):
        problem = random_problem(100 + seed, 1)
        assert least_time(problem).durations == pytest.approx(
            problem.rest_to_rest_times(), rel=1e-6)


@pytest.mark.parametrize('factor', [0.5, 3.0])
def test_limits_in_another_unit_of_time_scale_the_time(factor):
    points = np.cumsum(np.random.default_rng(1800).normal(0.0, 0.5, (6, 3)), axis=0)
    slow = least_time(problem_through(points, 0.8, 1.1, 4.0)).durations
    fast = least_time(problem_through(
        points, 0.8 * factor, 1.1 * factor ** 2, 4.0 * factor ** 3)).durations
    assert fast * factor == pytest.approx(slow, rel=1e-4)
    assert fast.sum() * factor == pytest.approx(slow.sum(), rel=GAP)


@pytest.mark.parametrize('seed', range(6))
def test_points_in_reverse_order_and_mirrored_take_the_same_time(seed):
    points = np.cumsum(np.random.default_rng(1900 + seed).normal(0.0, 0.5, (6, 3)), axis=0)
    forwards, backwards, mirrored = (
        least_time(problem_through(p, jerk=8.0)) for p in (points, points[::-1], -points))
    assert backwards.durations.sum() == pytest.approx(forwards.durations.sum(), rel=GAP)
    assert mirrored.durations.sum() == pytest.approx(forwards.durations.sum(), rel=GAP)
    assert mirrored.velocities == pytest.approx(-forwards.velocities, abs=1e-4)


@pytest.mark.parametrize('seed', range(10))
def test_lower_bounds_on_durations_hold_and_never_shorten_the_motion(seed):
    problem = random_problem(200 + seed, 5)
    free = least_time(problem).durations
    least_T = free * np.random.default_rng(seed).choice([0.5, 1.0, 1.5], 5)
    kept = least_time(problem, least_T).durations
    assert (kept >= least_T).all()
    assert kept.sum() >= free.sum() * (1.0 - GAP)


@pytest.mark.parametrize('seed', range(10))
def test_time_scale_is_1_for_least_durations_and_the_inverse_of_a_common_factor(seed):
    problem = random_problem(300 + seed, 4)
    durations = least_time(problem).durations
    assert least_time_scale(problem, durations)[0] == pytest.approx(1.0, abs=2e-6)
    # The same proportions: the stretch undoes any common factor.
    assert least_time_scale(problem, 0.4 * durations)[0] == pytest.approx(2.5, rel=4e-6)
    factor, solution = least_time_scale(problem, 0.4 * durations)
    assert solution.durations == pytest.approx(factor * 0.4 * durations, rel=1e-12)


@pytest.mark.parametrize('seed', range(6))
def test_time_scale_is_the_least_that_bisection_over_least_durations_finds(seed):
    # Durations d f are feasible where the least time with that least_T is their own sum.
    problem = random_problem(400 + seed, 3)
    d = np.random.default_rng(seed).uniform(0.5, 2.0, 3)
    factor = least_time_scale(problem, d)[0]

    def excess(f):
        return least_time(problem, f * d).durations.sum() / (f * d.sum()) - 1.0 - 1e-4

    assert brentq(excess, 0.3 * factor, 3.0 * factor, xtol=1e-4) == pytest.approx(
        factor, rel=2e-2)


def newton_steps(problem):
    """Return how often the solver asks whether to stop: once a step, linear in the problem."""
    count = 0

    def counted():
        nonlocal count
        count += 1
        return False

    least_time(problem, should_stop=counted)
    return count


def test_newton_steps_hardly_grow_with_the_number_of_via_points():
    few = [newton_steps(random_problem(500 + s, 5)) for s in range(4)]
    many = [newton_steps(random_problem(500 + s, 160)) for s in range(4)]
    assert max(many) <= 4 * max(few)


@pytest.mark.parametrize('seed', range(4))
def test_stopped_early_it_has_a_motion_that_is_feasible_and_says_how_far_it_may_be_off(seed):
    problem = random_problem(600 + seed, 4)
    best = least_time(problem).durations.sum()
    for most in (0, 5, 20):
        calls = iter(range(most + 1))
        v, T, gap = least_time(problem, should_stop=lambda a=calls, most=most: next(a) == most)
        assert next(calls, None) is None
        ends = np.vstack((np.zeros(3), v, np.zeros(3)))
        for k, j in np.ndindex(problem.displacements.shape):
            assert is_feasible(ends[k, j], ends[k + 1, j], T[k], problem.displacements[k, j],
                               problem.max_velocity[j], problem.law.slope[j])
        assert best <= T.sum() <= best + 2.0 * gap
