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
from rrr_traj_planner.core.control.tolerances import Tolerances
from rrr_traj_planner.core.errors import InvalidInputError

SEEN = (0.5, 1.1, 0.2, 0.0, 0.05, 0.0)
DESIRED = (0.5, 1.1, 0.5, *(0.0,) * 6)  # joint 2 is 0.3 rad behind, joint 1 moves

PATH = ('State tolerances failed for joint 2:',
        'Position Error: 0.300000, Position Tolerance: 0.250000',
        'Holding position due to state tolerance violation')
GOAL = ('State tolerances failed for joint 1:',
        'Velocity Error: -0.050000, Velocity Tolerance: 0.010000',
        'State tolerances failed for joint 2:',
        'Position Error: 0.300000, Position Tolerance: 0.250000',
        'Exceeded goal_time_tolerance: holding position...')
LEFT = (0.0, 0.0, 0.25)


@pytest.mark.parametrize(('tolerances', 'since_end', 'first', 'lines'), [
    (Tolerances(), -1.0, True, ()),
    (Tolerances(trajectory=LEFT), -1.0, False, PATH),
    (Tolerances(trajectory=(0.1, 0.1, 0.31)), -1.0, False, ()),
    (Tolerances(trajectory=LEFT), 0.5, False, ()),           # the end is the goal's
    (Tolerances(trajectory=LEFT), 0.5, True, PATH),          # but for the first check
    (Tolerances(goal=LEFT), 1e9, False, ()),                 # any time for the goal
    (Tolerances(goal=LEFT, goal_time=2.0), 2.0, False, ()),
    (Tolerances(goal=LEFT, goal_time=2.0), 2.001, False, GOAL),
    (Tolerances(goal_time=2.0, stopped_velocity=0.0), 3.0, False, ()),
    (Tolerances(cmd_timeout=1.0), 1.0, False, ()),
    (Tolerances(cmd_timeout=1.0), 1.001, False, ('Aborted due to command timeout',)),
    (Tolerances(goal_time=2.0, goal=(1.0,) * 3, stopped_velocity=0.0, cmd_timeout=1.0), 9.0,
     False, ())])                                            # not above the goal's time
def test_violations_and_their_texts(tolerances, since_end, first, lines):
    assert tolerances.violation(SEEN, DESIRED, since_end, first) == lines


def test_nothing_is_watched_unless_something_is_limited():
    assert Tolerances().are_none
    assert Tolerances(goal=np.ones(3)).are_none  # for ever
    assert not Tolerances(goal_time=1.0).are_none
    assert not Tolerances(trajectory=LEFT).are_none


@pytest.mark.parametrize(('fields', 'text'), [
    ({'trajectory': (0.0, -1.0, 0.0)}, r'^trajectory is .* rad, must not be negative'),
    ({'goal': (0.0, nan, 0.0)}, r'^goal\[1\] is nan'),
    ({'goal_time': inf}, r'goal_time is inf s, must be finite'),
    ({'stopped_velocity': -1.0}, r'stopped_velocity is -1.0')])
def test_tolerances_without_sense_are_refused(fields, text):
    with pytest.raises(InvalidInputError, match=text):
        Tolerances(**fields)
