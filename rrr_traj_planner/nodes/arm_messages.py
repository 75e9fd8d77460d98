"""Between ROS messages and the arm's own values."""

from __future__ import annotations

from array import array
from collections.abc import Sequence

from builtin_interfaces.msg import Duration, Time
from rrr_traj_planner.core.incoming_trajectory import IncomingPoint, IncomingTrajectory
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory

SECOND = 1_000_000_000  # ns


def incoming_trajectory(message: JointTrajectory) -> IncomingTrajectory:
    """
    Return the content of a message, nothing checked.

    Parameters
    ----------
    message : JointTrajectory
        The message.

    Returns
    -------
    IncomingTrajectory
        Its names, stamp and points.

    """
    return IncomingTrajectory(
        message.joint_names, nanoseconds(message.header.stamp),
        [IncomingPoint(nanoseconds(p.time_from_start), p.positions, p.velocities,
                       p.accelerations, p.effort) for p in message.points])


def nanoseconds(time: Time | Duration) -> int:
    """
    Return a time or duration message in nanoseconds.

    Parameters
    ----------
    time : Time or Duration
        The message.

    Returns
    -------
    int
        [ns].

    """
    return int(time.sec) * SECOND + int(time.nanosec)


class JointStateMessage:
    """
    A joint state message, made once and filled again for each publication.

    Parameters
    ----------
    joint_names : sequence of str
        The joints.

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
            When the joints were like this [ns].
        position, velocity, effort : sequence of float
            [rad], [rad/s], [N m]; an effort may be left out.

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
