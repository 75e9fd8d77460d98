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
Estimated time of a motion through joint positions: trapezoidal velocity profiles.

Siciliano et al., Robotics, 2009, section 4.2.1.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arrays import Array, IntArray


class ViaPointBehaviour(NamedTuple):
    """
    How a planner's motions pass via points, for the estimate of their time.

    Parameters
    ----------
    via : {'through', 'stop', 'blend'}
        'through': a joint has zero velocity at a via point where it reverses; 'stop': all joints
        rest at every via point; 'blend': a transition around the via point, which is not met,
        joins the constant velocities of both segments.
    mean_acceleration : float
        Mean over peak acceleration of a change of velocity: 0.5 for a full-period cycloid, and
        for symmetric ramps without a phase of constant acceleration.

    """

    via: Literal['through', 'stop', 'blend'] = 'through'
    mean_acceleration: float = 0.5


THROUGH = ViaPointBehaviour()


def ramp_time(velocity: Array, acceleration: Array, jerk: Array) -> Array:
    """
    Return the least time of a change of velocity between states without acceleration.

    Jerk is constant but for its sign (Biagiotti & Melchiorri, Trajectory Planning for Automatic
    Machines and Robots, 2008, section 3.4).

    Parameters
    ----------
    velocity : ndarray
        The change, its magnitude [rad/s].
    acceleration, jerk : ndarray
        Limits, positive [rad/s^2, rad/s^3], of shapes that broadcast.

    Returns
    -------
    ndarray
        Times [s].

    """
    peak = np.minimum(acceleration, np.sqrt(velocity * jerk))
    moves = peak > 0.0
    return np.asarray(np.where(moves, velocity / np.where(moves, peak, 1.0), 0.0) + peak / jerk)


def joint_travel_time(limits: JointLimits, joint: int | slice, travel: Array,
                      ends: Array | IntArray | int, reversals: Array | IntArray | int,
                      passing: ViaPointBehaviour) -> Array:
    """
    Return the time of a joint's travel between via points, by a trapezoidal velocity profile.

    With a rest at one or both ends velocity over time is a trapezium, or a triangle for a short
    travel; with none, a rectangle. With blends, half of each transition lies within the segment:
    at speed v and mean acceleration a it takes v / a at a reversal and v / (2 a) at an end of the
    motion.

    Parameters
    ----------
    limits : JointLimits
        Velocity and acceleration limits; may be infinite.
    joint : int or slice
        Which joint, or joints along the last axis.
    travel : ndarray
        Lengths [rad], not negative.
    ends : ndarray or int
        Number of ends of the travel that are ends of the motion.
    reversals : ndarray or int
        Number of the other ends at which the joint reverses.
    passing : ViaPointBehaviour
        How the motion passes via points.

    Returns
    -------
    ndarray
        Times [s].

    """
    velocity = limits.max_velocity[joint]
    acceleration = passing.mean_acceleration * limits.max_acceleration[joint]
    with np.errstate(invalid='ignore', divide='ignore', over='ignore'):
        if passing.via == 'blend':
            line = np.maximum(travel / velocity,
                              np.sqrt(travel * (reversals + 0.5 * ends) / acceleration))
            speed = np.where(line > 0.0, travel / line, 0.0)
            return np.asarray(line + 0.5 * ends * speed / acceleration)
        rests = 2 if passing.via == 'stop' else ends + reversals
        ramp = np.where(np.isinf(acceleration), 0.0, velocity / acceleration)
        cruises = 2.0 * travel >= rests * velocity * ramp
        return np.where(rests == 0, travel / velocity,
                        np.where(cruises, travel / velocity + 0.5 * rests * ramp,
                                 np.sqrt(2.0 * rests * travel / acceleration)))


def travel_times(limits: JointLimits, q: Array, passing: ViaPointBehaviour) -> Array:
    """
    Return the time of each joint alone from each point to the next.

    Parameters
    ----------
    limits : JointLimits
        Velocities and accelerations.
    q : ndarray, shape (n, 3)
        Joint positions [rad].
    passing : ViaPointBehaviour
        How the motion passes via points.

    Returns
    -------
    ndarray, shape (n - 1, 3)
        Times [s].

    """
    travel = np.diff(q, axis=0)
    reversals = np.zeros(q.shape, dtype=int)
    reversals[1:-1] = np.sign(travel[:-1]) * np.sign(travel[1:]) <= 0.0
    return joint_travel_time(
        limits, slice(None), np.abs(travel), motion_ends(len(travel))[:, np.newaxis],
        reversals[:-1] + reversals[1:], passing)


def motion_ends(segments: int) -> IntArray:
    """
    Return the number of ends of the motion that belong to each segment.

    Parameters
    ----------
    segments : int
        Number of segments.

    Returns
    -------
    ndarray of int, shape (segments,)
        1 for the first and the last, 2 for the only one, 0 for others.

    """
    ends = np.zeros(segments, dtype=np.intp)
    ends[:1] += 1
    ends[-1:] += 1
    return ends


def travel_time(limits: JointLimits, q: Array, passing: ViaPointBehaviour) -> float:
    """
    Return the estimated time of a motion through joint positions.

    Parameters
    ----------
    limits : JointLimits
        Velocities and accelerations.
    q : ndarray, shape (n, 3)
        Joint positions [rad].
    passing : ViaPointBehaviour
        How it passes via points.

    Returns
    -------
    float
        Sum over the segments of the slowest joint's time [s].

    """
    return float(travel_times(limits, q, passing).max(axis=1).sum())
