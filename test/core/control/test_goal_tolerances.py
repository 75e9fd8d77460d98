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

"""Tolerances of a goal: 0 leaves the parameters', -1 takes them away, nonsense leaves all."""

from __future__ import annotations

from math import inf, nan

import numpy as np
import pytest
from rrr_traj_planner.core.control.goal_tolerances import (
    AskedTolerance,
    AskedTolerances,
    tolerances_of_goal,
)
from rrr_traj_planner.core.control.tolerances import Tolerances
from rrr_traj_planner.core.errors import InvalidInputError

NAMES = ('a', 'b', 'c')
DEFAULTS = Tolerances(
    trajectory=(0.1, 0.2, 0.3), goal=(0.01, 0.02, 0.03), stopped_velocity=(0.5,) * 3,
    goal_time=2.0, cmd_timeout=5.0)


def resolved(**asked):
    return tolerances_of_goal(DEFAULTS, AskedTolerances(**asked), NAMES)


def values(tolerances):
    return {name: np.asarray(value).tolist() for name, value in (
        (name, getattr(tolerances, name)) for name in (
            'trajectory', 'trajectory_velocity', 'goal', 'stopped_velocity', 'goal_time',
            'cmd_timeout'))}


@pytest.mark.parametrize(('asked', 'changed'), [
    ({}, {}),
    ({'path': [AskedTolerance('b', 0.0, 0.0)], 'goal': [AskedTolerance('c', 0.0, 0.0)]}, {}),
    ({'path': [AskedTolerance('b', 0.7, 0.8, 0.9)]},
     {'trajectory': [0.1, 0.7, 0.3], 'trajectory_velocity': [0.0, 0.8, 0.0]}),
    ({'path': [AskedTolerance('c', -1.0, -1.0, -1.0)]}, {'trajectory': [0.1, 0.2, 0.0]}),
    ({'goal': [AskedTolerance('a', 0.7, -1.0), AskedTolerance('c', -1.0, 0.8)]},
     {'goal': [0.7, 0.02, 0.0], 'stopped_velocity': [0.0, 0.5, 0.8]}),
    ({'goal': [AskedTolerance('a', 0.7, 0.0), AskedTolerance('a', 0.0, 0.9)]},  # the last counts
     {'stopped_velocity': [0.9, 0.5, 0.5]}),
    ({'path': [AskedTolerance('a', inf, 0.0)]}, {'trajectory': [1e9, 0.2, 0.3]}),
    ({'goal_time': 0.25}, {'goal_time': 0.25}),
    ({'goal_time': -1.0}, {'goal_time': 0.0}),
    ({'goal_time': -1.0 + 1e-8}, {'goal_time': 0.0})])  # within a float's epsilon
def test_goal_has_what_it_asks_for_and_else_the_parameters(asked, changed):
    assert values(resolved(**asked)) == {**values(DEFAULTS), **changed}


@pytest.mark.parametrize(('asked', 'text'), [
    ({'path': [AskedTolerance('d', 0.1, 0.1)]},
     "joint 'd' specified in goal.path_tolerance does not exist. Using default tolerances."),
    ({'goal': [AskedTolerance('', 0.1, 0.1)]},
     "joint '' specified in goal.goal_tolerance does not exist. Using default tolerances."),
    ({'path': [AskedTolerance('a', -0.5, 0.1)]},
     "joint 'a' specified in goal.path_tolerance has a invalid position tolerance. Using default "
     'tolerances.'),
    ({'goal': [AskedTolerance('b', 0.5, -2.0)]},
     "joint 'b' specified in goal.goal_tolerance has a invalid velocity tolerance. Using default "
     'tolerances.'),
    ({'goal': [AskedTolerance('b', 0.5, 0.0, -2.0)]},
     "joint 'b' specified in goal.goal_tolerance has a invalid acceleration tolerance. Using "
     'default tolerances.'),
    ({'goal': [AskedTolerance('b', nan, 0.0)]},
     "joint 'b' specified in goal.goal_tolerance has a invalid position tolerance. Using default "
     'tolerances.'),
    ({'goal_time': -0.25},
     'Specified illegal goal_time_tolerance: -0.250000. Using default tolerances')])
def test_nonsense_is_refused_in_the_controller_s_words(asked, text):
    with pytest.raises(InvalidInputError) as caught:
        resolved(**asked)
    assert str(caught.value) == text
