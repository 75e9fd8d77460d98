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

"""Meshes that suit a motion, and the motion on them: against NumPy's interpolation."""

from itertools import product

from helpers.spline_cases import random_motion
import numpy as np
import pytest
from rrr_traj_planner.planners.solver.refinement import (
    BASE,
    halved,
    MOST_UNIFORM,
    moved,
    refined,
    SMOOTHING,
)
from rrr_traj_planner.planners.solver.splines import Mesh

SEEDS = range(8)
MAX_JERK = np.array([9.0, 7.0, 11.0])


def monitor_of(mesh, points, m):
    """Return each interval's value of the monitor function, as the docstrings say."""
    jerk = mesh.states(points, m).jerk[:, :mesh.n + 1]
    scale = MAX_JERK * (np.abs(jerk).max(axis=(0, 1)) / MAX_JERK).max()
    change = np.abs(np.diff(jerk, axis=1) / scale).max(axis=2) / (mesh.parts * mesh.n) + BASE
    beside = np.pad(change, ((0, 0), (1, 1)), mode='edge')
    return sum(f * beside[:, i:i + mesh.n] for i, f in enumerate(SMOOTHING))


@pytest.mark.parametrize('seed', SEEDS)
def test_every_interval_has_the_same_share_of_the_monitor_s_integral(seed):
    mesh, points, m = random_motion(seed)
    found = refined(mesh, points, m, MAX_JERK, 0.0)[0]
    for monitor, parts, starts, new in zip(
            monitor_of(mesh, points, m), mesh.parts, mesh.starts, found.starts):
        integral = np.concatenate(([0.0], np.cumsum(monitor * parts)))
        assert np.diff(np.interp(new, starts, integral)) == pytest.approx(
            np.full(mesh.n, integral[-1] / mesh.n))
        assert new[-1] == pytest.approx(1.0, abs=1e-15)


def test_no_interval_is_shorter_than_the_least_and_long_ones_keep_their_proportions():
    short = 0
    for seed, rise in product(SEEDS, (0.02, 0.08, 10.0)):
        mesh, points, m = random_motion(seed)
        free, parts = (refined(mesh, points, m, MAX_JERK, r)[0].parts for r in (0.0, rise))
        least = np.minimum(rise / m.T, MOST_UNIFORM / mesh.n)[:, np.newaxis]
        assert (parts >= least * (1.0 - 1e-12)).all()
        assert parts.sum(axis=1) == pytest.approx(np.ones(len(parts)), abs=1e-14)
        for own, before, longer in zip(parts, free, parts > least * (1.0 + 1e-12)):
            ratios = own[longer] / before[longer]
            assert ratios == pytest.approx(np.full(len(ratios), ratios[0]), rel=1e-12)
            short += np.count_nonzero(~longer)
    assert short > 10


@pytest.mark.parametrize('seed', SEEDS)
def test_jerk_is_interpolated_linearly(seed):
    mesh, points, m = random_motion(seed)
    rng = np.random.default_rng(seed)
    parts = rng.uniform(0.2, 1.0, (len(m.T), mesh.n + 3))
    to = Mesh(parts / parts.sum(axis=1, keepdims=True))
    jerk = mesh.states(points, m).jerk[:, :mesh.n + 1]
    inner = np.array([[np.interp(new[1:-1], old, f) for f in own.T] for new, old, own in zip(
        to.starts, mesh.starts, jerk)]).swapaxes(1, 2)
    found, expected = moved(mesh, to, points, m), to.restored(points, m._replace(inner=inner))
    assert found.inner == pytest.approx(expected.inner, abs=1e-9)


@pytest.mark.parametrize('seed', SEEDS)
def test_a_mesh_of_halves_leaves_a_motion_as_it_is(seed):
    mesh, points, m = random_motion(seed)
    finer = halved(mesh)
    before = mesh.states(points, m)
    after = finer.states(points, moved(mesh, finer, points, m))
    for f, g in zip(before, after):
        assert g[:, :2 * mesh.n + 1:2] == pytest.approx(f[:, :mesh.n + 1], abs=1e-9)
