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

"""The planner's answer, executed unchanged by the arm: two processes, and DDS between."""

from __future__ import annotations

from helpers.plan_requests import plan_request, points_of, START, TABLE_6_1
from helpers.scripts import Script, script
import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.nodes.output.message_times import nanoseconds
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory

# The bound of the demonstration [m].
REACHED = 2e-3


def seconds(state):
    return 1e-9 * nanoseconds(state.header.stamp)


def test_arm_passes_every_via_point_on_its_time(ros):
    points = TABLE_6_1[1:]
    with Script(script('planner')), Script(script('simulated_arm')):
        actual = ros.listen(JointState, 'joint_states', 100)
        desired = ros.listen(JointState, 'desired_joint_states', 100)
        publisher = ros.publisher(JointTrajectory, 'joint_trajectory')
        actual.wait_for()
        response = ros.call(PlanTrajectory, 'plan_trajectory', plan_request(
            points, start=START))
        assert response.error_code == response.SUCCESS, response.message
        planned = points_of(response.trajectory)
        publisher.publish(response.trajectory)  # as it came
        moving = desired.wait_for(lambda s: np.any(s.velocity))
        desired.wait_for(lambda s: not np.any(s.velocity) and seconds(s) > seconds(moving))

    # When it began, by what the arm's controller followed soon after.
    after = next(s for s in desired.messages if np.abs(s.velocity).max() > 0.1)
    joint = int(np.abs(after.velocity).argmax())
    rising = planned.positions[:np.abs(planned.velocities[:, joint]).argmax(), joint]
    sign = np.sign(after.velocity[joint])
    begun = seconds(after) - np.interp(
        sign * after.position[joint], sign * rising, planned.times[:len(rising)])
    states = actual.messages[:]  # the last ones may still be arriving
    executed = spline_through(TrajectoryPoints(
        np.array([seconds(s) for s in states]) - begun,
        np.array([s.position for s in states]),
        np.array([s.velocity for s in states])))
    tip = forward_kinematics(RobotModel(), executed.at(response.via_times)[0])
    assert np.linalg.norm(tip - points, axis=1).max() <= REACHED
    last = forward_kinematics(RobotModel(), np.array(desired.messages[-1].position))
    np.testing.assert_allclose(last, points[-1], atol=1e-9)
