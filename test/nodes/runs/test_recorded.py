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

"""Motions as joint states show them, of controllers that know more or less."""

from __future__ import annotations

from math import nan

from builtin_interfaces.msg import Time
import numpy as np
import pytest
from rrr_traj_planner.nodes.runs.recorded import recorded_motion
from sensor_msgs.msg import JointState

NAMES = ['a', 'b', 'c']
SPEED = np.array((1.0, -2.0, 0.5))  # rad/s
PERIOD = 0.25                       # s


def states(count=5, **fields):
    """Return states of joints that turn steadily, one of which belongs to no arm."""
    return [JointState(
        name=['c', 'gripper', 'b', 'a'],
        position=[*(0.25 * k * SPEED[2:]).tolist(), 9.0, *(0.25 * k * SPEED[1::-1]).tolist()],
        **fields) for k in range(count)]


def stamped(messages, first=100):
    for k, message in enumerate(messages):
        message.header.stamp = Time(sec=first + k // 4, nanosec=250_000_000 * (k % 4))
    return messages


def test_joints_are_found_among_others_and_times_count_from_the_start():
    given = {'velocity': [SPEED[2], 0.0, SPEED[1], SPEED[0]], 'effort': [3.0, 9.0, 2.0, 1.0]}
    motion, torque = recorded_motion(stamped(states(**given)), NAMES, 100.5)
    assert motion.times.tolist() == [-0.5, -0.25, 0.0, 0.25, 0.5]
    assert motion.positions == pytest.approx(np.outer(motion.times + 0.5, SPEED))
    assert motion.velocities == pytest.approx(np.tile(SPEED, (5, 1)))
    assert torque.tolist() == [[1.0, 2.0, 3.0]] * 5


@pytest.mark.parametrize('fields', [
    {}, {'velocity': [nan] * 4, 'effort': [nan] * 4}, {'effort': [1.0, 1.0, nan, 1.0]}])
def test_velocities_and_torques_that_nobody_measures_are_done_without(fields):
    motion, torque = recorded_motion(stamped(states(**fields)), NAMES, 100.0)
    assert motion.velocities == pytest.approx(np.tile(SPEED, (5, 1)))
    assert torque is None


def test_a_state_that_comes_twice_counts_once():
    once = stamped(states())
    motion, _ = recorded_motion([once[0], *once, once[-1]], NAMES, 100.0)
    assert motion.times.tolist() == [0.0, 0.25, 0.5, 0.75, 1.0]
