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

"""Conversion between ROS messages and the arm's values."""

from __future__ import annotations

from array import array
from collections.abc import Sequence

from control_msgs.action import FollowJointTrajectory
from control_msgs.msg import JointTolerance
from rrr_traj_planner.core.control.goal_tolerances import AskedTolerance, AskedTolerances
from rrr_traj_planner.core.control.trajectory_validation import IncomingPoint, IncomingTrajectory
from rrr_traj_planner.core.errors import counted, format_distinct, InvalidInputError
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.nodes.output.message_times import nanoseconds, seconds
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory

MAX_DISTURBANCE = 1e5  # N m, far above any motor's torque; more would make the simulation diverge


def disturbance_torque(message: JointState,
                       joint_names: Sequence[str]) -> tuple[float, float, float]:
    """
    Return the disturbance torques of a message in the order of the arm's joints.

    Parameters
    ----------
    message : JointState
        Names and efforts only; joints that are not named have no disturbance.
    joint_names : sequence of str
        Names of the arm's joints.

    Returns
    -------
    tuple of 3 floats
        Torques [N m].

    Raises
    ------
    InvalidInputError
        If a name is unknown or repeats, sizes differ, there is a position or velocity, or an
        effort is not finite or too large.

    """
    if len(message.position) or len(message.velocity):
        raise InvalidInputError('a disturbance has efforts only, no positions or velocities')
    if len(message.name) != len(message.effort):
        raise InvalidInputError(f'a disturbance has {counted(len(message.name), "name")} and '
                                f'{counted(len(message.effort), "effort")}, must have an effort '
                                'for each name')
    torque = dict.fromkeys(joint_names, 0.0)
    for i, (name, effort) in enumerate(zip(message.name, message.effort)):
        if name not in torque or name in message.name[:i]:
            raise InvalidInputError(f"a disturbance names joint '{name}', must name distinct "
                                    f'joints of {", ".join(joint_names)}')
        if not abs(effort) <= MAX_DISTURBANCE:
            shown, low, high = format_distinct(effort, -MAX_DISTURBANCE, MAX_DISTURBANCE)
            raise InvalidInputError(f'the disturbance of {name} is {shown} N m, must be in '
                                    f'[{low}, {high}] N m')
        torque[name] = float(effort)
    n1, n2, n3 = torque.values()
    return n1, n2, n3


def incoming_trajectory(message: JointTrajectory) -> IncomingTrajectory:
    """
    Return the content of a trajectory message, unchecked.

    Parameters
    ----------
    message : JointTrajectory
        The message.

    Returns
    -------
    IncomingTrajectory
        Joint names, stamp and points.

    """
    return IncomingTrajectory(
        message.joint_names, nanoseconds(message.header.stamp),
        [IncomingPoint(nanoseconds(p.time_from_start), p.positions, p.velocities,
                       p.accelerations, p.effort) for p in message.points])


def asked_tolerances(goal: FollowJointTrajectory.Goal) -> AskedTolerances:
    """
    Return the tolerances of a goal, unchecked.

    Parameters
    ----------
    goal : FollowJointTrajectory.Goal
        The goal.

    Returns
    -------
    AskedTolerances
        Of its path, of its end, and its time.

    """
    def listed(tolerances: Sequence[JointTolerance]) -> list[AskedTolerance]:
        return [AskedTolerance(t.name, t.position, t.velocity, t.acceleration)
                for t in tolerances]

    return AskedTolerances(listed(goal.path_tolerance), listed(goal.goal_tolerance),
                           seconds(goal.goal_time_tolerance))


class JointStateMessage:
    """
    A joint state message that is created once and reused for each publication.

    Parameters
    ----------
    joint_names : sequence of str
        Names of the joints.

    """

    def __init__(self, joint_names: Sequence[str]) -> None:
        self._message = JointState(name=list(joint_names))

    def filled(self, stamp: int, position: Sequence[float], velocity: Sequence[float],
               effort: Sequence[float] = ()) -> JointState:
        """
        Return the message with new content.

        Parameters
        ----------
        stamp : int
            Time of the state [ns].
        position, velocity, effort : sequence of float
            State of the joints [rad], [rad/s], [N m]; effort may be empty.

        Returns
        -------
        JointState
            The same object each time.

        """
        message = self._message
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)
        message.position = array('d', position)
        message.velocity = array('d', velocity)
        message.effort = array('d', effort)
        return message
