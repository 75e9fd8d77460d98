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

"""A trajectory controller that is not the package's, of an arm that follows it exactly."""

from __future__ import annotations

from math import nan

from control_msgs.action import FollowJointTrajectory
from control_msgs.msg import JointTrajectoryControllerState
from helpers.arm_in_ros import NAMES, START
import numpy as np
from rclpy.duration import Duration
from rrr_traj_planner.nodes.output.message_times import nanoseconds
from rrr_traj_planner.nodes.process.goal_server import ABORTED, GoalServer, SUCCEEDED
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectoryPoint

RATE = 100.0  # Hz
ORDER = ['gripper', *reversed(NAMES)]  # of the states that it publishes


class OtherController:
    """
    Measures positions alone, and publishes them by one of two topics.

    By `joint_states` in one of several forms: `plain`, `without time`, `in parts` (each message
    has some of the joints) or `nan` (in place of velocities and efforts).
    """

    def __init__(self, ros, name, by_joint_states=True, late=0.0, form='plain'):
        self._form = form
        self._late = Duration(seconds=late)  # of its clock
        self._clock = ros.node.get_clock()
        self.q, self._goal = np.array(START), None
        self._server = GoalServer(
            ros.node, FollowJointTrajectory, f'{name}/follow_joint_trajectory', lambda goal: None,
            self._begin, self._cancel)
        self._by_joint_states = by_joint_states
        kind, topic = ((JointState, 'joint_states') if by_joint_states else
                       (JointTrajectoryControllerState, f'{name}/controller_state'))
        self._states = ros.node.create_publisher(kind, topic, 10)
        ros.node.create_timer(1.0 / RATE, self._update)

    def destroy(self):
        self._server.destroy()

    def _begin(self, handle, _):
        """Take over from the goal in progress, if there is one; no feedback is given of either."""
        if self._goal is not None:
            self._server.end(self._goal, ABORTED, FollowJointTrajectory.Result())
        self._goal = handle

    def _cancel(self, _):
        self._goal = None
        return FollowJointTrajectory.Result()

    def _update(self):
        """Follow the goal by straight lines between its points, and publish the state."""
        now = self._clock.now() - self._late
        if self._goal is not None:
            trajectory = self._goal.request.trajectory
            times = [nanoseconds(p.time_from_start) for p in trajectory.points]
            time = now.nanoseconds - nanoseconds(trajectory.header.stamp)
            q = np.array([p.positions for p in trajectory.points])
            self.q = np.array([np.interp(time, times, column) for column in q.T])
            if time > times[-1]:
                self._server.end(self._goal, SUCCEEDED, FollowJointTrajectory.Result())
                self._goal = None
        message = self._message(now.to_msg())
        if self._form != 'in parts':
            self._states.publish(message)
            return
        for part in (slice(0, 2), slice(2, 4)):
            self._states.publish(JointState(
                header=message.header, name=message.name[part], position=message.position[part]))

    def _message(self, stamp):
        q = [0.0, *self.q[::-1].tolist()]
        if self._by_joint_states:
            message = JointState(name=ORDER, position=q)
        else:
            message = JointTrajectoryControllerState(joint_names=ORDER)
            message.reference = message.feedback = JointTrajectoryPoint(positions=q)
        if self._form == 'nan':
            message.velocity = message.effort = [nan] * len(ORDER)
        if self._form != 'without time':
            message.header.stamp = stamp
        return message
