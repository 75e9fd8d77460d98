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

"""`~/controller_state`: what other topics have, in one message."""

from __future__ import annotations

from control_msgs.msg import JointTrajectoryControllerState
from helpers.arm_in_ros import ALL, Arm, GOAL, moving, NAMES, rest_to_rest, stamp
import numpy as np
from rrr_traj_planner.nodes.output.message_times import nanoseconds

TRAPEZE = 5e-3  # rad/s^2: snap * 5 ms^2 / 12, of a snap of 2400 rad/s^4 at most


def test_controller_state_is_what_the_other_topics_have(ros):
    arm = Arm(ros, **{'payload.mass': 3.0})
    states = ros.listen(JointTrajectoryControllerState, 'simulated_arm/controller_state', ALL)
    states.wait_for()
    arm.send(rest_to_rest(GOAL, 0.4))
    arm.desired.wait_for(moving)
    arm.desired.wait_for(lambda m: np.array_equal(m.position, GOAL))
    until = stamp(arm.desired.messages[-1])
    for listener in (states, arm.actual, arm.desired):
        listener.wait_for(lambda m: stamp(m) > until)
    actual, desired = ({stamp(m): m for m in x.messages} for x in (arm.actual, arm.desired))
    common = [m for m in states.messages if stamp(m) in actual and stamp(m) in desired]
    assert len(common) > 20
    for m in common:
        a, d = actual[stamp(m)], desired[stamp(m)]
        assert m.joint_names == NAMES and m.speed_scaling_factor == 1.0
        for point, state in ((m.reference, d), (m.feedback, a)):
            np.testing.assert_array_equal(point.positions, state.position)
            np.testing.assert_array_equal(point.velocities, state.velocity)
        np.testing.assert_array_equal(m.error.positions, np.subtract(d.position, a.position))
        np.testing.assert_array_equal(m.error.velocities, np.subtract(d.velocity, a.velocity))
        np.testing.assert_array_equal(m.output.effort, a.effort)
    # Of the trajectory: its time, and the acceleration of a quintic that starts at rest.
    moved = [m for m in common if 0 < nanoseconds(m.reference.time_from_start) < 4 * 10 ** 8
             and np.any(m.reference.velocities)]
    start = stamp(moved[0]) - nanoseconds(moved[0].reference.time_from_start)
    for m in moved:
        assert stamp(m) - nanoseconds(m.feedback.time_from_start) == start
    t = np.array([1e-9 * nanoseconds(m.reference.time_from_start) for m in moved])
    qd, qdd = (np.array([getattr(m.reference, name) for m in moved])
               for name in ('velocities', 'accelerations'))
    between = np.diff(t) < 0.006  # no state was lost between two
    assert between.any()
    slope = (np.diff(qd, axis=0) / np.diff(t)[:, np.newaxis])[between]
    np.testing.assert_allclose(slope, (0.5 * (qdd[1:] + qdd[:-1]))[between], atol=TRAPEZE)
