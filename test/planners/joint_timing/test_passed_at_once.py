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

"""Via points so soon after a moving start that no jerk changes when they are passed."""

from dataclasses import replace

from helpers.planning_cases import ARM, LIMITS
import numpy as np
import pytest
from rrr_traj_planner.planners.joint_timing.passed_at_once import (
    times_of_points_passed_at_once,
    without_first_points,
)
from rrr_traj_planner.planners.tasks import JointTask, StartRates

Q, FAR = np.array([0.8, 1.6, 0.2]), np.array([1.0, 1.2, 0.0])
RATES = StartRates(np.array([0.5, -0.2, 0.9]), np.array([0.3, 0.8, -1.0]))


def on_its_way(t):
    """Return where constant acceleration takes the arm."""
    return Q + t * (RATES.velocity + 0.5 * t * RATES.acceleration)


def task(*points):
    """Return a task from the moving state through joint positions."""
    return JointTask(ARM, LIMITS, np.array([Q, *points]), None, 0.01, start_rates=RATES)


def test_points_on_the_way_are_passed_when_the_arm_is_there():
    times = [3e-7, 2e-6, 4e-5]
    found = times_of_points_passed_at_once(task(*map(on_its_way, times), FAR))
    assert found.tolist() == pytest.approx(times, rel=1e-6)


@pytest.mark.parametrize('point', [
    on_its_way(2e-3),                           # jerk of 10 rad/s^3 moves a joint by 1.3e-8 rad
    on_its_way(1e-6) + [0.0, 2e-9, 0.0],        # beside the way
    on_its_way(-1e-6), FAR])                    # behind, and elsewhere
def test_other_points_are_not(point):
    assert times_of_points_passed_at_once(task(point, FAR)).tolist() == []


def test_the_last_point_is_not_for_the_arm_rests_there():
    assert times_of_points_passed_at_once(task(on_its_way(1e-6))).tolist() == []


def test_an_arm_that_turns_is_nowhere_at_once():
    rates = StartRates(np.zeros(3), RATES.acceleration)
    turning = replace(task(Q + 1e-9, FAR), start_rates=rates)
    assert times_of_points_passed_at_once(turning).tolist() == []


def test_the_segments_that_are_left_keep_their_numbers():
    whole = task(on_its_way(1e-6), FAR, Q)
    left = without_first_points(whole, 1)
    assert left.points.tolist() == [Q.tolist(), FAR.tolist(), Q.tolist()]
    assert [left.segment_number(k) for k in (0, 1)] == [1, 2]
    numbered = without_first_points(replace(whole, segment_numbers=np.array([3, 5, 6])), 1)
    assert [numbered.segment_number(k) for k in (0, 1)] == [5, 6]
