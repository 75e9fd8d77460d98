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

    def __init__(self, solved=(), eased=True, finished_in=None, tightened=True):
        self._solved, self._eased, self._tightened = iter(solved), eased, tightened
        self._finished_in, self.asked, self.tolerances = finished_in, [], []

    def solved(self):
        self.asked.append('solved')
        return next(self._solved, 'a motion')

    def eased(self):
        self.asked.append('eased')
        return self._eased

    def finished(self, outcome, tolerance):
        assert outcome == 'a motion'
        self.tolerances.append(tolerance)
        return len(self.tolerances) == self._finished_in

    def tightened(self):
        self.asked.append('tightened')
        return self._tightened


def rounds(problem):
    tighten(problem, SCHEDULE, lambda: False)
    return problem


def test_the_tolerance_grows_after_some_rounds_and_no_more_than_all_are_made():
    found = rounds(Scripted())
    assert found.tolerances == pytest.approx([1e-3, 1e-3, 1e-3, 2e-3, 4e-3, 8e-3], rel=1e-12)
    assert found.asked == ['solved', 'tightened'] * 6


def test_a_solution_within_its_tolerance_is_the_last():
    assert rounds(Scripted(finished_in=2)).asked == ['solved', 'tightened', 'solved']


def test_margins_that_do_not_grow_end_it():
    assert rounds(Scripted(tightened=False)).asked == ['solved', 'tightened']


def test_without_a_start_margins_are_eased_and_the_problem_is_solved_again():
    found = rounds(Scripted(solved=['a motion', None, None], finished_in=2))
    assert found.asked == ['solved', 'tightened', 'solved', 'eased', 'solved', 'eased', 'solved']
    assert rounds(Scripted(solved=[None], eased=False)).asked == ['solved', 'eased']
