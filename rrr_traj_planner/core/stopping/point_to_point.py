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
Moves of all joints from rest to rest, on a line in joint space, as fast as the limits allow.

All joints follow one quintic: the fraction 10 s^3 - 15 s^4 + 6 s^5 of the distance, s = t / T.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics.motor_torque import motor_torque
from rrr_traj_planner.core.stopping.joint_brake import LEAST_TIME
from rrr_traj_planner.core.trajectory.quintic_spline import hermite
from rrr_traj_planner.core.trajectory.reference_trajectory import ReferenceTrajectory

# Factors on the least time that are tried; if none satisfies the torque limits, the fastest whose
# torque ratio is within HARDLY_MORE of the lowest is used. Chosen.
SLOWINGS = 1.2 ** np.arange(40.0)
HARDLY_MORE = 1.1


class Move(NamedTuple):
    """
    A motion that ends with a move.

    Attributes
    ----------
    motion : ReferenceTrajectory
        The motion.
    peak_torque : ndarray, shape (3,)
        Of the move [N m]; beyond the limits where no duration satisfies them.

    """

    motion: ReferenceTrajectory
    peak_torque: Array


def extended_by_move(motion: ReferenceTrajectory, target: Array, limits: JointLimits,
                     model: RobotModel) -> Move:
    """
    Return a motion that ends at rest, and then a move to a target.

    Parameters
    ----------
    motion : ReferenceTrajectory
        It ends at rest.
    target : ndarray, shape (3,)
        Positions [rad].
    limits : JointLimits
        Velocity, acceleration and jerk limits are satisfied, and torque limits where possible.
    model : RobotModel
        The arm, for its torques.

    Returns
    -------
    Move
        At rest at the target in the end.

    """
    start, zero = motion.final, np.zeros(3)
    if (start == target).all():
        return Move(motion, zero)
    T, peak_torque = _duration(start, target, limits, model)
    move = np.stack(hermite(T, (start, zero, zero), (target, zero, zero)), axis=-1)
    return Move(ReferenceTrajectory(np.append(motion.knots, motion.knots[-1] + T),
                                    np.concatenate((motion.coefficients, move[np.newaxis])),
                                    target, motion.origin_ns), peak_torque)


def quickest(ratio: Array) -> int:
    """
    Return the index of the fastest acceptable motion.

    Parameters
    ----------
    ratio : ndarray, shape (n,)
        Largest ratio of a quantity to its limit for each motion, faster motions first.

    Returns
    -------
    int
        The first motion within the limits; if there is none, the first whose ratio is at most
        HARDLY_MORE times the lowest.

    """
    least = float(ratio.min())
    return int(np.argmax(ratio <= (1.0 if least <= 1.0 else HARDLY_MORE * least)))


def _duration(start: Array, target: Array, limits: JointLimits,
              model: RobotModel) -> tuple[float, Array]:
    """Return how long a move takes [s], and its largest torques [N m]."""
    distance = np.abs(target - start)
    least = max(LEAST_TIME, float(np.max((
        15.0 / 8.0 * distance / limits.max_velocity,
        np.sqrt(10.0 / 3.0 ** 0.5 * distance / limits.max_acceleration),
        np.cbrt(60.0 * distance / limits.max_jerk)))))
    T = least * SLOWINGS
    # where torques are compared; chosen
    s = np.linspace(0.0, 1.0, 41)[:, np.newaxis]
    q = start + (10.0 - 15.0 * s + 6.0 * s ** 2) * s ** 3 * (target - start)
    qd = 30.0 * (s * (1.0 - s)) ** 2 * (target - start) / T[:, np.newaxis, np.newaxis]
    qdd = 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) * (target - start) / (
        T[:, np.newaxis, np.newaxis] ** 2)
    torque = np.abs(motor_torque(model, np.broadcast_to(q, qd.shape), qd, qdd))
    ratio = (torque / limits.max_effort).max(axis=(1, 2))
    i = quickest(ratio)
    return float(T[i]), torque[i].max(axis=0)
