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
Motions whose acceleration is a sequence of ramps between node values.

Each segment between via points has n ramps of equal duration. The node accelerations are the
unknowns (direct transcription: Betts, Practical Methods for Optimal Control, 2010): position and
velocity are linear in them, acceleration keeps its limits everywhere if it does at the nodes, and
jerk is continuous, zero at every node, its peaks known in closed form.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.motion_laws.ramps import Ramps, RampShape
from rrr_traj_planner.core.trajectory.piecewise import JointProfile, PiecewiseTrajectory


class Variables(NamedTuple):
    """Unknowns of N segments of n ramps, of J coordinates (the joints: J = 3)."""

    inner: Array     # node accelerations within the segments [rad/s^2], shape (N, n - 1, J)
    v: Array         # velocities at the via points [rad/s], (N - 1, J)
    a: Array         # accelerations there [rad/s^2], (N - 1, J)
    T: Array         # durations [s], (N,)


class States(NamedTuple):
    """The states of a motion at the nodes, then at the middles between them."""

    q: Array     # shape (N, 2 n + 1, 3)
    qd: Array
    qdd: Array
    jerk: Array  # the peak of each ramp, signed, shape (N, n, 3)


@lru_cache(maxsize=64)
def grid_of(n: int, constant_jerk_fraction: float) -> Grid:
    """
    Return the grid of n ramps, computed once.

    Parameters
    ----------
    n, constant_jerk_fraction
        As of `Grid`.

    Returns
    -------
    Grid
        Not to be changed.

    """
    return Grid(n, constant_jerk_fraction)


class Grid:
    """
    The constant matrices of n ramps in a segment, of duration h each.

    Parameters
    ----------
    n : int
        Number of ramps, at least 4.
    constant_jerk_fraction : float
        Part of each during which jerk is constant; 0: the thesis's half-periods (6.3).

    Attributes
    ----------
    shape : RampShape
        Of every ramp.
    qdd, qd, q : ndarray, shape (2 n + 1, n + 1)
        Times the node accelerations: acceleration, change of velocity / h and displacement / h^2
        at the points, without the start velocity's part.
    jerk : ndarray, shape (n, n + 1)
        Times the node accelerations: peaks of jerk times h.
    elapsed : ndarray, shape (2 n + 1,)
        Time of each point / h.
    restore : ndarray, shape (n - 1, 2)
        Smooth inner accelerations that change velocity by h, and displacement by h^2.

    """

    def __init__(self, n: int, constant_jerk_fraction: float = 0.0) -> None:
        self.n, self.shape = n, RampShape(constant_jerk_fraction)
        one, whole = np.eye(n + 1), self.shape(1.0)[0]
        qd, q = np.zeros((n + 1, n + 1)), np.zeros((n + 1, n + 1))
        for j in range(n):
            qd[j + 1] = qd[j] + 0.5 * (one[j] + one[j + 1])
            q[j + 1] = q[j] + qd[j] + 0.5 * one[j] + whole * (one[j + 1] - one[j])
        rise = one[1:] - one[:-1]
        way, speed, _, _ = self.shape(0.5)
        self.qdd = np.vstack((one, 0.5 * (one[1:] + one[:-1])))
        self.qd = np.vstack((qd, qd[:-1] + 0.5 * one[:-1] + speed * rise))
        self.q = np.vstack((q, q[:-1] + 0.5 * qd[:-1] + 0.125 * one[:-1] + way * rise))
        self.jerk = self.shape.peak_jerk * rise
        self.elapsed = np.concatenate((np.arange(n + 1.0), np.arange(n) + 0.5))
        self.restore = self._restoring_shapes()

    def _restoring_shapes(self) -> Array:
        """Return inner accelerations, sine-shaped, for a unit of velocity and of displacement."""
        s = np.arange(1, self.n) / self.n
        shapes = np.stack((np.sin(np.pi * s), np.sin(2.0 * np.pi * s)), axis=1)
        gains = np.stack((self.qd[self.n], self.q[self.n]))[:, 1:-1] @ shapes
        return shapes @ np.linalg.inv(gains)

    def nodes(self, m: Variables) -> tuple[Array, Array, Array]:
        """
        Return accelerations of all nodes, and velocities at the segments' ends.

        Parameters
        ----------
        m : Variables
            The motion.

        Returns
        -------
        tuple of ndarray
            Accelerations (N, n + 1, 3) [rad/s^2]; velocities at starts and at ends (N, 3) [rad/s].

        """
        rest = np.zeros((1, m.inner.shape[-1]))
        a, v = np.concatenate((rest, m.a, rest)), np.concatenate((rest, m.v, rest))
        nodes = np.concatenate((a[:-1, np.newaxis], m.inner, a[1:, np.newaxis]), axis=1)
        return nodes, v[:-1], v[1:]

    def states(self, points: Array, m: Variables) -> States:
        """
        Return the states of a motion; each segment is integrated from its own via point.

        Parameters
        ----------
        points : ndarray, shape (N + 1, 3)
            Via points [rad].
        m : Variables
            The motion.

        Returns
        -------
        States
            Position [rad], velocity [rad/s], acceleration [rad/s^2], peaks of jerk [rad/s^3].

        """
        nodes, v0, _ = self.nodes(m)
        h = (m.T / self.n)[:, np.newaxis, np.newaxis]
        v0 = v0[:, np.newaxis]
        displacement = h * (self.elapsed[:, np.newaxis] * v0 + h * (self.q @ nodes))
        return States(
            points[:-1, np.newaxis] + displacement,
            v0 + h * (self.qd @ nodes), self.qdd @ nodes, (self.jerk @ nodes) / h)

    def profiles(self, points: Array, m: Variables) -> list[JointProfile]:
        """
        Return each coordinate's motion as pieces.

        Parameters
        ----------
        points : ndarray, shape (N + 1, J)
            Via points.
        m : Variables
            The motion.

        Returns
        -------
        list of JointProfile
            A ramp from node to node.

        """
        n, (nodes, _, _), at = self.n, self.nodes(m), self.states(points, m)
        h, J = np.repeat(m.T / n, n), m.inner.shape[-1]
        q, qd, a, rise = (f.reshape(-1, J).T for f in (
            at.q[:, :n], at.qd[:, :n], nodes[:, :-1], np.diff(nodes, axis=1)))
        return [JointProfile(Ramps(h, q[j], qd[j], a[j], rise[j], self.shape)) for j in range(J)]

    def trajectory(self, points: Array, m: Variables) -> PiecewiseTrajectory:
        """
        Return the motion of all joints.

        Parameters
        ----------
        points : ndarray, shape (N + 1, 3)
            Via points [rad].
        m : Variables
            The motion.

        Returns
        -------
        PiecewiseTrajectory
            See `profiles`.

        """
        return PiecewiseTrajectory(
            self.profiles(points, m), np.concatenate(([0.0], np.cumsum(m.T))))


def restored(grid: Grid, points: Array, m: Variables) -> Variables:
    """
    Return the motion with inner accelerations corrected so that it meets the via points exactly.

    Parameters
    ----------
    grid : Grid
        Discretisation: n ramps per segment.
    points : ndarray, shape (N + 1, 3)
        Via points [rad].
    m : Variables
        The motion, up to rounding or a step's second order.

    Returns
    -------
    Variables
        With the same via velocities, via accelerations and durations.

    """
    nodes, v0, v1 = grid.nodes(m)
    h = (m.T / grid.n)[:, np.newaxis]
    target = np.stack(((v1 - v0) / h, (np.diff(points, axis=0) - m.T[:, np.newaxis] * v0)
                       / h ** 2), axis=1)
    residual = target - np.stack((grid.qd[grid.n], grid.q[grid.n])) @ nodes
    return m._replace(inner=m.inner + grid.restore @ residual)


def time_scaled(m: Variables, factor: float) -> Variables:
    """
    Return a motion along the same path with all times scaled.

    Parameters
    ----------
    m : Variables
        The motion.
    factor : float
        Above 1: slower.

    Returns
    -------
    Variables
        Velocities are divided by the factor, accelerations by its square.

    """
    return Variables(m.inner / factor ** 2, m.v / factor, m.a / factor ** 2, m.T * factor)


def with_durations(m: Variables, T: Array) -> Variables:
    """
    Return a motion that stops at every via point along the same path in other durations.

    Parameters
    ----------
    m : Variables
        The motion.
    T : ndarray, shape (N,)
        The durations [s].

    Returns
    -------
    Variables
        Each segment scaled in time by itself.

    """
    return m._replace(inner=m.inner * ((m.T / T) ** 2)[:, np.newaxis, np.newaxis], T=T)
