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

"""4-1-4, after Paul: the thesis's t_acc, its times, and where t_acc is less."""

from dataclasses import replace
from functools import partial

from helpers.planning_cases import ARM, FREE, LIMITS, STRONG, table, through
import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.planners.methods.poly_414 import planned
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.tasks import JointTask, T_ACC

table, through = (partial(f, planner_id='poly_414') for f in (table, through))
LONGER = 1e-5  # relative: durations are a little longer than the least

# Joint angles at table 6.1's points.
Q_6_1 = np.radians([[30.0464, 54.0815, 14.2147], [50.0921, 88.8437, 4.4472],
                    [40.1792, 96.9387, -2.3015]])


def transitions(trajectory):
    """Return the lengths of the pieces in which some joint's velocity changes."""
    change = np.array([p.pieces.change for p in trajectory.profiles])
    return trajectory.profiles[0].pieces.duration[np.abs(change).max(axis=0) > 1e-12]


def test_t_acc_is_table_6_2_s():
    assert T_ACC == 0.5


def test_table_6_1_takes_two_lines_of_2_t_acc_and_half_a_transition_at_each_end():
    # Within 1 s every joint is below 1 rad/s (0.607) and 1.5 * 0.607 / 1 s = 0.910 of 1 rad/s^2.
    answer = plan(ARM, FREE, table('6.1'))
    assert answer.trajectory.duration == pytest.approx(3.0, rel=LONGER)
    assert answer.via_times == pytest.approx([0.0, 1.5, 3.0], rel=LONGER)
    assert transitions(answer.trajectory) == pytest.approx(np.ones(3), rel=LONGER)
    assert answer.peaks.velocity[1] == pytest.approx(np.radians(88.8437 - 54.0815), rel=1e-4)
    assert answer.peaks.acceleration[1] == pytest.approx(0.910, abs=6e-4)
    # Jerk peaks at the ends of transitions: 6 * 0.607 / 1 s^2.
    assert answer.peaks.jerk[1] == pytest.approx(6.0 * 0.6067, abs=6e-4)


def test_motion_around_the_via_point_is_6_5():
    answer = plan(ARM, FREE, table('6.1'))
    A, B, C = Q_6_1[0], Q_6_1[1], Q_6_1[2]
    T1, t = 1.0, np.linspace(-0.5, 0.5, 21)[:, np.newaxis]
    # Paul's A is the place t_acc before B, on the line.
    dB, dC, h = (A - B) * T_ACC / 1.0, C - B, (t + T_ACC) / (2.0 * T_ACC)
    printed = ((dC * T_ACC / T1 + dB) * (2.0 - h) * h ** 2 - 2.0 * dB) * h + B + dB
    assert answer.trajectory(1.5 + t[:, 0])[0] == pytest.approx(printed, abs=1e-5)


def test_via_point_is_missed_by_3_32_of_change_of_velocity_times_a_second():
    answer = plan(ARM, FREE, table('6.1'))
    change = np.diff(Q_6_1, n=2, axis=0)[0] / 1.0
    missed = answer.trajectory(answer.via_times[1])[0] - Q_6_1[1]
    assert missed == pytest.approx(3.0 / 32.0 * change, abs=1e-5)
    assert '0.049 rad' in answer.note


def test_acceleration_beyond_its_limit_slows_the_lines_and_leaves_t_acc():
    answer = plan(ARM, FREE, table('6.3'))
    assert transitions(answer.trajectory) == pytest.approx(np.ones(3), rel=LONGER)
    assert answer.trajectory.duration > 3.0
    assert answer.peaks.acceleration.max() == pytest.approx(1.0, rel=LONGER)


def test_torque_slows_the_motion_as_a_whole():
    weak = replace(STRONG, max_effort=[150.0, 222.0, 200.0])
    free, slowed = (plan(ARM, limits, table('6.3')) for limits in (STRONG, weak))
    factor = slowed.trajectory.duration / free.trajectory.duration
    assert factor > 1.01
    assert slowed.effort[1] == pytest.approx(222.0, rel=1e-6)
    assert transitions(slowed.trajectory) == pytest.approx(
        factor * transitions(free.trajectory), rel=1e-9)
    t = np.linspace(0.0, free.trajectory.duration, 33)
    assert slowed.trajectory(factor * t)[0] == pytest.approx(free.trajectory(t)[0], abs=1e-9)


def test_t_acc_is_reduced_beside_short_segments():
    # 0.03 rad from rest to rest at 1 rad/s^2: 2 sqrt(1.5 * 0.03) = 0.424 s, less than 1 s.
    q = [[0.3, 1.5, 0.0], [0.33, 1.5, 0.0], [0.36, 1.5, 0.0]]
    answer = plan(ARM, replace(FREE, max_jerk=np.full(3, np.inf)), through(q))
    found = transitions(answer.trajectory)
    assert found[[0, -1]] == pytest.approx([2.0 * np.sqrt(1.5 * 0.03)] * 2, rel=1e-4)
    assert answer.trajectory.duration < 2.0


def test_t_acc_is_kept_where_reducing_it_would_make_the_motion_slower():
    q = [[0.3, 1.4, 0.0], [1.0, 1.8, 0.3], [1.0, 1.8 + 1e-6, 0.3], [0.4, 1.5, -0.4]]
    answer = plan(ARM, FREE, through(q))
    assert transitions(answer.trajectory) == pytest.approx(np.ones(4), rel=LONGER)


@pytest.mark.parametrize('t_acc', [0.25, 1.0])
def test_another_t_acc_is_used(t_acc):
    task = JointTask(ARM, FREE, Q_6_1, None, 0.01)
    motion = planned(task, t_acc)
    assert (transitions(motion) <= 2.0 * t_acc * (1.0 + LONGER)).all()
    assert transitions(motion)[0] == pytest.approx(min(2.0 * t_acc, 2.0 * np.sqrt(
        1.5 * np.radians(88.8437 - 54.0815))), rel=1e-4)


@pytest.mark.parametrize('durations', [[4.0, 4.0], [10.0, 3.5], [1.7, 1.7]])
def test_prescribed_durations_are_kept_with_t_acc(durations):
    answer = plan(ARM, LIMITS, table('6.1', segment_durations=durations))
    assert answer.via_times == pytest.approx([0.0, durations[0], sum(durations)], abs=1e-9)
    assert transitions(answer.trajectory) == pytest.approx(np.ones(3), rel=1e-9)
    assert (answer.effort <= LIMITS.max_effort * (1.0 + 1e-6)).all()


def test_prescribed_durations_too_short_for_t_acc_reduce_it():
    # 0.6 s hold a first transition and half of the next: 0.4 s each.
    q = [[0.3, 1.5, 0.0], [0.35, 1.5, 0.0], [0.45, 1.5, 0.0]]
    answer = plan(ARM, replace(FREE, max_jerk=np.full(3, np.inf)),
                  through(q, segment_durations=[0.6, 6.0]))
    assert answer.via_times == pytest.approx([0.0, 0.6, 6.6], abs=1e-9)
    assert transitions(answer.trajectory) == pytest.approx([0.4, 0.4, 1.0], rel=1e-9)


def test_half_a_transition_s_length_is_what_the_request_says():
    # A longer transition passes the via point by at a greater distance.
    misses = []
    for t_acc in (0.2, 0.4):
        request = table('6.1', half_transition=t_acc)
        found = plan(ARM, LIMITS, request)
        tip = forward_kinematics(ARM, found.trajectory(found.via_times)[0])
        misses.append(float(np.linalg.norm(tip[1] - request.via_points[1])))
    assert 0.0 < misses[0] < misses[1]


def test_a_transition_of_no_length_is_refused():
    with pytest.raises(InvalidInputError,
                       match=r'half_transition is 0\.0 s, must be at least 1e-09 s'):
        table('6.1', half_transition=0.0)
