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

"""Motions of the arm node: a clock that waits for it, places to go to, steps in its command."""

from __future__ import annotations

from helpers.arm_in_ros import SECOND, stamp
import numpy as np
from rclpy.time import Time
from rosgraph_msgs.msg import Clock as ClockMessage
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque
from rrr_traj_planner.core.kinematics.forward import forward_kinematics

RATE = 100.0  # Hz, of the arm's states
TICK = round(SECOND / RATE)
LIMITS = JointLimits()
ROUNDING = 1e-6  # rad, rad/s: of stamps, a nanosecond each, and of the fields of a message
MORE = 1.1      # times jerk's limit, by a quintic between two points


def random_places(rng, model):
    """Return one to three tip positions that the arm can reach and hold."""
    while True:
        q = rng.uniform([0.1, 0.6, -0.6], [1.4, 1.8, 0.6], (rng.integers(1, 4), 3))
        if (np.abs(gravity_torque(model, q)) < 0.9 * LIMITS.max_effort).all():
            return forward_kinematics(model, q).tolist()


class SteppedClock:
    """A clock that goes on when the arm has followed: no message is late, however busy it is."""

    def __init__(self, ros):
        self.time = 100 * SECOND
        self._publisher = ros.publisher(ClockMessage, '/clock')

    def now(self):
        """Return the time, as a node's clock does."""
        return Time(nanoseconds=self.time)

    def advance(self, arm, seconds):
        """Let time pass."""
        for _ in range(round(seconds * SECOND / TICK)):
            self.time += TICK
            self._publisher.publish(ClockMessage(clock=self.now().to_msg()))
            arm.desired.wait_for(lambda m: stamp(m) > self.time - TICK,
                                 max(len(arm.desired.messages) - 5, 0))


def assert_steady(messages):
    """Assert that what the controller follows has no step in position, velocity, acceleration."""
    t = np.array([stamp(m) for m in messages]) / SECOND
    q, v = (np.array([getattr(m, f) for m in messages]) for f in ('position', 'velocity'))
    dt = np.diff(t)[:, np.newaxis]
    jerk = MORE * LIMITS.max_jerk
    # the error of the trapezoidal rule is at most jerk dt^3 / 12
    assert (np.abs(np.diff(q, axis=0) - 0.5 * dt * (v[1:] + v[:-1]))
            <= jerk * dt ** 3 / 12.0 + ROUNDING).all()
    mean = np.diff(v, axis=0) / dt  # acceleration, somewhere between two messages
    assert (np.abs(np.diff(mean, axis=0))
            <= 0.5 * jerk * (dt[1:] + dt[:-1]) + ROUNDING / dt.min()).all()
