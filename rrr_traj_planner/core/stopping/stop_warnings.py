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

"""Warnings of limits that a stop violates: a sentence for each joint, with values and units."""

from __future__ import annotations

from math import inf

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics.motor_torque import motor_torque
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque
from rrr_traj_planner.core.stopping.task import (
    FINE,
    LIMIT_TOLERANCE,
    MeasuredState,
    StopTask,
)
from rrr_traj_planner.core.trajectory.reference_trajectory import ReferenceTrajectory

# Velocities [rad/s] and range violations [rad] below these are not reported; chosen.
SLOW, NEAR = 0.01, 1e-4


def deceleration_warnings(task: StopTask, q: Array, qd: Array, needed: Array) -> list[str]:
    """
    Return warnings for joints whose required deceleration exceeds the limit.

    Parameters
    ----------
    task : StopTask
        The task.
    q, qd, needed : ndarray, shape (3,)
        Positions [rad], velocities [rad/s] and required decelerations [rad/s^2]; these infinite
        where a joint stops instantaneously, 0 where its present acceleration is enough.

    Returns
    -------
    list of str
        A sentence for each of them.

    """
    limits, warnings = task.limits, []
    source = 'measured' if isinstance(task.motion, MeasuredState) else 'commanded'
    for i, name in enumerate(task.model.joint_names):
        if needed[i] > limits.max_acceleration[i] * (1.0 + LIMIT_TOLERANCE) and (
                abs(qd[i]) > SLOW):
            how = (f'brakes with {needed[i]:.4g} rad/s^2, limit '
                   f'{limits.max_acceleration[i]:.4g} rad/s^2, to rest inside it'
                   if needed[i] < inf else 'stops at once')
            warnings.append(f'{name} moves at {qd[i]:.4g} rad/s at {q[i]:.6g} rad ({source}), '
                            f'range {_range(limits, i)} rad: it {how}')
    return warnings


def torque_warnings(task: StopTask, motion: ReferenceTrajectory) -> list[str]:
    """
    Return warnings for joints whose torque exceeds the limit.

    Parameters
    ----------
    task : StopTask
        The task.
    motion : ReferenceTrajectory
        The stop.

    Returns
    -------
    list of str
        A sentence for each of them.

    """
    q, qd, qdd, _ = motion.at(np.linspace(task.now, motion.end, FINE))
    peak = np.maximum(np.abs(motor_torque(task.model, q, qd, qdd)).max(axis=0),
                      np.abs(gravity_torque(task.model, motion.final)))
    return [f'stopping requires {peak[i]:.1f} N m at {name}, limit '
            f'{task.limits.max_effort[i]:.1f} N m'
            for i, name in enumerate(task.model.joint_names)
            if peak[i] > task.limits.max_effort[i] * (1.0 + LIMIT_TOLERANCE)]


def range_warnings(task: StopTask, q: Array) -> list[str]:
    """
    Return warnings for joints outside their ranges, or commanded to be there.

    Parameters
    ----------
    task : StopTask
        The task.
    q : ndarray, shape (3,)
        Positions from which the stop begins [rad].

    Returns
    -------
    list of str
        A sentence for each of them.

    """
    limits, warnings = task.limits, []
    measured = isinstance(task.motion, MeasuredState)
    command = task.motion.commanded_position if isinstance(task.motion, MeasuredState) else q
    for i, name in enumerate(task.model.joint_names):
        if _beyond(limits, q)[i] > NEAR:
            warnings.append(f'{name} is {"at" if measured else "commanded to"} {q[i]:.6g} rad, '
                            f'outside its range {_range(limits, i)} rad: it goes back inside')
        elif _beyond(limits, command)[i] > NEAR:
            warnings.append(f'{name} is commanded to {command[i]:.6g} rad, outside its range '
                            f'{_range(limits, i)} rad: the arm stops from where it is measured')
    return warnings


def _beyond(limits: JointLimits, q: Array) -> Array:
    """Return the distances of positions beyond their ranges; negative inside [rad]."""
    return np.maximum(q - limits.max_position, limits.min_position - q)


def _range(limits: JointLimits, i: int) -> str:
    return f'[{limits.min_position[i]:.6g}, {limits.max_position[i]:.6g}]'
