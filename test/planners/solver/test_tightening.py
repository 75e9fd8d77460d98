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

"""The rounds of tightening, by a scripted problem: how many, how exact, and what ends them."""

import pytest
from rrr_traj_planner.planners.solver.tightening import Schedule, tighten

SCHEDULE = Schedule(rounds=6, tolerance=1e-3, patience=2, growth=2.0)


class Scripted:
    """A problem that says in each round what it is told to, and writes down what it is asked."""

    def __init__(self, solved=(), relaxes=True, accepted_in=None, tightens=True):
        self._solved, self._relaxes, self._tightens = iter(solved), relaxes, tightens
        self._accepted_in, self.asked, self.tolerances = accepted_in, [], []

    def solve(self):
        self.asked.append('solve')
        return next(self._solved, 'a motion')

    def relax(self):
        self.asked.append('relax')
        return self._relaxes

    def accept(self, outcome, tolerance):
        assert outcome == 'a motion'
        self.tolerances.append(tolerance)
        return len(self.tolerances) == self._accepted_in

    def tighten(self):
        self.asked.append('tighten')
        return self._tightens


def rounds(problem):
    tighten(problem, SCHEDULE, lambda: False)
    return problem


def test_the_tolerance_grows_after_some_rounds_and_no_more_than_all_are_made():
    found = rounds(Scripted())
    assert found.tolerances == pytest.approx([1e-3, 1e-3, 1e-3, 2e-3, 4e-3, 8e-3], rel=1e-12)
    assert found.asked == ['solve', 'tighten'] * 6


def test_a_solution_within_its_tolerance_is_the_last():
    assert rounds(Scripted(accepted_in=2)).asked == ['solve', 'tighten', 'solve']


def test_margins_that_do_not_grow_end_it():
    assert rounds(Scripted(tightens=False)).asked == ['solve', 'tighten']


def test_without_a_start_margins_are_relaxed_and_the_problem_is_solved_again():
    found = rounds(Scripted(solved=['a motion', None, None], accepted_in=2))
    assert found.asked == ['solve', 'tighten', 'solve', 'relax', 'solve', 'relax', 'solve']
    assert rounds(Scripted(solved=[None], relaxes=False)).asked == ['solve', 'relax']
