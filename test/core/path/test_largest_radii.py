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

"""The largest radii within a deviation."""

from helpers.path_cases import distance_to_polyline, random_points
import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.path.design import line_arc, line_polynomial
from rrr_traj_planner.core.path.largest_radii import largest_radii

FAMILIES = (line_arc, line_polynomial)


@pytest.mark.parametrize('family', FAMILIES)
def test_path_stays_within_the_deviation_and_uses_it_where_nothing_else_binds(family):
    rng = np.random.default_rng(63)
    used = 0
    for _ in range(15):
        points, bound = random_points(rng), 10.0 ** rng.uniform(-3.0, -1.0)
        path = largest_radii(family, points, bound)
        s = np.linspace(0.0, path.length, 5001)
        assert distance_to_polyline(points, path(s)[0]).max() <= bound * (1.0 + 1e-9)
        used += (path.deviation >= 0.999 * bound).sum()
    assert used > 30


def test_radius_between_long_legs_is_the_one_of_the_drawing():
    points = [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 10.0, 0.0]]
    path = largest_radii(line_arc, points, 0.01)
    # rho (1 - cos 45 deg) = 0.01
    assert path.radii == pytest.approx([0.01 / (1.0 - np.sqrt(0.5))], rel=2e-4)


@pytest.mark.parametrize('family', FAMILIES)
def test_collinear_points_stay_on_their_line(family):
    path = largest_radii(family, np.outer([0.0, 0.5, 1.0], [1.0, 0.0, 0.0]), 0.01)
    assert path.length == pytest.approx(1.0, abs=1e-14)


@pytest.mark.parametrize('bound', [0.0, -1.0, np.nan, np.inf])
def test_deviation_that_is_none_is_refused(bound):
    with pytest.raises(InvalidInputError, match='^max_deviation is .* m, must be (pos|fin)it'):
        largest_radii(line_arc, np.eye(3), bound)
