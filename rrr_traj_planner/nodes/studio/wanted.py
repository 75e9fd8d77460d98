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

"""What the user of the page wants to be planned."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.payload import Payload
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.errors import InvalidInputError, UnreachableError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.inverse import nearest_solution
from rrr_traj_planner.nodes.point_files.task import Task
from rrr_traj_planner.planners.registry import planner


@dataclass(frozen=True, eq=False)
class Wanted:
    """
    What is to be planned.

    Attributes
    ----------
    task : Task
        Via points of the tip, planner, stops, rests and durations.
    velocity_scaling, acceleration_scaling : float
        Fractions of the limits that may be used.
    elbow, shoulder : str
        The posture, 'up' or 'down', 'front' or 'back'; empty: free.
    max_deviation : float
        Of a Cartesian planner's path from the polyline [m]; 0: the planner's own.
    payload : Payload
        What the arm carries.
    joints : ndarray, shape (n, 3), optional
        Joint positions at the via points [rad], where these are to be gone through: no choice of
        posture, then. NaN where they are not known.

    """

    task: Task
    velocity_scaling: float = 1.0
    acceleration_scaling: float = 1.0
    elbow: str = ''
    shoulder: str = ''
    max_deviation: float = 0.0
    payload: Payload = field(default_factory=Payload)
    joints: Array | None = None

    @property
    def points(self) -> Array:
        """Return the via points, shape (n, 3) [m]."""
        return self.task.via_points

    @property
    def stops(self) -> BoolArray:
        """Return whether the arm stops at each via point, shape (n,): at the last it does."""
        stops = np.zeros(len(self.points), dtype=bool)
        if len(self.task.stop_at):
            stops[:] = self.task.stop_at
        stops[-1] = True
        return stops

    @property
    def rests(self) -> Array:
        """Return how long the arm rests at each via point, shape (n,) [s]."""
        return np.array(self.task.dwell) if len(self.task.dwell) else np.zeros(len(self.points))

    @property
    def durations(self) -> Array:
        """Return the prescribed time of each segment, shape (n - 1,) [s]; NaN: none is."""
        durations = self.task.segment_durations
        return np.array(durations) if len(durations) else np.full(len(self.points) - 1, np.nan)

    @property
    def joints_known(self) -> bool:
        """Return whether the motion is through joint positions, all of which are known."""
        return self.joints is not None and bool(np.isfinite(self.joints).all())

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
            The same otherwise; joint positions there are not known any more.

        """
        points, joints = np.array(self.points), self.joints
        points[index] = position
        if joints is not None:
            joints = np.array(joints)
            joints[index] = np.nan
        return replace(self, task=replace(self.task, via_points=points), joints=joints)

    def with_options(self, other: Wanted) -> Wanted:
        """
        Return the same with the options of another: all that a via-point file does not have.

        Parameters
        ----------
        other : Wanted
            Whose scalings, posture, deviation and payload are taken; no posture where joint
            positions are gone through.

        Returns
        -------
        Wanted
            With these via points.

        """
        free = self.joints is not None
        return replace(other, task=self.task, joints=self.joints,
                       elbow='' if free else other.elbow,
                       shoulder='' if free else other.shoulder)

    def completed(self, model: RobotModel, before: Wanted | None = None) -> Wanted:
        """
        Return the same with joint positions that are not known found from the tip's.

        Parameters
        ----------
        model : RobotModel
            The arm.
        before : Wanted, optional
            Via points of as many as now are nearest to their own joint positions in it; others to
            those of the nearest via point that has some.

        Returns
        -------
        Wanted
            Still not known where a via point is out of reach.

        """
        if self.joints is None or self.joints_known:
            return self
        joints = np.array(self.joints)
        known = np.flatnonzero(np.isfinite(joints).all(axis=1))
        own = before.joints if before is not None and before.joints is not None else joints
        for index in np.flatnonzero(np.isnan(joints).any(axis=1)).tolist():
            seed = own[index] if len(own) == len(joints) else joints[index]
            if np.isnan(seed).any() and len(known):
                seed = joints[known[np.abs(known - index).argmin()]]
            try:
                joints[index] = nearest_solution(
                    model, self.points[index], np.nan_to_num(seed))
            except UnreachableError:
                continue
        return replace(self, joints=joints)


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
        With the positions of the tip that belong to joint positions.

    Raises
    ------
    InvalidInputError
        If the via points are in another frame, or of other joints, or the planner is unknown.

    """
    task.check_frame(base_frame)
    try:
        planner(task.planner_id or default_planner)
    except InvalidInputError as error:
        raise InvalidInputError(f'{task.name}: {error}') from None
    joints = task.joint_via_points(model.joint_names)
    points = task.via_points if joints is None else forward_kinematics(model, joints)
    return Wanted(replace(task, via_points=points, joint_positions=None, frame='',
                          planner_id=task.planner_id or default_planner), joints=joints)
