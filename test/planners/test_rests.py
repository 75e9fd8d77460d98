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

"""Where and how long the arm rests, and what is refused."""

from math import inf, nan

import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.planners.request import PlanningRequest
from rrr_traj_planner.planners.rests import rests_at_via_points

POINTS = [[1.0, 0.6, 1.0], [0.5, 0.5, 1.4], [0.45, 0.4, 1.4]]
START = [0.5, 1.0, 0.2]


def rests(stop_at=None, dwell=None, started=False):
    at, seconds = rests_at_via_points(stop_at, dwell, 3, started)
    return at.tolist(), seconds.tolist()


def test_arm_rests_at_both_ends_and_where_it_is_to_stop():
    assert rests() == ([True, False, True], [0.0, 0.0, 0.0])
    assert rests(started=True) == ([False, False, True], [0.0, 0.0, 0.0])
    assert rests([False, True, True], started=True)[0] == [False, True, True]
    assert rests([False, True, True])[0] == [True, True, True]  # it starts there, at rest


def test_dwell_is_taken_wherever_the_arm_rests():
    assert rests(None, [0.5, 0.0, 2])[1] == [0.5, 0.0, 2.0]
    assert rests([True, True, True], [0.1, 0.2, 0.3], started=True)[1] == [0.1, 0.2, 0.3]


@pytest.mark.parametrize(('stop_at', 'dwell', 'started', 'message', 'via_point'), [
    ([True], None, False, r'^stop_at has 1 value for 3 via points, must have one for each', -1),
    ([], None, False, r'^stop_at has 0 values for 3 via points, must have one for each', -1),
    (None, [0.0] * 4, False, r'^dwell has 4 values for 3 via points, must have one for each', -1),
    ([1, 0, 1], None, False, r'^stop_at is \[1, 0, 1\], must be truth values$', -1),
    ([True, True, False], None, False, (
        r'^stop_at\[2\] is false, must be true: the motion ends at the last via point, at r'), 2),
    (None, [0.0, 0.0, -0.5], False, (
        r'^dwell\[2\] is -0\.5 s, must be 0, or finite and at least 1e-06 s$'), 2),
    (None, [nan, 0.0, 0.0], False, r'^dwell\[0\] is nan s, must be 0, or finite and at ', 0),
    (None, [0.0, 0.0, inf], False, r'^dwell\[2\] is inf s, must be 0, or finite and at ', 2),
    (None, [0.0, 0.0, 1e-9], False, r'^dwell\[2\] is 1e-09 s, must be 0, or finite and ', 2),
    (None, [0.0, 0.5, 0.0], False, (
        r'^dwell\[1\] is 0\.5 s, but the arm does not stop at via point 1: stop_at must be'), 1),
    ([False, True, True], [0.5, 0.0, 0.0], True, r'^dwell\[0\] is 0\.5 s, but the arm does', 0)])
def test_what_is_no_rest_is_refused(stop_at, dwell, started, message, via_point):
    with pytest.raises(InvalidInputError, match=message) as refusal:
        PlanningRequest(POINTS, stop_at=stop_at, dwell=dwell, start=START if started else None)
    assert refusal.value.via_point == via_point


def test_rests_that_take_too_many_points_are_refused_before_anything_is_planned():
    with pytest.raises(InvalidInputError, match=(
            r'^a motion of 3000 s with a point every 0\.01 s has more than 200000 points$')):
        PlanningRequest(POINTS, dwell=[1000.0, 0.0, 2000.0])


def test_a_request_keeps_what_it_is_given_when_its_start_changes():
    request = PlanningRequest(POINTS, stop_at=[False, True, True])
    assert request.rest_points.tolist() == [0, 1, 2]
    started = PlanningRequest(POINTS, stop_at=request.stop_at, start=START)
    assert started.rests.at.tolist() == [False, True, True]
    assert started.rest_points.tolist() == [0, 2, 3]
    with pytest.raises(ValueError, match='read-only'):
        request.stop_at[0] = True


@pytest.mark.parametrize(('points', 'message'), [
    ({}, '^via_points or joint_via_points must be given$'),
    ({'via_points': POINTS, 'joint_via_points': POINTS},
     '^via_points and joint_via_points are both given, must be one of the two$'),
    ({'joint_via_points': [[0.1, 0.2]]}, '^joint_via_points has shape'),
    ({'joint_via_points': [[0.1, 0.2, nan]] * 2}, r'^joint_via_points\[0\]\[2\] is nan, must be'),
    ({'joint_via_points': [[0.1, 1.2, 0.3]]}, '^1 via point given, at least 2 needed$'),
    ({'joint_via_points': [[0.1, 1.2, 0.3]] * 2, 'elbow': 'up'},
     r"^elbow is 'up', must be None: joint_via_points have postures of their own$"),
    ({'joint_via_points': [[0.1, 1.2, 0.3]] * 2, 'shoulder': 'back'},
     r"^shoulder is 'back', must be None: joint_via_points have postures of their own$")])
def test_via_points_are_given_in_one_way(points, message):
    with pytest.raises(InvalidInputError, match=message):
        PlanningRequest(**points)


def test_joint_via_points_are_counted_as_via_points_are():
    request = PlanningRequest(joint_via_points=np.zeros((3, 3)), start=START)
    assert (request.number, request.segments) == (3, 3)
