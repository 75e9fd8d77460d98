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

"""What is said of motions of which more could be had."""

from math import inf, nan

import pytest
from rrr_traj_planner.planners.solver.convergence import unconverged_note


def test_nothing_is_said_of_what_converged():
    assert unconverged_note(0.0, 10.0) == unconverged_note(0.04, 10.0) == ''


@pytest.mark.parametrize(('gap', 'part'), [(0.1, '1'), (2.0, '20'), (2.49, '24.9')])
def test_a_bound_is_told_where_it_says_something(gap, part):
    assert unconverged_note(gap, 10.0) == (
        f'planning ended before it converged: at most {part} % of the time could be saved')


@pytest.mark.parametrize('gap', [2.5, 10.0, 1e9, inf, nan])
def test_no_bound_is_told_that_says_nothing(gap):
    assert unconverged_note(gap, 10.0) == (
        'planning ended before it converged: faster motions may be possible')
