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

"""A running arm node for tests, with its messages and methods to command it."""

from __future__ import annotations

from builtin_interfaces.msg import Duration, Time
import numpy as np
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.srv import SetParameters
from rclpy.parameter import Parameter
from rrr_traj_planner.nodes.arm_node.node import SimulatedArm
from rrr_traj_planner.nodes.output.message_times import nanoseconds
from rrr_traj_planner.nodes.parameters.table import ARM, rows_of
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

NAMES = ['joint_1', 'joint_2', 'joint_3']
START = np.array(rows_of(ARM, NAMES)['initial_positions'].default)
GOAL = START + (0.05, -0.04, 0.06)
SECOND = 10 ** 9
ALL = 1000  # queue of a listener [messages]: no burst is lost on a busy machine


def duration(seconds):
    sec, nanosec = divmod(round(seconds * SECOND), SECOND)
    return Duration(sec=sec, nanosec=nanosec)


def trajectory_message(*points, names=NAMES, stamp=0):
    """Return points: time [s], positions, then velocities and accelerations if wanted."""
    message = JointTrajectory(joint_names=list(names))
    message.header.stamp = Time(sec=stamp // SECOND, nanosec=stamp % SECOND)
    for time, *fields in points:
        point = JointTrajectoryPoint(time_from_start=duration(time))
        for field, values in zip(('positions', 'velocities', 'accelerations'), fields):
            setattr(point, field, [float(x) for x in values])
        message.points.append(point)
    return message


class Arm:
    """A running arm node, its published messages, and methods to send it trajectories."""

    def __init__(self, ros, **overrides):
        self.ros = ros
        self.node = SimulatedArm(context=ros.context, parameter_overrides=[
            Parameter(name, value=value) for name, value in overrides.items()])
        self.actual = ros.listen(JointState, 'joint_states', ALL)
        self.desired = ros.listen(JointState, 'desired_joint_states', ALL)
        ros.add(self.node)
        self._publisher = ros.publisher(JointTrajectory, 'joint_trajectory')

    def send(self, *points, names=NAMES, stamp=0):
        """Send a trajectory on the topic."""
        self._publisher.publish(trajectory_message(*points, names=names, stamp=stamp))

    def disturb(self, **torques):
        """Apply disturbance torques [N m] to joints; without any, end the disturbance."""
        if not hasattr(self, '_disturber'):
            self._disturber = self.ros.publisher(JointState, 'disturbance')
        self._disturber.publish(JointState(
            name=list(torques), effort=[float(x) for x in torques.values()]))

    def set_parameter(self, name, value):
        """Set a parameter, and return the response."""
        message = ParameterMessage(
            name=name, value=Parameter(name, value=value).get_parameter_value())
        return self.ros.call(SetParameters, 'simulated_arm/set_parameters',
                             SetParameters.Request(parameters=[message])).results[0]

    def trigger(self, name):
        return self.ros.call(Trigger, f'simulated_arm/{name}')

    def now(self):
        return self.node.get_clock().now().nanoseconds


def stamp(message):
    return nanoseconds(message.header.stamp)


def at(q, tolerance=1e-5):
    """Return whether a joint state is at rest at given positions."""
    return lambda m: (np.abs(np.subtract(m.position, q)).max() <= tolerance
                      and np.abs(m.velocity).max() <= tolerance)


def moving(message):
    return np.abs(message.velocity).max() > 0.01


def rest_to_rest(goal, duration):
    return duration, goal, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
