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
Starts from motion: whether the arm can go on from there, and the limits of a motion that does.

A state of a motion along its limits leaves no room to a motion that is made of other pieces.
Limits are therefore raised, by up to ALLOWED, to what the state itself needs.
"""

from __future__ import annotations

from dataclasses import replace
import math

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics.motor_torque import motor_torque
from rrr_traj_planner.core.errors import format_distinct, StartStateError
from rrr_traj_planner.core.rounding import JOINT_ROUNDING
from rrr_traj_planner.planners.tasks import StartRates

ALLOWED = 1e-3  # part of a limit: to which a controller's quintics keep the limits of an answer
# Chosen values.
ROOM = 2e-4      # part by which a limit is above what the state needs
NARROW = 3e-3    # rad, that braking leaves before the end of a range; there the joint
FOR_ROOM = 4e-4  # may brake harder by this part


def limits_of_moving_start(model: RobotModel, limits: JointLimits, start: Array,
                           rates: StartRates) -> JointLimits:
    """
    Return the limits of a motion that starts moving, after a check that there is one.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Its limits, scaled as requested.
    start : ndarray, shape (3,)
        Joint positions [rad], within their ranges.
    rates : StartRates
        How the joints move there.

    Returns
    -------
    JointLimits
        Up to ALLOWED above the given ones, where the state itself is.

    Raises
    ------
    StartStateError
        If the state is beyond a limit, or a joint cannot stop inside its range.

    """
    v, a = rates
    effort = np.abs(motor_torque(model, start, v, a))
    # the velocity that is reached while the acceleration is reduced to zero
    reached = np.abs(v + np.where(v * a >= 0.0, a * np.abs(a) / (2.0 * limits.max_jerk), 0.0))
    raised = {}
    for name, needed, what, unit in (
            ('max_acceleration', np.abs(a), 'accelerates with', 'rad/s^2'),
            ('max_velocity', reached, 'cannot but reach', 'rad/s'),
            ('max_effort', effort, 'needs', 'N m')):
        limit = getattr(limits, name)
        beyond = needed > (1.0 + ALLOWED) * limit
        if beyond.any():
            j = int(beyond.argmax())
            shown, most = format_distinct(float(needed[j]), float(limit[j]))
            raise StartStateError(f'start state: {model.joint_names[j]} {what} {shown} {unit}, '
                                  f'limit {most} {unit}')
        raised[name] = np.maximum(limit, (1.0 + ROOM) * needed)
    found = replace(limits, **raised)
    narrow = _room(model, found, start, rates) < NARROW
    return replace(found, **{name: np.where(
        narrow, np.maximum(getattr(found, name), (1.0 + FOR_ROOM) * getattr(limits, name)),
        getattr(found, name)) for name in ('max_acceleration', 'max_jerk')})


def _room(model: RobotModel, limits: JointLimits, start: Array, rates: StartRates) -> Array:
    """Return what braking leaves of the way to ends of ranges [rad]; raise if it is nothing."""
    room = np.stack((limits.max_position - start, start - limits.min_position))
    beyond = np.stack([least_advance(sign * rates.velocity, sign * rates.acceleration, limits)
                       for sign in (1.0, -1.0)]) - room
    if (beyond > JOINT_ROUNDING).any():
        side, j = divmod(int(beyond.argmax()), len(start))
        end = (limits.max_position, limits.min_position)[side][j]
        raise StartStateError(
            f'start state: {model.joint_names[j]} is at {start[j]:.6g} rad and moves at '
            f'{rates.velocity[j]:.6g} rad/s, too fast towards the end of its range at '
            f'{end:.6g} rad: within its limits it goes at least {beyond[side, j]:.3g} rad beyond')
    return np.asarray(-beyond.max(axis=0))


def least_advance(velocity: Array, acceleration: Array, limits: JointLimits) -> Array:
    """
    Return how far joints still advance, at least, before they turn back.

    The acceleration falls with the greatest jerk to the greatest deceleration, which lasts until
    the joint turns.

    Parameters
    ----------
    velocity, acceleration : ndarray, shape (3,)
        In the direction of the advance, or against it [rad/s], [rad/s^2].
    limits : JointLimits
        On acceleration and jerk; either may be infinite.

    Returns
    -------
    ndarray, shape (3,)
        [rad], not negative.

    """
    found = np.zeros(3)
    for j, (v, a, most, jerk) in enumerate(zip(
            velocity.tolist(), acceleration.tolist(), limits.max_acceleration.tolist(),
            limits.max_jerk.tolist())):
        t = q = 0.0
        if math.isfinite(jerk):
            if v < 0.0 and (a <= 0.0 or a * a + 2.0 * jerk * v <= 0.0):
                continue  # it never advances
            turns = (a + math.sqrt(a * a + 2.0 * jerk * v)) / jerk  # if the jerk lasts so long
            t = min((a + most) / jerk, turns)
            q, v = t * (v + t * (a / 2.0 - t * jerk / 6.0)), v + t * (a - t * jerk / 2.0)
            if t == turns:
                v = 0.0
        found[j] = max(q + max(v, 0.0) ** 2 / (2.0 * most), 0.0)
    return found
