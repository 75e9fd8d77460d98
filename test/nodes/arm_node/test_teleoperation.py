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

"""The example of teleoperation in docs/arm.md, run unchanged."""

from __future__ import annotations

import sys

from builtin_interfaces.msg import Time
from helpers.arm_in_ros import ALL, Arm, SECOND, stamp, START
from helpers.examples import example
from helpers.places import DOCS
from helpers.scripts import Script
import numpy as np
from rclpy.clock import Clock, ClockType
from rosgraph_msgs.msg import Clock as ClockMessage
from trajectory_msgs.msg import JointTrajectory

SWING, W, SECONDS = 0.03, np.pi, 2.0  # one swing, shorter than in the document
TICK, AHEAD = SECOND // 100, SECOND // 20
JOINED = SECOND // 5
ERROR = 1e-4  # rad, at every state; largest where acceleration ends at once


class PatientClock:
    """A clock that advances with the stream of points, however busy the machine is."""

    def __init__(self, ros):
        self.now = 100 * SECOND
        self._stream = ros.listen(JointTrajectory, 'joint_trajectory', ALL).messages
        self._publisher = ros.node.create_publisher(ClockMessage, '/clock', 10)
        ros.node.create_timer(0.002, self._tick, clock=Clock(clock_type=ClockType.STEADY_TIME))
        self._calls = 0

    def _tick(self):
        self._calls += 1
        if (stamp(self._stream[-1]) >= self.now + AHEAD if self._stream
                else self._calls % 25 == 0):  # until it begins, a fifth of real time
            self.now += TICK
        self._publisher.publish(ClockMessage(
            clock=Time(sec=self.now // SECOND, nanosec=self.now % SECOND)))


def test_arm_follows_a_stream_of_stamped_points(ros):
    code = example(DOCS / 'arm.md', 'teleoperation')
    for there, here in (('0.1, 8.0  #', f'0.1, {SECONDS}  #'),
                        ('SWING, W = 0.1, tau / 4.0', f'SWING, W = {SWING}, {W}')):
        assert code.count(there) == 1
        code = code.replace(there, here)
    PatientClock(ros)
    arm = Arm(ros, allow_nonzero_velocity_at_trajectory_end=True, use_sim_time=True)
    with Script([sys.executable, '-c', code, '--ros-args', '-p', 'use_sim_time:=true']) as sender:
        while not (line := sender.read_until('\n')[0].strip()).isdigit():
            assert 'RTPS' in line  # Fast DDS prints its problems on standard output
        start = int(line)
        arm.actual.wait_for(lambda m: stamp(m) >= start + SECONDS * SECOND)
        assert sender.ended()[0] == 0
    states = [m for m in arm.actual.messages
              if start + JOINED < stamp(m) < start + SECONDS * SECOND]
    times = np.array([stamp(m) - start for m in states]) / SECOND
    expected = START + SWING * (1.0 - np.cos(W * times))[:, np.newaxis]
    assert len(states) > 350  # of 360, one each 5 ms
    assert np.abs(np.array([m.position for m in states]) - expected).max() < ERROR
