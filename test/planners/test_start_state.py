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

"""Motions that begin where the arm is: its posture, its turns, and noise at the ends of ranges."""

from dataclasses import replace
import re

import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import JointRangeError, RrrPlannerError, StartStateError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.postures import ELBOWS, Posture, posture_of, SHOULDERS
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.registry import planner_ids
from rrr_traj_planner.planners.request import PlanningRequest

ARM, LIMITS = RobotModel(), JointLimits()
CARTESIAN = ('line_arc', 'line_polynomial')
BEHIND = np.array([0.5, 2.2, 0.3])  # the tip is 0.96 m behind joint axis 1
STRONG = np.full(3, np.inf)


def turning(low, high, base=LIMITS):
    """Return limits with a range of joint 1."""
    return replace(base, min_position=(low, *base.min_position[1:]),
                   max_position=(high, *base.max_position[1:]))


def tip(*q):
    return forward_kinematics(ARM, np.array(q, dtype=float))


def planned(limits, points, **request):
    return plan(ARM, limits, PlanningRequest(points, **request))


def around(*azimuths):
    return [(0.8 * np.cos(a), 0.8 * np.sin(a), 1.0) for a in azimuths]


@pytest.mark.parametrize('planner_id', planner_ids())
def test_a_start_over_the_shoulder_moves_its_tip_by_5_mm_without_turning(planner_id):
    answer = planned(turning(-np.pi, np.pi), [tip(*BEHIND) + (0.0, 0.0, 0.005)], start=BEHIND,
                     planner_id=planner_id)
    q = answer.points.positions
    assert q[0] == pytest.approx(BEHIND, abs=1e-9)
    assert forward_kinematics(ARM, q[-1]) == pytest.approx(
        tip(*BEHIND) + (0.0, 0.0, 0.005), abs=1e-9)
    assert np.abs(q - BEHIND).max() < 0.02
    assert np.ptp(q[:, 0]) < 1e-6


RANGES = [([-np.pi, 0.0, -np.pi], [np.pi, np.pi, 2.0 * np.pi]),
          ([-1.5 * np.pi] * 3, [1.5 * np.pi] * 3), ([-2.0 * np.pi] * 3, [2.0 * np.pi] * 3)]


@pytest.mark.parametrize('planner_id', planner_ids())
def test_motions_from_random_starts_begin_there_or_are_refused(planner_id):
    rng, answers = np.random.default_rng(len(planner_id)), 0
    for k in range(6):
        limits = JointLimits(*RANGES[k % 3], max_effort=STRONG)
        start = rng.uniform(limits.min_position, limits.max_position)
        points = [forward_kinematics(ARM, start) + rng.normal(size=3) * 0.05]
        try:
            answer = planned(limits, points, start=start, planner_id=planner_id)
        except RrrPlannerError:
            continue
        answers += 1
        q = answer.points.positions
        assert q[0].tolist() == start.tolist()
        assert (q >= limits.min_position - 1e-9).all()
        assert (q <= limits.max_position + 1e-9).all()
        assert forward_kinematics(ARM, q[-1]) == pytest.approx(points[-1], abs=1e-8)
    assert answers >= 2


@pytest.mark.parametrize('planner_id', CARTESIAN)
def test_a_path_in_range_only_on_another_turn_of_joint_1_is_refused(planner_id):
    # From 2.9 rad on to 3.7: in range from -3.4 rad on, but that is not where the arm is.
    limits = turning(-1.2 * np.pi, 1.1 * np.pi, replace(LIMITS, max_effort=STRONG))
    points = around(2.9, 3.3, 3.7)
    answer = planned(limits, points, planner_id=planner_id)
    assert answer.points.positions[0, 0] == pytest.approx(2.9 - 2.0 * np.pi)
    start = answer.points.positions[0] + (2.0 * np.pi, 0.0, 0.0)
    with pytest.raises(JointRangeError, match=r'joint_1 would be at 3\.[67]\d* rad'):
        planned(limits, points[1:], start=start, planner_id=planner_id)


@pytest.mark.parametrize('planner_id', CARTESIAN)
def test_a_start_on_the_axis_leaves_it_only_in_the_direction_of_joint_1(planner_id):
    start = np.array([0.4, 2.2, 0.5])
    start[2] = np.arcsin(-0.9 * np.cos(2.2) / 0.7) - 2.2 + 2.0 * np.pi  # the tip on joint axis 1
    assert np.hypot(*tip(*start)[:2]) < 1e-12
    limits = JointLimits([-3.0] * 3, [7.0] * 3, max_effort=STRONG)
    for azimuth in (0.4, 0.4 + np.pi):
        answer = planned(limits, around(azimuth), start=start, planner_id=planner_id)
        assert answer.points.positions[0] == pytest.approx(start, abs=1e-9)
        assert np.ptp(answer.points.positions[:, 0]) < 1e-9
    with pytest.raises(StartStateError, match=(
            r'^start state: joint_1 is at 0\.4 rad with the tip on joint axis 1 \(singularity\): '
            r'it would need unbounded velocity to reach 1 rad, where the path leaves the axis')):
        planned(limits, around(1.0), start=start, planner_id=planner_id)


def test_the_start_s_elbow_branch_stays_where_it_is_feasible():
    # With the elbow down, 0.7 mm away. The joint with the largest displacement L accelerates to v
    # and decelerates in T each, L = v T, full-period cycloids of jerk 2 pi v / T^2 = 10 rad/s^3.
    start, goal = [1.255, 0.234, 3.294], [0.1893, 0.5814, 1.3568]
    answer = planned(LIMITS, [goal], start=start)
    displacement = answer.points.positions[-1] - start
    assert np.abs(displacement).max() < 2e-3
    assert answer.trajectory.duration == pytest.approx(
        2.0 * (2.0 * np.pi * np.abs(displacement).max() / 10.0) ** (1.0 / 3.0), rel=1e-5)
    assert answer.trajectory.duration == pytest.approx(0.173, abs=5e-4)
    assert planned(LIMITS, [goal], start=start, elbow='up').trajectory.duration > 4.0


@pytest.mark.parametrize('posture', [
    Posture(e, s) for s in SHOULDERS for e in ELBOWS])
def test_nearby_points_are_reached_in_the_start_s_posture_and_further_ones_in_another(posture):
    limits = JointLimits([-3.0] * 3, [7.0] * 3, max_effort=STRONG)
    rng = np.random.default_rng(5)
    for _ in range(10):
        start = next(q for q in rng.uniform(-3.0, 6.0, (200, 3)) if posture_of(ARM, q) == posture
                     and abs(np.cos(q[2])) > 0.2 and np.hypot(*tip(*q)[:2]) > 0.3)
        answer = planned(limits, [tip(*start + 0.01)], start=start)
        assert posture_of(ARM, answer.points.positions[-1]) == posture
        assert answer.points.positions[-1] == pytest.approx(start + 0.01, abs=1e-9)


def test_another_posture_is_taken_where_the_start_s_is_out_of_range():
    start = np.array([0.5, 0.4, 2.8])  # elbow down
    goal = tip(0.9, 1.4, 0.2)
    assert planned(LIMITS, [goal], start=start).points.positions[-1, 2] > 1.6
    tight = replace(LIMITS, max_position=(np.pi / 2, np.pi, 2.82))  # down needs 2.94 rad there
    assert planned(tight, [goal], start=start).points.positions[-1] == pytest.approx(
        [0.9, 1.4, 0.2], abs=1e-9)


@pytest.mark.parametrize('noise', [0.0, 1e-9, -1e-9, 1e-4, -1e-4])
def test_an_arm_upright_on_its_axis_needs_no_half_turn_however_its_noise_falls(noise):
    limits = JointLimits([-3.5] * 3, [4.5] * 3, max_effort=STRONG)
    start = np.array([0.3, np.pi / 2 + noise, np.pi / 2 - noise / 3])
    for azimuth in (0.3, 0.3 - np.pi):
        answer = planned(limits, around(azimuth), start=start)
        assert np.ptp(answer.points.positions[:, 0]) < 1e-3


def test_a_range_of_more_than_a_turn_makes_no_motion_longer():
    # 2 pi - 6.2 = 0.083 rad: transitions to v and back in T each, displacement v T, acceleration
    # 2 v / T = 1 rad/s^2. A revolution at 1 rad/s has two transitions of 2 s, at 0.5 rad/s.
    short = planned(turning(-np.pi, 2.0 * np.pi), around(-3.1, 3.1))
    assert short.trajectory.duration == pytest.approx(
        4.0 * ((2.0 * np.pi - 6.2) / 2.0) ** 0.5, rel=1e-4)
    assert planned(turning(-1.5 * np.pi, 1.5 * np.pi), around(
        *np.linspace(-np.pi, np.pi, 13))).trajectory.duration == pytest.approx(
            2.0 * np.pi / 1.0 + 2.0, abs=0.05)


def test_a_start_outside_its_range_by_no_more_than_the_tolerance_is_on_its_end():
    goal = [tip(0.5, 1.4, 0.1)]
    for start, taken in (([-1e-6, 1.5, 0.0], [0.0, 1.5, 0.0]),
                         ([np.pi / 2 + 0.0099, 1.5, 0.0], [np.pi / 2, 1.5, 0.0])):
        answer = planned(LIMITS, goal, start=start, start_state_tolerance=0.01)
        assert answer.points.positions[0].tolist() == taken
    with pytest.raises(StartStateError, match=(
            r'^start state: joint_1 is at -0\.01000001 rad, limits 0 to 1\.570796 rad, '
            r'start_state_tolerance 0\.01 rad$')):
        planned(LIMITS, goal, start=[-0.01000001, 1.5, 0.0], start_state_tolerance=0.01)
    with pytest.raises(StartStateError, match=(
            r'^start state: joint_1 is at 1\.570797 rad, limits 0 to 1\.570796 rad$')):
        planned(LIMITS, goal, start=[np.pi / 2 + 1e-6, 1.5, 0.0])


@pytest.mark.parametrize(('start', 'reason'), [
    ((34.0, 57.0, 17.0), 'joint_1 is at 34 rad, limits 0 to 1.5708 rad (in degrees?)'),
    ((1.0, 90.0, 0.0), 'joint_2 is at 90 rad, limits 0 to 3.14159 rad (in degrees?)'),
    ((0.5, 1.0, -170.0), 'joint_3 is at -170 rad, limits -3.14159 to 6.28319 rad (in degrees?)'),
    ((2.0, 57.0, 1.0), 'joint_1 is at 2 rad, limits 0 to 1.5708 rad (in degrees?)'),
    ((-34.0, 1.0, 0.2), 'joint_1 is at -34 rad, limits 0 to 1.5708 rad'),   # nor as degrees
    ((1.0, 6.0, 0.2), 'joint_2 is at 6 rad, limits 0 to 3.14159 rad'),      # a turn too far
    ((1.0, 1.0, 400.0), 'joint_3 is at 400 rad, limits -3.14159 to 6.28319 rad')])
def test_refusal_of_a_start_asks_for_degrees_where_they_explain_it(start, reason):
    for planner_id in ('cycloid', 'line_arc'):
        with pytest.raises(StartStateError, match=f'^start state: {re.escape(reason)}$'):
            planned(LIMITS, [tip(0.5, 1.4, 0.1)], planner_id=planner_id, start=start)


@pytest.mark.parametrize('planner_id', planner_ids())
@pytest.mark.parametrize('start', [
    (0.3, 1.2, 0.1),
    (0.3, 2.0, np.arcsin(-0.9 * np.cos(2.0) / 0.7) - 2.0),  # the tip is on joint axis 1
    (0.3, 1.2, np.pi / 2 - 1e-7)])                          # all but stretched
def test_a_first_via_point_where_the_tip_is_takes_no_time(planner_id, start):
    if start[2] > 1.5 and planner_id in CARTESIAN:
        return  # from the edge of the workspace no path leads on
    first, then = np.round(tip(*start), 9), (0.8 * np.cos(0.3), 0.8 * np.sin(0.3), 1.0)
    answer = planned(turning(-1.0, 1.0), [first, then], start=start, planner_id=planner_id)
    assert answer.via_times[0] == 0.0
    assert answer.points.positions[0].tolist() == pytest.approx(list(start), abs=1e-9)
