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

"""The Newton step against a dense solution of the same optimality conditions."""

from dataclasses import replace

import numpy as np
import pytest
from ramp_cases import all_free, bounds, FREE, LIMITS, own_unknowns, random_motion, slow_start
from rrr_traj_planner.planners.ramp_chain import Motion
from rrr_traj_planner.planners.ramp_curvature import Curvature, curvature
from rrr_traj_planner.planners.ramp_newton import Freedom, newton_step

SEEDS = range(8)


def problem(seed, limits, n=None, segments=None):
    """Return grid, ends and curvature of a barrier problem at a slow motion."""
    rng = np.random.default_rng(seed)
    grid, points, _ = random_motion(seed, n, segments)
    constraints, m = slow_start(limits, grid, points)
    slacks, changes, _ = constraints.linear(m)
    duals = [rng.uniform(0.5, 2.0, s.shape) * 1e-3 / s for s in slacks]
    weights = rng.uniform(0.5, 2.0, len(m.T))
    pushes = [1e-3 / s for s in slacks]
    return grid, m, grid.end_changes(m), (slacks, changes, duals, pushes, weights)


def jointly(c):
    """Return the same curvature with joints taken together."""
    N, m = c.y.shape[0], c.y.shape[-1]
    yy = np.zeros((N, 3 * m, 3 * m))
    for j in range(3):
        yy[:, j * m:(j + 1) * m, j * m:(j + 1) * m] = c.yy[:, j]
    return c._replace(yy=yy)


def dense_step(grid, m, ends, c, freedom):
    """Return the step that least squares find from all optimality conditions at once."""
    N, size = len(m.T), grid.n + 2
    parts = [f.size for f in m]
    total = sum(parts)

    def unflat(x):
        return Motion(*(part.reshape(f.shape) for part, f in zip(
            np.split(x, np.cumsum(parts)[:-1]), m)))

    # own unknowns, durations and end conditions as linear maps of all unknowns
    maps = [(own_unknowns(grid, unflat(e)), grid.nodes(unflat(e))[2], unflat(e).T)
            for e in np.eye(total)]
    Y = np.stack([np.swapaxes(y, 1, 2).reshape(N, 3 * size) for y, _, _ in maps], -1)
    T = np.stack([t for _, _, t in maps], -1)
    H, g, rows = np.zeros((total, total)), np.zeros(total), []
    c = c if c.yy.ndim == 3 else jointly(c)
    for k in range(N):
        cross = Y[k].T @ c.yT[k].reshape(-1)[:, np.newaxis] @ T[k][np.newaxis]
        H += Y[k].T @ c.yy[k] @ Y[k] + cross + cross.T + c.TT[k] * np.outer(T[k], T[k])
        g += Y[k].T @ c.y[k].reshape(-1) + c.T[k] * T[k]
        for j in range(3):
            own = Y[k].reshape(3, size, total)[j]
            v1 = np.stack([v[k, j] for _, v, _ in maps])
            rows += [ends[0][k, 0] @ own + ends[1][k, 0, j] * T[k] - v1,
                     ends[0][k, 1] @ own + ends[1][k, 1, j] * T[k]]
    E = np.array(rows)
    allowed = np.eye(total)
    start = total - N
    fixed = [start + k for k in range(N) if not freedom.free[k]]
    fixed += [parts[0] + i for i in np.flatnonzero(freedom.still.ravel())]
    basis = np.delete(allowed, fixed, axis=1)
    if freedom.tie.any():
        basis = np.column_stack((basis, np.concatenate((np.zeros(start), freedom.tie))))
    h, e = basis.T @ H @ basis, E @ basis
    K = np.block([[h, e.T], [e, np.zeros((len(e), len(e)))]])
    x = np.linalg.lstsq(K, np.concatenate((-basis.T @ g, np.zeros(len(e)))), rcond=None)[0]
    step = basis @ x[:basis.shape[1]]
    return unflat(step), -float(g @ step)


def agree(found, expected, rel=1e-6):
    for f, e in zip(found, expected):
        assert f == pytest.approx(e, rel=rel, abs=rel * (1e-9 + np.abs(e).max(initial=0.0)))


@pytest.mark.parametrize('seed', SEEDS)
@pytest.mark.parametrize('limits', [FREE, LIMITS], ids=['by joint', 'torque'])
def test_step_is_that_of_a_dense_solution(seed, limits):
    grid, m, ends, given = problem(seed, limits)
    c, freedom = curvature(*given), all_free(len(m.T))
    assert c.yy.ndim == (4 if limits is FREE else 3)
    step = newton_step(grid.n, ends, c, freedom)
    expected, gain = dense_step(grid, m, ends, c, freedom)
    agree(step.motion, expected)
    assert step.gain == pytest.approx(gain, rel=1e-6)
    assert step.gain > 0.0


@pytest.mark.parametrize('seed', SEEDS)
def test_step_of_tied_fixed_and_free_durations_and_stops_is_that_of_a_dense_solution(seed):
    grid, m, ends, given = problem(seed, FREE, segments=4)
    still = np.zeros((3, 3), bool)
    still[seed % 3, 1] = True
    c = curvature(*given)
    for free, tie in (([1, 0, 0, 1], [0.0, 1.5, 0.7, 0.0]), ([0, 0, 0, 0], [1.0, 2.0, 1.0, 0.5]),
                      ([1, 0, 1, 1], [0.0] * 4)):
        freedom = Freedom(np.array(free, bool), np.array(tie), np.ones(4), still)
        step = newton_step(grid.n, ends, c, freedom)
        expected, gain = dense_step(grid, m, ends, c, freedom)
        agree(step.motion, expected, 1e-5)
        assert step.gain == pytest.approx(gain, rel=1e-5)


@pytest.mark.parametrize('seed', SEEDS)
def test_elimination_by_joint_and_of_all_joints_together_agree(seed):
    grid, m, ends, given = problem(seed, FREE)
    c, freedom = curvature(*given), all_free(len(m.T))
    one, all_ = (newton_step(grid.n, ends, x, freedom) for x in (c, jointly(c)))
    agree(one.motion, all_.motion, 1e-7)
    assert one.gain == pytest.approx(all_.gain, rel=1e-9)


@pytest.mark.parametrize('seed', SEEDS)
def test_step_keeps_the_segments_ends_to_first_order(seed):
    grid, m, ends, given = problem(seed, LIMITS)
    step = newton_step(grid.n, ends, curvature(*given), all_free(len(m.T))).motion
    moved = ends[0] @ own_unknowns(grid, step) + ends[1] * step.T[:, np.newaxis, np.newaxis]
    assert moved[:, 0] == pytest.approx(grid.nodes(step)[2], abs=1e-8)
    assert moved[:, 1] == pytest.approx(np.zeros_like(moved[:, 1]), abs=1e-8)


@pytest.mark.parametrize('seed', SEEDS)
def test_gradient_is_the_difference_of_the_barrier_function(seed):
    grid, points, _ = random_motion(seed)
    constraints, m = slow_start(LIMITS, grid, points)
    slacks, changes, _ = constraints.linear(m)
    barrier, weights = 0.01, np.ones(len(m.T))
    pushes = [barrier / s for s in slacks]
    c = curvature(slacks, changes, pushes, pushes, weights)
    rng = np.random.default_rng(seed)
    step = Motion(*(rng.normal(size=f.shape) for f in m))
    y = np.swapaxes(own_unknowns(grid, step), 1, 2)
    slope = (c.y * y).sum() + c.T @ step.T

    def merit(x):
        moved = Motion(*(f + x * s for f, s in zip(m, step)))
        return moved.T.sum() - barrier * sum(
            np.log(s).sum() for s in bounds(LIMITS, grid, points).slacks(moved))

    e = 1e-6
    assert slope == pytest.approx((merit(e) - merit(-e)) / (2.0 * e), rel=1e-4, abs=1e-4)


def test_band_that_rounding_left_indefinite_still_gives_a_finite_step():
    grid, m, ends, given = problem(0, replace(FREE, max_jerk=[1e5] * 3), segments=3)
    c = curvature(*given)
    flat = Curvature(1e-18 * c.yy, 0.0 * c.yT, c.TT, c.y, c.T)
    step = newton_step(grid.n, ends, flat, all_free(3))
    assert all(np.isfinite(f).all() for f in step.motion)
