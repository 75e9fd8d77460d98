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

"""What the user of the page wants to be planned, and how it changes."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.nodes.point_files.task import Task

FEWEST_POINTS = 2  # a motion begins at the first via point


@dataclass(frozen=True, eq=False)
class Wanted:
    """
    What is to be planned.

    Attributes
    ----------
    task : Task
        Via points of the tip, planner, stops and rests.
    velocity_scaling, acceleration_scaling : float
        Fractions of the limits that may be used.

    """

    task: Task
    velocity_scaling: float = 1.0
    acceleration_scaling: float = 1.0

    @property
    def points(self) -> Array:
        """Return the via points, shape (n, 3) [m]."""
        return self.task.via_points

    def with_planner(self, planner_id: str) -> Wanted:
        """
        Return the same by another planner.

        Parameters
        ----------
        planner_id : str
            Its id.

        Returns
        -------
        Wanted
            The same otherwise.

        """
        return replace(self, task=replace(self.task, planner_id=planner_id))

    def with_scalings(self, velocity: float, acceleration: float) -> Wanted:
        """
        Return the same with other fractions of the limits.

        Parameters
        ----------
        velocity, acceleration : float
            In (0, 1].

        Returns
        -------
        Wanted
            The same otherwise.

        """
        return replace(self, velocity_scaling=velocity, acceleration_scaling=acceleration)

    def moved(self, index: int, position: tuple[float, float, float]) -> Wanted:
        """
        Return the same with one via point elsewhere.

        Parameters
        ----------
        index : int
            Which one.
        position : tuple of 3 floats
            Where it is now [m].

        Returns
        -------
        Wanted
            The same otherwise.

        """
        points = np.array(self.points)
        points[index] = position
        return replace(self, task=replace(self.task, via_points=points))

    def with_point(self) -> Wanted:
        """
        Return the same with one via point more, halfway from the last one to the first.

        Returns
        -------
        Wanted
            The arm stops at the new last via point, and at the one before only if it rests there.

        """
        points, stop_at, dwell = self.points, self.task.stop_at, self.task.dwell
        rests = len(dwell) > 0 and bool(dwell[-1] > 0.0)
        if rests and not len(stop_at):
            stop_at = np.arange(len(points)) == len(points) - 1
        if len(stop_at):
            stop_at = np.concatenate((stop_at[:-1], [rests, True]))
        return replace(self, task=replace(
            self.task, via_points=np.vstack((points, 0.5 * (points[-1] + points[0]))),
            stop_at=stop_at, dwell=np.append(dwell, 0.0) if len(dwell) else dwell))

    def without_last(self) -> Wanted:
        """
        Return the same without the last via point.

        Returns
        -------
        Wanted
            The same where only `FEWEST_POINTS` are left.

        """
        if len(self.points) <= FEWEST_POINTS:
            return self
        stop_at = np.array(self.task.stop_at[:-1])
        stop_at[-1:] = True
        return replace(self, task=replace(
            self.task, via_points=self.points[:-1], stop_at=stop_at, dwell=self.task.dwell[:-1]))


def wanted_of(task: Task, model: RobotModel, base_frame: str, default_planner: str) -> Wanted:
    """
    Return what a via-point file asks for, as the page can change it.

    Parameters
    ----------
    task : Task
        The file.
    model : RobotModel
        The arm.
    base_frame : str
        Its frame.
    default_planner : str
        Id of the planner where the file names none.

    Returns
    -------
    Wanted
        Joint positions have become positions of the tip; durations are left out.

    Raises
    ------
    InvalidInputError
        If the via points are in another frame, or of other joints.

    """
    task.check_frame(base_frame)
    joints = task.joint_via_points(model.joint_names)
    points = task.via_points if joints is None else forward_kinematics(model, joints)
    return Wanted(replace(task, via_points=points, joint_positions=None,
                          segment_durations=np.zeros(0),
                          planner_id=task.planner_id or default_planner))
