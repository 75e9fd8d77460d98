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

"""The reference trajectory of the arm's controller: piecewise quintics in time."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array, bound_array, finite_array
from rrr_traj_planner.core.nanoseconds import nanoseconds, SECOND
from rrr_traj_planner.core.states import Desired
from rrr_traj_planner.core.trajectory.quintic_cursor import QuinticCursor
from rrr_traj_planner.core.trajectory.quintic_spline import QuinticSpline, spline_through
from rrr_traj_planner.core.trajectory.trajectory_points import FLOAT_EPSILON, TrajectoryPoints


class ReferenceTrajectory(QuinticSpline):
    """
    Piecewise polynomials in time.

    After the last knot the reference is at rest. If it has a velocity there, the arm must brake
    from `end_state` (`stopping.stop`).

    The interval of a time is determined in whole nanoseconds, as in joint_trajectory_controller;
    at a knot it is the one that begins there.

    Parameters
    ----------
    knots : ndarray, shape (n,)
        Strictly increasing times [s] since the origin.
    coefficients : ndarray, shape (n - 1, 3, 6)
        For each interval and joint, of 1, x, ..., x^5 with x the time since its knot [s].
    final : ndarray, shape (3,)
        Position at the last knot, held from then on [rad].
    origin_ns : int
        Origin of the knots' times [ns].
    final_velocity, final_acceleration : ndarray, shape (3,), optional
        At the last knot [rad/s], [rad/s^2]; None: at rest.

    Attributes
    ----------
    ends_moving : bool
        Whether there is a velocity at the last knot.
    elapsed : callable
        `QuinticCursor.elapsed`: the desired state after a time since the origin.

    """

    def __init__(self, knots: Array, coefficients: Array, final: Array, origin_ns: int = 0,
                 final_velocity: Array | None = None,
                 final_acceleration: Array | None = None) -> None:
        super().__init__(knots, coefficients, final)
        self.origin_ns = origin_ns
        self._knots_ns = [nanoseconds(knot) for knot in knots.tolist()]
        zero = np.zeros(3)
        self.set_end_state(zero if final_velocity is None else final_velocity,
                           zero if final_acceleration is None else final_acceleration)
        self.elapsed = QuinticCursor(knots, self._knots_ns, coefficients, final).elapsed

    def set_end_state(self, velocity: Array, acceleration: Array) -> None:
        """
        Set velocity and acceleration at the last knot.

        Parameters
        ----------
        velocity, acceleration : ndarray, shape (3,)
            [rad/s], [rad/s^2].

        """
        self.final_velocity, self.final_acceleration = velocity, acceleration
        self.ends_moving = bool(velocity.any())  # read at every step of a simulation

    @property
    def origin(self) -> float:
        """Return the origin of the knots' times [s]."""
        return self.origin_ns / SECOND

    @property
    def start(self) -> float:
        """When the motion begins [s]."""
        return self.origin + float(self.knots[0])

    @property
    def end(self) -> float:
        """When the motion comes to rest, or ends [s]."""
        return self.origin + float(self.knots[-1])

    @property
    def end_ns(self) -> int:
        """Return the same [ns]."""
        return self.origin_ns + self._knots_ns[-1]

    @property
    def end_state(self) -> Desired:
        """Position, velocity and acceleration at the last knot."""
        q1, q2, q3, qd1, qd2, qd3, a1, a2, a3 = np.concatenate(
            (self.final, self.final_velocity, self.final_acceleration)).tolist()
        return q1, q2, q3, qd1, qd2, qd3, a1, a2, a3

    def __call__(self, t: float) -> Desired:
        """
        Return the desired state at a time.

        Parameters
        ----------
        t : float
            [s]; before the first knot its state applies, after the last one rest.

        Returns
        -------
        tuple of 9 floats
            Positions [rad], velocities [rad/s], accelerations [rad/s^2].

        """
        t -= self.origin
        return self.elapsed(nanoseconds(t), t)

    def command(self, now: int) -> Desired:
        """
        Return the desired state at a time of a clock.

        Parameters
        ----------
        now : int
            [ns].

        Returns
        -------
        tuple of 9 floats
            As `__call__`.

        """
        n = now - self.origin_ns
        return self.elapsed(n, n / SECOND)

    def at(self, t: ArrayLike) -> tuple[Array, Array, Array, Array]:
        """
        Return the motion at many times.

        Parameters
        ----------
        t : array_like, shape (...)
            Times [s]; before the first knot its state applies, from the last one on `end_state`.

        Returns
        -------
        tuple of ndarray, shape (..., 3)
            Position [rad], velocity [rad/s], acceleration [rad/s^2], jerk [rad/s^3].

        """
        q, qd, qdd, qddd = super().at(bound_array('t', t) - self.origin)
        if len(self.coefficients) == 0:
            return q, qd + self.final_velocity, qdd + self.final_acceleration, qddd
        return q, qd, qdd, qddd

    def states(self) -> tuple[Array, Array, Array]:
        """
        Return the states after each knot, and `end_state` at the last.

        Returns
        -------
        tuple of ndarray, shape (n, 3)
            Positions [rad], velocities [rad/s], accelerations [rad/s^2].

        """
        c = self.coefficients
        return (np.vstack((c[:, :, 0], self.final)),
                np.vstack((c[:, :, 1], self.final_velocity)),
                np.vstack((2.0 * c[:, :, 2], self.final_acceleration)))


def reference_through(points: TrajectoryPoints, origin_ns: int = 0) -> ReferenceTrajectory:
    """
    Return the reference trajectory through points.

    Parameters
    ----------
    points : TrajectoryPoints
        The points.
    origin_ns : int
        Origin of their times [ns].

    Returns
    -------
    ReferenceTrajectory
        Lines, cubics and quintics between them.

    """
    spline = spline_through(points)
    motion = ReferenceTrajectory(spline.knots, spline.coefficients, spline.final, origin_ns)
    moving = np.abs(points.velocities[-1]) > FLOAT_EPSILON
    if moving.any():  # other joints are at rest, as if all were
        acceleration = (motion.at(motion.end)[2] if len(motion.coefficients)
                        else points.accelerations[-1])
        motion.set_end_state(np.where(moving, points.velocities[-1], 0.0),
                             np.where(moving, acceleration, 0.0))
    return motion


def holding(q: ArrayLike, now: int = 0) -> ReferenceTrajectory:
    """
    Return a reference trajectory that holds a position.

    Parameters
    ----------
    q : array_like, shape (3,)
        Positions [rad].
    now : int
        When it begins [ns].

    Returns
    -------
    ReferenceTrajectory
        Of one knot.

    """
    return ReferenceTrajectory(np.zeros(1), np.zeros((0, 3, 6)), finite_array('q', q, (3,)), now)
