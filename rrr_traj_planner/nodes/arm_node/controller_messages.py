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
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.core.simulation.controlled_arm import ControlledArm
from trajectory_msgs.msg import JointTrajectoryPoint


def feedback_message(arm: ControlledArm, stamp: int) -> FollowJointTrajectory.Feedback:
    """
    Return the feedback of a goal.

    Parameters
    ----------
    arm : ControlledArm
        The arm, which follows the goal's trajectory.
    stamp : int
        Time of its state [ns].

    Returns
    -------
    FollowJointTrajectory.Feedback
        `time_from_start` counts from the trajectory's start, as in joint_trajectory_controller.

    """
    message = FollowJointTrajectory.Feedback(joint_names=arm.settings.model.joint_names)
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)
    message.desired, message.actual, message.error = _points(arm)
    return message


def _points(arm: ControlledArm) -> tuple[JointTrajectoryPoint, ...]:
    """Return reference, measured state and their difference."""
    desired, actual = arm.desired, arm.measured
    error = [a - b for a, b in zip(desired, actual)]
    sec, nanosec = divmod(arm.now - arm.motion.origin_ns, SECOND)
    time = Duration(sec=sec, nanosec=nanosec)
    return (_point(desired[:3], desired[3:6], desired[6:], time),
            _point(actual[:3], actual[3:], (), time), _point(error[:3], error[3:], (), Duration()))


def _point(positions: Sequence[float], velocities: Sequence[float],
           accelerations: Sequence[float], time: Duration) -> JointTrajectoryPoint:
    return JointTrajectoryPoint(
        positions=array('d', positions), velocities=array('d', velocities),
        accelerations=array('d', accelerations), time_from_start=time)
