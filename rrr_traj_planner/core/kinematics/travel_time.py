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

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arrays import Array, IntArray

# The mean acceleration of a change of velocity whose acceleration rises from zero and falls to
# it again, over its peak: a full-period cycloid's, and any symmetric ramp's without a cruise.
MEAN_ACCELERATION = 0.5


def way_time(limits: JointLimits, joint: int | slice, ways: Array,
             rests: Array | IntArray | int) -> Array:
    """
    Return how long a joint takes for ways that it begins or ends at rest, or at full speed.

    The velocity over time is a trapezium, or a triangle where the way is short; with no rest, a
    rectangle.

    Parameters
    ----------
    limits : JointLimits
        Velocity and acceleration; infinite ones do not bind.
    joint : int or slice
        Which joint, or joints along the last axis.
    ways : ndarray
        Lengths [rad], not negative.
    rests : ndarray or int
        At how many of its two ends the joint rests.

    Returns
    -------
    ndarray
        Times [s].

    """
    velocity = limits.max_velocity[joint]
    acceleration = MEAN_ACCELERATION * limits.max_acceleration[joint]
    with np.errstate(invalid='ignore', divide='ignore', over='ignore'):
        ramp = np.where(np.isinf(acceleration), 0.0, velocity / acceleration)
        cruises = 2.0 * ways >= rests * velocity * ramp
        return np.where(rests == 0, ways / velocity,
                        np.where(cruises, ways / velocity + 0.5 * rests * ramp,
                                 np.sqrt(2.0 * rests * ways / acceleration)))


def way_times(limits: JointLimits, q: Array) -> Array:
    """
    Return how long each joint takes from each point to the next, if it alone counts.

    A joint rests at the ends of the motion and where it turns back.

    Parameters
    ----------
    limits : JointLimits
        Velocities and accelerations.
    q : ndarray, shape (n, 3)
        Joint positions [rad].

    Returns
    -------
    ndarray, shape (n - 1, 3)
        Times [s].

    """
    ways = np.diff(q, axis=0)
    rests = np.ones(q.shape, dtype=int)
    rests[1:-1] = np.sign(ways[:-1]) * np.sign(ways[1:]) <= 0.0
    return way_time(limits, slice(None), np.abs(ways), rests[:-1] + rests[1:])


def travel_time(limits: JointLimits, q: Array) -> float:
    """
    Return how long a motion through joint positions takes.

    Parameters
    ----------
    limits : JointLimits
        Velocities and accelerations.
    q : ndarray, shape (n, 3)
        Joint positions [rad].

    Returns
    -------
    float
        In each segment the time of the joint that takes longest, in all [s].

    """
    return float(way_times(limits, q).max(axis=1).sum())
