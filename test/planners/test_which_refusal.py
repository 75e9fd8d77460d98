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

"""Of an arm with several solutions for each point, the refusal that a user can act upon."""

from __future__ import annotations

from dataclasses import replace

from helpers.public_arms import described, DESCRIPTIONS
import numpy as np
import pytest
from rrr_traj_planner.core.errors import JointRangeError, RrrPlannerError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.joint_ranges import out_of_range, whole_turns
from rrr_traj_planner.core.kinematics.solutions import solutions
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest

NAMES = ['anymal_c_leg', 'dex3_thumb', 'kr16_2_first3', 'plain_arm', 'tilted_arm', 'trifinger',
         'uarm_swift_pro']


def arm_named(name):
    """Return an arm without torque limits, which refuse too."""
    found = described(DESCRIPTIONS / f'{name}.urdf')
    found.limits = replace(found.limits, max_effort=np.full(3, np.inf))
    return found


def is_in_range(arm, point):
    return any(not out_of_range(q + whole_turns(q, arm.limits), arm.limits).any()
               for q in solutions(arm.model, point).q[:, np.newaxis])


def tip_out_of_range(arm, rng):
    while True:
        point = forward_kinematics(arm.model, rng.uniform(-np.pi, np.pi, 3))
        if not is_in_range(arm, point):
            return point


def pose(arm, rng):
    limits = arm.limits
    return rng.uniform(np.maximum(limits.min_position, -np.pi),
                       np.minimum(limits.max_position, np.pi))


@pytest.mark.parametrize('planner_id', ['cycloid', 'time_optimal', 'line_arc'])
@pytest.mark.parametrize('name', NAMES)
def test_the_only_via_point_out_of_range_is_named(name, planner_id):
    arm, rng = arm_named(name), np.random.default_rng(3)
    for trial in range(6):
        bad = tip_out_of_range(arm, rng)
        points = [forward_kinematics(arm.model, pose(arm, rng)) for _ in range(3)]
        points.insert(trial % 4, bad)
        start = None if trial < 4 else pose(arm, rng)
        with pytest.raises(JointRangeError) as caught:
            plan(arm.model, arm.limits, PlanningRequest(
                np.array(points), planner_id=planner_id, start=start))
        assert caught.value.via_point == trial % 4
        assert str(caught.value).startswith(f'via point {trial % 4}: ')


def test_path_that_leaves_a_range_is_refused_where_it_leaves_it():
    """Of each branch that begins within the ranges; joint 1 goes round beyond its range."""
    arm = arm_named('uarm_swift_pro')
    points = np.array([[-0.042, -0.062, -0.0216], [0.0055, 0.0254, -0.0412],
                       [0.0582, -0.0145, -0.0863]])
    for shoulder in ('', 'front', 'back'):
        with pytest.raises(JointRangeError, match='between via points 1 and 2') as caught:
            plan(arm.model, arm.limits, PlanningRequest(
                points, planner_id='line_arc', max_deviation=0.005, shoulder=shoulder or None))
        assert caught.value.via_point == 2


@pytest.mark.parametrize('name', NAMES)
def test_no_path_is_refused_at_its_beginning_that_is_in_range(name):
    arm, rng, refused = arm_named(name), np.random.default_rng(8), 0
    for _ in range(12):
        points = np.array([forward_kinematics(arm.model, pose(arm, rng)) for _ in range(3)])
        try:
            plan(arm.model, arm.limits, PlanningRequest(points, planner_id='line_arc'))
        except JointRangeError as error:
            assert ' at 0 m along the path' not in str(error)
            refused += 1
        except RrrPlannerError:
            pass
    if name in ('trifinger', 'uarm_swift_pro', 'anymal_c_leg'):
        assert refused
