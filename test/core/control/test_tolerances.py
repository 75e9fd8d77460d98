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

"""When joint_trajectory_controller would give a trajectory up, in its words."""

from __future__ import annotations

from math import inf, nan

import numpy as np
import pytest
from rrr_traj_planner.core.control.tolerances import Exceeded, Outcome, Tolerances
from rrr_traj_planner.core.errors import InvalidInputError

SEEN = (0.5, 1.1, 0.2, 0.0, 0.05, 0.0)
DESIRED = (0.5, 1.1, 0.5, *(0.0,) * 6)  # joint 2 is 0.3 rad behind, joint 1 moves

BEHIND = Exceeded(2, 'Position', pytest.approx(0.3), 0.25)
MOVES = Exceeded(1, 'Velocity', -0.05, 0.01)
LEFT = (0.0, 0.0, 0.25)
NONE = np.zeros(3)


@pytest.mark.parametrize(('tolerances', 'since_end', 'first', 'found'), [
    (Tolerances(), -1.0, True, None),
    (Tolerances(trajectory=LEFT), -1.0, False, (Outcome.PATH_VIOLATED, (BEHIND,))),
    (Tolerances(trajectory=(0.1, 0.1, 0.31)), -1.0, False, None),
    (Tolerances(trajectory_velocity=(0.01,) * 3), -1.0, False, (Outcome.PATH_VIOLATED, (MOVES,))),
    (Tolerances(trajectory=LEFT), 0.5, False, None),         # the end is the goal's
    (Tolerances(trajectory=LEFT), 0.5, True,                 # but for the first check
     (Outcome.PATH_VIOLATED, (BEHIND,))),
    (Tolerances(goal=LEFT), 1e9, False, None),               # any time for the goal
    (Tolerances(goal=LEFT, goal_time=2.0), 2.0, False, None),
    (Tolerances(goal=LEFT, goal_time=2.0), 2.001, False, (Outcome.GOAL_VIOLATED, (MOVES, BEHIND))),
    (Tolerances(goal_time=2.0, stopped_velocity=NONE), 3.0, False, None),
    (Tolerances(cmd_timeout=1.0), 1.0, False, None),
    (Tolerances(cmd_timeout=1.0), 1.001, False, (Outcome.TIMED_OUT, ())),
    (Tolerances(goal_time=2.0, goal=(1.0,) * 3, stopped_velocity=NONE, cmd_timeout=1.0), 9.0,
     False, None)])                                          # not above the goal's time
def test_violations_of_tolerances(tolerances, since_end, first, found):
    verdict = tolerances.verdict(SEEN, DESIRED, since_end, first)
    assert (verdict and (verdict.outcome, verdict.exceeded)) == found


@pytest.mark.parametrize(('tolerances', 'since_end', 'outcome'), [
    (Tolerances(stopped_velocity=NONE), -0.001, None),
    (Tolerances(stopped_velocity=NONE), 0.0, Outcome.REACHED),
    (Tolerances(), 1e9, None),                               # joint 1 moves on for ever
    (Tolerances(goal_time=1.0), 1.001, Outcome.GOAL_VIOLATED),
    (Tolerances(goal=LEFT, stopped_velocity=NONE, cmd_timeout=1.0), 1.5, Outcome.TIMED_OUT),
    (Tolerances(trajectory=LEFT, stopped_velocity=NONE), 0.0, Outcome.REACHED)])
def test_goal_is_reached_at_its_end_within_its_tolerances(tolerances, since_end, outcome):
    verdict = tolerances.verdict(SEEN, DESIRED, since_end, is_goal=True)
    assert (verdict and verdict.outcome) == outcome


def test_lines_are_the_controller_s():
    verdict = Tolerances(goal=(0.0, 0.001, 0.25), goal_time=2.0).verdict(
        (0.5, 1.11, *SEEN[2:]), DESIRED, 3.0)
    assert verdict.lines == (
        'State tolerances failed for joint 1:',
        'Position Error: -0.010000, Position Tolerance: 0.001000',
        'Velocity Error: -0.050000, Velocity Tolerance: 0.010000',
        'State tolerances failed for joint 2:',
        'Position Error: 0.300000, Position Tolerance: 0.250000')


def test_nothing_is_watched_unless_something_is_limited():
    none, endless = Tolerances(), Tolerances(goal=np.ones(3))
    for tolerances in (none, endless):
        assert not tolerances.apply_on_the_way and not tolerances.apply_after_the_end
    assert Tolerances(goal_time=1.0).apply_after_the_end
    assert Tolerances(cmd_timeout=1.0).apply_after_the_end
    assert Tolerances(trajectory=LEFT).apply_on_the_way
    assert Tolerances(trajectory_velocity=LEFT).apply_on_the_way


@pytest.mark.parametrize(('fields', 'text'), [
    ({'trajectory': (0.0, -1.0, 0.0)}, r'^trajectory is .* rad, must not be negative'),
    ({'goal': (0.0, nan, 0.0)}, r'^goal\[1\] is nan'),
    ({'goal_time': inf}, r'goal_time is inf s, must be finite'),
    ({'stopped_velocity': (0.0, 0.0, -1.0)},
     r'^stopped_velocity is .* rad/s, must not be negative')])
def test_tolerances_without_sense_are_refused(fields, text):
    with pytest.raises(InvalidInputError, match=text):
        Tolerances(**fields)
