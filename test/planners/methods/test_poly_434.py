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

"""Lin's 4-3-4: quartic lift-off, cubic cruise, quartic set-down, in every segment."""

from dataclasses import replace
from functools import partial

from helpers.planning_cases import ARM, FREE, LIMITS, STRONG, table, through
from helpers.random_tasks import random_task
import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError, TimingError
from rrr_traj_planner.core.trajectory.torque import time_scale_for_torque
from rrr_traj_planner.core.trajectory.trajectory import times_within
from rrr_traj_planner.planners.methods import poly_434
from rrr_traj_planner.planners.planning import plan

table, through = (partial(f, planner_id='poly_434') for f in (table, through))
LIGHT = replace(FREE, max_jerk=np.full(3, np.inf))

# Degrees, from the verified joint angles of both tables: the largest displacement of each segment,
# joint 2's and then joint 1's of table 6.1, joint 3's and then joint 2's of table 6.3.
LONGEST = {'6.1': (88.8437 - 54.0815, 50.0921 - 40.1792),
           '6.3': (9.1332 + 29.4763, 58.4486 - 26.1272)}


@pytest.mark.parametrize('name', LONGEST)
def test_tables_take_the_root_of_6_way_over_acceleration_in_each_segment(name):
    answer = plan(ARM, STRONG, table(name))
    assert np.diff(answer.via_times) == pytest.approx(
        np.sqrt(6.0 * np.deg2rad(LONGEST[name])), rel=5e-6)
    assert answer.peaks.acceleration.max() == pytest.approx(1.0, rel=1e-5)


@pytest.mark.parametrize(('changes', 'seconds'), [
    ({}, np.sqrt(6.0 * 0.6)),                        # acceleration alone
    ({'max_jerk': [0.5] * 3}, np.cbrt(32.0 * 1.2)),  # jerk alone
    # 0.1 rad/s: 6 s, and one of two quartics of 1.5 * 0.1 / 1.
    ({'max_velocity': [0.1] * 3}, 6.15)])
def test_one_joint_alone_takes_the_time_of_a_hand_calculation(changes, seconds):
    found = plan(ARM, replace(LIGHT, **changes), through([[0.3, 1.5, 0.0], [0.9, 1.5, 0.0]]))
    assert found.trajectory.duration == pytest.approx(seconds, rel=1e-5)


def test_arm_rests_at_every_via_point_and_moves_straight_in_joint_space_between():
    answer = plan(ARM, LIMITS, table('6.1'))
    q, qd, qdd, _ = answer.trajectory(answer.via_times)
    assert np.abs(qd).max() <= 1e-12
    assert np.abs(qdd).max() <= 1e-12
    for k in range(2):
        s = (answer.trajectory(np.linspace(*answer.via_times[k:k + 2], 50))[0] - q[k]) / (
            q[k + 1] - q[k])
        assert np.ptp(s, axis=1).max() <= 1e-11
        assert np.diff(s[:, 0]).min() >= 0.0


def test_every_segment_is_a_quartic_a_cubic_and_a_quartic_of_equal_length_on_table_6_1():
    for profile in plan(ARM, LIMITS, table('6.1')).trajectory.profiles:
        assert (profile.pieces.snap != 0.0).tolist() == [True, False, True] * 2
        for T in profile.pieces.duration.reshape(2, 3):
            assert T == pytest.approx([T.mean()] * 3, rel=1e-3)


def test_jerk_steps_within_its_limit():
    limits = replace(FREE, max_jerk=[2.0, 3.0, 4.0])
    answer = plan(ARM, limits, table('6.1'))
    t = times_within(answer.trajectory, 50)
    assert (np.abs(answer.trajectory(t)[3]) <= limits.max_jerk * (1.0 + 1e-6)).all()
    start = np.abs(answer.trajectory(np.array([0.0]))[3][0])
    assert (start / limits.max_jerk).max() == pytest.approx(1.0, rel=1e-4)


def test_the_reverse_task_has_the_same_motion_backwards():
    q = [[0.3, 1.4, 0.0], [0.9, 1.7, -0.4]]
    forth, back = (plan(ARM, FREE, through(points)).trajectory for points in (q, q[::-1]))
    assert forth.duration == pytest.approx(back.duration, rel=1e-12)
    t = np.linspace(0.0, forth.duration, 41)
    assert forth(t)[0] == pytest.approx(back(forth.duration - t)[0], abs=1e-9)


def test_only_the_segments_that_lack_torque_are_slowed_and_use_all_of_it():
    q = [[0.3, 1.4, 0.0], [1.2, 1.4, 0.0], [1.2, 1.5, 0.1]]  # joint 1 moves in the first alone
    free = plan(ARM, FREE, through(q))
    inertia = free.effort[0] / free.peaks.acceleration[0]  # joint 1's, about, in this pose
    weak = replace(FREE, max_effort=[0.5 * inertia, np.inf, np.inf])
    slow = plan(ARM, weak, through(q))
    T, slowed = np.diff(free.via_times), np.diff(slow.via_times)
    # Without gravity and, all but, without change of inertia it is a lower acceleration limit.
    assert slowed[0] == pytest.approx(np.sqrt(2.0) * T[0], rel=2e-2)
    assert slowed[0] <= np.sqrt(2.0) * T[0] * (1.0 + 1e-3)
    assert slowed[1] == pytest.approx(T[1], rel=1e-9)
    assert slow.effort[0] == pytest.approx(0.5 * inertia, rel=1e-6)


@pytest.mark.parametrize('limit', [164.0, 168.0, 172.0])
def test_where_torque_is_short_the_law_is_faster_than_the_symmetric_one_slowed_down(limit):
    weak = replace(LIMITS, max_effort=[150.0, limit, 200.0])
    free, found = plan(ARM, FREE, table('6.1')), plan(ARM, weak, table('6.1'))
    stretched = free.via_times[1] * time_scale_for_torque(ARM, weak, free.trajectory).value.max()
    assert free.via_times[1] < found.via_times[1] < 0.95 * stretched
    assert found.effort[1] == pytest.approx(limit, rel=1e-6)


def test_less_torque_never_makes_a_motion_faster():
    free = plan(ARM, FREE, table('6.1'))
    needed = free.effort[1]
    times = [plan(ARM, replace(LIMITS, max_effort=[150.0, share * needed, 200.0]),
                  table('6.1')).trajectory.duration for share in (0.99999, 0.999, 0.99, 0.96)]
    assert times[0] >= free.trajectory.duration
    assert (np.diff(times) >= 0.0).all()


def test_several_starts_find_faster_laws_than_one(monkeypatch):
    tasks = [random_task(seed) for seed in (4, 8, 13, 21)]  # of those that lack torque

    def durations():
        return np.array([plan(task.model, task.limits, task.request_to(
            'poly_434')).trajectory.duration for task in tasks])

    by_all = durations()
    monkeypatch.setattr(poly_434, 'STARTS', ())
    by_one = durations()
    assert (by_all <= by_one * (1.0 + 1e-9)).all()
    assert (by_all / by_one).min() <= 0.97


def test_where_the_prescribed_durations_are_long_enough_no_other_law_is_sought():
    weak = replace(LIMITS, max_effort=[150.0, 166.0, 200.0])
    answer = plan(ARM, weak, table('6.1', segment_durations=[6.0, np.nan],
                                   should_stop=lambda: True))
    assert answer.note == ''
    parts = answer.trajectory.profiles[0].pieces.duration[:3]
    assert parts == pytest.approx([2.0] * 3, rel=1e-3)


def test_when_planning_time_is_over_the_symmetric_law_is_slowed_and_the_note_says_so():
    weak = replace(LIMITS, max_effort=[150.0, 166.0, 200.0])
    found = plan(ARM, weak, table('6.1'))
    stopped = plan(ARM, weak, table('6.1', should_stop=lambda: True))
    assert found.note == ''
    assert stopped.note == ('planning time was over before the fastest 4-3-4 law within torque '
                            'was found for segment 0')
    assert stopped.trajectory.duration > found.trajectory.duration
    assert stopped.effort[1] == pytest.approx(166.0, rel=1e-6)


def test_durations_that_torque_made_long_may_be_prescribed_and_no_shorter_ones():
    weak = replace(LIMITS, max_effort=[150.0, 166.0, 200.0])
    least = np.diff(plan(ARM, weak, table('6.1')).via_times)
    again = plan(ARM, weak, table('6.1', segment_durations=least))
    assert np.diff(again.via_times) == pytest.approx(least, abs=1e-9)
    with pytest.raises(TimingError, match='too short for segment 0: the least feasible are'):
        plan(ARM, weak, table('6.1', segment_durations=least * [0.99, 1.0]))


def test_without_an_acceleration_limit_it_refuses():
    free = replace(LIMITS, max_acceleration=[1.0, np.inf, 1.0])
    with pytest.raises(InvalidInputError, match=(
            '^a planner of quartic transitions needs acceleration limits, joint_2 has none$')):
        plan(ARM, free, table('6.1'))
