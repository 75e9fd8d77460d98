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

"""Taking over a new trajectory: no joint leaves its range."""

from __future__ import annotations

from dataclasses import replace
from math import inf

from helpers.planning_cases import LIMITS
from helpers.replacement_cases import (
    commands,
    LEAD,
    MOVING,
    NOW_NS,
    Q,
    replaced,
    REST,
    single,
    takeover,
)
import numpy as np
import pytest
from rrr_traj_planner.core.control.replacement import replacement
from rrr_traj_planner.core.nanoseconds import nanoseconds
from rrr_traj_planner.core.trajectory.reference_trajectory import ReferenceTrajectory
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints


def turning_points(motion):
    """Return where joint 1 turns back, and the ends of each polynomial, (n,) [rad]."""
    found = []
    for c, T in zip(motion.coefficients[:, 0], np.diff(motion.knots)):
        p = np.polynomial.Polynomial(c)
        found += [p(x.real) for x in p.deriv().roots() if 0.0 < x.real < T and abs(x.imag) < 1e-9]
        found += [p(0.0), p(T)]
    return np.array(found)


def down_and_up(end, stroke, duration, n=201):
    """Return points on which joint 1 goes to an end of its range and turns back there."""
    t, w = np.linspace(0.0, duration, n), 2.0 * np.pi / duration
    first = (end + 0.5 * stroke * (1.0 + np.cos(w * t)), -0.5 * stroke * w * np.sin(w * t),
             -0.5 * stroke * w ** 2 * np.cos(w * t))
    states = np.tile(np.array([(0.0, 1.0, 0.2), (0.0,) * 3, (0.0,) * 3])[:, np.newaxis], (1, n, 1))
    states[..., 0] = first
    return TrajectoryPoints(t, *states, np.full(n, True), np.full(n, True))


@pytest.mark.parametrize('end', [0.0, np.pi / 2])
def test_no_join_leaves_a_range_between_samples(end):
    inward = 1.0 if end == 0.0 else -1.0
    joined = 0
    for seed in range(40):
        rng = np.random.default_rng(seed)
        stroke, duration, away, late = rng.uniform([0.01, 1.0, 0.0, 0.0], [0.3, 4.0, 0.1, 0.5])
        command = (end + inward * away, 1.0 + rng.uniform(-0.5, 0.5), 0.2, *(0.0,) * 6)
        motion = replaced(takeover(command), down_and_up(end, inward * stroke, duration),
                          NOW_NS - nanoseconds(late * duration), LEAD)
        if isinstance(motion, ReferenceTrajectory):
            joined += 1
            first = ReferenceTrajectory(
                motion.knots[:2], motion.coefficients[:1], motion.final, motion.origin_ns)
            assert (inward * (turning_points(first) - end)).min() >= -3e-6
    assert joined > 30


def test_trajectory_out_of_reach_is_replaced_by_its_end_without_leaving_a_range():
    # joint_1 is 0.02 rad before its end and needs 0.02 to stop: no quintic leads back in time
    command = (0.02, 1.0, 0.2, -0.2, *(0.0,) * 5)
    limits = replace(LIMITS, max_jerk=np.full(3, inf))
    motion = replaced(takeover(command, limits), single((0.01, 1.0, 0.2), 0.0), NOW_NS, LEAD)
    states = commands(motion, motion.end + 0.1)[1]
    assert states[:, 0].min() >= -1e-9
    assert np.abs(states[:, 6:]).max() <= 1.0 + 1e-6
    np.testing.assert_allclose(states[-1, :3], (0.01, 1.0, 0.2), atol=1e-12)


@pytest.mark.parametrize(('q', 'text'), [
    ((-0.3, 0.9, 0.2), 'end with joint_1 at -0.3 rad, range [0, 1.5708] rad: holding position'),
    ((0.5, 0.9, 90.0), 'end with joint_3 at 90 rad, range [-3.14159, 6.28319] rad (in '
                       'degrees?): holding position'),
    ((0.5, 3.2, 0.2), 'end with joint_2 at 3.2 rad, range [0, 3.14159] rad: holding position')])
@pytest.mark.parametrize('command', [REST, MOVING])
def test_motion_of_our_own_does_not_end_outside_a_range(command, q, text):
    found = replacement(takeover(command), single(q, 0.1), NOW_NS, LEAD)
    assert text in ' '.join(found.warnings)
    assert found.holds
    _, states = commands(found.motion, found.motion.end + 0.1)
    assert (states[:, :3] >= LIMITS.min_position).all()
    assert (states[:, :3] <= LIMITS.max_position).all()
    assert not states[-1, 3:].any()


def test_last_point_rounded_to_four_digits_is_inside():
    found = replacement(takeover(), single((1.5708, 1.0, 0.2), 0.1), NOW_NS, LEAD)
    assert found.motion.final[0] == 1.5708 and not found.warnings


@pytest.mark.parametrize(('joint', 'end'), [(0, 0.0), (0, np.pi / 2), (2, -np.pi), (1, np.pi)])
@pytest.mark.parametrize('before', [0.0, 0.02, 0.3])
@pytest.mark.parametrize('velocity', [0.2, 0.9])
def test_no_joint_leaves_a_range_for_a_point_that_is_reached_late(joint, end, before, velocity):
    side = np.sign(end - Q[joint])
    command = np.array(REST)
    command[joint] = end - side * (before + 0.3)
    q, qd = command[:3].copy(), np.zeros(3)
    q[joint], qd[joint] = end - side * before, side * velocity
    # 0.3 rad in 0.1 s is too much; meanwhile the point would be so much further
    found = replacement(takeover(tuple(command.tolist())), TrajectoryPoints(
        [0.1], [q], [qd], np.zeros((1, 3)), [True], [True]), NOW_NS, LEAD)
    motion = found.motion
    states = commands(motion, motion.end + 0.1)[1]
    assert (side * (states[:, joint] - end)).max() <= 1e-4
    arrived = motion.final[joint] + 0.5 * motion.final_velocity[joint] * velocity  # v^2 / 2 A on
    assert side * (arrived - end) <= 1e-4
    assert not found.warnings and not found.holds
