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
One segment: transition, cruise, transition, between via velocities, for many joints at once.

A transition that changes velocity by D lasts at least t(D) = max(slope D, root sqrt(D)): the first
by the acceleration limit, the second by the jerk limit. By symmetry of its acceleration it covers
(v0 + v1) t / 2. Everything about a segment follows from these two facts, whatever the function.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array


class TransitionLaw(NamedTuple):
    """
    How long a transition must last; fields broadcast with joints, shape (3,).

    For a function whose peak acceleration is A D / t and whose peak jerk is B D / t^2, the slope
    is A / max_acceleration and the root is sqrt(B / max_jerk), 0 without a jerk limit.
    """

    slope: Array  # [s^2/rad]
    root: Array   # [s sqrt(s/rad)]

    def least_time(self, change: Array) -> Array:
        """
        Return the least duration of a change of velocity.

        Parameters
        ----------
        change : ndarray
            Change of velocity, of either sign [rad/s].

        Returns
        -------
        ndarray
            [s].

        """
        change = np.abs(change)
        return np.maximum(self.slope * change, self.root * np.sqrt(change))

    def largest_change(self, duration: Array) -> Array:
        """
        Return the largest change of velocity within a duration.

        Parameters
        ----------
        duration : ndarray
            [s].

        Returns
        -------
        ndarray
            Its magnitude [rad/s].

        """
        with np.errstate(divide='ignore'):
            by_jerk = np.where(self.root > 0.0, (duration / self.root) ** 2, np.inf)
        return np.minimum(duration / self.slope, by_jerk)


class Reach(NamedTuple):
    """The largest displacement of a segment and its derivatives."""

    cruise: Array    # cruise velocity that gives it [rad/s]
    distance: Array  # [rad]
    d_v0: Array
    d_v1: Array
    d_T: Array


def reach(law: TransitionLaw, max_velocity: Array, v0: Array, v1: Array, T: Array) -> Reach:
    """
    Return the largest displacement in a given time between given velocities.

    The least one is minus the reach between the opposite velocities.

    Parameters
    ----------
    law : TransitionLaw
        Transitions' least durations.
    max_velocity : ndarray
        [rad/s].
    v0, v1 : ndarray
        Velocities at the ends [rad/s], not above the maximum.
    T : ndarray
        Duration [s], at least `law.least_time(v1 - v0)`.

    Returns
    -------
    Reach
        Shapes broadcast.

    """
    gap = np.abs(v1 - v0)
    rise = _rise(law, gap, T)
    free = np.maximum(v0, v1) + rise
    cruise = np.minimum(free, max_velocity)
    capped = free > max_velocity
    u0, u1 = cruise - v0, cruise - v1
    t0, t1 = law.least_time(u0), law.least_time(u1)
    jerky0, jerky1 = t0 > law.slope * u0, t1 > law.slope * u1
    p0, p1 = np.where(jerky0, 0.75, 1.0) * t0, np.where(jerky1, 0.75, 1.0) * t1
    # inverse slopes of t(u): at u -> 0 the slope itself is infinite where jerk binds
    with np.errstate(divide='ignore', invalid='ignore'):
        i0 = np.where(jerky0, 2.0 * u0 / t0, 1.0 / law.slope)
        i1 = np.where(jerky1, 2.0 * u1 / t1, 1.0 / law.slope)
        i0, i1 = np.nan_to_num(i0), np.nan_to_num(i1)
        share = np.where(i0 + i1 > 0.0, i1 / (i0 + i1), 0.5)
    left = np.where(capped, 0.0, T - p0 - p1)
    return Reach(
        cruise=cruise,
        distance=cruise * T - 0.5 * (u0 * t0 + u1 * t1),
        d_v0=p0 + left * share,
        d_v1=p1 + left * (1.0 - share),
        d_T=cruise + left * share * i0)


def _rise(law: TransitionLaw, gap: Array, T: Array) -> Array:
    """Return y >= 0 with t(y) + t(y + gap) = T: how far the cruise is above the faster end."""
    slope, root = law.slope, law.root
    by_acceleration = 0.5 * (T / slope - gap)
    if not np.any(root > 0.0):
        return np.maximum(by_acceleration, 0.0)
    with np.errstate(divide='ignore', invalid='ignore'):
        change = (root / slope) ** 2  # below it, jerk rules
        by_jerk = np.maximum((T / root) ** 2 - gap, 0.0) ** 2 / (2.0 * T / root) ** 2
        mixed_root = 2.0 * (T - slope * gap) / (
            root + np.sqrt(root ** 2 + 4.0 * slope * np.maximum(T - slope * gap, 0.0)))
        mixed = np.maximum(mixed_root, 0.0) ** 2
        rise = np.where(by_jerk + gap <= change, by_jerk, mixed)
    return np.where((by_acceleration >= change) | (root <= 0.0),
                    np.maximum(by_acceleration, 0.0), rise)
