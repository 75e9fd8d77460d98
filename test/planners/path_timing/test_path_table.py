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

"""What the table of a path gives, against the path itself, differences and the dynamics."""

from helpers.path_terms import terms_at
from helpers.random_paths import random_case
import numpy as np
import pytest
from rrr_traj_planner.core.dynamics.rigid_body import (
    gravity_torque,
    inertia_matrix,
    inverse_dynamics,
)
from rrr_traj_planner.core.trajectory.sampling import STEP_OVERSHOOT
from rrr_traj_planner.planners.path_timing.pieces import PARTS
from rrr_traj_planner.planners.path_timing.table import PathTable

SEEDS = range(16)
# Of each quantity's largest value on the path: dq, ddq, dddq, m, c, g. Cubics through 65 places
# of a piece follow third derivatives least well.
ACCURACY = (1e-5, 1e-4, 4e-4, 1e-5, 1e-4, 1e-6)
TORQUE = 1e-4      # likewise, of the sum
AT_PLACES = 1e-12


def random_table(seed):
    case = random_case(seed)
    return case.arm_path, PathTable(case.arm_path)


def inner_places(table, seed, n=30):
    """Return random places within every piece, shape (N, n)."""
    share = np.random.default_rng(seed).uniform(0.01, 0.99, (len(table.ends) - 1, n))
    return table.ends[:-1, np.newaxis] + np.diff(table.ends)[:, np.newaxis] * share


def exact(arm_path, s):
    """Return what is demanded at places by the path itself, in the order of the table."""
    model, (q, dq, ddq, dddq) = arm_path.model, arm_path(s.ravel())
    g, still = gravity_torque(model, q), np.zeros_like(q)
    m = inverse_dynamics(model, q, still, dq) - g
    c = inverse_dynamics(model, q, dq, ddq) - g
    return [x.reshape(*s.shape, 3) for x in (dq, ddq, dddq, m, c, g)]


@pytest.mark.parametrize('seed', SEEDS)
def test_table_is_the_exact_demand_to_its_accuracy(seed):
    arm_path, table = random_table(seed)
    s = inner_places(table, seed)
    for ours, wanted, accuracy in zip(terms_at(table, s), exact(arm_path, s), ACCURACY):
        assert np.abs(ours - wanted).max() <= accuracy * np.abs(wanted).max()


@pytest.mark.parametrize('seed', SEEDS)
def test_table_is_exact_at_its_nodes(seed):
    arm_path, table = random_table(seed)
    s = table.places[:, 1:-1]
    for ours, wanted in zip(terms_at(table, s), exact(arm_path, s)):
        assert ours == pytest.approx(wanted, abs=AT_PLACES * (1.0 + np.abs(wanted).max()))
    assert table.values.g[:, 1:-1] == pytest.approx(terms_at(table, s).g, abs=1e-9)


@pytest.mark.parametrize('seed', SEEDS)
def test_ends_of_pieces_have_the_values_of_their_own_side(seed):
    arm_path, table = random_table(seed)
    first, last = (
        terms_at(table, table.ends[k:len(table.ends) - 1 + k, np.newaxis]) for k in (0, 1))
    from_right = arm_path(table.ends[:-1])
    from_left = arm_path(table.ends[1:], left=True)
    for ours, theirs in ((first, from_right), (last, from_left)):
        for name in ('dq', 'ddq', 'dddq'):
            wanted = getattr(theirs, name)
            assert getattr(ours, name)[:, 0] == pytest.approx(
                wanted, abs=1e-10 * (1.0 + np.abs(wanted).max()))
    # Torque is inertia times acceleration, and all else that speed asks of it does not step.
    steps = from_right.ddq[1:] - from_left.ddq[:-1]
    torques = np.einsum('nij,nj->ni', inertia_matrix(arm_path.model, from_right.q[1:]), steps)
    for ours, theirs in zip(np.moveaxis(table.overshoot, 1, 0), (steps, torques)):
        tolerance = 1e-9 * (1.0 + np.abs(theirs).max())
        assert ours[:-1] == pytest.approx(-STEP_OVERSHOOT * theirs, abs=tolerance)
        assert not ours[-1].any()


@pytest.mark.parametrize('seed', SEEDS)
def test_torque_of_a_motion_is_what_the_table_says(seed):
    arm_path, table = random_table(seed)
    s = inner_places(table, seed)
    v, a = np.random.default_rng(seed).normal(size=(2, *s.shape, 1))
    d = terms_at(table, s)
    q, dq, ddq, _ = (x.reshape(*s.shape, 3) for x in arm_path(s.ravel()))
    tau = inverse_dynamics(arm_path.model, *(x.reshape(-1, 3) for x in (
        q, dq * v, ddq * v ** 2 + dq * a))).reshape(*s.shape, 3)
    size = np.abs(tau).max()
    assert d.m * a + d.c * v ** 2 + d.g == pytest.approx(tau, abs=TORQUE * size)


def test_pieces_meet_at_joins_and_where_long_ones_are_parted_equally():
    for seed in SEEDS:
        arm_path, table = random_table(seed)
        wanted = np.array([0.0, *arm_path.path.joins, arm_path.path.length])
        whole, lengths = wanted[-1], np.diff(table.ends)
        assert set(wanted.tolist()) <= set(table.ends.tolist())
        assert lengths.max() <= whole / PARTS * (1.0 + 1e-12)
        for begin, end in zip(wanted, wanted[1:]):
            parts = lengths[(table.ends[:-1] >= begin) & (table.ends[1:] <= end)]
            assert parts == pytest.approx((end - begin) / len(parts), rel=1e-9)
            assert len(parts) == 1 or (end - begin) / (len(parts) - 1) > whole / PARTS
        assert table.places[:, 0].tolist() == table.ends[:-1].tolist()
        assert table.places[:, -1].tolist() == table.ends[1:].tolist()
