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
from rrr_traj_planner.core.errors import JointRangeError
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.registry import planner_ids

ARMS = {arm.name: arm for arm in arms()}
OTHERS = [x for x in planner_ids() if x not in ('cycloid', 'time_optimal', *PATHS)]
# Arms whose random path leaves a range between two via points, all of which are within. The other
# 22 of 30 are planned for by both planners of paths; in joint space all are, by every planner.
LEAVING = {'eezybotarm_mk2', 'geomagic_touch', 'hyq_leg', 'plain_arm', 'tilted_arm',
           'trifinger_pro', 'chain 3', 'chain 7'}


def requests(name, planner_id, number):
    """Return random requests, of an arm's own."""
    k = list(ARMS).index(name)
    return [task(ARMS[name], planner_id, np.random.default_rng((k, i))) for i in range(number)]


@pytest.mark.parametrize('name', ARMS)
def test_joint_space_motions_exist_and_keep_every_limit_by_pinocchio(name):
    k = list(ARMS).index(name)
    for planner_id in ('cycloid', 'time_optimal', OTHERS[k % len(OTHERS)]):
        request, = requests(name, planner_id, 1)
        found = plan(ARMS[name].model, ARMS[name].limits, request)
        assert violations(ARMS[name], request, found) == [], planner_id


@pytest.mark.parametrize('planner_id', PATHS)
@pytest.mark.parametrize('name', [name for name in ARMS if name not in LEAVING])
def test_paths_keep_every_limit_by_pinocchio(name, planner_id):
    request, = requests(name, planner_id, 1)
    found = plan(ARMS[name].model, ARMS[name].limits, request)
    assert violations(ARMS[name], request, found) == []


@pytest.mark.parametrize('planner_id', PATHS)
@pytest.mark.parametrize('name', sorted(LEAVING))
def test_paths_that_leave_a_range_between_via_points_are_refused_for_it(name, planner_id):
    request, = requests(name, planner_id, 1)
    with pytest.raises(JointRangeError, match=r'^at \S+ m along the path, between via points \d'):
        plan(ARMS[name].model, ARMS[name].limits, request)


def test_arms_are_as_many_as_is_said_and_each_planner_has_three():
    assert (len(ARMS), len(set(ARMS) - LEAVING)) == (30, 22)
    assert len(ARMS) >= 3 * len(OTHERS)
