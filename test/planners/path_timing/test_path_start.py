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

import numpy as np
import pytest
from rrr_traj_planner.planners.path_timing.start import motion_with_speeds, uniform_along
from rrr_traj_planner.planners.solver.ramps import Grid


def rough_path(seed):
    """Return ends of pieces from 0.1 mm to 1 m long, and speeds at them over as wide a range."""
    rng = np.random.default_rng(seed)
    ends = np.concatenate(([0.0], np.cumsum(10.0 ** rng.uniform(-4.0, 0.0, 6))))
    return ends, np.concatenate(([0.0], 10.0 ** rng.uniform(-3.0, 0.0, 5), [0.0]))


def uniform(grid, ends, speeds):
    return uniform_along(grid, ends)


@pytest.mark.parametrize('start', [motion_with_speeds, uniform])
@pytest.mark.parametrize('seed', range(12))
def test_initial_motions_pass_the_ends_of_pieces_and_never_go_back(start, seed):
    grid = Grid(20, (0.0, 0.6)[seed % 2])
    ends, speeds = rough_path(seed)
    m = start(grid, ends, speeds)
    at = grid.states(ends[:, np.newaxis], m)
    assert at.q[:, grid.n, 0] == pytest.approx(ends[1:], rel=1e-9)
    assert at.qd[1:, grid.n, 0][:-1] == pytest.approx(at.qd[2:, 0, 0], rel=1e-6)
    found = at.qd[..., 0]
    assert np.abs(found[[0, -1], [0, grid.n]]).max() < 1e-9 * found.max()
    assert (np.sort(found.ravel())[2:] > 0.0).all()


@pytest.mark.parametrize('seed', range(10))
def test_initial_motion_has_the_given_speeds_and_no_acceleration_where_pieces_meet(seed):
    grid, (ends, speeds) = Grid(20), rough_path(seed)
    m = motion_with_speeds(grid, ends, speeds)
    assert m.v[:, 0] == pytest.approx(speeds[1:-1], rel=1e-12)
    assert (m.a == 0.0).all()
    # a cycloid of velocity covers the mean of its end speeds
    assert m.T * (speeds[1:] + speeds[:-1]) == pytest.approx(2.0 * np.diff(ends), rel=1e-12)
    between = grid.states(ends[:, np.newaxis], m).qd[..., 0]
    low, high = (f(speeds[:-1], speeds[1:]) for f in (np.minimum, np.maximum))
    margin = 0.02 * (high - low) + 1e-12
    assert (between.min(axis=1) >= low - margin).all()
    assert (between.max(axis=1) <= high + margin).all()
