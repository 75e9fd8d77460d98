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

"""Motions of piecewise linear jerk against SciPy's splines, quadrature and finite differences."""

from helpers.spline_cases import (
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
from rrr_traj_planner.planners.joint_timing.start import (
    LEAST_INTERVALS,
    rest_to_rest_legs,
    rest_to_rest_shapes,
    with_durations,
)
from rrr_traj_planner.planners.solver.splines import (
    Mesh,
    time_scaled,
    uniform_mesh,
    Variables,
    with_stops,
)
from scipy.interpolate import make_interp_spline

SEEDS = range(8)
EXACT = {'rel': 1e-10, 'abs': 1e-10}      # rounding


def moved_by(mesh, points, m, step, size):
    """Return where the kernels' step leads."""
    return stepped(bounds(LIMITS, mesh, points).problem, m, step, size)[0]


def integrals(mesh, points, m, k, t):
    """Return the states of segment k at times from its start, by SciPy's splines."""
    jerk = make_interp_spline(mesh.starts[k] * m.T[k], nodes_of(m)[k], k=1)
    a, v, q = (jerk.antiderivative(order) for order in (1, 2, 3))
    t = t[:, np.newaxis]
    return np.stack((
        points[k] + m.v[k] * t + 0.5 * m.a[k] * t ** 2 + q(t[:, 0]),
        m.v[k] + m.a[k] * t + v(t[:, 0]), m.a[k] + a(t[:, 0]), jerk(t[:, 0])), axis=1)


@pytest.mark.parametrize('seed', SEEDS)
def test_states_are_integrals_of_the_jerk(seed):
    mesh, points, m = random_motion(seed)
    at = np.stack(mesh.states(points, m), axis=2)
    for k, T in enumerate(m.T):
        s = mesh.starts[k]
        places = np.concatenate((s, 0.5 * (s[:-1] + s[1:])))
        assert at[k] == pytest.approx(integrals(mesh, points, m, k, places * T), **EXACT)


@pytest.mark.parametrize('per_interval', [1, 2, 7, 24])
@pytest.mark.parametrize('seed', SEEDS[:4])
def test_samples_are_integrals_of_the_jerk_in_the_order_of_time(seed, per_interval):
    mesh, points, m = random_motion(seed)
    found = mesh.samples(points, m, per_interval)
    assert found.shape == (len(m.T), mesh.n * per_interval + 1, 4, 3)
    for k, T in enumerate(m.T):
        s = mesh.starts[k]
        part = np.arange(per_interval) / per_interval
        places = np.append((s[:-1, np.newaxis] + mesh.parts[k][:, np.newaxis] * part).ravel(), 1.0)
        assert found[k] == pytest.approx(integrals(mesh, points, m, k, places * T), **EXACT)


@pytest.mark.parametrize('seed', SEEDS)
def test_restored_motions_meet_every_via_point_in_its_state(seed):
    mesh, points, m = random_motion(seed)
    at = mesh.states(points, m)
    for found, expected in ((at.q, points), (at.qd, m.v), (at.qdd, m.a), (at.jerk, m.j)):
        assert found[:, mesh.n] == pytest.approx(expected[1:], **EXACT)
        assert found[:, 0] == pytest.approx(expected[:-1], **EXACT)


@pytest.mark.parametrize('seed', SEEDS)
def test_restoring_changes_nothing_but_inner_jerks_and_those_only_once(seed):
    mesh, points, m = random_motion(seed)
    off = m._replace(inner=m.inner + random_step(seed, m).inner)
    back = mesh.restored(points, off)
    assert all((f == g).all() for f, g in zip(back[1:], off[1:]))
    assert mesh.restored(points, back).inner == pytest.approx(back.inner, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize('seed', SEEDS)
@pytest.mark.parametrize('size', [1.0, 0.1])
def test_moved_motions_meet_every_via_point_in_its_state(seed, size):
    mesh, points, m = random_motion(seed)
    step = random_step(seed, m)
    step = step._replace(T=0.2 * np.tanh(step.T) * m.T)
    moved = moved_by(mesh, points, m, step, size)
    at = mesh.states(points, moved)
    for found, expected in ((at.q, points), (at.qd, moved.v), (at.qdd, moved.a)):
        assert found[:, mesh.n] == pytest.approx(expected[1:], **EXACT)
    for values in moved[1:4]:
        assert (values[[0, -1]] == 0.0).all()
    assert moved.T == pytest.approx(m.T + size * step.T)


@pytest.mark.parametrize('seed', SEEDS)
def test_a_step_that_stretches_time_is_followed_as_a_stretch(seed):
    mesh, points, m = random_motion(seed)
    for rate, size in ((0.3, 1.0), (-0.4, 0.5)):
        # the derivative of a stretch by the factor 1 + rate * size
        step = Variables(-3.0 * rate * m.inner, -rate * m.v, -2.0 * rate * m.a, -3.0 * rate * m.j,
                         rate * m.T)
        moved = moved_by(mesh, points, m, step, size)
        for found, expected in zip(moved, time_scaled(m, 1.0 + rate * size)):
            assert found == pytest.approx(expected, **EXACT)


@pytest.mark.parametrize('seed', SEEDS)
def test_a_step_that_keeps_the_ends_to_first_order_is_followed_to_first_order(seed):
    mesh, points, m = random_motion(seed)
    step = random_step(seed, m)
    step = step._replace(T=0.1 * step.T)
    # mend the step's own inner jerks: its ends must not move to first order
    tiny = 1e-6
    inner = (mesh.restored(points, shifted(m, step, tiny)).inner
             - mesh.restored(points, shifted(m, step, -tiny)).inner) / (2.0 * tiny)
    step = step._replace(inner=inner)
    for size in (1e-3, 1e-4):
        moved = moved_by(mesh, points, m, step, size)
        scale = np.abs(step.inner).max() + np.abs(m.inner).max()
        assert moved.inner == pytest.approx(
            m.inner + size * step.inner, abs=1000.0 * size ** 2 * scale)
        for found, before, change in zip(moved[1:4], m[1:4], step[1:4]):
            assert found == pytest.approx(before + size * change, abs=60.0 * size ** 2)


@pytest.mark.parametrize('first', [True, False])
def test_a_via_point_follows_the_stretch_of_the_much_shorter_of_its_segments(first):
    mesh, points, m = random_motion(5, segments=2)
    short = np.array([first, not first])
    m = mesh.restored(points, m._replace(T=np.where(short, 1e-2, 1.0)))
    nothing = Variables(*(np.zeros_like(f) for f in m))
    factor = 1.3
    step = nothing._replace(v=-0.3 * m.v, a=-0.6 * m.a, j=-0.9 * m.j,
                            T=np.where(short, 0.3 * m.T, 0.0))
    moved = moved_by(mesh, points, m, step, 1.0)
    for order, (found, before) in enumerate(zip(moved[1:4], m[1:4]), 1):
        assert found == pytest.approx(before / factor ** order, rel=1e-5)


def test_a_step_to_no_duration_leads_nowhere():
    mesh, points, m = random_motion(1)
    step = random_step(1, m)._replace(T=-1.1 * m.T)
    assert stepped(bounds(LIMITS, mesh, points).problem, m, step, 1.0) is None


@pytest.mark.parametrize('seed', SEEDS)
def test_trajectories_run_through_the_states_with_continuous_jerk(seed):
    mesh, points, m = random_motion(seed)
    trajectory, at = mesh.trajectory(points, m), mesh.states(points, m)
    starts = np.concatenate(([0.0], np.cumsum(m.T)))
    assert trajectory.via_times == pytest.approx(starts)
    for k, T in enumerate(m.T):
        s = mesh.starts[k]
        share = np.concatenate((s, 0.5 * (s[:-1] + s[1:])))
        for before in (0.0, 1e-9):  # s: on either side of a node
            inside = np.clip(starts[k] + T * share - before, 0.0, trajectory.duration)
            for found, expected in zip(trajectory(inside), at):
                assert found == pytest.approx(expected[k], rel=1e-6, abs=1e-6)


@pytest.mark.parametrize('n', [4, 7, 20])
def test_straight_motions_stop_at_every_point_and_never_turn_back(n):
    points = np.array([[0.0, 1.0, 0.0], [0.5, 0.7, 0.0], [-0.3, 1.2, 0.4]])
    mesh = uniform_mesh(2, n)
    m = with_stops(rest_to_rest_shapes(mesh, points), np.ones(2))
    slow = with_durations(m, np.array([2.0, 3.0]))
    for motion in (m, slow):
        at = mesh.states(points, motion)
        assert at.q[:, n] == pytest.approx(points[1:], **EXACT)
        assert at.qd[:, n] == pytest.approx(np.zeros((2, 3)), abs=1e-12)
        assert at.qdd[:, n] == pytest.approx(np.zeros((2, 3)), abs=1e-12)
        assert (at.qd * np.diff(points, axis=0)[:, np.newaxis] >= -1e-12).all()
    assert mesh.states(points, slow).q == pytest.approx(mesh.states(points, m).q, **EXACT)


def stops_on_the_way(seed):
    """Return points to stop at, and which nodes of the motion through them are at rest at each."""
    rng = np.random.default_rng(9000 + seed)
    n = int(rng.integers(8, 41))
    parts = rng.uniform(0.5, 2.0, n)
    parts /= parts.sum()
    legs = int(rng.integers(1, n // LEAST_INTERVALS + 1))
    points = rng.uniform(-1.0, 1.0, (legs + 1, 3))
    mesh = Mesh(parts[np.newaxis])
    m = with_stops(rest_to_rest_legs(parts, points)[np.newaxis], np.ones(1))
    at = mesh.states(points[[0, -1]], m)
    q, qd = at.q[0, :n + 1], at.qd[0, :n + 1]
    still = np.abs(qd).max(axis=1) <= 1e-8
    return n, points, [np.flatnonzero(still & (np.abs(q - p).max(axis=1) <= 1e-9))
                       for p in points]


@pytest.mark.parametrize('seed', SEEDS)
def test_stops_on_the_way_are_made_in_order(seed):
    n, points, rows = stops_on_the_way(seed)
    assert [len(found) for found in rows] == [1] * len(points)
    row = np.concatenate(rows)
    assert row[[0, -1]].tolist() == [0, n]
    assert (np.diff(row) >= LEAST_INTERVALS).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_longer_legs_have_no_fewer_intervals_but_for_the_rounding_of_one(seed):
    _, points, rows = stops_on_the_way(seed)
    intervals, length = np.diff(np.concatenate(rows)), np.abs(np.diff(points, axis=0)).max(axis=1)
    by_length = intervals[np.argsort(length)]
    assert (by_length >= np.maximum.accumulate(by_length) - 1).all()


def test_legs_have_intervals_as_the_cubic_roots_of_their_lengths_beside_the_least():
    # 12 intervals to spare, 2 : 1 for legs of 8 and 1
    points = np.array([[0.0, 0.0, 0.0], [0.0, 0.8, 0.2], [0.1, 0.8, 0.2]])
    n = 12 + 2 * LEAST_INTERVALS
    m = with_stops(rest_to_rest_legs(np.full(n, 1.0 / n), points)[np.newaxis], np.ones(1))
    q = uniform_mesh(1, n).states(points[[0, -1]], m).q[0]
    assert q[LEAST_INTERVALS + 8] == pytest.approx(points[1], abs=1e-10)


@pytest.mark.parametrize('seed', SEEDS)
def test_stretched_motions_go_the_same_way_more_slowly(seed):
    mesh, points, m = random_motion(seed)
    at, slow = mesh.states(points, m), mesh.states(points, time_scaled(m, 1.7))
    for order, (found, before) in enumerate(zip(slow, at)):
        assert found == pytest.approx(before / 1.7 ** order, **EXACT)
