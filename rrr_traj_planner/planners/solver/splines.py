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
Motions of piecewise linear, continuous jerk: quartic splines with three continuous derivatives.

Each segment between via points has n intervals, whose durations are fixed parts of its own. The
jerks at the nodes are the unknowns (direct transcription: Betts, Practical Methods for Optimal
Control, 2010): velocity and position are linear in them, jerk keeps its limits everywhere if it
does at the nodes, and the extremes of acceleration, velocity and position are roots of a line, a
quadratic and a cubic.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.kernels import contiguous
from rrr_traj_planner.core.motion_laws.polynomial_piece import PolynomialPiece
from rrr_traj_planner.core.read_only import make_read_only
from rrr_traj_planner.core.trajectory.joint_profile import JointProfile
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.planners.solver.library import KERNELS

LEAST_INTERVALS = 5  # of a segment: two for each of its ends' three conditions, less one


class Variables(NamedTuple):
    """Unknowns of N segments of n intervals, of J coordinates (the joints: J = 3)."""

    inner: Array     # jerks at the nodes within the segments [rad/s^3], shape (N, n - 1, J)
    v: Array         # velocities at the via points [rad/s], (N + 1, J)
    a: Array         # accelerations there [rad/s^2], (N + 1, J)
    j: Array         # jerks there [rad/s^3], (N + 1, J)
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
        found, end = [], 0
        for field in self:
            start, end = end, end + field.size
            found.append(flat[start:end].reshape(field.shape))
        return Variables(*found)


def with_stops(inner: Array, T: Array) -> Variables:
    """
    Return a motion that rests at every via point, without jerk.

    Parameters
    ----------
    inner : ndarray, shape (N, n - 1, J)
        Jerks at inner nodes [rad/s^3].
    T : ndarray, shape (N,)
        Durations [s].

    Returns
    -------
    Variables
        The motion; whether it meets the via points depends on the jerks.

    """
    rest = np.zeros((len(inner) + 1, inner.shape[-1]))
    return Variables(inner, rest, rest, rest, T)


class States(NamedTuple):
    """The states of a motion at the nodes, then at the middles between them: (N, 2 n + 1, J)."""

    q: Array
    qd: Array
    qdd: Array
    jerk: Array


class Mesh:
    """
    The nodes of every segment.

    Parameters
    ----------
    parts : ndarray, shape (N, n)
        Durations of the n intervals over their segment's; n at least `LEAST_INTERVALS`.
    suits : ndarray of bool, shape (N,), optional
        Which segments' nodes suit their motion: refinements keep them.

    Attributes
    ----------
    parts, suits, n
        As given.
    restore : ndarray, shape (N, n - 1, 3)
        Smooth inner jerks which, in a segment of unit duration, change acceleration, velocity or
        position at its end by 1.

    """

    def __init__(self, parts: Array, suits: BoolArray | None = None) -> None:
        self.parts, self.suits = contiguous(parts), suits
        N, self.n = self.parts.shape
        self.restore = np.empty((N, self.n - 1, 3))
        KERNELS.spline_restoring_shapes(
            N, self.n, self.parts.ctypes.data, self.restore.ctypes.data)
        make_read_only((self.parts, self.restore))

    @property
    def starts(self) -> Array:
        """Return where intervals begin and end, as parts of the segments, shape (N, n + 1)."""
        ends = np.cumsum(self.parts, axis=1)
        return np.concatenate((np.zeros((len(ends), 1)), ends), axis=1)

    @property
    def node_shares(self) -> Array:
        """Return the weights of the trapezoidal rule, shape (N, n + 1); 1 in sum."""
        shares, halves = np.zeros((len(self.parts), self.n + 1)), 0.5 * self.parts
        shares[:, :-1] += halves
        shares[:, 1:] += halves
        return shares

    def samples(self, points: Array, m: Variables, per_interval: int) -> Array:
        """
        Return the states of a motion at equally spaced times of every interval.

        Parameters
        ----------
        points : ndarray, shape (N + 1, J)
            Via points [rad]; each segment is integrated from its own.
        m : Variables
            The motion.
        per_interval : int
            Samples of each interval, from its start on.

        Returns
        -------
        ndarray, shape (N, n per_interval + 1, 4, J)
            Position [rad], velocity, acceleration and jerk, in the order of time.

        """
        return self._sampled(points, m, per_interval, nodes_first=False)

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
        z = self._sampled(points, m, 2, nodes_first=True)
        return States(*(z[:, :, order] for order in range(4)))

    def _sampled(self, points: Array, m: Variables, per_interval: int,
                 nodes_first: bool) -> Array:
        (N, _, J), points, flat = m.inner.shape, contiguous(points), m.flat()
        z = np.empty((N, self.n * per_interval + 1, 4, J))
        KERNELS.spline_sample(J, N, self.n, self.parts.ctypes.data, points.ctypes.data,
                              flat.ctypes.data, per_interval, nodes_first, z.ctypes.data)
        return z

    def restored(self, points: Array, m: Variables) -> Variables:
        """
        Return the motion with inner jerks corrected so that it meets the via points.

        Parameters
        ----------
        points : ndarray, shape (N + 1, J)
            Via points [rad].
        m : Variables
            The motion, up to rounding or a step's second order.

        Returns
        -------
        Variables
            With the same states at the via points, and the same durations.

        """
        (N, _, J), points, flat = m.inner.shape, contiguous(points), m.flat()
        KERNELS.spline_meet_points(J, N, self.n, self.parts.ctypes.data, points.ctypes.data,
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
            A quartic from node to node.

        """
        n, at, J = self.n, self.states(points, m), m.inner.shape[-1]
        h = self.parts * m.T[:, np.newaxis]
        snap = np.diff(at.jerk[:, :n + 1], axis=1) / h[..., np.newaxis]
        pieces = [f.reshape(-1, J).T for f in (*(f[:, :n] for f in at), snap)]
        return [JointProfile(PolynomialPiece(h.ravel(), *(f[j] for f in pieces)))
                for j in range(J)]

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


def uniform_mesh(segments: int, n: int) -> Mesh:
    """
    Return a mesh of equal intervals.

    Parameters
    ----------
    segments, n : int
        Numbers of segments, and of intervals in each.

    Returns
    -------
    Mesh
        The mesh.

    """
    return Mesh(np.full((segments, n), 1.0 / n))


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
        Velocities are divided by the factor, accelerations by its square, jerks by its cube.

    """
    return Variables(m.inner / factor ** 3, m.v / factor, m.a / factor ** 2, m.j / factor ** 3,
                     m.T * factor)
