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

"""What is known of an answer's size before it is planned."""

from __future__ import annotations

import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.planners.answers.answer_size import check_answer_size, least_time
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.registry import planner_ids
from rrr_traj_planner.planners.request import PlanningRequest

LIMITS = JointLimits()


def test_slow_joint_s_velocity_counts_segment_by_segment():
    q = np.array([(0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (0.0, 5.0, 0.0)])
    limits = JointLimits(max_velocity=[1.0, 0.1, 1.0])
    assert least_time(limits, q) == pytest.approx(10.0 + 50.0, rel=1e-12)


def test_short_displacement_from_rest_to_rest_is_a_triangle_of_velocity():
    q = np.array([(0.0, 0.0, 0.0), (0.25, 0.0, 0.0)])  # 0.5 s up to 0.5 rad/s, 0.5 s down
    assert least_time(LIMITS, q) == pytest.approx(1.0, rel=1e-12)


def test_no_limits_or_no_displacement_take_no_time():
    q = np.array([(0.0, 0.0, 0.0), (1.0, 1.0, 1.0)])
    free = JointLimits(max_velocity=np.full(3, np.inf), max_acceleration=np.full(3, np.inf))
    assert least_time(free, q) == 0.0
    assert least_time(LIMITS, q[:1]) == least_time(LIMITS, q[[0, 0]]) == 0.0


@pytest.mark.parametrize('planner_id', planner_ids())
@pytest.mark.parametrize('seed', range(3))
def test_no_planner_is_faster(planner_id, seed):
    rng = np.random.default_rng(seed)
    q = rng.uniform((0.3, 0.8, -0.5), (1.2, 1.6, 0.5), (4, 3))
    limits = JointLimits(max_effort=np.full(3, 1e4))
    found = plan(RobotModel(), limits, PlanningRequest(
        forward_kinematics(RobotModel(), q), planner_id=planner_id))
    assert least_time(limits, q) <= found.trajectory.duration


def test_refusal_says_how_long_and_how_many():
    q = np.array([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0)])
    request = PlanningRequest(np.eye(3), max_points=150)
    with pytest.raises(InvalidInputError, match=(
            'a motion of 2 s with a point every 0.01 s has more than 150 points')):
        check_answer_size(LIMITS, request, q)
    check_answer_size(LIMITS, PlanningRequest(np.eye(3), max_points=250), q)


def test_prescribed_durations_are_known_beforehand():
    with pytest.raises(InvalidInputError, match='a motion of 1000 s .* more than 200000 points'):
        PlanningRequest(np.eye(3), segment_durations=[1e3, np.nan], sample_period=1e-3)


def test_displacement_too_short_for_numbers_is_none():
    a = (1.02, 0.59, 0.97)
    tips = np.array([a, (1.0, 0.6, 1.0)])
    tips[:, 1] = (1e-309, 1.1e-309)  # joint 1 would move by 1e-310 rad
    found = plan(RobotModel(), LIMITS, PlanningRequest(tips))
    assert np.ptp(found.points.positions[:, 0]) == 0.0
