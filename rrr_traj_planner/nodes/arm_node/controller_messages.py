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

"""Messages about the arm's controller: reference, measured state, and their difference."""

from __future__ import annotations

from array import array
from collections.abc import Sequence

from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from control_msgs.msg import JointTrajectoryControllerState
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.core.simulation.controlled_arm import ControlledArm
from std_msgs.msg import Header
from trajectory_msgs.msg import JointTrajectoryPoint


class ControllerMessages:
    """
    Messages that are created once and reused for each publication.

    Times from the start count from the start of the trajectory, or of the hold, as in
    joint_trajectory_controller.

    Parameters
    ----------
    arm : ControlledArm
        The arm.

    """

    def __init__(self, arm: ControlledArm) -> None:
        self._arm, names = arm, list(arm.settings.model.joint_names)
        self._feedback = FollowJointTrajectory.Feedback(joint_names=names)
        self._state = JointTrajectoryControllerState(joint_names=names, speed_scaling_factor=1.0)

    def feedback(self, stamp: int) -> FollowJointTrajectory.Feedback:
        """
        Return the feedback of a goal.

        Parameters
        ----------
        stamp : int
            Time of the arm's state [ns].

        Returns
        -------
        FollowJointTrajectory.Feedback
            The same object each time.

        """
        message = self._feedback
        self._fill(message.header, message.desired, message.actual, message.error, stamp)
        return message

    def state(self, stamp: int) -> JointTrajectoryControllerState:
        """
        Return the controller's state.

        Parameters
        ----------
        stamp : int
            Time of the arm's state [ns].

        Returns
        -------
        JointTrajectoryControllerState
            Its output are the torques that it commands; the same object each time.

        """
        message = self._state
        self._fill(message.header, message.reference, message.feedback, message.error, stamp)
        message.output.effort = array('d', self._arm.torque)
        return message

    def _fill(self, header: Header, reference: JointTrajectoryPoint,
              measured: JointTrajectoryPoint, error: JointTrajectoryPoint, stamp: int) -> None:
        """Fill a message's stamp and points."""
        header.stamp.sec, header.stamp.nanosec = divmod(stamp, SECOND)
        desired, actual = self._arm.desired, self._arm.measured
        elapsed = self._arm.now - self._arm.motion.origin_ns
        for point, values in ((reference, desired), (measured, actual)):
            _fill_point(point, values)
            _fill_time(point.time_from_start, elapsed)
        reference.accelerations = array('d', desired[6:])
        _fill_point(error, [a - b for a, b in zip(desired, actual)])


def _fill_point(point: JointTrajectoryPoint, values: Sequence[float]) -> None:
    """Fill positions and velocities."""
    point.positions, point.velocities = array('d', values[:3]), array('d', values[3:6])


def _fill_time(time: Duration, nanoseconds: int) -> None:
    time.sec, time.nanosec = divmod(nanoseconds, SECOND)
