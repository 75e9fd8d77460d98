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

    def change_rate(self, duration: Array) -> Array:
        """
        Return by how much the largest change of velocity grows with the duration.

        Parameters
        ----------
        duration : ndarray
            [s].

        Returns
        -------
        ndarray
            [rad/s^2].

        """
        with np.errstate(divide='ignore', invalid='ignore'):
            by_jerk = 2.0 * duration / self.root ** 2
        return np.where(self.largest_change(duration) < duration / self.slope, by_jerk,
                        1.0 / self.slope)


class Derivatives(NamedTuple):
    """The largest displacement, and its derivatives by v0, v1 and T."""

    distance: Array  # shape (...) [rad]
    gradient: Array  # (..., 3)
    hessian: Array   # (..., 3, 3)


def largest_cruise(law: TransitionLaw, max_velocity: Array, v0: Array, v1: Array,
                   T: Array) -> Array:
    """
    Return the cruise that takes furthest in a given time between given velocities.

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
    ndarray
        [rad/s]; shapes broadcast.

    """
    return np.minimum(_fastest_cruise(law, v0, v1, T), max_velocity)


def reach(law: TransitionLaw, max_velocity: Array, v0: Array, v1: Array, T: Array) -> Array:
    """
    Return the largest displacement in a given time between given velocities.

    The least one is minus the reach between the opposite velocities.

    Parameters
    ----------
    law, max_velocity, v0, v1, T
        As in `largest_cruise`.

    Returns
    -------
    ndarray
        [rad]; shapes broadcast.

    """
    cruise = largest_cruise(law, max_velocity, v0, v1, T)
    u0, u1 = cruise - v0, cruise - v1
    return np.asarray(cruise * T - 0.5 * (u0 * law.least_time(u0) + u1 * law.least_time(u1)))


def derivatives(law: TransitionLaw, max_velocity: Array, v0: Array, v1: Array,
                T: Array) -> Derivatives:
    """
    Return the largest displacement and its derivatives.

    With t_k how long the transition at end k lasts, i_k the inverse slope of t(u) there and m_k =
    (t_k + u_k / i_k) / (2 t_k), a change of velocity by u costs m t: m is 1 where acceleration
    bounds a transition, 3 / 4 where jerk does.

    Parameters
    ----------
    law, max_velocity, v0, v1, T
        As in `largest_cruise`; velocities below the maximum.

    Returns
    -------
    Derivatives
        One-sided where two laws or a limit meet.

    """
    free = _fastest_cruise(law, v0, v1, T)
    capped = free >= max_velocity
    cruise = np.where(capped, max_velocity, free)
    u0, u1 = cruise - v0, cruise - v1
    (t0, m0, i0, k0), (t1, m1, i1, k1) = _transition(law, u0), _transition(law, u1)
    p0, p1 = m0 * t0, m1 * t1
    with np.errstate(divide='ignore', invalid='ignore'):
        q = np.where(capped, 0.0, 1.0 / (i0 + i1))
        # where the cruise is at its limit it does not change, but for transitions at their ends
        own0, own1 = np.where(capped, m0 / i0, m0 * q), np.where(capped, m1 / i1, m1 * q)
    share, rest = i1 * q, i0 * q   # how the cruise follows v0 and v1
    by_T = share * i0              # and the duration
    left = np.where(capped, 0.0, T - p0 - p1)
    skew = left * q ** 3 * (i0 * k1 + i1 * k0)         # of left * share with v0
    skew_T = left * q ** 3 * (i0 ** 2 * k1 - i1 ** 2 * k0)  # and with T
    more = (m0 - m1) * q                               # of left with v0
    with_T = 1.0 - m0 * share - m1 * rest              # and with T
    one_one = -own0 + more * share + skew
    two_two = -own1 - more * rest + skew
    one_two = m0 * q - more * share - skew
    one_T = (m0 + with_T) * share + skew_T
    two_T = (m1 + with_T) * rest - skew_T
    T_T = by_T * (1.0 + with_T) + left * q ** 3 * (i1 ** 3 * k0 + i0 ** 3 * k1)
    hessian = np.stack((one_one, one_two, one_T, one_two, two_two, two_T, one_T, two_T, T_T), -1)
    return Derivatives(
        cruise * T - 0.5 * (u0 * t0 + u1 * t1),
        np.stack((p0 + left * share, p1 + left * rest, cruise + left * by_T), -1),
        hessian.reshape(*hessian.shape[:-1], 3, 3))


def _transition(law: TransitionLaw, u: Array) -> tuple[Array, Array, Array, Array]:
    """Return t(u), m and i of `derivatives`, and how i changes with u, times i."""
    by_acceleration, by_jerk = law.slope * u, law.root * np.sqrt(u)
    jerky = by_jerk > by_acceleration
    with np.errstate(divide='ignore', invalid='ignore'):
        return (np.where(jerky, by_jerk, by_acceleration), np.where(jerky, 0.75, 1.0),
                np.where(jerky, 2.0 * u / by_jerk, 1.0 / law.slope),
                np.where(jerky, 2.0 / law.root ** 2, 0.0))


def _fastest_cruise(law: TransitionLaw, v0: Array, v1: Array, T: Array) -> Array:
    """Return the cruise that takes all the time, not bounded by the velocity limit."""
    return np.asarray(np.maximum(v0, v1) + _rise(law, np.abs(v1 - v0), T))


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
