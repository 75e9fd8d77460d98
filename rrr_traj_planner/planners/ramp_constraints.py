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

"""The limits of a chain of ramps: their slacks, and how they change with the unknowns."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core import equations
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.equations import Terms
from rrr_traj_planner.core.limits import JointLimits
from rrr_traj_planner.core.model import RobotModel
from rrr_traj_planner.planners.limit_tables import ALONE, Tables, TORQUE
from rrr_traj_planner.planners.ramp_chain import Grid, Motion, States

DIFFERENCE = 1e-7  # rad: the change of the equations' terms with position is a difference over it

# Room beyond a range for joints that stay at its end [rad]; less than what counts as leaving it.
EDGE = 5e-10

# Stands for no bound: so far away that it does not count.
FAR = 1e6


class Change(NamedTuple):
    """
    How a limited quantity x changes with a segment's own unknowns.

    These are y, the velocity at the segment's start and its n + 1 node accelerations, and its
    duration T.
    """

    by_y: Array  # (N, p, m) where it is each joint's own matter, else (N, p, 3, 3, m)
    by_T: Array  # (N, p, 3)


class TorqueCurvature(NamedTuple):
    """What second derivatives of torque are made of, at the points of all segments."""

    at: Terms      # the equations' terms, and their changes with joints 2 and 3
    by_q2: Terms
    by_q3: Terms
    states: States
    by_y: States   # (N, p, m): of q, qd, qdd
    by_T: States   # (N, p, 3)


class Constraints:
    """
    Limits on velocity, acceleration, jerk, position and torque.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Infinite where there is none.
    grid : Grid
        The family of motions.
    points : ndarray, shape (N + 1, 3)
        Via points [rad].
    margins : ndarray, shape (2, N, 2 n + 1, 3)
        How far inside the range each joint is to stay at each point, above and below [rad].
    velocity_margins : ndarray, shape (N, 2 n + 1, 3)
        How far below its limit each velocity is to stay at each point [rad/s].
    effort_margins : ndarray, shape (N, 2 n + 1, 3)
        How far below its limit each torque is to stay at each point [N m].
    floor : ndarray, shape (N,), optional
        Least durations of the segments [s].

    Attributes
    ----------
    effort : ndarray, shape (N, 2 n, 3)
        Bounds of the torques, margins taken off, at all points but a segment's first [N m].
    with_torque : bool
        Whether torque is limited; without it the joints are independent but for time.

    """

    def __init__(self, model: RobotModel, limits: JointLimits, grid: Grid, points: Array,
                 margins: Array, velocity_margins: Array, effort_margins: Array,
                 floor: Array | None = None) -> None:
        self.grid, self.points, self.limits = grid, points, limits
        self._constants = equations.constants(model)
        n = grid.n
        inside = np.r_[1:n, n + 1:2 * n + 1]  # not at the via points, where the place is given
        fastest = limits.max_velocity - velocity_margins[:, 1:]
        bounded = (('qd', np.arange(1, 2 * n + 1), -fastest, fastest),
                   ('qdd', np.arange(1, n + 1), -limits.max_acceleration,
                    limits.max_acceleration),
                   ('jerk', np.arange(n), -limits.max_jerk, limits.max_jerk),
                   ('q', inside, *self._ranges(margins[:, :, inside])))
        self._boxes = [(name, rows, np.maximum(lower, -FAR), np.minimum(upper, FAR))
                       for name, rows, lower, upper in bounded
                       if np.isfinite(upper).any() or np.isfinite(lower).any()]
        self.effort = (np.minimum(limits.max_effort, FAR) - effort_margins)[:, 1:]
        self.floor = floor
        # without torque the joints are independent but for time
        self.with_torque = bool(np.isfinite(limits.max_effort).any())

    def _ranges(self, margins: Array) -> tuple[Array, Array]:
        above, below = margins
        return self.limits.min_position - EDGE + below, self.limits.max_position + EDGE - above

    def slacks(self, m: Motion) -> list[Array]:
        """
        Return the room that a motion leaves to its limits.

        Parameters
        ----------
        m : Motion
            Its unknowns.

        Returns
        -------
        list of ndarray, shape (2, N, p, 3)
            Above and below, for each limited quantity; positive strictly within.

        """
        at = self.grid.states(self.points, m)
        found = self._room(at, m.T)
        if self.with_torque:
            found.append(self._torque_room(self._torque(self._terms(at.q), at)))
        return found

    def linear(self, m: Motion) -> tuple[list[Array], list[Change], TorqueCurvature | None]:
        """
        Return the room to the limits, and how the limited quantities change.

        Parameters
        ----------
        m : Motion
            Its unknowns.

        Returns
        -------
        tuple
            Room as of `slacks`; a `Change` for each limited quantity; what torque's curvature
            needs, None where torque is not limited.

        """
        grid = self.grid
        at = grid.states(self.points, m)
        by_y, by_T = grid.changes(m), grid.changes_by_duration(m, at)
        slacks = self._room(at, m.T)
        changes = [Change(getattr(by_y, name)[:, rows], getattr(by_T, name)[:, rows])
                   for name, rows, _, _ in self._boxes]
        if self.floor is not None:
            N, m_ = len(m.T), grid.n + 2
            changes.insert(0, Change(np.zeros((N, 1, m_)), np.ones((N, 1, 3))))
        if not self.with_torque:
            return slacks, changes, None
        t, by_q2, by_q3 = self._terms_and_changes(at.q)
        slacks.append(self._torque_room(self._torque(t, at)))
        curvature = TorqueCurvature(t, by_q2, by_q3, at, by_y, by_T)
        changes.append(self._torque_change(curvature))
        return slacks, changes, curvature

    def hessian(self, bent: TorqueCurvature, duals: Array) -> tuple[Array, Array, Array]:
        """
        Return second derivatives of the torques' weighted sum; see `torque_hessian`.

        Parameters
        ----------
        bent : TorqueCurvature
            What they are made of.
        duals : ndarray, shape (2, N, p, 3)
            Multipliers of the torque's upper and lower limits.

        Returns
        -------
        tuple of ndarray
            By y twice, by y and T, by T twice.

        """
        return torque_hessian(bent, duals)

    def tables(self) -> Tables:
        """Return the limits as the compiled method takes them."""
        N, n, P = len(self.points) - 1, self.grid.n, 2 * self.grid.n + 1
        kinds = {'q': (0, 0), 'qd': (1, 0), 'qdd': (2, 0), 'jerk': (3, n + 1)}  # first point
        bounds, boxed = np.zeros((2, N, P, 4, 3)), np.zeros((P, 4, 3), bool)
        for name, rows, lower, upper in self._boxes:
            kind, first = kinds[name]
            bounds[0, :, first + rows, kind] = np.swapaxes(
                np.broadcast_to(lower, (N, len(rows), 3)), 0, 1)
            bounds[1, :, first + rows, kind] = np.swapaxes(
                np.broadcast_to(upper, (N, len(rows), 3)), 0, 1)
            boxed[first + rows, kind] = True
        kept = np.zeros((P, 3), bool)
        kept[1:] = self.with_torque
        effort = np.concatenate((np.full((N, 1, 3), FAR), self.effort), axis=1)
        return Tables(
            TORQUE if self.with_torque else ALONE, bounds[0].reshape(N, P, 12),
            bounds[1].reshape(N, P, 12), boxed.reshape(P, 12), -effort, effort, kept, self.floor,
            np.array(self._constants), difference=DIFFERENCE)

    def _room(self, at: States, T: Array) -> list[Array]:
        found = []
        if self.floor is not None:
            spare = np.broadcast_to((T - self.floor)[:, np.newaxis, np.newaxis], (len(T), 1, 3))
            found.append(np.stack((FAR - spare, spare)))
        for name, rows, lower, upper in self._boxes:
            x = getattr(at, name)[:, rows]
            found.append(np.stack((upper - x, x - lower)))
        return found

    def _torque_room(self, tau: Array) -> Array:
        effort, tau = self.effort, tau[:, 1:]
        return np.stack((effort - tau, effort + tau))

    def _terms(self, q: Array) -> Terms:
        return equations.terms(self._constants, q[..., 1], q[..., 2], np.sin, np.cos)

    def _terms_and_changes(self, q: Array) -> tuple[Terms, Terms, Terms]:
        """Return the equations' terms and their derivatives by q2 and by q3."""
        shifted = np.stack((q, q, q))
        shifted[1, ..., 1] += DIFFERENCE
        shifted[2, ..., 2] += DIFFERENCE
        found = self._terms(shifted)
        found = Terms(*(np.broadcast_to(f, shifted.shape[:-1]) for f in found))
        by_q2, by_q3 = (Terms(*((f[k] - f[0]) / DIFFERENCE for f in found)) for k in (1, 2))
        return Terms(*(f[0] for f in found)), by_q2, by_q3

    @staticmethod
    def _torque(t: Terms, at: States) -> Array:
        (w1, w2, w3), (a1, a2, a3) = np.moveaxis(at.qd, -1, 0), np.moveaxis(at.qdd, -1, 0)
        return np.stack(equations.torques(t, w1, w2, w3, a1, a2, a3), axis=-1)

    def _torque_change(self, c: TorqueCurvature) -> Change:
        """Return torque's first derivatives; it is linear in the terms."""
        t = c.at
        by_q, by_qd, by_qdd = (np.zeros((*c.states.q.shape, 3)) for _ in range(3))
        by_q[..., 1], by_q[..., 2] = (self._torque(d, c.states) for d in (c.by_q2, c.by_q3))
        w1, w2, w3 = np.moveaxis(c.states.qd, -1, 0)
        by_qd[..., 0, 0], by_qd[..., 0, 1], by_qd[..., 0, 2] = (
            t.D2 * w2 + t.D3 * w3, t.D2 * w1, t.D3 * w1)
        by_qd[..., 1, 0], by_qd[..., 1, 1], by_qd[..., 1, 2] = (
            -t.D2 * w1, 2.0 * t.bc3 * w3, 2.0 * t.bc3 * (w2 + w3))
        by_qd[..., 2, 0], by_qd[..., 2, 1] = -t.D3 * w1, -2.0 * t.bc3 * w2
        by_qdd[..., 0, 0], by_qdd[..., 1, 1], by_qdd[..., 2, 2] = t.H11, t.H22, t.H33
        by_qdd[..., 1, 2] = by_qdd[..., 2, 1] = t.H23
        by_T = (by_q @ c.by_T.q[..., np.newaxis] + by_qd @ c.by_T.qd[..., np.newaxis])[..., 0]
        kinds = ((by_q, c.by_y.q), (by_qd, c.by_y.qd), (by_qdd, c.by_y.qdd))
        by_y = sum(by[:, 1:, :, :, np.newaxis] * d[:, 1:, np.newaxis, np.newaxis]
                   for by, d in kinds)
        return Change(np.asarray(by_y), by_T[:, 1:])


def torque_hessian(c: TorqueCurvature, duals: Array) -> tuple[Array, Array, Array]:
    """
    Return the second derivatives of (upper - lower multipliers) . torque, summed over points.

    Of those by position twice only gravity's count: they are its own terms, negative.

    Parameters
    ----------
    c : TorqueCurvature
        What they are made of.
    duals : ndarray, shape (2, N, p, 3)
        Multipliers of the torque's upper and lower limits.

    Returns
    -------
    tuple of ndarray
        By y twice (N, 3 m, 3 m), by y and T (N, 3, m), by T twice (N,).

    """
    s1, s2, s3 = np.moveaxis(duals[0] - duals[1], -1, 0)
    w1, w2, w3 = np.moveaxis(c.states.qd[:, 1:], -1, 0)
    by_point = np.zeros((*s1.shape, 9, 9))  # q, qd, qdd of three joints
    t = Terms(*(f[:, 1:] for f in c.at))
    for k, d in ((1, c.by_q2), (2, c.by_q3)):
        D2, D3, bc3, H11, H22, H23 = (
            f[:, 1:] for f in (d.D2, d.D3, d.bc3, d.H11, d.H22, d.H23))
        by_point[..., k, 3] = s1 * (D2 * w2 + D3 * w3) - (s2 * D2 + s3 * D3) * w1
        by_point[..., k, 4] = s1 * D2 * w1 + 2.0 * bc3 * (s2 * w3 - s3 * w2)
        by_point[..., k, 5] = s1 * D3 * w1 + 2.0 * s2 * bc3 * (w2 + w3)
        by_point[..., k, 6], by_point[..., k, 7] = s1 * H11, s2 * H22 + s3 * H23
        by_point[..., k, 8] = s2 * H23
    by_point[..., 3, 4], by_point[..., 3, 5] = s1 * t.D2, s1 * t.D3
    by_point[..., 4, 5] = 2.0 * s2 * t.bc3
    by_point[..., 1, 2] = -(s2 + s3) * t.g3
    by_point += np.swapaxes(by_point, -1, -2)
    by_point[..., 1, 1], by_point[..., 2, 2] = -(s2 * t.g2 + s3 * t.g3), -(s2 + s3) * t.g3
    by_point[..., 3, 3] = -(s2 * t.D2 + s3 * t.D3)
    by_point[..., 4, 4] = -2.0 * s3 * t.bc3
    by_point[..., 5, 5] = 2.0 * s2 * t.bc3
    N, p = s1.shape
    D = np.stack([getattr(c.by_y, f)[:, 1:] for f in ('q', 'qd', 'qdd')], axis=2)  # (N, p, 3, m)
    m = D.shape[-1]
    DT = np.concatenate([getattr(c.by_T, f)[:, 1:] for f in ('q', 'qd', 'qdd')], axis=-1)
    HT = (by_point @ DT[..., np.newaxis])[..., 0]                                 # (N, p, 9)
    H = by_point.reshape(N, p, 3, 3, 3, 3)  # kind, joint twice
    Dt = np.swapaxes(D.reshape(N, 3 * p, m), 1, 2)
    right = np.einsum('npaibj,npbl->npaijl', H, D).reshape(N, 3 * p, 9 * m)
    yy = np.moveaxis((Dt @ right).reshape(N, m, 3, 3, m), 1, 2).reshape(N, 3 * m, 3 * m)
    yT = np.swapaxes(Dt @ HT.reshape(N, 3 * p, 3), 1, 2)
    return yy, yT, (DT * HT).sum(axis=(1, 2))
