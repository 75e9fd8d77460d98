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

"""Positions as they are typed into the panel."""

from __future__ import annotations

from importlib import import_module

import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError

pytest.importorskip('viser', reason='viser is not installed: make studio installs it')
points = import_module('rrr_traj_planner.nodes.studio.panel.points')


@pytest.mark.parametrize('text', [
    '0.5, -0.1, 1.44', '0.5 -0.1 1.44', '0.5;-.1;1.44', ' 5e-1,\t-0.10 , 1.440,'])
def test_positions_are_read(text):
    assert points.position_in(text) == (0.5, -0.1, 1.44)


@pytest.mark.parametrize('text', [
    '', '-', '0.5, -', '0.5, -0.1', '1, 2, 3, 4', 'x, y, z', '0.5, nan, 1', '1, 2, inf',
    '0,5, 0,1, 1,44'])
def test_what_is_no_position_is_refused(text):
    with pytest.raises(InvalidInputError, match='must be three numbers, x, y, z in m'):
        points.position_in(text)


def test_what_is_shown_is_read_to_the_micrometre():
    for point in np.random.default_rng(0).uniform(-2.0, 2.0, (50, 3)):
        shown = points.position_in(points.position_text(point))
        assert shown == pytest.approx(tuple(point), abs=0.5001e-6)
