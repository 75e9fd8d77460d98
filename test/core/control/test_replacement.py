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

"""Taking over a new trajectory: a smooth command, within limits, on schedule where possible."""

from __future__ import annotations

from dataclasses import replace
from math import inf

from helpers.planning_cases import LIMITS
from helpers.replacement_cases import (
    assert_smooth,
    commands,
    FAST,
    LEAD,
    MOVING,
    NOW,
    NOW_NS,
    positions_only,
    Q,
    replaced,
    REST,
    single,
    smooth_points,
    takeover,
)
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.control.takeover import Takeover
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.core.nanoseconds import nanoseconds
from rrr_traj_planner.core.trajectory.reference_trajectory import reference_through
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints


def test_trajectory_that_begins_at_the_command_is_followed_exactly():
    points = smooth_points(Q)
    motion = replaced(takeover(), points, NOW_NS, LEAD)
    expected = reference_through(points, NOW_NS)
    for t in np.linspace(NOW, NOW + 3.1, 777):
        assert motion(t) == expected(t)


def test_line_that_begins_at_the_command_is_followed_as_a_line():
    points = positions_only((0.0, Q), (2.0, Q + 0.4))
    motion = replaced(takeover(), points, NOW_NS, LEAD)
    np.testing.assert_allclose(motion(NOW + 0.5)[:3], Q + 0.1, atol=1e-12)


def test_first_point_ahead_is_led_into_by_what_it_carries():
    ahead = Q + 0.1
    linear = replaced(takeover(MOVING, FAST), single(ahead, 1.0), NOW_NS, LEAD)
    np.testing.assert_allclose(linear(NOW + 0.5)[:3], Q + 0.05, atol=1e-12)
    known = TrajectoryPoints([1.0], [ahead], *np.zeros((2, 1, 3)), [True], [True])
    quintic = replaced(takeover(MOVING, FAST), known, NOW_NS, LEAD)
    np.testing.assert_allclose(quintic(NOW), MOVING, atol=1e-12)
    np.testing.assert_allclose(quintic(NOW + 1.0 - 1e-12), (*ahead, *(0.0,) * 6), atol=1e-9)
    cubic = replaced(takeover(MOVING, FAST), TrajectoryPoints(
        [1.0], [ahead], *np.zeros((2, 1, 3)), [True], [False]), NOW_NS, LEAD)
    np.testing.assert_allclose(cubic(NOW)[:6], MOVING[:6], atol=1e-12)
    np.testing.assert_allclose(cubic(NOW + 0.5)[:3], 0.5 * (Q + ahead) + np.array(
        MOVING[3:6]) / 8.0, atol=1e-12)  # Hermite's cubic at its middle


@pytest.mark.parametrize('command', [REST, MOVING])
def test_trajectory_elsewhere_is_joined_on_schedule(command):
    points = smooth_points(Q + 0.02)
    motion = replaced(takeover(command), points, NOW_NS, LEAD)
    target = reference_through(points, NOW_NS)
    assert_smooth(command, motion)
    assert motion.end == target.end
    joined = NOW + float(motion.knots[1])
    assert joined < NOW + 2.0
    for t in np.linspace(joined + 1e-6, target.end + 0.1, 200):
        np.testing.assert_allclose(motion(t), target(t), atol=1e-12)


def test_join_is_the_earliest_within_limits():
    points = smooth_points(Q + 0.02)
    motion = replaced(takeover(), points, NOW_NS, LEAD)
    i = len(points.times) - len(motion.knots) + 1  # the point that is joined
    early = TrajectoryPoints(*(getattr(points, f)[i - 1:] for f in (
        'times', 'positions', 'velocities', 'accelerations', 'has_velocity',
        'has_acceleration')))
    earlier = replaced(takeover(limits=FAST), early, NOW_NS, LEAD)  # approached
    _, states = commands(earlier, NOW + float(points.times[i - 1]))
    assert np.abs(states[:, 6:]).max() > 1.0


def test_trajectory_under_way_is_joined_where_it_is_now():
    points = smooth_points(Q)
    motion = replaced(takeover(), points, nanoseconds(NOW - 0.5), LEAD)
    assert_smooth(REST, motion)
    assert motion.end == NOW + 2.5
    assert motion.knots[1] > 0.5


def test_single_point_due_now_is_reached_within_the_limits():
    target = Q + np.array([0.4, -0.3, 0.2])
    for command in (REST, MOVING):
        motion = replaced(takeover(command), single(target, 0.0), NOW_NS, LEAD)
        assert_smooth(command, motion)
        np.testing.assert_allclose(motion(motion.end + 0.1), (*target, *(0.0,) * 6), atol=1e-12)
        assert motion.end - NOW < 4.0


def test_trajectory_out_of_reach_on_schedule_ends_at_its_last_point_late():
    points = positions_only((0.0, Q + 1.0), (0.1, Q + 0.9))
    motion = replaced(takeover(), points, NOW_NS, LEAD)
    assert_smooth(REST, motion)
    assert motion.end > NOW + 0.1
    assert motion(motion.end + 0.1)[:3] == tuple(Q + 0.9)


def test_first_point_within_a_step_is_due_now():
    motion = replaced(takeover(), single(Q + 0.4, 1e-9), NOW_NS, LEAD)
    assert_smooth(REST, motion)


def test_arm_without_limits_still_does_not_jump():
    free = JointLimits(*(np.full(3, x) for x in (-inf, inf, inf, inf, inf, inf)))
    motion = replaced(takeover(limits=free), single(Q + 0.4, 0.0), NOW_NS, LEAD)
    np.testing.assert_allclose(motion(NOW), REST, atol=1e-12)
    assert motion(motion.end + 1.0)[:3] == tuple(Q + 0.4)


def test_random_replacements_never_jump():
    rng = np.random.default_rng(8)
    for _ in range(100):
        command = (*Q, *rng.uniform(-0.8, 0.8, 6))
        points = smooth_points(Q + rng.uniform(-0.3, 0.3, 3), n=31)
        origin_ns = nanoseconds(NOW - rng.uniform(0.0, 2.5))
        motion = replaced(takeover(command), points, origin_ns, LEAD)
        assert_smooth(command, motion)


@pytest.mark.parametrize('offset', [0.03, -0.03])
@pytest.mark.parametrize('lead', [0.0005, 0.02, 0.1, 0.3])
def test_first_point_ahead_that_is_too_far_is_joined_within_the_limits(lead, offset):
    # A quintic from rest to rest over 0.03 rad in 0.1 s takes 5.77 * 0.03 / 0.1^2 = 17 rad/s^2.
    points = smooth_points(Q + offset)
    motion = replaced(takeover(), points, nanoseconds(NOW + lead), LEAD)
    assert_smooth(REST, motion)
    assert motion.end == NOW + lead + 3.0
    np.testing.assert_allclose(motion(motion.end + 0.1)[:3], points.positions[-1], atol=1e-12)


def test_line_with_too_large_a_velocity_step_is_joined_within_the_limits():
    points = positions_only((0.0, Q + 0.03), (1.0, Q + 0.05), (2.0, Q + 0.07))
    # 0.3 rad/s at once, where 0.1 s of 1 rad/s^2 allow 0.1
    motion = replaced(takeover(), points, nanoseconds(NOW + 0.1), LEAD)
    states = commands(motion, NOW + 1.1)[1]
    assert np.abs(np.diff(states[:, 3:6], axis=0)).max() <= 1e-3 * 1.001
    np.testing.assert_allclose(motion(NOW + 2.0)[:3], Q + 0.068, atol=1e-12)


def test_single_point_ahead_that_is_too_far_is_reached_late():
    known = TrajectoryPoints([0.1], [Q + 0.1], *np.zeros((2, 1, 3)), [True], [True])
    motion = replaced(takeover(), known, NOW_NS, LEAD)
    assert_smooth(REST, motion)
    # from rest to rest: sqrt(5.77 * 0.1 / 1), and at most the next time that is tried
    assert 0.7598 <= motion.end - NOW <= 0.7598 * 1.15
    np.testing.assert_allclose(motion(motion.end + 0.1)[:3], Q + 0.1, atol=1e-12)


def test_stream_of_moving_points_is_followed_within_the_limits():
    leader, command = Q.copy(), REST
    for step in range(150):  # 100 Hz, 0.3 rad/s from the first message on
        now = NOW + 0.01 * step
        leader = Q + 0.3 * 0.01 * step
        point = TrajectoryPoints(
            [0.05], [leader + 0.3 * 0.05], [np.full(3, 0.3)], np.zeros((1, 3)), [True], [True])
        motion = replaced(Takeover(now, command, LIMITS, RobotModel()), point, nanoseconds(now),
                          LEAD)
        command = motion(now + 0.01)
        assert np.abs(command[6:]).max() <= 1.0 + 1e-6
        assert np.abs(command[3:6]).max() <= 1.0 + 1e-6
    np.testing.assert_allclose(command[:3], leader + 0.003, atol=1e-4)
    np.testing.assert_allclose(command[3:6], 0.3, atol=1e-3)


def test_join_is_within_torque_limits_where_acceleration_has_none():
    limits = replace(LIMITS, max_acceleration=np.full(3, inf),
                     max_effort=np.array([150.0, 200.0, 200.0]))
    motion = replaced(takeover(limits=limits), smooth_points(Q + 0.1), NOW_NS, LEAD)
    states = commands(motion, NOW + float(motion.knots[1]))[1]
    torque = np.abs(inverse_dynamics(RobotModel(), *np.hsplit(states, 3)))
    assert (torque <= limits.max_effort * 1.001).all()
