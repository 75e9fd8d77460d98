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

"""Times of motions with blends: they keep the limits, and a search of all times finds no less."""

import numpy as np
import pytest
from rrr_traj_planner.planners.blends.blend_motion import excess
from rrr_traj_planner.planners.blends.blend_timing import fastest, total_time
from rrr_traj_planner.planners.transitions.transition_law import TransitionLaw
from rrr_traj_planner.planners.transitions.via_problem import ViaProblem

SEEDS = range(12)
ROUNDING = 1.0 + 1e-9
GRID = 400            # times of each line that the search evaluates, at steps of 1 %


def never():
    return False


def random_problem(seed, n, jerk=True):
    rng = np.random.default_rng(700 + seed)
    law = TransitionLaw(rng.uniform(0.5, 3.0, 3), rng.uniform(0.1, 1.5, 3) * jerk)
    limit = rng.uniform(0.3, 2.0, 3)
    return ViaProblem(rng.uniform(-1.0, 1.0, (n, 3)), law, limit, -np.ones((n - 1, 3)),
                      np.ones((n - 1, 3)))


def searched(problem, transitions=None):
    """Return the least total time of two lines on a grid of their times."""
    steps = problem.rest_to_rest_times().max() * np.geomspace(0.03, 1.5, GRID)
    first, second = (t.ravel()[:, np.newaxis] for t in np.meshgrid(steps, steps))
    v0, v1 = problem.displacements[0] / first, problem.displacements[1] / second

    def lasting(change):
        change = np.abs(change)
        return np.maximum(
            problem.law.slope * change, problem.law.root * np.sqrt(change)).max(axis=1)

    need = np.stack([lasting(v0), lasting(v1 - v0), lasting(v1)])
    t = need if transitions is None else np.tile(transitions[:, np.newaxis], need.shape[1])
    fits = ((np.abs(v0) <= problem.max_velocity).all(axis=1)
            & (np.abs(v1) <= problem.max_velocity).all(axis=1) & (need <= t).all(axis=0)
            & (t[0] + t[1] <= 2.0 * first[:, 0]) & (t[1] + t[2] <= 2.0 * second[:, 0]))
    return (first + second)[fits, 0] + 0.5 * (t[0] + t[2])[fits]


@pytest.mark.parametrize('seed', SEEDS)
def test_no_times_of_a_search_are_better(seed):
    problem = random_problem(seed, 2)
    found, grid = total_time(fastest(problem, None, never)), searched(problem).min()
    assert found <= grid * (1.0 + 1e-5)
    assert found >= grid * (1.0 - 0.03)  # the grid's steps are of 1 %


@pytest.mark.parametrize('seed', SEEDS)
def test_no_times_of_a_search_are_better_with_given_transitions(seed):
    problem = random_problem(seed, 2)
    transitions = np.random.default_rng(seed).uniform(0.5, 1.5, 3)
    found = fastest(problem, transitions, never)
    assert found.transitions.tolist() == transitions.tolist()
    grid = searched(problem, transitions)
    if len(grid):
        assert total_time(found) <= grid.min() * (1.0 + 1e-5)


@pytest.mark.parametrize('n', [1, 2, 3, 7, 40])
@pytest.mark.parametrize('given', [False, True])
def test_limits_are_kept(n, given):
    for seed in range(5):
        problem = random_problem(30 + seed, n)
        transitions = np.full(n + 1, 0.7) if given else None
        assert (excess(problem, fastest(problem, transitions, never)) <= ROUNDING).all()


def test_one_line_takes_two_transitions_from_rest_to_rest():
    for seed in SEEDS:
        problem = random_problem(60 + seed, 1)
        assert total_time(fastest(problem, None, never)) == pytest.approx(
            problem.rest_to_rest_times().sum(), rel=1e-4)


def test_never_slower_than_stops_at_every_via_point():
    for seed in SEEDS:
        problem = random_problem(80 + seed, 6)
        assert total_time(fastest(problem, None, never)) < problem.rest_to_rest_times().sum()


def test_a_search_that_is_stopped_at_once_is_within_the_limits():
    problem = random_problem(5, 4)
    stopped, free = fastest(problem, None, lambda: True), fastest(problem, None, never)
    assert (excess(problem, stopped) <= ROUNDING).all()
    assert total_time(stopped) > total_time(free)
