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

"""The result of planning: the motion, its points, and its peaks."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike
from typing import TextIO

from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics.motor_torque import motor_torque, rest_speed_of
from rrr_traj_planner.core.read_only import ReadOnlyArrays
from rrr_traj_planner.core.trajectory.trajectory import Peaks, Trajectory
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.planners.csv_columns import write_columns


@dataclass(frozen=True, eq=False)
class Plan(ReadOnlyArrays):
    """
    A motion within its limits, and its peaks.

    Parameters
    ----------
    trajectory : Trajectory
        The continuous motion.
    points : TrajectoryPoints
        The same, sampled.
    via_times : ndarray
        When each via point is reached [s]; for one that is blended, the middle of its transition.
    peaks : Peaks
        Exact extremes over the continuous motion.
    effort : ndarray, shape (3,)
        Peak torques [N m].
    model : RobotModel
        The arm that it is planned for.
    note : str
        Remarks for the caller, usually empty.

    """

    trajectory: Trajectory
    points: TrajectoryPoints
    via_times: Array
    peaks: Peaks
    effort: Array
    model: RobotModel
    note: str = ''

    def columns(self) -> dict[str, Array]:
        """
        Return the sampled motion by columns, with its torques.

        Returns
        -------
        dict
            Arrays of shape (n,) by their headers: `time [s]`, then of every joint `NAME position
            [rad]`, of every joint `NAME velocity [rad/s]`, `NAME acceleration [rad/s^2]` and
            `NAME effort [N m]`.

        """
        p = self.points
        torque = motor_torque(self.model, p.positions, p.velocities, p.accelerations,
                              rest_speed_of(p.velocities))
        found = {'time [s]': p.times}
        for quantity, values in (
                ('position [rad]', p.positions), ('velocity [rad/s]', p.velocities),
                ('acceleration [rad/s^2]', p.accelerations), ('effort [N m]', torque)):
            found |= {f'{joint} {quantity}': values[:, i]
                      for i, joint in enumerate(self.model.joint_names)}
        return found

    def to_csv(self, file: str | PathLike[str] | TextIO) -> None:
        """
        Write `columns` as a file of comma-separated values, with digits to read them again.

        Parameters
        ----------
        file : path or text file
            A path, which is overwritten, or a file that is open for text.

        Raises
        ------
        InvalidInputError
            If the file is neither a path nor an open file.
        OSError
            If it cannot be written.

        """
        write_columns(file, self.columns())
