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

"""An estimate of how long a motion through joint positions takes, before it is planned."""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arrays import Array, IntArray


class Passing(NamedTuple):
    """
    How a planner's motions pass via points, as far as an estimate of their time goes by it.

    Parameters
    ----------
    via : {'through', 'stop', 'blend'}
        'through': a joint rests at a via point where it turns back there; 'stop': all joints rest
        at every via point; 'blend': from each segment's constant velocity to the next one's in a
        transition around the via point, which is missed.
    mean_acceleration : float
        Of a change of velocity, over its peak: 0.5 where acceleration rises from zero and falls
        to it again as in a full-period cycloid, or in any symmetric ramp without a cruise.

    """

    via: Literal['through', 'stop', 'blend'] = 'through'
    mean_acceleration: float = 0.5


THROUGH = Passing()


def way_time(limits: JointLimits, joint: int | slice, ways: Array, ends: Array | IntArray | int,
             turns: Array | IntArray | int, passing: Passing) -> Array:
    """
    Return how long a joint takes for ways between via points.

    Where it begins or ends at rest, velocity over time is a trapezium, or a triangle where the way
    is short; with no rest, a rectangle. In a blend half of a transition lies within the way: with
    a speed v and a mean acceleration a it takes v / a where the joint turns back, and v / (2 a)
    where the motion begins or ends, of which the other half comes before or after.

    Parameters
    ----------
    limits : JointLimits
        Velocity and acceleration; infinite ones do not bind.
    joint : int or slice
        Which joint, or joints along the last axis.
    ways : ndarray
        Lengths [rad], not negative.
    ends : ndarray or int
        How many of the two ends are ends of the motion.
    turns : ndarray or int
        At how many of the others the joint turns back.
    passing : Passing
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
            line = np.maximum(ways / velocity, np.sqrt(ways * (turns + 0.5 * ends) / acceleration))
            speed = np.where(line > 0.0, ways / line, 0.0)
            return np.asarray(line + 0.5 * ends * speed / acceleration)
        rests = 2 if passing.via == 'stop' else ends + turns
        ramp = np.where(np.isinf(acceleration), 0.0, velocity / acceleration)
        cruises = 2.0 * ways >= rests * velocity * ramp
        return np.where(rests == 0, ways / velocity,
                        np.where(cruises, ways / velocity + 0.5 * rests * ramp,
                                 np.sqrt(2.0 * rests * ways / acceleration)))


def way_times(limits: JointLimits, q: Array, passing: Passing) -> Array:
    """
    Return how long each joint takes from each point to the next, if it alone counts.

    Parameters
    ----------
    limits : JointLimits
        Velocities and accelerations.
    q : ndarray, shape (n, 3)
        Joint positions [rad].
    passing : Passing
        How the motion passes via points.

    Returns
    -------
    ndarray, shape (n - 1, 3)
        Times [s].

    """
    ways = np.diff(q, axis=0)
    turns = np.zeros(q.shape, dtype=int)
    turns[1:-1] = np.sign(ways[:-1]) * np.sign(ways[1:]) <= 0.0
    return way_time(limits, slice(None), np.abs(ways), motion_ends(len(ways))[:, np.newaxis],
                    turns[:-1] + turns[1:], passing)


def motion_ends(segments: int) -> IntArray:
    """
    Return how many ends of the motion each of its segments has.

    Parameters
    ----------
    segments : int
        How many there are.

    Returns
    -------
    ndarray of int, shape (segments,)
        1 for the first and the last, 2 for the only one, 0 for others.

    """
    ends = np.zeros(segments, dtype=np.intp)
    ends[:1] += 1
    ends[-1:] += 1
    return ends


def travel_time(limits: JointLimits, q: Array, passing: Passing) -> float:
    """
    Return how long a motion through joint positions takes.

    Parameters
    ----------
    limits : JointLimits
        Velocities and accelerations.
    q : ndarray, shape (n, 3)
        Joint positions [rad].
    passing : Passing
        How it passes via points.

    Returns
    -------
    float
        In each segment the time of the joint that takes longest, in all [s].

    """
    return float(way_times(limits, q, passing).max(axis=1).sum())
