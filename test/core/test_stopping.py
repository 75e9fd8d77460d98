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

"""Stopping: from the commanded state to rest, within the limits."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest
from rrr_traj_planner.core.dynamics import inverse_dynamics
from rrr_traj_planner.core.limits import JointLimits
from rrr_traj_planner.core.model import RobotModel
from rrr_traj_planner.core.stopping import stopping, stopping_time

MODEL, LIMITS = RobotModel(), JointLimits(max_effort=np.full(3, inf))
NOW = 7.0


def random_commands(count):
    rng = np.random.default_rng(4)
    for _ in range(count):
        yield tuple(rng.uniform((0.1, 0.1, -1.0) + (-1.0,) * 6, 1.0).tolist())


def sampled(motion):
    times = motion.origin + np.linspace(0.0, float(motion.knots[-1]), 2001)
    return times, np.array([motion(t) for t in times])


def test_stop_starts_from_the_command_and_ends_at_rest():
    for command in random_commands(50):
        motion = stopping(command, NOW, LIMITS, MODEL)
        np.testing.assert_allclose(motion(NOW), command, atol=1e-12)
        assert motion(motion.end + 1e-9)[3:] == (0.0,) * 6
        np.testing.assert_allclose(motion(motion.end - 1e-9), motion(motion.end + 1e-9), atol=1e-7)


def test_stop_keeps_acceleration_and_jerk_limits():
    for command in random_commands(50):
        times, states = sampled(stopping(command, NOW, LIMITS, MODEL))
        assert np.abs(states[:, 6:]).max() <= 1.0 + 1e-6
        jerk = np.abs(np.diff(states[:, 6:], axis=0)) / np.diff(times)[:, np.newaxis]
        assert jerk.max() <= 10.0 + 1e-6


def test_velocity_is_the_derivative_of_position():
    for command in random_commands(10):
        times, states = sampled(stopping(command, NOW, LIMITS, MODEL))
        for n in (0, 3):
            rate = np.diff(states[:, n:n + 3], axis=0) / np.diff(times)[:, np.newaxis]
            middle = 0.5 * (states[1:, n + 3:n + 6] + states[:-1, n + 3:n + 6])
            room = 10.0 * np.diff(times).max()  # the trapezium's error where jerk steps
            np.testing.assert_allclose(rate, middle, atol=room)


def test_time_from_a_velocity_alone_is_the_cubic_s():
    # peak deceleration 1.5 v/T, jerk 6 v/T^2
    assert stopping_time(1.0, 0.0, 1.0, inf) == pytest.approx(1.5, abs=1e-6)
    assert stopping_time(-1.0, 0.0, inf, 6.0) == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize('command', [(inf, 0.0), (0.0, inf), (np.nan, 0.0), (1e308, 1e308)])
def test_search_for_a_time_ends_even_without_one(command):
    assert stopping_time(*command, 1.0, 10.0) > 1e9


def test_arm_at_rest_stays():
    q = (0.5, 0.9, 0.2)
    motion = stopping((*q, *(0.0,) * 6), NOW, LIMITS, MODEL)
    assert motion.end == NOW
    assert motion(NOW) == (*q, *(0.0,) * 6)


def test_stop_is_slowed_until_torques_fit():
    command = (0.5, 1.2, 0.2, 0.0, -1.0, -1.0, 0.0, 0.0, 0.0)  # falling, braked by lifting
    rest = np.abs(inverse_dynamics(MODEL, command[:3], command[3:6], command[6:]))
    limits = JointLimits(max_acceleration=np.full(3, 50.0), max_jerk=np.full(3, inf),
                         max_effort=rest + 60.0)
    _, states = sampled(stopping(command, NOW, limits, MODEL))
    torque = np.abs(inverse_dynamics(MODEL, states[:, :3], states[:, 3:6], states[:, 6:]))
    assert (torque.max(axis=0) <= limits.max_effort * 1.01).all()


def test_arm_that_cannot_be_held_stops_all_the_same():
    limits = JointLimits(max_effort=np.full(3, 1.0))
    motion = stopping((0.5, 1.0, 0.2, 0.5, 0.5, 0.5, 0.0, 0.0, 0.0), NOW, limits, MODEL)
    assert motion.end - NOW < 4.0
