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

"""The start of a goal: what keeps the arm from its first point; points that are missed."""

from __future__ import annotations

from dataclasses import replace
import re

from helpers.planning_cases import LIMITS
from helpers.replacement_cases import (
    FAST,
    LEAD,
    MOVING,
    NOW,
    NOW_NS,
    positions_only,
    Q,
    single,
    smooth_points,
    takeover,
)
import numpy as np
import pytest
from rrr_traj_planner.core.control.replacement import Missed, replacement
from rrr_traj_planner.core.control.takeover import Takeover
from rrr_traj_planner.core.control.trajectory_start import START_TOLERANCE, unmet_start
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.core.nanoseconds import nanoseconds
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints

QUINTIC, CUBIC = 10.0 / np.sqrt(3.0), 6.0  # peak acceleration of rest to rest, times d / T^2


def at_rest(q, time, acceleration=True):
    """Return a point at rest."""
    return TrajectoryPoints([time], [q], *np.zeros((2, 1, 3)), [True], [acceleration])


def numbers(text):
    """Return value and limit in a sentence about joint_1."""
    found = re.search(r'joint_1 \D*([\d.]+) rad/s\^2[^,]*, limit ([\d.]+) ', text)
    return [float(x) for x in found.groups()]


@pytest.mark.parametrize(('acceleration', 'factor'), [(True, QUINTIC), (False, CUBIC)])
def test_excess_of_acceleration_on_the_way_is_told(acceleration, factor):
    # 0.03 rad in 0.2 s: at most 1.875 * 0.15 = 0.28 rad/s, so acceleration is exceeded alone
    q = Q + (0.03, 0.0, 0.0)
    text = unmet_start(takeover(), at_rest(q, 0.2, acceleration), NOW_NS, LEAD)
    assert text.startswith('The first point cannot be reached in time, it is due in 0.200 s: ')
    assert numbers(text) == pytest.approx([factor * 0.03 / 0.04, 1.0], rel=1e-5)
    assert 'joint_2' not in text and 'rad/s,' not in text
    assert unmet_start(takeover(limits=FAST), at_rest(q, 0.2, acceleration), NOW_NS, LEAD) == ''


def test_excess_of_velocity_by_a_line_is_told():
    text = unmet_start(takeover(), single(Q + (0.0, 0.0, -0.4), 0.1), NOW_NS, LEAD)
    assert text.endswith(': joint_3 reaches 4 rad/s, limit 1 rad/s')


def test_step_of_velocity_to_several_lines_is_told():
    points = positions_only((0.1, Q + (0.03, 0.0, 0.0)), (1.0, Q + 0.05))
    text = unmet_start(takeover(), points, NOW_NS, LEAD)  # 0.3 rad/s in 0.1 s
    assert numbers(text) == pytest.approx([3.0, 1.0])


def test_excess_of_torque_is_told():
    q, qd = np.array(Q), np.zeros(3)
    hold = np.abs(inverse_dynamics(takeover().model, q, qd, qd))
    limits = replace(FAST, max_effort=hold + 1.0)
    text = unmet_start(takeover(limits=limits), at_rest(q + (0.0, 0.05, 0.0), 0.2), NOW_NS, LEAD)
    found = re.search(r'joint_2 needs ([\d.]+) N m, limit ([\d.]+) N m', text)
    value, limit = map(float, found.groups())
    assert limit == pytest.approx(hold[1] + 1.0, rel=1e-5)
    peak = inverse_dynamics(
        takeover().model, q, qd, np.array([0.0, QUINTIC * 0.05 / 0.04, 0.0]))[1]
    assert value == pytest.approx(abs(peak), rel=0.05)  # which is reached on the way


@pytest.mark.parametrize('lead', [0.0, 0.0005])
def test_first_point_that_is_due_now_elsewhere_is_told(lead):
    start = nanoseconds(NOW + lead)
    text = unmet_start(takeover(), smooth_points(Q + (0.0, 0.02, 0.0)), start, LEAD)
    assert text == (
        'joint_2 is commanded 1 rad, the first point, which is due now, has 1.02 rad (they may '
        'differ by 0.01 rad; a point that is due later is moved to)')
    near = smooth_points(Q + 0.9 * START_TOLERANCE)
    assert unmet_start(takeover(), near, start, LEAD) == ''
    assert unmet_start(takeover(), single(Q + 0.4, lead), NOW_NS, LEAD).startswith(
        'joint_1 is commanded 0.5 rad, the first point, which is due now, has 0.9 rad')


def test_first_point_that_is_due_now_with_another_velocity_is_told():
    assert 'joint_3 is commanded 0.5 rad/s, the first point, which is due now, has 0 rad/s' in (
        unmet_start(takeover(MOVING), smooth_points(Q), NOW_NS, LEAD))
    line = positions_only((0.0, Q), (2.0, Q + 0.4))
    assert unmet_start(takeover(MOVING), line, NOW_NS, LEAD) == ''


def test_trajectory_under_way_may_begin_anywhere():
    points = smooth_points(Q + 0.3)
    assert unmet_start(takeover(), points, NOW_NS, LEAD) != ''
    assert unmet_start(takeover(), points, NOW_NS - 1, LEAD) == ''


def test_random_starts_that_are_not_complained_of_miss_no_point():
    rng = np.random.default_rng(5)
    refused = 0
    for _ in range(200):
        points = smooth_points(Q + rng.uniform(-0.1, 0.1, 3), n=31)
        start = nanoseconds(NOW + rng.uniform(0.01, 1.0))
        command = (*Q, *rng.uniform(-0.2, 0.2, 6))
        now = Takeover(NOW, command, LIMITS, takeover().model)
        text = unmet_start(now, points, start, LEAD)
        found = replacement(now, points, start, LEAD)
        assert (text == '') is (found.missed == Missed())
        assert text == '' or 'joint_' in text
        refused += text != ''
    assert 20 < refused < 180


def test_missed_points_are_counted():
    points = smooth_points(Q + 0.02)
    found = replacement(takeover(), points, NOW_NS, LEAD)
    joined = len(points.times) - len(found.motion.knots) + 2  # beginning with 1
    assert found.missed == Missed(joined - 1, (
        f'{joined - 1} points are missed: point {joined} of 301 is the first that can be reached '
        'in time'))
    under_way = replacement(takeover(), points, nanoseconds(NOW - 1.0), LEAD)
    joined = len(points.times) - len(under_way.motion.knots) + 2
    assert under_way.missed.points == joined - 1 - 100  # 100 points had passed
    assert replacement(takeover(), smooth_points(Q), NOW_NS, LEAD).missed == Missed()


def test_last_point_that_is_late_is_told():
    found = replacement(takeover(), single(Q + 0.4, 0.0), NOW_NS, LEAD)
    late = found.motion.end - NOW
    assert found.missed == Missed(0, f'the last point is reached {late:.3f} s late')
    two = replacement(takeover(), positions_only((0.0, Q + 1.0), (0.1, Q + 0.9)), NOW_NS, LEAD)
    assert two.missed.points == 1
    assert two.missed.text.startswith('1 point is missed, the last point is reached ')
