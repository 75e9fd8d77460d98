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

"""From tip positions to joint positions: one branch, the ranges, holding torques."""

from dataclasses import replace

from helpers.random_tasks import random_task
from helpers.thesis_cases import ANGLE_TOLERANCE, POINTS
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import LimitViolationError, StartStateError, UnreachableError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.postures import Posture, posture_of
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest
from rrr_traj_planner.planners.via_points import check_start, holding_failure, joint_via_points

ARM, LIMITS = RobotModel(), JointLimits()
WIDE = JointLimits(min_position=[-np.pi] * 3, max_position=[np.pi, np.pi, 2.0 * np.pi],
                   max_effort=[np.inf] * 3)


def tips(*names):
    return np.array([POINTS[name][0] for name in names])


def test_points_of_table_6_1_are_where_the_thesis_s_arm_must_go():
    names = [f'6.1 point {k}' for k in (1, 2, 3)]
    q = joint_via_points(ARM, LIMITS, tips(*names), None, Posture())
    assert np.degrees(q) == pytest.approx(
        np.array([POINTS[name][1] for name in names]), abs=ANGLE_TOLERANCE)


@pytest.mark.parametrize('seed', range(40))
def test_random_points_come_back_from_their_tips(seed):
    task = random_task(seed)
    q = joint_via_points(task.model, task.limits, forward_kinematics(task.model, task.q), None,
                         posture_of(task.model, task.q[0]))
    assert q == pytest.approx(task.q, abs=1e-9)


@pytest.mark.parametrize('elbow', ['up', 'down'])
def test_requested_elbow_branch_holds_for_every_point(elbow):
    q = joint_via_points(ARM, WIDE, tips('6.1 point 1', '6.3 point 1'), None,
                         Posture(elbow, 'front'))
    assert forward_kinematics(ARM, q) == pytest.approx(tips('6.1 point 1', '6.3 point 1'))
    assert ((q[:, 2] < np.pi / 2) == (elbow == 'up')).all()


def test_elbow_is_down_where_up_is_out_of_range():
    only_down = replace(WIDE, min_position=[-np.pi, -np.pi, 1.7])
    answer = plan(ARM, only_down, PlanningRequest(tips('6.1 point 1', '6.1 point 2')))
    assert (answer.points.positions[:, 2] > np.pi / 2).all()


def test_point_out_of_range_is_refused_by_joint_value_and_range():
    narrow = replace(WIDE, max_position=[0.6, np.pi, 2.0 * np.pi])
    with pytest.raises(LimitViolationError, match=(
            r'^via point 1: joint_1 would be at 0\.874[\d]* rad \(elbow up, shoulder front\), '
            r'limits -3\.14159 to 0\.6 rad$')) as no:
        joint_via_points(ARM, narrow, tips('6.1 point 1', '6.1 point 2'), None,
                         Posture('up', 'front'))
    assert (no.value.via_point, no.value.joint, no.value.limit) == (1, 'joint_1', 0.6)


def test_unreachable_point_is_refused_with_its_distance_and_index():
    with pytest.raises(UnreachableError, match='^via point 1: .* by 0.4 m$') as no:
        joint_via_points(
            ARM, WIDE, np.array([[1.0, 0.0, 0.5], [2.0, 0.0, 0.5]]), None, Posture())
    assert no.value.via_point == 1
    assert no.value.distance == pytest.approx(0.4)


def test_previous_point_decides_what_the_vertical_axis_leaves_open():
    above = np.array([[0.0, 0.0, 1.7]])
    q = joint_via_points(ARM, WIDE, above, np.array([0.9, 1.0, 0.0]), Posture('up'))
    assert q[0, 0] == 0.9
    assert joint_via_points(ARM, WIDE, above, None, Posture('up'))[0, 0] == 0.0


def test_holding_failure_names_the_first_point_that_gravity_makes_too_heavy():
    # Arm level and stretched: 16 * 0.5 * 9.81 + 12 * 9.81 * (0.9 + 0.5) = 243.3 N m.
    q = np.array([[0.0, np.pi / 2, 0.0], [0.0, 0.0, np.pi / 2]])
    failure = holding_failure(ARM, LIMITS, q)
    assert str(failure) == 'via point 1: joint_2 needs 243.3 N m to hold, limit 200 N m'
    assert failure.value == pytest.approx(243.288)
    assert holding_failure(ARM, replace(LIMITS, max_effort=[1.0, 243.3, 60.0]), q) is None


def test_start_rounded_out_of_its_range_is_moved_into_it():
    start = check_start(ARM, LIMITS, np.array([-5e-10, 1.5, 0.0]))
    assert start.tolist() == [0.0, 1.5, 0.0]


def test_start_beyond_its_range_is_refused():
    with pytest.raises(StartStateError, match=(
            r'^start state: joint_2 is at -0\.01 rad, limits 0 to 3\.14159 rad$')):
        check_start(ARM, LIMITS, np.array([0.1, -0.01, 0.0]))
