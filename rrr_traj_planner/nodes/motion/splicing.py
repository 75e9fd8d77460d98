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

"""
A trajectory that goes on with another one in motion.

The message has what is left of the motion in progress and the new plan behind it, with the old
stamp: at every instant the command is on both, so that nothing steps (docs/replanning.md).
"""

from __future__ import annotations

from builtin_interfaces.msg import Duration
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.nodes.motion.arm_states import ArmState
from rrr_traj_planner.nodes.output.message_times import nanoseconds
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint


def time_of(trajectory: JointTrajectory, i: int) -> int:
    """
    Return when a trajectory reaches one of its points.

    Parameters
    ----------
    trajectory : JointTrajectory
        With a stamp.
    i : int
        Index of the point.

    Returns
    -------
    int
        [ns].

    """
    return nanoseconds(trajectory.header.stamp) + nanoseconds(
        trajectory.points[i].time_from_start)


def first_point_from(trajectory: JointTrajectory, time: int) -> int:
    """
    Return the first point that is reached at a time or later.

    Parameters
    ----------
    trajectory : JointTrajectory
        With a stamp.
    time : int
        [ns].

    Returns
    -------
    int
        Index; that of the last point if all are reached earlier.

    """
    due = time - nanoseconds(trajectory.header.stamp)
    return next((k for k, point in enumerate(trajectory.points)
                 if nanoseconds(point.time_from_start) >= due), len(trajectory.points) - 1)


def state_at(trajectory: JointTrajectory, i: int) -> ArmState:
    """
    Return the state at a point.

    Parameters
    ----------
    trajectory : JointTrajectory
        Its points have velocities and accelerations.
    i : int
        Index of the point.

    Returns
    -------
    ArmState
        At the time of the point.

    """
    point = trajectory.points[i]
    return ArmState(dict(zip(trajectory.joint_names, zip(
        point.positions, point.velocities, point.accelerations))), time_of(trajectory, i))


def spliced(trajectory: JointTrajectory, i: int, plan: JointTrajectory,
            now: int) -> JointTrajectory:
    """
    Return a trajectory up to one of its points, and a plan from there on.

    Parameters
    ----------
    trajectory : JointTrajectory
        The motion in progress.
    i : int
        The point with which the plan begins.
    plan : JointTrajectory
        Times are from its first point.
    now : int
        Points that have passed are left out, but the last of them [ns].

    Returns
    -------
    JointTrajectory
        With the stamp of the motion in progress.

    """
    begins = nanoseconds(trajectory.points[i].time_from_start)
    first = max(first_point_from(trajectory, now) - 1, 0)
    return JointTrajectory(
        header=trajectory.header, joint_names=plan.joint_names,
        points=[*trajectory.points[first:i], *(_later(point, begins) for point in plan.points)])


def _later(point: JointTrajectoryPoint, delay: int) -> JointTrajectoryPoint:
    sec, nanosec = divmod(nanoseconds(point.time_from_start) + delay, SECOND)
    return JointTrajectoryPoint(
        positions=point.positions, velocities=point.velocities,
        accelerations=point.accelerations, time_from_start=Duration(sec=sec, nanosec=nanosec))
