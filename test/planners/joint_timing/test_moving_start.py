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

"""What a start that moves allows: how far joints advance, which limits the state needs."""

from dataclasses import replace

from helpers.planning_cases import ARM, LIMITS, NONE
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.planners.joint_timing.moving_start import (
    least_advance,
    limits_of_moving_start,
)
from rrr_traj_planner.planners.tasks import StartRates

Q = np.array([0.8, 1.6, 0.2])


def integrated(v, a, limits, dt=2e-4):
    """Return the advance with falling acceleration, by small steps."""
    q, most = np.zeros(3), np.zeros(3)
    for _ in range(int(8.0 / dt)):
        after = np.maximum(a - limits.max_jerk * dt, -limits.max_acceleration)
        q, v = q + dt * (v + dt * (a + after) / 4.0), v + dt * (a + after) / 2.0
        a, most = after, np.maximum(most, q)
    return most


@pytest.mark.parametrize('seed', range(12))
def test_joints_advance_as_far_as_by_integration(seed):
    rng = np.random.default_rng(seed)
    most = rng.uniform(0.5, 3.0, 3)
    limits = JointLimits(max_acceleration=most, max_jerk=rng.choice([2.0, 20.0, np.inf], 3))
    v, a = rng.uniform(-1.0, 1.0, 3), rng.uniform(-1.0, 1.0, 3) * most
    assert least_advance(v, a, limits) == pytest.approx(integrated(v, a, limits), abs=1e-3)


def test_without_a_limit_on_acceleration_joints_stop_at_once():
    limits = JointLimits(max_acceleration=NONE, max_jerk=NONE)
    assert least_advance(np.ones(3), np.zeros(3), limits).tolist() == [0.0] * 3


def test_limits_are_raised_by_little_where_the_state_is_at_them_and_nowhere_else():
    # joint 1 at its velocity, joint 2 at its acceleration limit
    rates = StartRates(np.array([1.0, 0.2, 0.0]), np.array([0.0, -1.0, 0.1]))
    found = limits_of_moving_start(ARM, LIMITS, Q, rates)
    assert (found.max_velocity / LIMITS.max_velocity).tolist() == pytest.approx([1.0002, 1.0, 1.0])
    assert (found.max_acceleration / LIMITS.max_acceleration).tolist() == pytest.approx(
        [1.0, 1.0002, 1.0])
    for same in ('min_position', 'max_position', 'max_jerk', 'max_effort'):
        assert getattr(found, same).tolist() == getattr(LIMITS, same).tolist()


def test_infinite_limits_stay_infinite():
    limits = replace(LIMITS, max_velocity=NONE, max_acceleration=NONE, max_jerk=NONE)
    found = limits_of_moving_start(ARM, limits, Q, StartRates(np.ones(3), np.ones(3)))
    assert np.isinf([found.max_velocity, found.max_acceleration, found.max_jerk]).all()


@pytest.mark.parametrize('room', [2e-3, 0.3])
def test_where_braking_leaves_little_room_harder_acceleration_and_jerk_are_allowed(room):
    # it brakes by jerk alone: 0.3 rad/s until (2 v / J)^0.5 later, after 2 v / 3 times that
    limits = replace(LIMITS, max_acceleration=NONE)
    way = 2.0 / 3.0 * 0.3 * np.sqrt(2.0 * 0.3 / 10.0)
    start = np.array([LIMITS.max_position[0] - way - room, 1.6, 0.2])
    found = limits_of_moving_start(
        ARM, limits, start, StartRates(np.array([0.3, 0.0, 0.0]), np.zeros(3)))
    more = found.max_jerk / limits.max_jerk - 1.0
    assert (more[0] > 0.0) == (room < 0.1)
    assert more[0] <= 1e-3 and more[1:].tolist() == [0.0, 0.0]
