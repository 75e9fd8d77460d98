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

"""What has to stop and what it must keep: a motion, the time, limits, the arm."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque, inverse_dynamics
from rrr_traj_planner.core.states import Desired, State
from rrr_traj_planner.core.trajectory.reference_trajectory import ReferenceTrajectory

# So far beyond a range is within it [rad]; a motion may touch its ends to the other.
POSITION_TOLERANCE, TOUCH = 1e-9, 1e-6

# At so many instants it is looked whether a motion stays inside.
LOOKS = 1001

# A command so far from the arm is not what has to stop: outside the ranges, inside [rad].
ASTRAY_OUTSIDE, ASTRAY = 1e-4, 0.2


@dataclass(frozen=True, eq=False)
class StopTask:
    """
    What has to stop, and what it must keep.

    Parameters
    ----------
    motion : ReferenceTrajectory
        What the arm follows; the stop may follow it a little longer.
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

    def torque_share(self, q: Array, qd: Array, qdd: Array, allowed: Array) -> Array:
        """
        Return torques over their limits, or over what is allowed where that is more.

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
        torque = np.abs(inverse_dynamics(self.model, q, qd, qdd))
        return np.asarray(torque / np.maximum(self.limits.max_effort, allowed))

    def rest_share(self, q: Array) -> Array:
        """
        Return the torques that hold the arm over their limits, the largest of the joints.

        Parameters
        ----------
        q : ndarray, shape (..., 3)
            Positions [rad].

        Returns
        -------
        ndarray, shape (...)
            Not negative.

        """
        share = np.abs(gravity_torque(self.model, q)) / self.limits.max_effort
        return np.asarray(share.max(axis=-1))

    def ranges(self, q: Array) -> tuple[Array, Array]:
        """
        Return the ranges, up to where joints are that are outside, and a little further.

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
        return (np.where(q < low - POSITION_TOLERANCE, q - TOUCH, low),
                np.where(q > high + POSITION_TOLERANCE, q + TOUCH, high))


def time_inside(motion: ReferenceTrajectory, now: float, limits: JointLimits) -> float:
    """
    Return until when a motion stays inside the ranges.

    Parameters
    ----------
    motion : ReferenceTrajectory
        The motion.
    now : float
        From when on it is looked at [s].
    limits : JointLimits
        With the ranges.

    Returns
    -------
    float
        Its end, if it never leaves them; -inf, if it is outside already [s].

    """
    looks = np.linspace(now, max(now, motion.end), LOOKS)
    q = motion.at(looks)[0]
    outside = ((q < limits.min_position - TOUCH) | (q > limits.max_position + TOUCH)).any(axis=1)
    if not outside.any():
        return motion.end
    first = int(np.argmax(outside))
    return float(looks[first - 1]) if first else -inf


def from_state(state: Desired, now: int) -> ReferenceTrajectory:
    """
    Return a motion that is over in the state in which it begins.

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
    A measured state as a motion that is over, for `stop`.

    It has one knot, and no acceleration, which is not measured.

    Parameters
    ----------
    seen : tuple of 6 floats
        Positions [rad] and velocities [rad/s].
    now : int
        The time [ns].
    commanded : ReferenceTrajectory
        What was commanded then.

    Attributes
    ----------
    commanded_position : ndarray, shape (3,)
        [rad].

    """

    def __init__(self, seen: State, now: int, commanded: ReferenceTrajectory) -> None:
        super().__init__(np.zeros(1), np.zeros((0, 3, 6)), np.array(seen[:3]), now,
                         np.array(seen[3:]), np.zeros(3))
        self.commanded_position = np.array(commanded.command(now)[:3])


def what_moves(motion: ReferenceTrajectory, now: int, seen: State,
               limits: JointLimits) -> ReferenceTrajectory:
    """
    Return what has to stop: a motion, or the state measured where that motion is far off.

    Parameters
    ----------
    motion : ReferenceTrajectory
        What is followed.
    now : int
        The time [ns].
    seen : tuple of 6 floats
        Measured positions [rad] and velocities [rad/s].
    limits : JointLimits
        With the ranges: a command outside them must be near the arm to be what moves.

    Returns
    -------
    ReferenceTrajectory
        For `stop`.

    """
    q = np.array(motion.command(now)[:3])
    outside = ((q < limits.min_position - TOUCH) | (q > limits.max_position + TOUCH)).any()
    astray = np.abs(q - seen[:3]).max() > (ASTRAY_OUTSIDE if outside else ASTRAY)
    return MeasuredState(seen, now, motion) if astray else motion
