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

"""Stops along a path of the tip: one branch of the inverse kinematics, whole turns, errors."""

from dataclasses import replace

from helpers.path_cases import distance_to_polyline
from helpers.planning_cases import ARM, LIMITS
import numpy as np
import pytest
from rrr_traj_planner.core.errors import (
    InvalidInputError,
    LimitViolationError,
    UnreachableError,
)
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest

FREE = replace(LIMITS, max_effort=np.full(3, np.inf))
CORNER = np.array([[0.9, 0.3, 1.0], [0.7, 0.6, 1.2], [0.6, 0.3, 1.4], [0.9, 0.4, 1.1]])
ON_LINE = 1e-9  # m

each_planner = pytest.mark.parametrize('planner_id', ['line_arc', 'line_polynomial'])


def planned(points, planner_id, limits=LIMITS, **request):
    return plan(ARM, limits, PlanningRequest(points, planner_id=planner_id, **request))


def turning(low, high):
    """Return limits with a range of joint 1."""
    return replace(FREE, min_position=(low, *LIMITS.min_position[1:]),
                   max_position=(high, *LIMITS.max_position[1:]))


def around(*azimuths):
    return np.array([(0.8 * np.cos(a), 0.8 * np.sin(a), 1.0) for a in azimuths])


@each_planner
def test_path_reverses_where_the_tip_stops_and_only_there(planner_id):
    there_and_back = CORNER[[0, 1, 0]]
    with pytest.raises(InvalidInputError, match=(
            r'^via point 1: the path reverses there, by 180\.000000 deg, and would have to stop; '
            r'stop_at lets the tip stop there$')) as refusal:
        planned(there_and_back, planner_id)
    assert refusal.value.via_point == 1
    answer = planned(
        there_and_back, planner_id, stop_at=[False, True, True], dwell=[0.0, 0.5, 0.0])
    out, back = np.diff(answer.via_times) - [0.0, 0.5]
    assert out == pytest.approx(planned(CORNER[:2], planner_id).trajectory.duration, abs=1e-9)
    assert back == pytest.approx(planned(CORNER[1::-1], planner_id).trajectory.duration, abs=1e-9)


@each_planner
def test_lines_through_a_stop_are_straight_up_to_it(planner_id):
    answer = planned(CORNER, planner_id, stop_at=[False, True, False, True])
    tip = forward_kinematics(ARM, answer.points.positions)
    first = answer.points.times <= answer.via_times[1]
    assert distance_to_polyline(CORNER[:2], tip[first]).max() <= ON_LINE
    assert ON_LINE < distance_to_polyline(CORNER, tip).max() <= 0.05 + ON_LINE


@each_planner
def test_whole_turns_of_the_first_part_suit_those_that_follow(planner_id):
    # From 2.9 rad on to 3.7: in range from -3.4 rad on. The first part alone would do from 2.9 on.
    limits = turning(-1.2 * np.pi, 1.1 * np.pi)
    alone = planned(around(2.9, 3.3), planner_id, limits)
    assert alone.points.positions[0, 0] == pytest.approx(2.9)
    answer = planned(around(2.9, 3.3, 3.7), planner_id, limits, stop_at=[False, True, True])
    assert answer.points.positions[0, 0] == pytest.approx(2.9 - 2.0 * np.pi)
    assert answer.points.positions[-1, 0] == pytest.approx(3.7 - 2.0 * np.pi)


@each_planner
def test_branch_is_chosen_for_all_parts(planner_id):
    """With the elbow down joint 3 is out of its range in the second part, though not before."""
    wide = replace(FREE, min_position=[-3.0] * 3)

    def joint_3(points, elbow, limits=wide):
        return planned(points, planner_id, limits, elbow=elbow,
                       stop_at=[True] * len(points)).points.positions[:, 2]

    points = CORNER[[1, 2, 0]]  # the last is nearest to the shoulder
    first, most = joint_3(points[:2], 'down').max(), joint_3(points, 'down').max()
    assert joint_3(points, 'up').max() < first < most - 0.01
    tight = replace(wide, max_position=(*FREE.max_position[:2], 0.5 * (most + first)))
    assert joint_3(points[:2], 'down', tight).max() == pytest.approx(first)
    assert joint_3(points, None, tight).max() < first  # up all the way


@each_planner
def test_errors_in_a_later_part_name_the_request_s_via_points(planner_id):
    points = np.vstack((CORNER[:2], [[0.1, 0.7, 0.6], [0.1, -0.7, 0.6]]))
    with pytest.raises((LimitViolationError, UnreachableError), match=(
            r'along the path, between via points 0 and 1 .*'
            r'\(points counted along the path, via points: 2, 3\)$')) as refusal:
        planned(points, planner_id, turning(-2.0, 2.0), stop_at=[False, True, True, True],
                shoulder='front')
    assert refusal.value.via_point in (2, 3)


@each_planner
def test_a_stop_on_joint_axis_1_is_left_in_the_plane_in_which_it_was_reached(planner_id):
    low, high, top = around(0.4)[0], around(1.0)[0], np.array([0.0, 0.0, 1.6])
    limits = turning(-4.0, 4.0)
    request = {'stop_at': [False, True, True], 'shoulder': 'front'}
    back = planned([low, top, low], planner_id, limits, **request)
    assert np.ptp(back.points.positions[:, 0]) < 1e-9
    with pytest.raises(LimitViolationError, match=(
            r'^via point 1: joint_1 is at 0\.4 rad with the tip on joint axis 1 \(singularity\): '
            r'it would need unbounded velocity to reach 1 rad, where the path leaves')) as refusal:
        planned([low, top, high], planner_id, limits, **request)
    assert refusal.value.via_point == 1


@each_planner
def test_via_points_that_are_one_place_are_passed_without_moving(planner_id):
    answer = planned(CORNER[[0, 0, 1, 1]], planner_id, stop_at=[True, True, False, True],
                     dwell=[0.1, 0.2, 0.0, 0.3])
    line = planned(CORNER[:2], planner_id).trajectory.duration
    assert answer.via_times == pytest.approx([0.0, 0.1, 0.3 + line, 0.3 + line], abs=1e-9)
    assert answer.trajectory.duration == pytest.approx(0.6 + line, abs=1e-9)
