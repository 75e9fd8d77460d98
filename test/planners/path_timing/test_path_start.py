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

"""Initial motions along a path: through the end of every piece, from rest to rest, never back."""

from helpers.random_paths import random_mesh
import numpy as np
import pytest
from rrr_traj_planner.planners.path_timing.mesh import path_mesh
from rrr_traj_planner.planners.path_timing.start import motion_with_speeds, uniform_along

# Of a cycloid's peak: 1 + (2 pi h)^2 / 12, where the longest interval is h = 0.132 of a piece.
JERK = 1.06


def rough_path(seed):
    """Return ends of pieces from 0.1 mm to 1 m long, and speeds at them over as wide a range."""
    rng = np.random.default_rng(seed)
    ends = np.concatenate(([0.0], np.cumsum(10.0 ** rng.uniform(-4.0, 0.0, 6))))
    return ends, np.concatenate(([0.0], 10.0 ** rng.uniform(-3.0, 0.0, 5), [0.0]))


def uniform(mesh, ends, speeds):
    return uniform_along(mesh, ends)


@pytest.mark.parametrize('start', [motion_with_speeds, uniform])
@pytest.mark.parametrize('seed', range(12))
def test_initial_motions_pass_the_ends_of_pieces_and_never_go_back(start, seed):
    ends, speeds = rough_path(seed)
    mesh = random_mesh(seed, len(ends) - 1, 20)
    m = start(mesh, ends, speeds)
    at = mesh.states(ends[:, np.newaxis], m)
    assert at.q[:, mesh.n, 0] == pytest.approx(ends[1:], rel=1e-9)
    assert at.qd[1:, mesh.n, 0][:-1] == pytest.approx(at.qd[2:, 0, 0], rel=1e-6)
    found = at.qd[..., 0]
    assert np.abs(found[[0, -1], [0, mesh.n]]).max() < 1e-9 * found.max()
    assert (np.sort(found.ravel())[2:] > 0.0).all()


@pytest.mark.parametrize('pieces', [1, 8, 11, 13, 30])
def test_speeds_change_as_in_a_cycloid_on_every_mesh_of_the_planner(pieces):
    # What `initial_speeds` reckons with: speed between those at the ends of a piece, and peaks of
    # acceleration 2 D / T and of jerk 2 pi D / T^2. Jerk is linear between samples of its sine:
    # less in their midst, and a little more at them so that the change is the same.
    mesh, rng = path_mesh(pieces), np.random.default_rng(pieces)
    for _ in range(20):
        ends = np.concatenate(([0.0], np.cumsum(10.0 ** rng.uniform(-4.0, 0.0, pieces))))
        speeds = np.append(0.0, 10.0 ** rng.uniform(-3.0, 0.0, pieces))
        m = motion_with_speeds(mesh, ends, speeds)
        change = np.abs(np.diff(speeds))[:, np.newaxis]
        low = np.minimum(speeds[1:], speeds[:-1])[:, np.newaxis]
        at = mesh.samples(ends[:, np.newaxis], m, 8)[..., 0]
        part, T = (at[..., 1] - low) / change, m.T[:, np.newaxis]
        assert (part >= -0.02).all() and (part <= 1.02).all()
        assert (at[:, 1:, 1] > 0.0).all()  # never back
        assert (np.abs(at[..., 2]) <= 1.01 * 2.0 * change / T).all()
        assert (np.abs(at[..., 3]) <= JERK * 2.0 * np.pi * change / T ** 2).all()


@pytest.mark.parametrize('seed', range(10))
def test_initial_motion_has_the_given_speeds_and_no_acceleration_where_pieces_meet(seed):
    ends, speeds = rough_path(seed)
    mesh = random_mesh(seed, len(ends) - 1, 20)
    m = motion_with_speeds(mesh, ends, speeds)
    assert m.v[:, 0] == pytest.approx(speeds, rel=1e-12)
    assert (m.a == 0.0).all() and (m.j == 0.0).all()
    # a cycloid of velocity covers the mean of its end speeds
    assert m.T * (speeds[1:] + speeds[:-1]) == pytest.approx(2.0 * np.diff(ends), rel=1e-12)
    between = mesh.states(ends[:, np.newaxis], m).qd[..., 0]
    low, high = (f(speeds[:-1], speeds[1:]) for f in (np.minimum, np.maximum))
    margin = 0.02 * (high - low) + 1e-12
    assert (between.min(axis=1) >= low - margin).all()
    assert (between.max(axis=1) <= high + margin).all()
