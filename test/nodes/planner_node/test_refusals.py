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

"""Refusals of plan requests by the script `planner`: their codes and messages."""

from __future__ import annotations

from math import inf, nan, pi
import re

from helpers.plan_answers import ROUNDING
from helpers.plan_requests import (
    assert_refused,
    is_refused,
    NAMES,
    plan_request,
    START,
    TABLE_6_1,
    TABLE_6_3,
)
import numpy as np
import pytest
from rrr_traj_planner_interfaces.srv import PlanTrajectory

CODES = PlanTrajectory.Response
INVALID, BAD_START = CODES.INVALID_GOAL_CONSTRAINTS, CODES.START_STATE_INVALID


@pytest.mark.parametrize(('points', 'text', 'via_point'), [
    (TABLE_6_3, 'via point 2: joint_2 needs 218.9 N m to hold, limit 200 N m', 2),
    ((TABLE_6_1[0], (1.0, -0.5, 0.9)), 'via point 1: joint_1 would be at -0.463648 rad (elbow '
     'up, shoulder front), limits 0 to 1.5708 rad', 1)])
def test_refusal_names_the_via_point_beyond_a_limit(ask, points, text, via_point):
    assert_refused(ask, plan_request(points), CODES.GOAL_CONSTRAINTS_VIOLATED, text, via_point)


@pytest.mark.parametrize(('point', 'text'), [
    ((3.0, 0.0, 0.5), "via point 1: (3, 0, 0.5) m is out of the arm's reach: it misses by 1.4 m"),
    ((0.05, 0.0, 0.5), "(0.05, 0, 0.5) m is out of the arm's reach: it misses by 0.15 m")])
def test_refusal_names_the_via_point_out_of_reach_and_its_distance(ask, point, text):
    assert_refused(ask, plan_request((TABLE_6_1[0], point)), CODES.NO_IK_SOLUTION, text, 1)


@pytest.mark.parametrize('planner_id', ['cycloid', 'cycloid_approach_a'])
@pytest.mark.parametrize('durations', [(0.1, 2.0), (1.0, 0.9)])
def test_short_durations_are_refused_with_feasible_ones(ask, planner_id, durations):
    request = plan_request(segment_durations=list(durations), planner_id=planner_id)
    refused = ask(request)
    is_refused(refused, CODES.PLANNING_FAILED, 'the least feasible')
    *_, offered = re.findall(r'\[([^]]+)\] s', refused.message)
    request.segment_durations = [float(d) for d in offered.split(',')]
    assert all(b >= a for a, b in zip(durations, request.segment_durations))
    response = ask(request)
    assert response.error_code == CODES.SUCCESS, response.message
    np.testing.assert_allclose(
        np.diff(response.via_times), request.segment_durations, atol=ROUNDING)


@pytest.mark.parametrize(('fields', 'text'), [
    ({'points': ()}, '0 via points given, at least 2 needed'),
    ({'points': TABLE_6_1[:1]}, '1 via point given, at least 2 needed'),
    ({'points': (), 'start': START}, '0 via points given, at least 1 needed'),
    ({'segment_durations': [1.0]}, '1 segment_durations given for 2 segments'),
    ({'segment_durations': [3.0, 3.0], 'start': START},
     '2 segment_durations given for 3 segments'),
    ({'segment_durations': [-1.0, 3.0]},
     'segment_durations[0] is -1.0 s, must be finite and at least 1e-09 s'),
    ({'segment_durations': [3.0, 0.0]},
     'segment_durations[1] is 0.0 s, must be finite and at least 1e-09 s'),
    ({'segment_durations': [nan, 3.0]},
     'segment_durations[0] is nan: planner cycloid takes every duration or none'),
    ({'segment_durations': [3.0, inf]},
     'segment_durations[1] is inf s, must be finite and at least 1e-09 s'),
    *(({f'max_{kind}_scaling_factor': value},
       f'max_{kind}_scaling_factor is {value}, must be in (0, 1]')
      for kind in ('velocity', 'acceleration') for value in (1.5, -1.0, nan, inf)),
    ({'sample_period': -0.01}, 'sample_period is -0.01 s, must be 0 or in [0.0001, 10] s'),
    ({'sample_period': 1e-5}, 'sample_period is 1e-05 s, must be 0 or in [0.0001, 10] s'),
    ({'sample_period': nan}, 'sample_period is nan s'),
    ({'sample_period': inf}, 'sample_period is inf s, must be 0 or in [0.0001, 10] s'),
    ({'sample_period': 1e3}, 'sample_period is 1000 s, must be 0 or in [0.0001, 10] s'),
    ({'max_deviation': -0.1}, 'max_deviation is -0.1 m, must be 0 or in [1e-06, 100] m'),
    ({'max_deviation': 5e-324}, 'max_deviation is 4.94066e-324 m, must be 0 or in'),
    ({'max_deviation': nan}, 'max_deviation is nan m'),
    ({'max_deviation': inf}, 'max_deviation is inf m'),
    ({'elbow': 'left'}, "elbow is 'left', must be 'up', 'down' or empty"),
    ({'planner_id': 'magic'}, "planner_id 'magic' is unknown, known are "),
    ({'planner_id': 'magic'}, 'cycloid, cycloid_approach_a')])
def test_malformed_request_is_refused(ask, fields, text):
    assert_refused(ask, plan_request(**fields), INVALID, text)


@pytest.mark.parametrize('value', [nan, inf, -inf])
def test_refusal_names_the_via_point_that_is_not_finite(ask, value):
    request = plan_request()
    request.via_points.poses[1].position.y = value
    assert_refused(ask, request, INVALID, f'via point 1: position is (0.46, {value}, 1.44) m, '
                   'must be finite', 1)


def test_refusal_names_the_via_point_with_an_orientation_that_is_not_finite(ask):
    request = plan_request()
    request.via_points.poses[2].orientation.x = nan
    assert_refused(ask, request, INVALID, 'via point 2: orientation is (nan, 0.0, 0.0, 1.0), '
                   'must be finite', 2)


@pytest.mark.parametrize(('start', 'text'), [
    ({'name': NAMES[:2], 'position': START[:2]},
     'start state names joint_3 0 times, must name each of joint_1, joint_2, joint_3 once'),
    ({'name': [*NAMES, 'joint_2'], 'position': [*START, 1.0]},
     'start state names joint_2 2 times'),
    ({'name': [], 'position': START}, 'start state names joint_1 0 times'),
    ({'position': []}, 'start state has 3 names, 0 positions and 0 velocities'),
    ({'position': START[:2]}, 'start state has 3 names, 2 positions and 0 velocities'),
    ({'position': START, 'velocity': [0.0]},
     'start state has 3 names, 3 positions and 1 velocity'),
    ({'position': [0.5, nan, 0.2]}, 'start state: joint_2 is at nan rad, must be finite'),
    ({'position': [0.5, 0.9, inf]}, 'start state: joint_3 is at inf rad, must be finite'),
    ({'position': [-0.1, 0.9, 0.2]},
     'start state: joint_1 is at -0.1 rad, limits 0 to 1.5708 rad'),
    # stretched out: 9.81 (16 * 0.5 + 12 (0.9 + 0.5))
    ({'position': [0.5, 0.0, pi / 2]},
     'start state: joint_2 needs 243.3 N m to hold, limit 200 N m'),
    ({'position': START, 'velocity': [0.0, 0.0, -0.5]},
     'start state: joint_3 moves at -0.5 rad/s, must be at rest'),
    ({'position': START, 'velocity': [0.0, nan, 0.0]}, 'start state: joint_2 moves at nan')])
def test_wrong_start_state_is_refused(ask, start, text):
    assert_refused(ask, plan_request(start=start), BAD_START, text)
