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

"""Approach (b): via points with blends, which are cycloid transitions."""

from dataclasses import replace
from functools import partial

from helpers.planning_cases import ARM, FREE, LIMITS, table, through
import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError, LimitViolationError, TimingError
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest

table, through = (partial(f, planner_id='cycloid_approach_b') for f in (table, through))


@pytest.mark.parametrize('joint', range(3))
@pytest.mark.parametrize('steps', [
    [0.2, 0.2, 0.3], [0.1, 0.1, 0.1, 0.2, 0.2, 0.05], [0.3, 0.3, -0.2], [1e-3, 1e-3, 0.4, 0.4],
    [0.15, 0.15, 0.15, 0.15]])
def test_equal_steps_take_no_more_time_than_nearly_equal_ones(joint, steps):
    # At equal steps velocity need not change at all: what is left of the change is rounding, and
    # so would be the jerk of a transition that is as short as that allows.
    q = np.tile([0.3, 1.3, 0.1], (len(steps) + 1, 1))
    q[1:, joint] += np.cumsum(steps)
    exact, nearly = (plan(ARM, FREE, through(p)) for p in (
        q, q + 1e-6 * np.random.default_rng(5).normal(size=q.shape)))
    assert (exact.peaks.jerk <= FREE.max_jerk * (1.0 + 1e-6)).all()
    assert (exact.peaks.acceleration <= FREE.max_acceleration * (1.0 + 1e-6)).all()
    assert exact.trajectory.duration <= nearly.trajectory.duration * 1.01


def test_via_points_at_equal_angles_about_the_base_are_planned():
    angles = np.array([0.3, 0.5, 0.7, 1.0])
    tips = np.stack((np.cos(angles), np.sin(angles), np.full(4, 0.8)), axis=1)
    answer = plan(ARM, LIMITS, PlanningRequest(tips, planner_id='cycloid_approach_b'))
    assert (answer.peaks.jerk <= LIMITS.max_jerk * (1.0 + 1e-6)).all()


def test_every_piece_is_a_full_period_cycloid_or_a_cruise_and_joints_share_them():
    trajectory = plan(ARM, FREE, table('6.1')).trajectory
    for profile in trajectory.profiles:
        assert (profile.pieces.w == 2.0 * np.pi).all()
        assert (profile.pieces.c == profile.pieces.b).all()
        assert profile.knots == pytest.approx(trajectory.profiles[0].knots, abs=1e-12)


def test_via_time_is_the_middle_of_a_transition():
    answer = plan(ARM, FREE, table('6.1'))
    profile = answer.trajectory.profiles[0]
    middles = 0.5 * (profile.knots[:-1] + profile.knots[1:])
    moving = np.abs(profile.pieces.b) > 1e-9
    assert np.abs(middles[moving] - answer.via_times[1]).min() < 1e-9


@pytest.mark.parametrize(('name', 'with_stops'), [('6.1', 3.380), ('6.3', 4.446)])
def test_tables_take_less_than_stops_at_the_via_points(name, with_stops):
    assert plan(ARM, FREE, table(name)).trajectory.duration < with_stops


def test_one_joint_in_one_direction_takes_the_time_of_one_segment():
    # 1.2 rad in two equal halves, 1 rad/s^2: as without the point between, 2 sqrt(2 * 1.2) s.
    limits = replace(FREE, max_velocity=np.full(3, np.inf), max_jerk=np.full(3, np.inf))
    q = [[0.1, 1.5, 0.0], [0.7, 1.5, 0.0], [1.3, 1.5, 0.0]]
    answer = plan(ARM, limits, through(q))
    assert answer.trajectory.duration == pytest.approx(2.0 * np.sqrt(2.0 * 1.2), rel=1e-4)


def test_one_prescribed_segment_holds_both_transitions_and_its_line():
    # 0.6 rad, 1 rad/s^2: T + 2 * 0.6 / T = 4, T = 3.669 s: cruise 0.6 / T.
    limits = replace(FREE, max_jerk=np.full(3, np.inf))
    q = [[0.3, 1.5, 0.0], [0.9, 1.5, 0.0]]
    answer = plan(ARM, limits, through(q, segment_durations=[4.0]))
    assert answer.via_times == pytest.approx([0.0, 4.0], abs=1e-9)
    assert answer.peaks.velocity[0] == pytest.approx(0.6 / (2.0 + np.sqrt(4.0 - 1.2)), rel=1e-9)
    assert answer.peaks.acceleration[0] == pytest.approx(1.0, rel=1e-9)


def test_where_torque_is_short_transitions_are_gentler():
    q = [[0.3, 1.4, 0.0], [1.2, 1.4, 0.0]]  # joint 1's torque is inertia alone
    free = plan(ARM, FREE, through(q, segment_durations=[5.0]))
    weak = replace(FREE, max_effort=[0.6 * free.effort[0], np.inf, np.inf])
    gentle = plan(ARM, weak, through(q, segment_durations=[5.0]))
    assert gentle.via_times == pytest.approx([0.0, 5.0], abs=1e-9)
    assert gentle.effort[0] <= 0.6 * free.effort[0] * (1.0 + 1e-6)
    assert gentle.peaks.velocity[0] > free.peaks.velocity[0]


def test_next_to_no_duration_is_refused_with_feasible_ones_that_are_then_accepted():
    request = table('6.1', segment_durations=[0.001, 5.0])
    with pytest.raises(TimingError) as refusal:
        plan(ARM, LIMITS, request)
    offered = refusal.value.least_durations
    assert sum(offered) < 10.0
    answer = plan(ARM, LIMITS, replace(request, segment_durations=offered))
    assert np.diff(answer.via_times) == pytest.approx(offered, abs=1e-9)


def test_a_path_that_cannot_be_held_and_a_missing_limit_are_refused():
    weak = replace(LIMITS, max_effort=[150.0, 200.0, 50.0])
    q = [[0.3, 1.5, -1.5], [0.3, np.pi / 2, 1.5]]
    for durations in (None, [9.0]):
        with pytest.raises(LimitViolationError, match='^segment 0: along the segment joint_3'):
            plan(ARM, weak, through(q, segment_durations=durations))
    limits = replace(LIMITS, max_acceleration=[1.0, np.inf, 1.0])
    with pytest.raises(InvalidInputError, match='needs acceleration limits, joint_2 has none$'):
        plan(ARM, limits, table('6.1'))
