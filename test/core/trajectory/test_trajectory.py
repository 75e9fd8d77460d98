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

"""Grids of times over a motion."""

from helpers.random_cases import random_trajectory
import numpy as np
import pytest
from rrr_traj_planner.core.trajectory.trajectory import times_within, Trajectory


class KnotsAlone(Trajectory):
    """A motion that knows its knots and nothing else."""

    knots = None

    def __init__(self, knots):
        self.knots = np.array(knots)
        self.duration = self.knots[-1]
        self.via_times = self.knots[[0, -1]]

    def __call__(self, t):
        raise NotImplementedError

    def peaks(self):
        raise NotImplementedError

    def time_scaled(self, factor):
        raise NotImplementedError


def test_grid_divides_every_interval_alike():
    assert times_within(KnotsAlone([0.0, 1.0, 1.5]), 2).tolist() == [0.0, 0.5, 1.0, 1.25, 1.5]
    assert times_within(KnotsAlone([0.0, 2.0]), 1).tolist() == [0.0, 2.0]


def test_grid_steps_are_no_longer_than_the_spacing():
    grid = times_within(KnotsAlone([0.0, 1.0, 1.5, 1.51]), 2, spacing=0.3)
    assert np.diff(grid) == pytest.approx([0.25] * 4 + [0.25] * 2 + [0.005] * 2, abs=1e-15)


@pytest.mark.parametrize(('per_interval', 'spacing'), [(1, np.inf), (7, np.inf), (3, 0.01)])
def test_grid_meets_every_knot_exactly_and_rises(per_interval, spacing):
    for seed in range(30):
        trajectory = random_trajectory(np.random.default_rng(seed))
        grid = times_within(trajectory, per_interval, spacing)
        knots = trajectory.knots
        assert np.isin(knots, grid).all()
        assert (grid[0], grid[-1]) == (0.0, trajectory.duration)
        assert (np.diff(grid) > 0.0).all()
        assert np.diff(grid).max() <= spacing * (1.0 + 1e-9)
        steps = np.diff(np.searchsorted(grid, knots))
        assert (steps >= per_interval).all()
        assert (steps <= np.maximum(per_interval, np.ceil(np.diff(knots) / spacing))).all()
