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

"""The stopping problem: current motion, start time, limits, arm."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics.motor_torque import motor_torque
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque
from rrr_traj_planner.core.rounding import JOINT_ROUNDING
from rrr_traj_planner.core.states import Desired, State
from rrr_traj_planner.core.trajectory.reference_trajectory import ReferenceTrajectory

# A motion that exceeds a range's end by no more than this touches it [rad]; chosen: as much as the
# points of a planned motion may exceed it by.
TOUCH = 1e-6

# What candidates must keep: limits to a relative tolerance, at so many samples of time. Chosen:
# warnings use both, so that a stop that was accepted gives none.
LIMIT_TOLERANCE, FINE = 1e-4, 241


# Tracking error above which the measured state is braked instead of the command: command outside
# the ranges, inside [rad]; chosen.
LARGE_ERROR_OUTSIDE, LARGE_ERROR = 1e-4, 0.2


@dataclass(frozen=True, eq=False)
class StopTask:
    """
    The stopping problem: current motion, start time, limits, arm.

    Parameters
    ----------
    motion : ReferenceTrajectory
        The current motion; a stop may follow it for some time.
    now : float
        When the stop begins [s].
    limits : JointLimits
        The limits.
    model : RobotModel
        The arm, for its torques.

    """

    motion: ReferenceTrajectory
    now: float
    limits: JointLimits
    model: RobotModel

    def torque_ratio(self, q: Array, qd: Array, qdd: Array, allowed: Array) -> Array:
        """
        Return torques over their limits, or over allowed torques that are larger.

        Parameters
        ----------
        q, qd, qdd : ndarray, shape (..., 3)
            Positions [rad], velocities [rad/s], accelerations [rad/s^2].
        allowed : ndarray, of a shape that goes with theirs
            Torques [N m].

        Returns
        -------
        ndarray, shape (..., 3)
            Not negative.

        """
        torque = np.abs(motor_torque(self.model, q, qd, qdd))
        return np.asarray(torque / np.maximum(self.limits.max_effort, allowed))

    def holding_torque_ratio(self, q: Array) -> Array:
        """
        Return the largest ratio of a holding torque (gravity) to its limit.

        Parameters
        ----------
        q : ndarray, shape (..., 3)
            Positions [rad].

        Returns
        -------
        ndarray, shape (...)
            Not negative.

        """
        ratio = np.abs(gravity_torque(self.model, q)) / self.limits.max_effort
        return np.asarray(ratio.max(axis=-1))

    def ranges(self, q: Array) -> tuple[Array, Array]:
        """
        Return position bounds, widened to the present position of joints outside them.

        Parameters
        ----------
        q : ndarray, shape (..., 3)
            Positions [rad].

        Returns
        -------
        tuple of ndarray, shape (..., 3)
            Lower and upper ends [rad].

        """
        low, high = self.limits.min_position, self.limits.max_position
        return (np.where(q < low - JOINT_ROUNDING, q - TOUCH, low),
                np.where(q > high + JOINT_ROUNDING, q + TOUCH, high))


def time_inside(motion: ReferenceTrajectory, now: float, limits: JointLimits) -> float:
    """
    Return the time until which a motion stays inside the ranges.

    Parameters
    ----------
    motion : ReferenceTrajectory
        The motion.
    now : float
        Time at which the check begins [s].
    limits : JointLimits
        With the ranges.

    Returns
    -------
    float
        Its end, if it never leaves them; -inf, if it is outside already [s].

    """
    # 1 ms apart in a motion of a second; chosen.
    times = np.linspace(now, max(now, motion.end), 1001)
    q = motion.at(times)[0]
    outside = ((q < limits.min_position - TOUCH) | (q > limits.max_position + TOUCH)).any(axis=1)
    if not outside.any():
        return motion.end
    first = int(np.argmax(outside))
    return float(times[first - 1]) if first else -inf


def from_state(state: Desired, now: int) -> ReferenceTrajectory:
    """
    Return a reference trajectory that consists of a single state.

    Parameters
    ----------
    state : tuple of 9 floats
        Positions [rad], velocities [rad/s], accelerations [rad/s^2].
    now : int
        The time [ns].

    Returns
    -------
    ReferenceTrajectory
        Of one knot.

    """
    q, qd, qdd = np.reshape(state, (3, 3))
    return ReferenceTrajectory(np.zeros(1), np.zeros((0, 3, 6)), q, now, qd, qdd)


class MeasuredState(ReferenceTrajectory):
    """
    A measured state as a reference trajectory of one knot, for `stop`.

    Its acceleration, which is not measured, is zero.

    Parameters
    ----------
    measured : tuple of 6 floats
        Positions [rad] and velocities [rad/s].
    now : int
        The time [ns].
    commanded : ReferenceTrajectory
        The trajectory commanded then.

    Attributes
    ----------
    commanded_position : ndarray, shape (3,)
        [rad].

    """

    def __init__(self, measured: State, now: int, commanded: ReferenceTrajectory) -> None:
        super().__init__(np.zeros(1), np.zeros((0, 3, 6)), np.array(measured[:3]), now,
                         np.array(measured[3:]), np.zeros(3))
        self.commanded_position = np.array(commanded.command(now)[:3])


def motion_to_brake(motion: ReferenceTrajectory, now: int, measured: State,
                    limits: JointLimits) -> ReferenceTrajectory:
    """
    Return the motion to brake: the reference, or the measured state if the error is large.

    Parameters
    ----------
    motion : ReferenceTrajectory
        The reference.
    now : int
        The time [ns].
    measured : tuple of 6 floats
        Measured positions [rad] and velocities [rad/s].
    limits : JointLimits
        Ranges: for a command outside them, a smaller tracking error counts as large.

    Returns
    -------
    ReferenceTrajectory
        For `stop`.

    """
    q = np.array(motion.command(now)[:3])
    outside = ((q < limits.min_position - TOUCH) | (q > limits.max_position + TOUCH)).any()
    large = np.abs(q - measured[:3]).max() > (LARGE_ERROR_OUTSIDE if outside else LARGE_ERROR)
    return MeasuredState(measured, now, motion) if large else motion
