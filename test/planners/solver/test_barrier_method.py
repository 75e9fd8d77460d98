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

"""The barrier method over via velocities: against a general solver and a closed form."""

from itertools import count

import numpy as np
import pytest
from rrr_traj_planner.planners.solver import barrier_method
from rrr_traj_planner.planners.solver.barrier_method import RELATIVE_GAP
from rrr_traj_planner.planners.solver.library import KERNELS
from rrr_traj_planner.planners.solver.via_barrier import ViaBarrier
from rrr_traj_planner.planners.transitions.largest_displacement import largest_displacement
from rrr_traj_planner.planners.transitions.transition_law import SegmentLimits, TransitionLaw
from rrr_traj_planner.planners.transitions.via_problem import ViaProblem
from rrr_traj_planner.planners.transitions.via_velocities import least_time, least_time_scale
from scipy.optimize import minimize

SEEDS = range(8)
SOLVED = 1e-4  # relative, to which SLSQP agrees: where laws meet, constraints have kinks


def random_problem(seed, most=12):
    """Return a problem of 1 to 12 segments, with or without a jerk limit, some joints still."""
    rng = np.random.default_rng(4300 + seed)
    n = int(rng.integers(1, most + 1))
    root = rng.uniform(0.3, 1.5, 3) * (rng.random() < 0.7)
    law = TransitionLaw(rng.uniform(0.5, 3.0, 3), root)
    highest = rng.uniform(0.1, 1.0, (n - 1, 3))
    D = rng.normal(0.0, 0.6, (n, 3)) * (rng.random((n, 3)) < 0.8)
    D[:, 0] += (D == 0.0).all(axis=1)
    return ViaProblem(D, law, np.full(3, 1.2), -highest, highest)


def slacks(problem, v, T):
    """Return what is left of every constraint."""
    v0, v1, t = np.vstack((np.zeros(3), v)), np.vstack((v, np.zeros(3))), T[:, np.newaxis]
    change = problem.law.largest_change(t)
    law, most, D = problem.law, problem.max_velocity, problem.displacements
    return np.concatenate([x.ravel() for x in (
        largest_displacement(SegmentLimits(law, most), v0, v1, t) - D,
        largest_displacement(SegmentLimits(law, most), -v0, -v1, t) + D,
        change - (v1 - v0), change + (v1 - v0), problem.highest - v, v - problem.lowest)])


def by_slsqp(problem, start, least_T=0.0):
    """Return the least total time that a general solver finds."""
    vias = start.velocities.size

    def parts(x):
        return x[:vias].reshape(-1, 3), np.maximum(x[vias:], 1e-3)

    x = minimize(lambda x: x[vias:].sum(), np.append(start.velocities, 1.2 * start.durations),
                 method='SLSQP', constraints=[
                     {'type': 'ineq', 'fun': lambda x: slacks(problem, *parts(x))},
                     {'type': 'ineq', 'fun': lambda x: x[vias:] - least_T}],
                 options={'maxiter': 500, 'ftol': 1e-10})
    kept = slacks(problem, *parts(x.x)).min() >= -1e-6
    return x.fun if kept else np.inf


@pytest.mark.parametrize('seed', SEEDS[:4])
def test_no_general_solver_finds_less_time_and_it_agrees_where_it_converges(seed):
    problem = random_problem(seed, most=3)
    found = least_time(problem)
    assert slacks(problem, found.velocities, found.durations).min() > 0.0
    assert by_slsqp(problem, found) >= (1.0 - SOLVED) * found.durations.sum()
    least_T = found.durations * np.random.default_rng(seed).uniform(0.5, 1.5, len(found.durations))
    floored = least_time(problem, least_T)
    assert (floored.durations > least_T).all()
    assert by_slsqp(problem, floored, least_T) >= (1.0 - SOLVED) * floored.durations.sum()


@pytest.mark.parametrize('seed', SEEDS)
def test_at_the_end_the_gradient_of_objective_and_barrier_vanishes(seed):
    # The condition of optimality of the last centre: with multipliers 1 / (weight slack) these are
    # the conditions of Karush, Kuhn and Tucker, but for a gap of the constraints over the weight.
    problem = random_problem(seed)
    found = least_time(problem)
    weight = (12 * len(found.durations) + 6 * len(found.velocities)) / found.gap
    end = ViaBarrier(problem, found.velocities, found.durations)
    KERNELS.via_attempt(end.address, weight)
    assert end.structure.decrement <= 1e-5
    assert found.gap < RELATIVE_GAP * found.durations.sum()


@pytest.mark.parametrize('seed', SEEDS)
def test_the_least_stretch_of_the_least_durations_is_one_and_halves_for_twice_as_long(seed):
    problem = random_problem(seed)
    T = least_time(problem).durations
    factor, found = least_time_scale(problem, T)
    assert factor <= 1.0 + 1e-6
    assert slacks(problem, found.velocities, found.durations).min() > 0.0
    assert found.durations == pytest.approx(factor * T, rel=1e-12)
    assert least_time_scale(problem, 2.0 * T)[0] == pytest.approx(0.5 * factor, rel=1e-5)


@pytest.mark.parametrize('seed', SEEDS)
def test_every_accepted_step_decreases_objective_and_barrier(seed, monkeypatch):
    accepted, tried = [], []

    class Watched:

        def __getattr__(self, name):
            return getattr(KERNELS, name)

        def via_attempt(self, at, weight):
            tried.append(KERNELS.via_attempt(at, weight))
            return tried[-1]

        def via_accept(self, at, less):
            accepted.append(tried[-1])
            KERNELS.via_accept(at, less)

    problem = random_problem(seed)
    start = least_time(problem, should_stop=lambda: True)
    barrier = ViaBarrier(problem, start.velocities, start.durations)
    monkeypatch.setattr(barrier_method, 'KERNELS', Watched())
    barrier_method.minimise(barrier, lambda: False)
    assert len(accepted) > 10
    assert max(accepted) < 0.0


def test_one_segment_takes_its_closed_form():
    # 1 rad/s^2: 0.5 rad takes sqrt(D slope) twice, 2 s.
    problem = ViaProblem(np.array([[0.5, 0.1, 0.0]]), TransitionLaw(np.full(3, 2.0), np.zeros(3)),
                         np.ones(3), np.zeros((0, 3)), np.zeros((0, 3)))
    assert least_time(problem).durations == pytest.approx([2.0], rel=1e-6)
    assert least_time_scale(problem, np.array([4.0]))[0] == pytest.approx(0.5, rel=1e-6)


def test_a_line_through_a_via_point_takes_as_long_as_without_it():
    # 2 rad in all joints at 1 rad/s^2, without a velocity limit in reach: 2 sqrt(2 D) = 4 s.
    D = np.full((2, 3), 1.0)
    room = np.full((1, 3), 9.0)
    law = TransitionLaw(np.full(3, 2.0), np.zeros(3))
    problem = ViaProblem(D, law, np.full(3, 9.0), -room, room)
    found = least_time(problem)
    assert found.durations == pytest.approx([2.0, 2.0], rel=1e-5)
    assert found.velocities == pytest.approx(np.full((1, 3), 1.0), rel=1e-3)


@pytest.mark.parametrize('steps', [0, 1, 7])
def test_it_asks_before_every_step_and_cancelled_it_keeps_its_feasible_iterate(steps):
    calls = count()
    problem = random_problem(3)
    found = least_time(problem, should_stop=lambda: next(calls) == steps)
    assert next(calls) == steps + 1
    assert slacks(problem, found.velocities, found.durations).min() > 0.0


def test_what_the_callback_raises_goes_on_to_the_caller():
    def should_stop():
        raise KeyboardInterrupt('now')

    with pytest.raises(KeyboardInterrupt, match='now'):
        least_time(random_problem(3), should_stop=should_stop)
