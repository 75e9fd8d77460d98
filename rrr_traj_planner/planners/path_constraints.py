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

"""The limits of a motion along a path, as the interior-point method sees them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.limits import JointLimits
from rrr_traj_planner.planners.limit_tables import PATH, Tables
from rrr_traj_planner.planners.path_table import Demand, PathTable
from rrr_traj_planner.planners.ramp_chain import Grid, Motion, States
from rrr_traj_planner.planners.ramp_constraints import Change

FAR = 1e6  # stands for no bound


QUANTITIES = 14  # three each of velocity, acceleration, jerk and torque, then:
VELOCITY, ACCELERATION, JERK, TORQUE = (slice(3 * k, 3 * k + 3) for k in range(4))
SPEED, ALONG = 12, 13  # the tip's speed, and its acceleration along the path

# Along a piece on which the tip is to keep its speed it may accelerate by so much [m/s^2].
STEADY = 1e-3


class Progress(NamedTuple):
    """Place, speed, acceleration and jerk along the path at points, shape (N, p) each."""

    s: Array
    sd: Array
    sdd: Array
    sddd: Array


class Bent(NamedTuple):
    """What second derivatives are made of."""

    demands: list[Demand]  # with two derivatives
    at: Progress
    by_y: Array            # of s, sd, sdd, sddd, (N, p, 4, m)
    by_T: Array            # (N, p, 4)


def limited(demand: Demand, at: Progress) -> Array:
    """
    Return the limited quantities.

    Parameters
    ----------
    demand : Demand
        Of the path at the points.
    at : Progress
        Of the motion.

    Returns
    -------
    ndarray, shape (N, p, QUANTITIES)
        Velocity, acceleration, jerk, torque of each joint, the tip's speed and acceleration.

    """
    _, v, a, j = (f[..., np.newaxis] for f in at)
    return np.concatenate((
        demand.dq * v, demand.ddq * v ** 2 + demand.dq * a,
        v * (demand.dddq * v ** 2 + 3.0 * demand.ddq * a) + demand.dq * j,
        demand.m * a + demand.c * v ** 2 + demand.g, v, a), axis=-1)


def all_bounds(limits: JointLimits, max_tip_speed: float) -> Array:
    """
    Return bounds on the magnitudes of all limited quantities.

    Parameters
    ----------
    limits : JointLimits
        Infinite where there is none.
    max_tip_speed : float
        [m/s], infinite where there is none.

    Returns
    -------
    ndarray, shape (QUANTITIES,)
        Infinite where there is none.

    """
    return np.concatenate((limits.max_velocity, limits.max_acceleration, limits.max_jerk,
                           limits.max_effort, [max_tip_speed, np.inf]))


class PathConstraints:
    """
    Limits on velocity, acceleration, jerk and torque of the joints, and on the tip's speed.

    Parameters
    ----------
    table : PathTable
        What the path asks of the joints.
    limits : JointLimits
        Infinite where there is none.
    max_tip_speed : float
        [m/s], infinite where there is none.
    grid : Grid
        The family of motions.
    margins : ndarray, shape (N, 2 n + 1, QUANTITIES)
        How far below its limit each quantity is to stay.
    steady : ndarray of bool, shape (N,)
        Pieces on which the tip keeps its speed.

    Attributes
    ----------
    points : ndarray, shape (N + 1, 1)
        Places where the pieces meet [m].
    margins
        As given.

    """

    def __init__(self, table: PathTable, limits: JointLimits, max_tip_speed: float, grid: Grid,
                 margins: Array, steady: BoolArray) -> None:
        self.table, self.grid, self.points = table, grid, table.ends[:, np.newaxis]
        self.margins = margins
        bounds = all_bounds(limits, max_tip_speed)
        upper = np.minimum(bounds, FAR) - margins
        upper[steady, :, ALONG] = STEADY
        lower = -upper
        lower[..., SPEED] = 0.0  # the tip moves on, but for where it begins and ends
        lower[0, 0, SPEED] = lower[-1, grid.n, SPEED] = -FAR
        kept = np.isfinite(bounds)
        kept[SPEED], kept[ALONG] = True, steady.any()
        self._kept = np.flatnonzero(kept)
        self._upper, self._lower = upper[..., self._kept], lower[..., self._kept]

    def slacks(self, m: Motion) -> list[Array]:
        """
        Return the room that a motion leaves to its limits.

        Parameters
        ----------
        m : Motion
            Its unknowns.

        Returns
        -------
        list of ndarray, shape (2, N, p, K)
            One, above and below.

        """
        at = progress_at(self.grid, self.points, m)
        return [self._room(limited(self.demands(at.s, 0)[0], at))]

    def linear(self, m: Motion) -> tuple[list[Array], list[Change], Bent]:
        """
        Return the room to the limits, how the limited quantities change, and their bends.

        Parameters
        ----------
        m : Motion
            Its unknowns.

        Returns
        -------
        tuple
            As `ramp_constraints.Constraints.linear`.

        """
        grid = self.grid
        states = grid.states(self.points, m)
        at = _progress(grid, states)
        by_y = _stacked(grid, grid.changes(m))
        by_T = _stacked(grid, grid.changes_by_duration(m, states))[..., 0]
        demands = self.demands(at.s, 2)
        gradient = _gradient(demands, at)[..., self._kept, :]         # (N, p, K, 4)
        changed = Change((gradient @ by_y)[..., np.newaxis, :],
                         (gradient @ by_T[..., np.newaxis])[..., 0])
        return [self._room(limited(demands[0], at))], [changed], Bent(demands, at, by_y, by_T)

    def hessian(self, bent: Bent, duals: Array) -> tuple[Array, Array, Array]:
        """
        Return the second derivatives of (upper - lower multipliers) . quantities.

        Parameters
        ----------
        bent : Bent
            What they are made of.
        duals : ndarray, shape (2, N, p, K)
            The multipliers.

        Returns
        -------
        tuple of ndarray
            By y twice (N, m, m), by y and T (N, 1, m), by T twice (N,).

        """
        weights = np.zeros((*bent.at.s.shape, QUANTITIES))
        weights[..., self._kept] = duals[0] - duals[1]
        H = _second(bent.demands, bent.at, weights)                   # (N, p, 4, 4)
        right = H @ bent.by_y
        yy = np.einsum('npim,npik->nmk', bent.by_y, right)
        HT = (H @ bent.by_T[..., np.newaxis])[..., 0]
        yT = np.einsum('npim,npi->nm', bent.by_y, HT)[:, np.newaxis]
        return yy, yT, (bent.by_T * HT).sum(axis=(1, 2))

    def tables(self) -> Tables:
        """Return the limits as the compiled method takes them."""
        N, P, _ = self._upper.shape
        bounds, boxed = np.zeros((2, N, P, 4)), np.zeros((P, 4), bool)
        general, kept = np.zeros((2, N, P, SPEED)), np.zeros((P, SPEED), bool)
        for column, quantity in enumerate(self._kept):
            of, flags, at = (general, kept, quantity) if quantity < SPEED else (
                bounds, boxed, 1 + quantity - SPEED)
            of[0, ..., at], of[1, ..., at] = self._lower[..., column], self._upper[..., column]
            flags[:, at] = True
        return Tables(PATH, bounds[0], bounds[1], boxed, general[0], general[1], kept,
                      table=self.table.coefficients, overshoot=self.table.overshoot)

    def demands(self, s: Array, order: int = 0) -> list[Demand]:
        """
        Return what is demanded, at the end of a piece with what a quintic overshoots by.

        Parameters
        ----------
        s : ndarray, shape (N, 2 n + 1)
            Places of a motion's points [m].
        order : int
            The highest derivative, at most 2.

        Returns
        -------
        list of Demand
            As `PathTable` gives it.

        """
        demands = self.table(s, order)
        if self.table.overshoot.any():
            ddq, c = demands[0].ddq.copy(), demands[0].c.copy()
            ddq[:, self.grid.n] += self.table.overshoot[:, 0]
            c[:, self.grid.n] += self.table.overshoot[:, 1]
            demands[0] = demands[0]._replace(ddq=ddq, c=c)
        return demands

    def _room(self, x: Array) -> Array:
        x = x[..., self._kept]
        return np.stack((self._upper - x, x - self._lower))


def progress_at(grid: Grid, points: Array, m: Motion) -> Progress:
    """
    Return a motion's progress at its points: the nodes, then the middles between them.

    Parameters
    ----------
    grid : Grid
        The family of motions.
    points : ndarray, shape (N + 1, 1)
        Places where the pieces meet [m].
    m : Motion
        Its unknowns.

    Returns
    -------
    Progress
        Of shape (N, 2 n + 1).

    """
    return _progress(grid, grid.states(points, m))


def _progress(grid: Grid, at: States) -> Progress:
    jerk = np.zeros_like(at.q[..., 0])
    jerk[:, grid.n + 1:] = at.jerk[..., 0]  # zero at the nodes, at its peak between them
    return Progress(at.q[..., 0], at.qd[..., 0], at.qdd[..., 0], jerk)


def _stacked(grid: Grid, change: States) -> Array:
    """Return changes of place, speed, acceleration and jerk at the points, (N, p, 4, m)."""
    jerk = np.zeros_like(change.q)
    jerk[:, grid.n + 1:] = change.jerk
    return np.stack((change.q, change.qd, change.qdd, jerk), axis=2)


def _gradient(demands: list[Demand], at: Progress) -> Array:
    """Return first derivatives of the limited quantities by s, sd, sdd, sddd."""
    d, by_s = demands[:2]
    _, v, a, j = (f[..., np.newaxis] for f in at)
    none, one = np.zeros_like(d.dq), np.ones_like(v)
    kinds = (
        (by_s.dq * v, d.dq, none, none),
        (by_s.ddq * v ** 2 + by_s.dq * a, 2.0 * d.ddq * v, d.dq, none),
        (v * (by_s.dddq * v ** 2 + 3.0 * by_s.ddq * a) + by_s.dq * j,
         3.0 * d.dddq * v ** 2 + 3.0 * d.ddq * a, 3.0 * d.ddq * v, d.dq),
        (by_s.m * a + by_s.c * v ** 2 + by_s.g, 2.0 * d.c * v, d.m, none),
        (0.0 * one, one, 0.0 * one, 0.0 * one), (0.0 * one, 0.0 * one, one, 0.0 * one))
    return np.concatenate([np.stack(kind, axis=-1) for kind in kinds], axis=-2)


def _second(demands: list[Demand], at: Progress, weights: Array) -> Array:
    """Return second derivatives of the weighted sum by s, sd, sdd, sddd, (N, p, 4, 4)."""
    d, s, ss = demands
    _, v, a, j = (f[..., np.newaxis] for f in at)
    lv, la, lj, lt = (weights[..., 3 * k:3 * k + 3] for k in range(4))
    H = np.zeros((*at.s.shape, 4, 4))
    H[..., 0, 0] = (
        lv * ss.dq * v + la * (ss.ddq * v ** 2 + ss.dq * a)
        + lj * (v * (ss.dddq * v ** 2 + 3.0 * ss.ddq * a) + ss.dq * j)
        + lt * (ss.m * a + ss.c * v ** 2 + ss.g)).sum(axis=-1)
    H[..., 0, 1] = (lv * s.dq + 2.0 * v * (la * s.ddq + lt * s.c)
                    + 3.0 * lj * (s.dddq * v ** 2 + s.ddq * a)).sum(axis=-1)
    H[..., 0, 2] = (la * s.dq + 3.0 * lj * s.ddq * v + lt * s.m).sum(axis=-1)
    H[..., 0, 3] = (lj * s.dq).sum(axis=-1)
    H[..., 1, 1] = (2.0 * la * d.ddq + 6.0 * lj * d.dddq * v + 2.0 * lt * d.c).sum(axis=-1)
    H[..., 1, 2] = (3.0 * lj * d.ddq).sum(axis=-1)
    upper = np.triu(H, 1)
    return H + np.swapaxes(upper, -1, -2)
