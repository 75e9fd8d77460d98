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

"""Approach (c): lift-off from rest, cruise, set-down to rest, in every segment."""

from dataclasses import replace
from functools import partial

from helpers.planning_cases import ARM, FREE, LIMITS, table, through
import numpy as np
import pytest
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.planners.planning import plan

table, through = (partial(f, planner_id='cycloid_approach_c') for f in (table, through))
LIGHT = replace(FREE, max_jerk=np.full(3, np.inf))


@pytest.mark.parametrize(('name', 'seconds'), [('6.1', 3.380), ('6.3', 4.446)])
def test_tables_take_the_times_that_are_known_of_a_stop_at_every_via_point(name, seconds):
    assert plan(ARM, FREE, table(name)).trajectory.duration == pytest.approx(seconds, abs=6e-4)


@pytest.mark.parametrize(('most', 'seconds'), [(5.0, np.sqrt(8.0 * 0.6)), (0.4, 2.3)])
def test_one_joint_alone_takes_the_time_of_a_hand_calculation(most, seconds):
    # 0.6 rad at 1 rad/s^2: two transitions of 2 u, u 2 u = 0.6, 4 u = sqrt(8 * 0.6); at 0.4 rad/s
    # at most two of 0.8 s, 0.32 rad, and 0.28 rad in 0.7 s between them.
    limits = replace(LIGHT, max_velocity=[most] * 3)
    found = plan(ARM, limits, through([[0.3, 1.5, 0.0], [0.9, 1.5, 0.0]]))
    assert found.trajectory.duration == pytest.approx(seconds, rel=1e-5)


def test_arm_rests_at_every_via_point():
    answer = plan(ARM, LIMITS, table('6.1'))
    q, qd, qdd, _ = answer.trajectory(answer.via_times)
    assert np.abs(qd).max() == 0.0
    assert np.abs(qdd).max() <= 1e-12
    assert forward_kinematics(ARM, q) == pytest.approx(table('6.1').via_points, abs=1e-9)


def test_only_the_segments_that_lack_torque_are_slowed():
    q = [[0.3, 1.4, 0.0], [1.2, 1.4, 0.0], [1.2, 1.5, 0.1]]  # joint 1 moves in the first alone
    free = plan(ARM, FREE, through(q))
    inertia = free.effort[0] / free.peaks.acceleration[0]  # joint 1's, about, in this pose
    weak = replace(FREE, max_effort=[0.5 * inertia, np.inf, np.inf])
    slow = plan(ARM, weak, through(q))
    T, slowed = np.diff(free.via_times), np.diff(slow.via_times)
    assert slowed[0] == pytest.approx(np.sqrt(2.0) * T[0], rel=1e-3)
    assert slowed[1] == pytest.approx(T[1], rel=1e-9)
    assert slow.effort[0] == pytest.approx(0.5 * inertia, rel=1e-6)
