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

"""Motions along a path to begin from: through every place, from rest to rest, never back."""

import numpy as np
import pytest
from rrr_traj_planner.planners.path_start import cycloid_along, uniform_along
from rrr_traj_planner.planners.ramp_chain import Grid


@pytest.mark.parametrize('start', [cycloid_along, uniform_along])
def test_motions_to_begin_from_pass_every_place_and_never_go_back(start):
    rng, grid = np.random.default_rng(31), Grid(20)
    for _ in range(50):
        ends = np.concatenate(([0.0], np.cumsum(10.0 ** rng.uniform(-4.0, 0.0, 6))))
        m = start(grid, ends)
        at = grid.states(ends[:, np.newaxis], m)
        assert at.q[:, grid.n, 0] == pytest.approx(ends[1:], rel=1e-9)
        assert at.qd[1:, grid.n, 0][:-1] == pytest.approx(at.qd[2:, 0, 0], rel=1e-6)
        speeds = at.qd[..., 0]
        assert np.abs(speeds[[0, -1], [0, grid.n]]).max() < 1e-9 * speeds.max()
        assert (np.sort(speeds.ravel())[2:] > 0.0).all()


def test_a_cycloid_comes_to_rest_in_however_short_a_piece():
    grid, ends = Grid(20), np.array([0.0, 1e-9, 0.4, 1.0 - 1e-9, 1.0])
    m = cycloid_along(grid, ends)
    assert m.T.sum() == pytest.approx(1.0)
    assert np.abs(grid.nodes(m)[0]).max() <= 2.0 * np.pi * 1.01
