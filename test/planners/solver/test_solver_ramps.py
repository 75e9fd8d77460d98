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

"""Chains of ramps against single ramps, quadrature and finite differences."""

from helpers.ramp_cases import (
    bounds,
    LIMITS,
    nodes_of,
    random_motion,
    random_step,
    shifted,
    stepped,
)
import numpy as np
import pytest
from rrr_traj_planner.core.motion_laws.ramps import Ramps
from rrr_traj_planner.planners.joint_timing.start import (
    LEAST_RAMPS,
    rest_to_rest_legs,
    rest_to_rest_shapes,
)
from rrr_traj_planner.planners.solver.ramps import (
    Grid,
    time_scaled,
    Variables,
    with_durations,
)

SEEDS = range(8)
EXACT = {'rel': 1e-11, 'abs': 1e-11}      # rounding


def moved_by(grid, points, m, step, size):
    """Return where the kernels' step leads."""
    return stepped(bounds(LIMITS, grid, points).problem, m, step, size)[0]


@pytest.mark.parametrize('seed', SEEDS)
def test_states_are_those_of_consecutive_ramps(seed):
    grid, points, m = random_motion(seed)
    at, (nodes, v0, _) = grid.states(points, m), nodes_of(m)
    for k, T in enumerate(m.T):
        q, qd = points[k], v0[k]
        for i in range(grid.n):
            piece = Ramps(T / grid.n, q, qd, nodes[k, i], nodes[k, i + 1] - nodes[k, i],
                          grid.shape)
            for row, s in ((i, 0.0), (grid.n + 1 + i, 0.5), (i + 1, 1.0)):
                expected = piece.at(s)
                assert at.q[k, row] == pytest.approx(expected[0], **EXACT)
                assert at.qd[k, row] == pytest.approx(expected[1], **EXACT)
                assert at.qdd[k, row] == pytest.approx(expected[2], **EXACT)
            assert at.jerk[k, grid.n + 1 + i] == pytest.approx(piece.at(0.5)[3], **EXACT)
            q, qd = piece.at(1.0)[:2]


def test_states_are_the_integrals_of_the_acceleration():
    grid, points, m = random_motion(2, n=6, segments=1)
    nodes, h = nodes_of(m)[0][0], m.T[0] / 6
    t = np.linspace(0.0, m.T[0], 6 * 4000 + 1)
    i = np.minimum((t / h).astype(int), 5)
    s = (t / h - i)[:, np.newaxis]
    qdd = nodes[i] + (nodes[i + 1] - nodes[i]) * 0.5 * (1.0 - np.cos(np.pi * s))
    dt = t[1]
    qd = np.vstack((np.zeros(3), np.cumsum(0.5 * dt * (qdd[1:] + qdd[:-1]), axis=0)))
    q = points[0] + np.vstack((np.zeros(3), np.cumsum(0.5 * dt * (qd[1:] + qd[:-1]), axis=0)))
    at, rows = grid.states(points, m), np.concatenate((np.arange(7) * 4000,
                                                       np.arange(6) * 4000 + 2000))
    assert at.q[0] == pytest.approx(q[rows], abs=1e-6)
    assert at.qd[0] == pytest.approx(qd[rows], abs=1e-6)


@pytest.mark.parametrize('per_ramp', [1, 2, 7, 24])
@pytest.mark.parametrize('seed', SEEDS[:4])
def test_samples_are_those_of_consecutive_ramps_in_the_order_of_time(seed, per_ramp):
    grid, points, m = random_motion(seed)
    (nodes, qd, _), q = nodes_of(m), points[:-1]
    h = (m.T / grid.n)[:, np.newaxis]
    found = grid.samples(points, m, per_ramp)
    assert found.shape == (len(m.T), grid.n * per_ramp + 1, 4, 3)
    for i in range(grid.n):
        piece = Ramps(h, q, qd, nodes[:, i], nodes[:, i + 1] - nodes[:, i], grid.shape)
        for r in range(per_ramp):
            expected = np.stack(piece.at(r / per_ramp), axis=1)
            assert found[:, i * per_ramp + r] == pytest.approx(expected, **EXACT)
        q, qd = piece.at(1.0)[:2]
    assert found[:, -1] == pytest.approx(
        np.stack((q, qd, nodes[:, -1], np.zeros_like(q)), axis=1), **EXACT)


@pytest.mark.parametrize('seed', SEEDS)
def test_restored_motions_meet_every_via_point_at_its_velocity(seed):
    grid, points, m = random_motion(seed)
    at, (_, _, v1) = grid.states(points, m), nodes_of(m)
    assert at.q[:, grid.n] == pytest.approx(points[1:], **EXACT)
    assert at.qd[:, grid.n] == pytest.approx(v1, **EXACT)


@pytest.mark.parametrize('seed', SEEDS)
def test_restoring_changes_nothing_but_inner_accelerations_and_those_only_once(seed):
    grid, points, m = random_motion(seed)
    off = m._replace(inner=m.inner + random_step(seed, m).inner)
    back = grid.restored(points, off)
    assert all((f == g).all() for f, g in zip(back[1:], off[1:]))
    assert grid.restored(points, back).inner == pytest.approx(back.inner, **EXACT)


@pytest.mark.parametrize('seed', SEEDS)
@pytest.mark.parametrize('size', [1.0, 0.1])
def test_moved_motions_meet_every_via_point_at_its_velocity(seed, size):
    grid, points, m = random_motion(seed)
    step = random_step(seed, m)
    step = step._replace(T=0.2 * np.tanh(step.T) * m.T)
    moved = moved_by(grid, points, m, step, size)
    assert grid.states(points, moved).q[:, grid.n] == pytest.approx(points[1:], **EXACT)
    assert grid.states(points, moved).qd[:, grid.n] == pytest.approx(
        nodes_of(moved)[2], **EXACT)
    assert moved.T == pytest.approx(m.T + size * step.T)


@pytest.mark.parametrize('seed', SEEDS)
def test_a_step_that_stretches_time_is_followed_as_a_stretch(seed):
    grid, points, m = random_motion(seed)
    for rate, size in ((0.3, 1.0), (-0.4, 0.5)):
        # the derivative of a stretch by the factor 1 + rate * size
        step = Variables(-2.0 * rate * m.inner, -rate * m.v, -2.0 * rate * m.a, rate * m.T)
        moved = moved_by(grid, points, m, step, size)
        for found, expected in zip(moved, time_scaled(m, 1.0 + rate * size)):
            assert found == pytest.approx(expected, **EXACT)


@pytest.mark.parametrize('seed', SEEDS)
def test_a_step_that_keeps_the_ends_to_first_order_is_followed_to_first_order(seed):
    grid, points, m = random_motion(seed)
    step = random_step(seed, m)
    step = step._replace(T=0.1 * step.T)
    # mend the step's own inner accelerations: its ends must not move to first order
    tiny = 1e-6
    inner = (grid.restored(points, shifted(m, step, tiny)).inner
             - grid.restored(points, shifted(m, step, -tiny)).inner) / (2.0 * tiny)
    step = step._replace(inner=inner)
    for size in (1e-3, 1e-4):
        moved = moved_by(grid, points, m, step, size)
        scale = np.abs(step.inner).max() + np.abs(m.inner).max()
        assert moved.inner == pytest.approx(
            m.inner + size * step.inner, abs=300.0 * size ** 2 * scale)
        for found, before, change in zip(moved[1:3], m[1:3], step[1:3]):
            assert found == pytest.approx(before + size * change, abs=30.0 * size ** 2)


@pytest.mark.parametrize('first', [True, False])
def test_a_via_point_follows_the_stretch_of_the_much_shorter_of_its_segments(first):
    grid, points, m = random_motion(5, segments=2)
    short = np.array([first, not first])
    m = grid.restored(points, m._replace(T=np.where(short, 1e-2, 1.0)))
    nothing = Variables(*(np.zeros_like(f) for f in m))
    factor = 1.3
    step = nothing._replace(v=-0.3 * m.v, a=-0.6 * m.a, T=np.where(short, 0.3 * m.T, 0.0))
    moved = moved_by(grid, points, m, step, 1.0)
    assert moved.v == pytest.approx(m.v / factor, rel=1e-5)
    assert moved.a == pytest.approx(m.a / factor ** 2, rel=1e-5)


def test_a_step_to_no_duration_leads_nowhere():
    grid, points, m = random_motion(1)
    step = random_step(1, m)._replace(T=-1.1 * m.T)
    assert stepped(bounds(LIMITS, grid, points).problem, m, step, 1.0) is None


@pytest.mark.parametrize('seed', SEEDS)
def test_trajectories_run_through_the_states(seed):
    grid, points, m = random_motion(seed)
    trajectory, at = grid.trajectory(points, m), grid.states(points, m)
    starts = np.concatenate(([0.0], np.cumsum(m.T)))
    assert trajectory.via_times == pytest.approx(starts)
    for k, T in enumerate(m.T):
        share = np.concatenate((np.arange(grid.n + 1.0), np.arange(grid.n) + 0.5)) / grid.n
        q, qd, qdd, _ = trajectory(starts[k] + T * share)
        for found, expected in ((q, at.q), (qd, at.qd), (qdd, at.qdd)):
            assert found == pytest.approx(expected[k], rel=1e-9, abs=1e-9)


@pytest.mark.parametrize('n', [4, 7, 20])
def test_straight_motions_stop_at_every_point_and_never_turn_back(n):
    points = np.array([[0.0, 1.0, 0.0], [0.5, 0.7, 0.0], [-0.3, 1.2, 0.4]])
    grid = Grid(n)
    rest = np.zeros((1, 3))
    m = Variables(rest_to_rest_shapes(grid, points)[:, 1:-1], rest, rest, np.ones(2))
    slow = with_durations(m, np.array([2.0, 3.0]))
    for motion in (m, slow):
        at = grid.states(points, motion)
        assert at.q[:, n] == pytest.approx(points[1:], **EXACT)
        assert at.qd[:, n] == pytest.approx(np.zeros((2, 3)), abs=1e-12)
        assert (at.qd * np.diff(points, axis=0)[:, np.newaxis] >= -1e-12).all()
    assert grid.states(points, slow).q == pytest.approx(grid.states(points, m).q, **EXACT)


def stops_on_the_way(seed):
    """Return points to stop at, and which nodes of the motion through them are at rest at each."""
    rng = np.random.default_rng(9000 + seed)
    grid, rest = Grid(int(rng.integers(8, 41))), np.zeros((0, 3))
    legs = int(rng.integers(1, grid.n // LEAST_RAMPS + 1))
    points = rng.uniform(-1.0, 1.0, (legs + 1, 3))
    m = Variables(rest_to_rest_legs(grid, points)[np.newaxis, 1:-1], rest, rest, np.ones(1))
    at = grid.states(points[[0, -1]], m)
    q, qd = at.q[0, :grid.n + 1], at.qd[0, :grid.n + 1]
    still = np.abs(qd).max(axis=1) <= 1e-10
    return grid.n, points, [np.flatnonzero(still & (np.abs(q - p).max(axis=1) <= 1e-11))
                            for p in points]


@pytest.mark.parametrize('seed', SEEDS)
def test_stops_on_the_way_are_made_in_order(seed):
    n, points, rows = stops_on_the_way(seed)
    assert [len(found) for found in rows] == [1] * len(points)
    row = np.concatenate(rows)
    assert row[[0, -1]].tolist() == [0, n]
    assert (np.diff(row) >= LEAST_RAMPS).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_longer_legs_have_no_fewer_ramps_but_for_the_rounding_of_one(seed):
    _, points, rows = stops_on_the_way(seed)
    ramps, length = np.diff(np.concatenate(rows)), np.abs(np.diff(points, axis=0)).max(axis=1)
    by_length = ramps[np.argsort(length)]
    assert (by_length >= np.maximum.accumulate(by_length) - 1).all()


def test_legs_have_ramps_as_the_roots_of_their_lengths_beside_the_least():
    # 12 ramps to spare, 3 : 1 for legs of 9 and 1
    points = np.array([[0.0, 0.0, 0.0], [0.0, 0.9, 0.2], [0.1, 0.9, 0.2]])
    grid, rest = Grid(12 + 2 * LEAST_RAMPS), np.zeros((0, 3))
    m = Variables(rest_to_rest_legs(grid, points)[np.newaxis, 1:-1], rest, rest, np.ones(1))
    q = grid.states(points[[0, -1]], m).q[0]
    assert q[LEAST_RAMPS + 9] == pytest.approx(points[1], abs=1e-12)


@pytest.mark.parametrize('seed', SEEDS)
def test_stretched_motions_go_the_same_way_more_slowly(seed):
    grid, points, m = random_motion(seed)
    at, slow = grid.states(points, m), grid.states(points, time_scaled(m, 1.7))
    assert slow.q == pytest.approx(at.q, **EXACT)
    assert slow.qd == pytest.approx(at.qd / 1.7, **EXACT)
    assert slow.jerk == pytest.approx(at.jerk / 1.7 ** 3, **EXACT)
