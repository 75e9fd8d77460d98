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

"""The goal for a plan: from the first via point, from elsewhere, and from an arm that moves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.inverse import nearest_solution
from rrr_traj_planner.nodes.point_files.reading import read_task
from rrr_traj_planner.nodes.studio.goals import goal_of
from rrr_traj_planner.nodes.studio.planned import Planned
from rrr_traj_planner.nodes.studio.wanted import wanted_of

MODEL = RobotModel()
WANTED = wanted_of(read_task('pick_and_place.yaml'), MODEL, 'base_link', 'cycloid')
JOINTS = np.array([nearest_solution(MODEL, p, (0.5, 1.0, 0.2)) for p in WANTED.points])
PLAN = Planned('time_optimal', 1.0, 0.0, '', np.zeros((2, 3)), np.zeros(1), np.arange(2.0),
               np.zeros((2, 3)), JOINTS, ())
STOPS, DWELL = WANTED.task.stop_at.tolist(), WANTED.task.dwell.tolist()


def joints_of(goal):
    return np.array([point.positions for point in goal.joint_via_points])


def test_arm_at_the_first_point_goes_on_from_there_in_the_plan_s_postures():
    dwell = [0.0, *DWELL[1:]]
    wanted = replace(WANTED, task=replace(WANTED.task, dwell=np.array(dwell)))
    goal = goal_of(wanted, PLAN, MODEL, JOINTS[0] + 0.001, moves=False)
    np.testing.assert_array_equal(joints_of(goal), JOINTS[1:])
    assert (list(goal.stop_at), list(goal.dwell)) == (STOPS[1:], DWELL[1:])
    assert (goal.planner_id, len(goal.via_points.poses)) == ('time_optimal', 0)


def test_rest_at_the_first_point_is_kept():
    wanted = replace(WANTED, task=replace(WANTED.task, dwell=np.array([0.5, *DWELL[1:]])))
    goal = goal_of(wanted, PLAN, MODEL, JOINTS[0] + 0.001, moves=False)
    np.testing.assert_array_equal(joints_of(goal), JOINTS)
    assert (list(goal.stop_at), list(goal.dwell)) == ([True, *STOPS[1:]], [0.5, *DWELL[1:]])


def test_arm_that_is_elsewhere_stops_at_the_first_point():
    goal = goal_of(WANTED, PLAN, MODEL, JOINTS[0] + 0.1, moves=False)
    np.testing.assert_array_equal(joints_of(goal), JOINTS)
    assert (list(goal.stop_at), list(goal.dwell)) == ([True, *STOPS[1:]], DWELL)


def test_arm_that_moves_is_taken_over_by_the_server_s_choice():
    goal = goal_of(WANTED, PLAN, MODEL, JOINTS[0], moves=True)
    assert goal.planner_id == '' and len(goal.joint_via_points) == len(JOINTS)


def test_plan_that_misses_its_points_is_asked_for_by_positions_of_the_tip():
    missing = replace(PLAN, via_joints=JOINTS + 0.01)
    goal = goal_of(WANTED, missing, MODEL, JOINTS[0] + 0.1, moves=False)
    assert len(goal.joint_via_points) == 0
    places = [(p.position.x, p.position.y, p.position.z) for p in goal.via_points.poses]
    np.testing.assert_array_equal(places, WANTED.points)


LIMITS = (np.ones(3), np.ones(3), np.full(3, 10.0))
TIMED = replace(PLAN, planner_id='cycloid', peaks=tuple(
    (name, 0.0 * limits, limits) for name, limits in zip('vaj', LIMITS)))
TIMES = np.array((2.0, 2.0, 4.0, 2.0, 2.0))


def timed(planner_id):
    return replace(WANTED, task=replace(
        WANTED.task, planner_id=planner_id, segment_durations=TIMES))


def test_times_are_those_of_the_plan_and_the_way_to_its_start_is_slow_enough():
    at_start = goal_of(timed('cycloid'), TIMED, MODEL, JOINTS[0], moves=False)
    assert list(at_start.segment_durations) == TIMES.tolist()
    goal = goal_of(timed('cycloid'), TIMED, MODEL, JOINTS[0] + (0.0, 0.2, 0.1), moves=False)
    way, *others = goal.segment_durations
    assert others == TIMES.tolist()
    # a cycloid's peaks are 2 d / T, 2 pi d / T^2 and 4 pi^2 d / T^3; the limits 1, 1 and 10
    assert max(0.4 / way, 0.4 * np.pi / way ** 2, 0.8 * np.pi ** 2 / way ** 3 / 10.0) < 0.5


@pytest.mark.parametrize(('planner_id', 'moves'), [('time_optimal', False), ('cycloid', True)])
def test_time_of_the_way_is_the_planner_s_choice_where_it_can_choose(planner_id, moves):
    goal = goal_of(timed(planner_id), TIMED, MODEL, JOINTS[0] + 0.2, moves=moves)
    assert np.isnan(goal.segment_durations[0])
    assert list(goal.segment_durations)[1:] == TIMES.tolist()


def test_posture_is_asked_for_only_where_joint_positions_do_not_say_it():
    wanted = replace(WANTED, elbow='up', shoulder='front', max_deviation=0.02)
    goal = goal_of(wanted, PLAN, MODEL, JOINTS[0], moves=False)
    assert (goal.elbow, goal.shoulder, goal.max_deviation) == ('', '', 0.0)
    along = goal_of(wanted.with_planner('line_arc'), PLAN, MODEL, JOINTS[0], moves=False)
    assert along.max_deviation == 0.02
    missing = replace(PLAN, via_joints=JOINTS + 0.01)
    goal = goal_of(wanted, missing, MODEL, JOINTS[0] + 0.1, moves=False)
    assert (goal.elbow, goal.shoulder) == ('up', 'front')


@pytest.mark.parametrize('stop_at', [(), (False,) * 5 + (True,)])
def test_scalings_and_stops_are_those_of_the_plan(stop_at):
    wanted = replace(WANTED, task=replace(
        WANTED.task, stop_at=np.array(stop_at, dtype=bool), dwell=np.zeros(0)))
    goal = goal_of(wanted.with_scalings(0.5, 0.25), PLAN, MODEL, JOINTS[0], moves=False)
    assert (goal.max_velocity_scaling_factor, goal.max_acceleration_scaling_factor) == (0.5, 0.25)
    assert list(goal.stop_at) == [False] * 4 + [True] and list(goal.dwell) == []
