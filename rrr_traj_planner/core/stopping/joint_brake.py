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
Jerk-limited braking of one joint: trapezoidal or triangular deceleration profile.

Of all motions from a state to rest within bounds on acceleration and jerk, this one decelerates
most at every velocity. It takes the least time and, unless the joint has to reverse, the shortest
distance (Kröger and Wahl, IEEE Transactions on Robotics 26(1), 2010: acceleration profiles NegTrap
and NegTri). Arrays of any shape, an element for each joint of each candidate.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.rounding import TIME_ROUNDING

# Least time in which a joint without limits on acceleration and jerk stops [s]; chosen.
LEAST_TIME = 0.01


class JointBrake(NamedTuple):
    """
    Three phases of constant jerk that end at rest.

    Attributes
    ----------
    velocity : ndarray, shape (...)
        At the start [rad/s].
    times : ndarray, shape (3, ...)
        Durations of the phases [s]; may be zero.
    accelerations, jerks : ndarray, shape (3, ...)
        With which the phases begin [rad/s^2], and of the phases [rad/s^3].

    """

    velocity: Array
    times: Array
    accelerations: Array
    jerks: Array

    @property
    def duration(self) -> Array:
        """How long the brake takes [s], shape (...)."""
        return np.asarray(self.times.sum(axis=0))

    def at(self, t: Array) -> tuple[Array, Array, Array, Array]:
        """
        Return the displacement and its derivatives.

        Parameters
        ----------
        t : ndarray
            Times since the start [s], of a shape that goes with the brake's.

        Returns
        -------
        tuple of ndarray
            [rad], [rad/s], [rad/s^2], [rad/s^3]; where phases meet, the last two are the later
            phase's, at the end the last one's, and then zero.

        """
        shape = np.broadcast_shapes(np.shape(t), self.velocity.shape)
        displacement, acceleration, jerk = np.zeros(shape), np.zeros(shape), np.zeros(shape)
        velocity = np.broadcast_to(self.velocity, shape)
        for T, a, j in zip(self.times, self.accelerations, self.jerks):
            x = np.clip(t, 0.0, T)
            displacement = displacement + x * (velocity + x * (a / 2.0 + x * j / 6.0))
            velocity = velocity + x * (a + x * j / 2.0)
            started = (t >= 0.0) & (T > 0.0)
            acceleration = np.where(started, a + x * j, acceleration)
            jerk = np.where(started, j, jerk)
            t = t - T
        over = t > TIME_ROUNDING
        return displacement, velocity, np.where(over, 0.0, acceleration), np.where(over, 0.0, jerk)

    def extremes(self) -> tuple[Array, Array]:
        """
        Return the least and the largest displacement.

        A joint reverses at most once, before its first acceleration has changed sign.

        Returns
        -------
        tuple of ndarray, shape (...)
            [rad], not positive and not negative.

        """
        a, j, v, T = self.accelerations[0], self.jerks[0], self.velocity, self.times[0]
        root = a + np.copysign(np.sqrt(np.maximum(a * a - 2.0 * j * v, 0.0)), a)
        t = np.clip(np.divide(-2.0 * v, root, out=np.zeros_like(T), where=root != 0.0), 0.0, T)
        displacements = np.stack((np.zeros_like(T), self.at(t)[0], self.at(self.duration)[0]))
        return displacements.min(axis=0), displacements.max(axis=0)


def direction(velocity: Array, acceleration: Array, max_jerk: Array) -> Array:
    """
    Return the sign of the velocity that remains once the acceleration is reduced to zero.

    Parameters
    ----------
    velocity, acceleration, max_jerk : ndarray
        [rad/s], [rad/s^2], [rad/s^3]; the last may be infinite.

    Returns
    -------
    ndarray
        -1, 0 or 1: the brake decelerates against it.

    """
    return np.sign(velocity + acceleration * np.abs(acceleration) / (2.0 * max_jerk))


def greatest_deceleration(velocity: Array, acceleration: Array, max_acceleration: Array,
                          max_jerk: Array) -> Array:
    """
    Return the peak deceleration of the fastest brake.

    Parameters
    ----------
    velocity, acceleration : ndarray
        At the start [rad/s], [rad/s^2].
    max_acceleration, max_jerk : ndarray
        Bounds on the magnitude [rad/s^2], [rad/s^3]; may be infinite. An initial acceleration
        that exceeds its bound takes the place of the bound.

    Returns
    -------
    ndarray
        [rad/s^2], not negative, finite.

    """
    limited = np.isfinite(max_jerk)
    toward = velocity * direction(velocity, acceleration, max_jerk)
    triangle = np.sqrt(np.maximum(
        np.where(limited, max_jerk, 0.0) * toward + 0.5 * acceleration ** 2, 0.0))
    peak = np.where(limited, triangle, np.abs(velocity) / LEAST_TIME)
    return np.minimum(peak, np.maximum(max_acceleration, np.abs(acceleration)))


def joint_brake(velocity: Array, acceleration: Array, deceleration: Array,
                max_jerk: Array) -> JointBrake:
    """
    Return the fastest brake with a given bound on its deceleration.

    Parameters
    ----------
    velocity, acceleration : ndarray
        At the start [rad/s], [rad/s^2].
    deceleration : ndarray
        Of the second phase [rad/s^2], at most `greatest_deceleration`; positive for a joint
        that moves.
    max_jerk : ndarray
        [rad/s^3]; infinite: the acceleration steps.

    Returns
    -------
    JointBrake
        Of the shape to which the arguments are broadcast.

    """
    v, a, p, J = np.broadcast_arrays(velocity, acceleration, deceleration, max_jerk)
    side = direction(v, a, J)
    plateau, jerk = -side * p, np.where(np.isfinite(J), J, 0.0)
    first, last = np.abs(plateau - a) / J, p / J
    left = side * (v + 0.5 * first * (a + plateau)) - 0.5 * p * last
    middle = np.divide(np.maximum(left, 0.0), p, out=np.zeros(p.shape), where=p > 0.0)
    return JointBrake(v, np.stack((first, middle, last)), np.stack((a, plateau, plateau)),
                      np.stack((np.sign(plateau - a) * jerk, np.zeros(p.shape), side * jerk)))
