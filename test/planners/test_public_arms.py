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

"""Public descriptions of arms, legs and fingers, and random chains, in every planner."""

from helpers.public_arms import arms, PATHS, task, violations
import numpy as np
import pytest
from rrr_traj_planner.core.errors import (
    ConvergenceError,
    LimitViolationError,
    RrrPlannerError,
    UnreachableError,
)
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.registry import planner_ids

ARMS = {arm.name: arm for arm in arms()}
OTHERS = [x for x in planner_ids() if x not in ('cycloid', 'time_optimal', *PATHS)]


def requests(name, planner_id, number):
    """Return random requests, of an arm's own."""
    k = list(ARMS).index(name)
    return [task(ARMS[name], planner_id, np.random.default_rng((k, i))) for i in range(number)]


@pytest.mark.parametrize('name', ARMS)
def test_joint_space_motions_keep_every_limit_by_pinocchio(name):
    k = list(ARMS).index(name)
    for planner_id in ('cycloid', 'time_optimal', OTHERS[k % len(OTHERS)]):
        for request in requests(name, planner_id, 2):
            try:
                found = plan(ARMS[name].model, ARMS[name].limits, request)
            except ConvergenceError:
                raise
            except RrrPlannerError as error:  # approach a cannot turn back at the end of a range
                assert planner_id != 'cycloid', str(error)
                continue
            assert violations(ARMS[name], request, found) == [], planner_id


@pytest.mark.parametrize('name', ARMS)
def test_paths_keep_every_limit_by_pinocchio_or_are_refused_for_a_reason(name):
    for planner_id in PATHS:
        for request in requests(name, planner_id, 1):
            try:
                found = plan(ARMS[name].model, ARMS[name].limits, request)
            except (UnreachableError, LimitViolationError):  # the path between the points
                continue
            assert violations(ARMS[name], request, found) == [], planner_id
