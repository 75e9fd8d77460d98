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
The instant at which a new trajectory takes over, and which states can be met from there.

A segment from the present command to a state is within the limits if its positions, velocities,
accelerations and torques are; each limit extends to the values of the command and of the state.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, BoolArray, IntArray
from rrr_traj_planner.core.dynamics.motor_torque import motor_torque
from rrr_traj_planner.core.states import Desired
from rrr_traj_planner.core.trajectory.bernstein import bernstein_forms, leaves
from rrr_traj_planner.core.trajectory.limit_check import TOLERANCE
from rrr_traj_planner.core.trajectory.quintic_spline import hermite, polynomial
from rrr_traj_planner.core.trajectory.reference_trajectory import ReferenceTrajectory

STEPS = 32  # in which the torque on a segment is checked; chosen


@dataclass(frozen=True, eq=False)
class Takeover:
    """
    The instant at which a new trajectory takes over.

    Parameters
    ----------
    now : float
        [s].
    command : tuple of 9 floats
        Positions [rad], velocities [rad/s], accelerations [rad/s^2] commanded now.
    limits : JointLimits
        Limits of joining motions.
    model : RobotModel
        The arm.
    running : ReferenceTrajectory, optional
        What would be braked now (`motion_to_brake`); None: only the command is known.

    """

    now: float
    command: Desired
    limits: JointLimits
    model: RobotModel
    running: ReferenceTrajectory | None = None

    @property
    def states(self) -> tuple[Array, Array, Array]:
        """Position, velocity and acceleration of the command, shape (3,) each."""
        q, qd, qdd = np.reshape(self.command, (3, 3))
        return q, qd, qdd


class Segment:
    """
    Segments from the command to states at later times, and the limits that hold for each.

    Parameters
    ----------
    takeover : Takeover
        The present.
    T : ndarray, shape (n,)
        Times until the states [s].
    ends : tuple of ndarray, shape (n, 3)
        Positions [rad]; for cubics velocities [rad/s], for quintics accelerations [rad/s^2] too.

    Attributes
    ----------
    forms : tuple of ndarray, shape (n, 3, m)
        Bernstein coefficients of position, velocity and acceleration.
    bounds : list of tuple of two ndarray, shape (n, 3)
        Lower and upper bounds of the same.

    """

    def __init__(self, takeover: Takeover, T: Array, ends: tuple[Array, ...]) -> None:
        self._takeover, self._T = takeover, T
        starts = takeover.states[:len(ends)]
        c = np.stack(np.broadcast_arrays(*hermite(T[:, np.newaxis], starts, ends)), axis=-1)
        self._c = np.pad(c, ((0, 0), (0, 0), (0, 6 - c.shape[-1])))
        self.forms = bernstein_forms(self._c, T)
        self.bounds = _bounds(takeover, ends)

    def torques(self, i: IntArray) -> tuple[Array, Array]:
        """
        Return the torques along some segments, and what they may be.

        Parameters
        ----------
        i : ndarray of int, shape (k,)
            Indices of the segments.

        Returns
        -------
        tuple of ndarray, shapes (m, k, 3), (1, k, 3)
            Absolute values, from the command to the state [N m]; largest ones [N m].

        """
        times = np.linspace(0.0, 1.0, STEPS + 1)[:, np.newaxis, np.newaxis]
        times = times * self._T[i, np.newaxis]
        q, qd, qdd = (polynomial(np.moveaxis(self._c[i], -1, 0), times, order)
                      for order in range(3))
        torque = np.abs(motor_torque(self._takeover.model, q, qd, qdd))
        return torque, np.maximum(
            self._takeover.limits.max_effort, np.maximum(torque[:1], torque[-1:]))

    def are_within_limits(self) -> BoolArray:
        """
        Return which of the segments are within the limits.

        Returns
        -------
        ndarray of bool, shape (n,)
            To `TOLERANCE`, which the bounds have.

        """
        met = np.ones(len(self._T), dtype=bool)
        for form, (low, high) in zip(self.forms, self.bounds):
            met &= ~leaves(form, low - TOLERANCE, high + TOLERANCE).any(axis=1)
        i = np.flatnonzero(met)
        torque, allowed = self.torques(i)
        met[i] = (torque <= allowed * (1.0 + TOLERANCE)).all(axis=(0, 2))
        return met


def _bounds(takeover: Takeover, ends: tuple[Array, ...]) -> list[tuple[Array, Array]]:
    """Return bounds on position, velocity and acceleration, (n, 3) each."""
    limits, starts = takeover.limits, takeover.states
    bounds = [(np.minimum(limits.min_position, np.minimum(starts[0], ends[0])),
               np.maximum(limits.max_position, np.maximum(starts[0], ends[0])))]
    for n, limit in enumerate((limits.max_velocity, limits.max_acceleration), start=1):
        end = np.abs(ends[n]) if n < len(ends) else np.zeros_like(ends[0])
        most = np.maximum(limit, np.maximum(np.abs(starts[n]), end)) * (1.0 + TOLERANCE)
        bounds.append((-most, most))
    return bounds
