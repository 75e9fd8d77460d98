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

"""Dense checks of a motion along a path: against a denser evaluation, and by laws."""

from helpers.path_terms import demands, terms_at
from helpers.random_paths import random_case, random_mesh
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.planners.path_timing.constraints import (
    ACCELERATION,
    JERK,
    PathConstraints,
    QUANTITIES,
    SPEED,
    TORQUE,
    VELOCITY,
)
from rrr_traj_planner.planners.path_timing.dense_check import dense_check
from rrr_traj_planner.planners.path_timing.start import motion_with_speeds
from rrr_traj_planner.planners.path_timing.table import PathTable
from rrr_traj_planner.planners.solver.splines import time_scaled

SEEDS = range(8)
DENSE = 300          # evaluations of an interval
# The allowance between two samples, an eighth of the second difference, is a bound: it
# exceeds the true excess by no more than this part of the largest value.
ALLOWED = 0.1


def random_check(seed, n=6):
    """Return a table, a mesh and a motion that no limits have shaped."""
    rng = np.random.default_rng(seed)
    table = PathTable(random_case(seed).arm_path)
    mesh = random_mesh(seed, len(table.ends) - 1, n)
    speeds = rng.uniform(0.2, 0.4, len(table.ends))
    speeds[[0, -1]] = 0.0
    m = motion_with_speeds(mesh, table.ends, speeds)
    m = m._replace(inner=m.inner + rng.normal(0.0, 0.1, m.inner.shape),
                   a=rng.normal(0.0, 0.1, m.a.shape))
    return table, mesh, mesh.restored(table.ends[:, np.newaxis], m)


def checked(table, mesh, m, bounds):
    """Return what a dense check finds."""
    N, steady = len(m.T), np.zeros(len(m.T), bool)
    constraints = PathConstraints(table, JointLimits(), np.inf, mesh,
                                  np.zeros((N, 2 * mesh.n + 1, QUANTITIES)), steady)
    return dense_check(constraints.problem, m, bounds)


def dense(table, mesh, m):
    """Return the limited quantities at equally spaced times of each interval, in their order."""
    profile = mesh.profiles(table.ends[:, np.newaxis], m)[0]
    starts = np.concatenate(([0.0], np.cumsum(m.T)[:-1]))
    share = np.array([np.interp(np.arange(mesh.n * DENSE + 1) / DENSE, range(mesh.n + 1), s)
                      for s in mesh.starts])
    t = starts[:, np.newaxis] + m.T[:, np.newaxis] * share
    at = np.stack([f.reshape(t.shape) for f in profile(t.ravel())], axis=-1)
    s = np.clip(at[..., 0], table.ends[:-1, np.newaxis], table.ends[1:, np.newaxis])
    return demands(terms_at(table, s), at)


def exceeded_bounds(x, part=0.8):
    """Return a part of the largest magnitudes, no bound on every fifth and on the last."""
    bounds = part * np.abs(x).max(axis=(0, 1))
    bounds[::5] = bounds[-1] = np.inf
    return bounds


@pytest.mark.parametrize('seed', SEEDS)
def test_excess_is_that_of_a_dense_evaluation_of_each_piece(seed):
    table, mesh, m = random_check(seed)
    x = np.abs(dense(table, mesh, m))
    bounds = exceeded_bounds(x)
    found = checked(table, mesh, m, bounds).excess
    assert found.shape == (len(m.T), 2 * mesh.n + 1, QUANTITIES)
    peaks, largest = x.max(axis=1), x.max(axis=(0, 1))
    wanted = np.where(peaks > bounds, peaks - bounds, 0.0)
    assert (found.max(axis=1) >= wanted - 1e-3 * largest).all()
    assert (found.max(axis=1) <= wanted + ALLOWED * largest).all()
    assert wanted.max() > 0.0


@pytest.mark.parametrize('seed', SEEDS)
def test_excess_is_reported_at_the_nearest_points(seed):
    table, mesh, m = random_check(seed)
    x = np.abs(dense(table, mesh, m))
    bounds = exceeded_bounds(x)
    found = checked(table, mesh, m, bounds).excess
    # in the order of time: nodes and the middles between them
    order = np.argsort(np.concatenate((np.arange(mesh.n + 1.0), np.arange(mesh.n) + 0.5)))
    near = DENSE // 4
    for i, point in enumerate(order):
        middle = i * DENSE // 2
        beside = x[:, max(middle - near, 0):middle + near + 1].max(axis=1)
        over = beside - bounds > ALLOWED * beside
        assert (found[:, point][over] > 0.0).all()
        wide = x[:, max(middle - 2 * near, 0):middle + 2 * near + 1].max(axis=1)
        assert (found[:, point][wide < (1.0 - ALLOWED) * bounds] == 0.0).all()


@pytest.mark.parametrize('kind', [VELOCITY, ACCELERATION, JERK, TORQUE, SPEED])
@pytest.mark.parametrize('seed', SEEDS[:4])
def test_a_motion_scaled_by_the_reported_factor_is_just_within_its_limits(seed, kind):
    table, mesh, m = random_check(seed)
    bounds = np.full(QUANTITIES, np.inf)
    bounds[kind] = 0.8 * np.abs(dense(table, mesh, m)).max(axis=(0, 1))[kind]
    if kind == TORQUE:  # no less than gravity takes, 0 of joint 1
        bounds[kind] = 1.01 * np.abs(table.values.g).max(axis=(0, 1)) + 0.01
    time_scale = checked(table, mesh, m, bounds).time_scale
    assert time_scale > 1.0
    scaled = time_scaled(m, time_scale)
    assert checked(table, mesh, scaled, bounds).time_scale == pytest.approx(1.0, rel=1e-9)


def test_a_torque_that_gravity_takes_can_be_met_by_no_slowing():
    table, mesh, m = random_check(0)
    bounds = np.full(QUANTITIES, np.inf)
    assert checked(table, mesh, m, bounds).time_scale == 0.0
    bounds[10] = 0.5 * np.abs(table.values.g[..., 1]).min()
    assert checked(table, mesh, m, bounds).time_scale == np.inf


def test_a_tip_that_moves_backwards_is_detected():
    table, mesh, m = random_check(1)
    bounds = np.full(QUANTITIES, np.inf)
    assert checked(table, mesh, m, bounds).is_forward
    back = m._replace(v=m.v * np.where(np.arange(len(m.v)) == 1, -1.0, 1.0)[:, np.newaxis])
    seen = checked(table, mesh, mesh.restored(table.ends[:, np.newaxis], back), bounds)
    assert seen.slowest <= -0.2
    assert not seen.is_forward
