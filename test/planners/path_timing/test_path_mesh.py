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

"""The mesh of a path: intervals are short where pieces meet, and fewer in each of many pieces."""

import numpy as np
import pytest
from rrr_traj_planner.planners.path_timing.mesh import (
    FEWEST_INTERVALS,
    LONGEST,
    MOST_INTERVALS,
    path_mesh,
    PIECES,
)


@pytest.mark.parametrize('pieces', [1, 8, PIECES, 13, 40])
def test_intervals_fill_each_piece_and_are_longest_in_its_middle(pieces):
    parts = path_mesh(pieces).parts
    assert parts.shape[0] == pieces
    assert parts.sum(axis=1) == pytest.approx(1.0, rel=1e-12)
    assert parts == pytest.approx(parts[:, ::-1], rel=1e-12)  # the same from both ends
    half = parts[:, :(parts.shape[1] + 1) // 2]
    assert (np.diff(half, axis=1) > 0.0).all()
    # the outer intervals' middles are not the ends themselves
    assert 0.7 * LONGEST <= parts.max() / parts.min() <= LONGEST


def test_long_paths_have_fewer_intervals_in_a_piece_and_never_less_than_the_fewest():
    counts = [path_mesh(pieces).n for pieces in range(1, 60)]
    assert counts[:PIECES] == [MOST_INTERVALS] * PIECES
    assert (np.diff(counts) <= 0).all()
    assert counts[-1] == FEWEST_INTERVALS
