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

"""How goals end: codes and texts."""

from __future__ import annotations

import pytest
from rrr_traj_planner.core.control.goal_end import (
    end_of,
    GoalEnd,
    not_followed,
    refusal,
    ResultCode,
)
from rrr_traj_planner.core.control.tolerances import Exceeded, Outcome, Verdict
from rrr_traj_planner.core.control.trajectory_validation import (
    check_trajectory,
    IncomingPoint,
    IncomingTrajectory,
)
from rrr_traj_planner.core.errors import InvalidInputError

NAMES = ('a', 'b', 'c')
POINT = IncomingPoint(10 ** 9, (0.1, 0.2, 0.3))
BEHIND = Exceeded(2, 'Position', 0.3, 0.25)
MOVES = Exceeded(1, 'Velocity', -0.05, 0.01)


@pytest.mark.parametrize(('verdict', 'code', 'text'), [
    (Verdict(Outcome.REACHED, 0.001), ResultCode.SUCCESSFUL, 'Goal successfully reached!'),
    (Verdict(Outcome.PATH_VIOLATED, -0.5, (BEHIND,)), ResultCode.PATH_TOLERANCE_VIOLATED,
     'Aborted due to path tolerance violation: c Position Error 0.3 rad, Tolerance 0.25'),
    (Verdict(Outcome.GOAL_VIOLATED, 2.5, (MOVES, BEHIND)), ResultCode.GOAL_TOLERANCE_VIOLATED,
     'Aborted due to goal_time_tolerance exceeding by 2.500000 seconds: b Velocity Error -0.05 '
     'rad/s, Tolerance 0.01; c Position Error 0.3 rad, Tolerance 0.25'),
    (Verdict(Outcome.TIMED_OUT, 2.5), ResultCode.GOAL_TOLERANCE_VIOLATED,
     'Aborted due to command timeout')])
def test_verdicts_become_the_controller_s_results(verdict, code, text):
    assert end_of(verdict, NAMES) == GoalEnd(code, text)


def test_trajectory_that_cannot_be_followed_is_an_invalid_goal():
    assert not_followed(('one', 'two')) == GoalEnd(ResultCode.INVALID_GOAL, 'Aborted: one; two')


@pytest.mark.parametrize(('names', 'stamp', 'points', 'code'), [
    (('a', 'b'), 0, [POINT], ResultCode.INVALID_JOINTS),
    (('a', 'b', 'd'), 0, [POINT], ResultCode.INVALID_JOINTS),
    (('a', 'b', 'b'), 0, [POINT], ResultCode.INVALID_JOINTS),
    ((), 0, [POINT], ResultCode.INVALID_JOINTS),
    (NAMES, 1, [POINT], ResultCode.OLD_HEADER_TIMESTAMP),
    (NAMES, 0, [], ResultCode.INVALID_GOAL),
    (NAMES, 0, [POINT, POINT], ResultCode.INVALID_GOAL),
    (NAMES, 0, [IncomingPoint(10 ** 9, (0.1, 0.2))], ResultCode.INVALID_GOAL)])
def test_refusals_have_the_code_of_their_reason(names, stamp, points, code):
    with pytest.raises(InvalidInputError) as caught:
        check_trajectory(IncomingTrajectory(names, stamp, points), NAMES, now=10 ** 12)
    assert refusal(caught.value) == GoalEnd(code, str(caught.value))
