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

"""The joints' and the tip's limits as constraints on the motion along a path, for the solver."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.planners.path_timing.table import PathTable, PathTerms
from rrr_traj_planner.planners.solver.limits import FAR, Limits, PATH
from rrr_traj_planner.planners.solver.ramps import Grid, States, Variables
from rrr_traj_planner.planners.solver.timing_problem import TimingProblem, Workspace

QUANTITIES = 14  # three each of velocity, acceleration, jerk and torque, then:
VELOCITY, ACCELERATION, JERK, TORQUE = (slice(3 * k, 3 * k + 3) for k in range(4))
SPEED, ALONG = 12, 13  # the tip's speed, and its acceleration along the path

# Bound on the tip's acceleration along pieces of constant speed [m/s^2]: a barrier method needs an
# interior.
STEADY = 1e-3


class Progress(NamedTuple):
    """Position, speed, acceleration and jerk along the path at points, shape (N, p) each."""

    s: Array
    sd: Array
    sdd: Array
    sddd: Array


def limited(terms: PathTerms, at: Progress) -> Array:
    """
    Return the limited quantities.

    Torques are those of Bobrow, Dubowsky & Gibson (1985): m sdd + c sd^2 + g.

    Parameters
    ----------
    terms : PathTerms
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
        terms.dq * v, terms.ddq * v ** 2 + terms.dq * a,
        v * (terms.dddq * v ** 2 + 3.0 * terms.ddq * a) + terms.dq * j,
        terms.m * a + terms.c * v ** 2 + terms.g, v, a), axis=-1)


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
        The path's derivatives and dynamics.
    limits : JointLimits
        Infinite where there is none.
    max_tip_speed : float
        [m/s], infinite where there is none.
    grid : Grid
        Discretisation: n ramps per segment.
    margins : ndarray, shape (N, 2 n + 1, QUANTITIES)
        Subtracted from each quantity's limit.
    steady : ndarray of bool, shape (N,)
        Pieces on which the tip keeps its speed.
    workspace : Workspace, optional
        Memory shared by problems that are solved one after the other.

    Attributes
    ----------
    points : ndarray, shape (N + 1, 1)
        Path lengths where the pieces meet [m].
    margins
        As given.

    """

    def __init__(self, table: PathTable, limits: JointLimits, max_tip_speed: float, grid: Grid,
                 margins: Array, steady: BoolArray, workspace: Workspace | None = None) -> None:
        self.table, self.grid, self.points = table, grid, table.ends[:, np.newaxis]
        self.margins, self._workspace = margins, workspace
        bounds = all_bounds(limits, max_tip_speed)
        upper = np.minimum(bounds, FAR) - margins
        upper[steady, :, ALONG] = STEADY
        lower = -upper
        lower[..., SPEED] = 0.0  # the tip moves forward; it rests at the start and the end
        lower[0, 0, SPEED] = lower[-1, grid.n, SPEED] = -FAR
        is_limited = np.isfinite(bounds)
        is_limited[SPEED], is_limited[ALONG] = True, steady.any()
        self._lower, self._upper, self._limited = lower, upper, is_limited

    @cached_property
    def problem(self) -> TimingProblem:
        """Return the problem that the solver works on."""
        N, P, _ = self._upper.shape
        lower, upper, bounded = np.zeros((N, P, 4)), np.zeros((N, P, 4)), np.zeros((P, 4), bool)
        along = slice(1, 3)  # the states' columns of the tip's speed and acceleration
        lower[..., along], upper[..., along] = self._lower[..., SPEED:], self._upper[..., SPEED:]
        bounded[:, along] = self._limited[SPEED:]
        return TimingProblem(self.grid, self.points, Limits(
            PATH, lower, upper, bounded, self._lower[..., :SPEED], self._upper[..., :SPEED],
            np.tile(self._limited[:SPEED], (P, 1)), table=self.table.coefficients,
            overshoot=self.table.overshoot), self._workspace)

    def terms(self, s: Array) -> PathTerms:
        """
        Return the path's terms, with a quintic's overshoot added at the ends of pieces.

        Parameters
        ----------
        s : ndarray, shape (N, 2 n + 1)
            Path lengths of a motion's points [m].

        Returns
        -------
        PathTerms
            Of the path there.

        """
        terms = self.table(s)
        if not self.table.overshoot.any():
            return terms
        ddq, c = terms.ddq.copy(), terms.c.copy()
        ddq[:, self.grid.n] += self.table.overshoot[:, 0]
        c[:, self.grid.n] += self.table.overshoot[:, 1]
        return terms._replace(ddq=ddq, c=c)


def progress_at(grid: Grid, points: Array, m: Variables) -> Progress:
    """
    Return a motion's progress at its points: the nodes, then the middles between them.

    Parameters
    ----------
    grid : Grid
        Discretisation: n ramps per segment.
    points : ndarray, shape (N + 1, 1)
        Path lengths where the pieces meet [m].
    m : Variables
        The motion.

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
