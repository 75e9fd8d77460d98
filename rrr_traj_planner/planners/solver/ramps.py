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
from rrr_traj_planner.core.kernels import contiguous
from rrr_traj_planner.core.motion_laws.ramps import Ramps, RampShape
from rrr_traj_planner.core.trajectory.piecewise import JointProfile, PiecewiseTrajectory
from rrr_traj_planner.planners.solver.library import KERNELS


class Variables(NamedTuple):
    """Unknowns of N segments of n ramps, of J coordinates (the joints: J = 3)."""

    inner: Array     # node accelerations within the segments [rad/s^2], shape (N, n - 1, J)
    v: Array         # velocities at the via points [rad/s], (N - 1, J)
    a: Array         # accelerations there [rad/s^2], (N - 1, J)
    T: Array         # durations [s], (N,)

    def flat(self) -> Array:
        """Return all unknowns as one vector, as the kernels take them."""
        return np.concatenate([f.ravel() for f in self])

    def with_values(self, flat: Array) -> Variables:
        """
        Return a motion of the same shape.

        Parameters
        ----------
        flat : ndarray
            Its unknowns as one vector, see `flat`.

        Returns
        -------
        Variables
            Views of the vector.

        """
        ends = np.cumsum([f.size for f in self])
        return Variables(*(part.reshape(f.shape) for part, f in zip(
            np.split(flat, ends[:-1]), self)))


class States(NamedTuple):
    """The states of a motion at the nodes, then at the middles between them: (N, 2 n + 1, J)."""

    q: Array
    qd: Array
    qdd: Array
    jerk: Array  # 0 at the nodes, at its peaks between them


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
    n ramps in a segment, of duration h each.

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
    displacement : ndarray, shape (n - 1,)
        Of a segment from rest, by each inner acceleration, divided by h^2.
    restore : ndarray, shape (n - 1, 2)
        Smooth inner accelerations that change velocity by h, and displacement by h^2.

    """

    def __init__(self, n: int, constant_jerk_fraction: float = 0.0) -> None:
        self.n, self.shape = n, RampShape(constant_jerk_fraction)
        self._end_q = float(self.shape(1.0)[0])
        none = np.zeros((0, n - 1))
        one_each = Variables(np.eye(n - 1)[np.newaxis], none, none, np.array([float(n)]))
        self.displacement, velocity, _, _ = self.samples(
            np.zeros((1, n - 1)), one_each, 1)[0, n]
        s = np.arange(1, n) / n
        shapes = np.stack((np.sin(np.pi * s), np.sin(2.0 * np.pi * s)), axis=1)
        gains = np.stack((velocity, self.displacement)) @ shapes
        self.restore = contiguous(shapes @ np.linalg.inv(gains))

    def samples(self, points: Array, m: Variables, per_ramp: int) -> Array:
        """
        Return the states of a motion at equally spaced times of every ramp.

        Parameters
        ----------
        points : ndarray, shape (N + 1, J)
            Via points [rad]; each segment is integrated from its own.
        m : Variables
            The motion.
        per_ramp : int
            Samples of each ramp, from its start on.

        Returns
        -------
        ndarray, shape (N, n per_ramp + 1, 4, J)
            Position [rad], velocity, acceleration and jerk, in the order of time.

        """
        return self._sampled(points, m, per_ramp, nodes_first=False)

    def states(self, points: Array, m: Variables) -> States:
        """
        Return the states of a motion at a problem's points.

        Parameters
        ----------
        points, m
            As of `samples`.

        Returns
        -------
        States
            Position [rad], velocity [rad/s], acceleration [rad/s^2], jerk [rad/s^3].

        """
        return States(*np.moveaxis(self._sampled(points, m, 2, nodes_first=True), 2, 0))

    def _sampled(self, points: Array, m: Variables, per_ramp: int, nodes_first: bool) -> Array:
        (N, _, J), points, flat = m.inner.shape, contiguous(points), m.flat()
        z = np.empty((N, self.n * per_ramp + 1, 4, J))
        unit = _unit_ramp(self.shape.constant_jerk_fraction, per_ramp)
        KERNELS.ramps_sample(J, N, self.n, self._end_q, points.ctypes.data, flat.ctypes.data,
                             per_ramp, nodes_first, unit.ctypes.data, z.ctypes.data)
        return z

    def restored(self, points: Array, m: Variables) -> Variables:
        """
        Return the motion with inner accelerations corrected so that it meets the via points.

        Parameters
        ----------
        points : ndarray, shape (N + 1, J)
            Via points [rad].
        m : Variables
            The motion, up to rounding or a step's second order.

        Returns
        -------
        Variables
            With the same via velocities, via accelerations and durations.

        """
        (N, _, J), points, flat = m.inner.shape, contiguous(points), m.flat()
        KERNELS.ramps_meet_points(J, N, self.n, self._end_q, points.ctypes.data,
                                  self.restore.ctypes.data, flat.ctypes.data)
        return m.with_values(flat)

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
        n, at, J = self.n, self.states(points, m), m.inner.shape[-1]
        h = np.repeat(m.T / n, n)
        q, qd, a, rise = (f.reshape(-1, J).T for f in (
            at.q[:, :n], at.qd[:, :n], at.qdd[:, :n], np.diff(at.qdd[:, :n + 1], axis=1)))
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


@lru_cache(maxsize=64)
def _unit_ramp(constant_jerk_fraction: float, per_ramp: int) -> Array:
    """Return q, qd, qdd and jerk of a ramp of unit duration and rise at samples, (per_ramp, 4)."""
    values = np.stack(RampShape(constant_jerk_fraction)(np.arange(per_ramp) / per_ramp), axis=1)
    values.setflags(write=False)
    return values
