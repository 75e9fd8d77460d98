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

Each segment between via points has n ramps of equal length. Node accelerations are the unknowns:
the acceleration keeps its limits everywhere if it does at the nodes, jerk is continuous, zero at
every node and closed-form at its peaks, and position and velocity are linear in them.
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
    """A motion at its points: nodes, then the middles between them; or its rate of change."""

    q: Array     # shape (N, 2 n + 1, 3)
    qd: Array
    qdd: Array
    jerk: Array  # the peak of each ramp, signed, shape (N, n, 3)


@lru_cache(maxsize=64)
def grid_of(n: int, cruise: float) -> Grid:
    """
    Return the grid of so many ramps, made once.

    Parameters
    ----------
    n, cruise
        As of `Grid`.

    Returns
    -------
    Grid
        Not to be changed.

    """
    return Grid(n, cruise)


class Grid:
    """
    Constant matrices of n ramps in a segment.

    Parameters
    ----------
    n : int
        Number of ramps, at least 4.
    cruise : float
        Part of each during which jerk is constant; 0: the thesis's half-periods.

    Attributes
    ----------
    shape : RampShape
        Of every ramp.
    qdd, qd, q : ndarray, shape (2 n + 1, n + 1)
        From node accelerations to acceleration, velocity gained / h and way gained / h^2 at the
        points, h the length of a ramp.
    jerk : ndarray, shape (n, n + 1)
        To the jerk's peaks times h.
    elapsed : ndarray, shape (2 n + 1,)
        Time of each point / h.
    restore : ndarray, shape (n - 1, 2)
        Smooth inner accelerations that gain a unit of velocity / h, and of way / h^2.

    """

    def __init__(self, n: int, cruise: float = 0.0) -> None:
        self.n, self.shape = n, RampShape(cruise)
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
        """Return smooth changes of inner accelerations that add a unit of velocity, and of way."""
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
            Its unknowns.

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
        Return the motion at its points; it begins each segment at its via point.

        Parameters
        ----------
        points : ndarray, shape (N + 1, 3)
            Via points [rad].
        m : Variables
            Its unknowns.

        Returns
        -------
        States
            Position [rad], velocity [rad/s], acceleration [rad/s^2], peaks of jerk [rad/s^3].

        """
        nodes, v0, _ = self.nodes(m)
        h = (m.T / self.n)[:, np.newaxis, np.newaxis]
        v0 = v0[:, np.newaxis]
        way = h * (self.elapsed[:, np.newaxis] * v0 + h * (self.q @ nodes))
        return States(
            points[:-1, np.newaxis] + way,
            v0 + h * (self.qd @ nodes), self.qdd @ nodes, (self.jerk @ nodes) / h)

    def profiles(self, points: Array, m: Variables) -> list[JointProfile]:
        """
        Return each coordinate's motion as pieces.

        Parameters
        ----------
        points : ndarray, shape (N + 1, J)
            Via points.
        m : Variables
            Its unknowns.

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
            Its unknowns.

        Returns
        -------
        PiecewiseTrajectory
            See `profiles`.

        """
        return PiecewiseTrajectory(
            self.profiles(points, m), np.concatenate(([0.0], np.cumsum(m.T))))


def restored(grid: Grid, points: Array, m: Variables) -> Variables:
    """
    Return the motion with inner accelerations mended to meet the via points exactly.

    Parameters
    ----------
    grid : Grid
        The family of motions.
    points : ndarray, shape (N + 1, 3)
        Via points [rad].
    m : Variables
        Its unknowns.

    Returns
    -------
    Variables
        Of the same via velocities, via accelerations and durations.

    """
    nodes, v0, v1 = grid.nodes(m)
    h = (m.T / grid.n)[:, np.newaxis]
    wanted = np.stack(((v1 - v0) / h, (np.diff(points, axis=0) - m.T[:, np.newaxis] * v0)
                       / h ** 2), axis=1)
    lacking = wanted - np.stack((grid.qd[grid.n], grid.q[grid.n])) @ nodes
    return m._replace(inner=m.inner + grid.restore @ lacking)


def stretched(m: Variables, factor: float) -> Variables:
    """
    Return a motion run through more slowly, as a whole.

    Parameters
    ----------
    m : Variables
        Its unknowns.
    factor : float
        What every time is multiplied by.

    Returns
    -------
    Variables
        The same way.

    """
    return Variables(m.inner / factor ** 2, m.v / factor, m.a / factor ** 2, m.T * factor)


def slowed(m: Variables, T: Array) -> Variables:
    """
    Return a motion with stops at every via point, run through in other durations.

    Parameters
    ----------
    m : Variables
        Its unknowns.
    T : ndarray, shape (N,)
        The durations [s].

    Returns
    -------
    Variables
        The same way.

    """
    return m._replace(inner=m.inner * ((m.T / T) ** 2)[:, np.newaxis, np.newaxis], T=T)
