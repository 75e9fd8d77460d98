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

"""Limits along a path: slacks against the limits, quantities against the exact motion."""

from dataclasses import replace

from helpers.path_terms import demands, terms_at
from helpers.random_paths import NONE, random_case, random_mesh
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.planners.path_timing.constraints import (
    limited_quantities,
    PathConstraints,
    QUANTITIES,
)
from rrr_traj_planner.planners.path_timing.table import PathTable
from rrr_traj_planner.planners.solver.splines import with_stops

SEEDS = range(12)
LIMITS = JointLimits(max_jerk=[10.0] * 3, max_effort=[300.0] * 3)
TIP_SPEED = 2.0
KINDS = ('velocity', 'acceleration', 'jerk', 'torque')


def random_problem(seed, limits=LIMITS, max_tip_speed=TIP_SPEED, margin=0.0, steady=False):
    """Return constraints on a random path and a motion along it that never stops."""
    rng = np.random.default_rng(4400 + seed)
    table = PathTable(random_case(seed, points=3).arm_path)
    N = len(table.ends) - 1
    mesh = random_mesh(seed, N, 8)
    constraints = PathConstraints(
        table, limits, max_tip_speed, mesh, np.full((N, 2 * mesh.n + 1, QUANTITIES), margin),
        np.full(N, steady))
    T, (v, a, j) = np.diff(table.ends), np.zeros((3, N + 1, 1))
    T[[0, -1]] *= 2.0
    v[1:-1, 0] = rng.uniform(0.8, 1.2, N - 1)
    a[1:-1], j[1:-1] = rng.normal(0.0, 0.05, (2, N - 1, 1))
    inner = rng.normal(0.0, 0.05, (N, mesh.n - 1, 1))
    m = with_stops(inner, T)._replace(v=v, a=a, j=j)
    return constraints, mesh.restored(constraints.points, m)


def slacks_of(constraints, m):
    """Return what is left above and below, (2, N, p, K): of joints, then the tip's speed."""
    N, p = len(m.T), 2 * constraints.mesh.n + 1
    limits = constraints.problem.limits
    found = constraints.problem.slacks(m)[:-2 * N].reshape(N, -1, 2)
    tip = int(limits.bounded.sum())
    along, joints = found[:, :tip].reshape(N, p, -1, 2), found[:, tip:].reshape(N, p, -1, 2)
    return np.moveaxis(np.concatenate((joints, along), axis=2), -1, 0)


def demands_of(constraints, m):
    """Return the states at the points, (N, p, 4), and the limited quantities by the kernel."""
    at = np.concatenate(constraints.mesh.states(constraints.points, m), axis=-1)
    return at, limited_quantities(constraints.problem, at, at_points=True)[0]


@pytest.mark.parametrize('seed', SEEDS)
def test_slacks_are_limits_less_quantities(seed):
    constraints, m = random_problem(seed)
    _, x = demands_of(constraints, m)
    upper, lower = slacks_of(constraints, m)
    bounds = np.concatenate((LIMITS.max_velocity, LIMITS.max_acceleration, LIMITS.max_jerk,
                             LIMITS.max_effort))
    assert upper[..., :12] == pytest.approx(bounds - x[..., :12])
    assert lower[..., :12] == pytest.approx(bounds + x[..., :12])
    assert upper[..., 12] == pytest.approx(TIP_SPEED - x[..., 12])
    assert lower[0, 1:, 12] == pytest.approx(x[0, 1:, 12])  # the tip does not go back
    assert lower[0, 0, 12] > 1e3                            # but rests at the start


@pytest.mark.parametrize('at_points', [True, False])
@pytest.mark.parametrize('seed', SEEDS)
def test_quantities_are_those_of_the_table_s_terms(seed, at_points):
    constraints, m = random_problem(seed)
    table, n = constraints.table, constraints.mesh.n
    at = np.concatenate(constraints.mesh.states(constraints.points, m), axis=-1)
    at[..., 0] = np.clip(at[..., 0], table.ends[:-1, np.newaxis], table.ends[1:, np.newaxis])
    terms = terms_at(table, at[..., 0])
    if at_points:  # in the last two intervals of each piece a quintic's overshoot is added
        for point in (n - 1, n, 2 * n - 1, 2 * n):  # nodes, then middles
            terms.ddq[:, point] += table.overshoot[:, 0]
            terms.c[:, point] += table.overshoot[:, 1]
    x, gravity = limited_quantities(constraints.problem, at, at_points)
    expected = demands(terms, at)
    assert x == pytest.approx(expected, abs=1e-11 * (1.0 + np.abs(expected).max()))
    assert gravity == pytest.approx(terms.g, rel=1e-11, abs=1e-11)


@pytest.mark.parametrize('seed', SEEDS)
def test_quantities_are_those_of_the_exact_motion(seed):
    # Joint motion by the chain rule from the path itself, without the table.
    constraints, m = random_problem(seed)
    at, x = demands_of(constraints, m)
    inside = slice(1, constraints.mesh.n - 1)  # before a quintic's overshoot is added
    s, v, a, j = (at[:, inside, k, np.newaxis] for k in range(4))
    q, dq, ddq, dddq = (f.reshape(*s.shape[:2], 3) for f in random_case(
        seed, points=3).arm_path(s.ravel()))
    for k, own in enumerate((dq * v, ddq * v ** 2 + dq * a,
                             dddq * v ** 3 + 3.0 * ddq * v * a + dq * j)):
        found = x[:, inside, 3 * k:3 * k + 3]
        assert found == pytest.approx(own, abs=3e-4 * (1.0 + np.abs(own).max())), KINDS[k]


def test_margins_take_their_part_of_every_limit():
    plain, inside = (slacks_of(random_problem(2, margin=x)[0], random_problem(2)[1])
                     for x in (0.0, 0.1))
    assert inside[..., :12] == pytest.approx(plain[..., :12] - 0.1)
    assert inside[0, ..., 12] == pytest.approx(plain[0, ..., 12] - 0.1)


def test_limits_that_are_infinite_are_not_looked_at():
    some = replace(LIMITS, max_effort=[np.inf, 200.0, np.inf], max_jerk=NONE)
    constraints, m = random_problem(2, some, np.inf)
    slacks = slacks_of(constraints, m)
    assert slacks.shape[-1] == 3 + 3 + 1 + 1
    assert slacks[0, ..., -1].min() > 1e5  # of the tip's speed only that it moves on
