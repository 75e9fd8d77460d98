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
One step of the interior-point method: the problem near a motion, the steps that it suggests.

A step is followed as far as it stays strictly within all limits and pays. Where a limit bends away
from what its rate promises, the step bends with it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple, Protocol

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.planners.limit_tables import Tables
from rrr_traj_planner.planners.ramp_chain import Grid, Motion
from rrr_traj_planner.planners.ramp_constraints import Change
from rrr_traj_planner.planners.ramp_curvature import Curvature, curvature, pulled
from rrr_traj_planner.planners.ramp_moves import stepped
from rrr_traj_planner.planners.ramp_newton import Freedom, newton_step, Step

BACKTRACKS = 30
SUFFICIENT_GAIN = 1e-4
SHORT = 0.05                 # a step of less than this part of it is tried again, simpler
LEAST_BEND = 1e-3            # size of step at which it is found out how slacks leave their rates
TO_BOUNDARY = 0.995          # part of the way to the boundary that a step may go
LEAST_ROOM_KEPT = 0.004      # part of its room that a constraint keeps in a step, and less
ROOM_AIMED_AT = 0.05         # part that it is to keep where a step was too long for it
LONGEST_RETRY = 0.95         # of a step that was too long


class Constraints(Protocol):
    """Limits on a motion, as the method sees them."""

    grid: Grid
    points: Array

    def slacks(self, m: Motion) -> list[Array]:
        """
        Return the room to the limits.

        Parameters
        ----------
        m : Motion
            Its unknowns.

        Returns
        -------
        list of ndarray, shape (2, N, p, K)
            Above and below, for each kind of limited quantity.

        """

    def linear(self, m: Motion) -> tuple[list[Array], list[Change], Any]:
        """
        Return the room to the limits, and how the limited quantities change.

        Parameters
        ----------
        m : Motion
            Its unknowns.

        Returns
        -------
        tuple
            Room as of `slacks`, a `Change` for each, and what `hessian` needs, or None.

        """

    def hessian(self, bent: Any, duals: Array) -> tuple[Array, Array, Array]:
        """
        Return the second derivatives of the last quantity's weighted sum.

        Parameters
        ----------
        bent : object
            As given by `linear`.
        duals : ndarray, shape (2, N, p, K)
            Multipliers of the upper and lower limits.

        Returns
        -------
        tuple of ndarray
            By y twice, by y and T, by T twice.

        """

    def tables(self) -> Tables:
        """Return the limits as the compiled method takes them."""


class Tried(NamedTuple):
    """A step, how slacks change along it, how far it goes, and what it leads to."""

    step: Step
    rates: list[Array]
    size: float
    moved: tuple[Motion, list[Array]] | None


class Local:
    """
    The problem near a motion, and the Newton steps that it suggests.

    Parameters
    ----------
    constraints : Constraints
        The limits.
    motion : Motion
        Strictly within them.
    duals : list of ndarray
        Multipliers, as slacks.
    freedom : Freedom
        What may change.
    barrier : float
        The barrier's weight.
    reliefs : list of ndarray, optional
        As slacks; None: none.

    Attributes
    ----------
    slacks : list of ndarray, shape (2, N, p, K)
        Room to the limits, with relief.
    reliefs : list of ndarray
        As given.
    changes : list of Change
        How the limited quantities change.

    """

    def __init__(self, constraints: Constraints, motion: Motion, duals: list[Array],
                 freedom: Freedom, barrier: float, reliefs: list[Array] | None = None) -> None:
        self.slacks, self.changes, self._bent = constraints.linear(motion)
        self.reliefs = reliefs
        pushes = [barrier / s for s in self.slacks]
        if reliefs is not None:
            self.slacks = [s + h for s, h in zip(self.slacks, reliefs)]
            pushes = [(barrier + d * h) / s for s, d, h in zip(self.slacks, duals, reliefs)]
        self._hessian = constraints.hessian
        self._n, self._ends = constraints.grid.n, constraints.grid.end_changes(motion)
        self._duals, self._freedom = duals, freedom
        self._simple = curvature(self.slacks, self.changes, duals, pushes, freedom.weights)

    def steps(self) -> Iterator[Step]:
        """Give the step with torque's own curvature, which may lead astray, then one without."""
        c = self._simple
        if self._bent is not None:
            yy, yT, TT = self._hessian(self._bent, self._duals[-1])
            full = c._replace(yy=c.yy + yy, yT=c.yT + yT, TT=c.TT + TT)
            step = self._step(full)
            if step is not None and step.gain > 0.0:
                yield step
        step = self._step(c)
        if step is not None:
            yield step

    def _step(self, c: Curvature) -> Step | None:
        try:
            return newton_step(self._n, self._ends, c, self._freedom)
        except np.linalg.LinAlgError:
            return None

    def bend(self, constraints: Constraints, motion: Motion, tried: Tried) -> Motion | None:
        """
        Return the change, by size squared, that mends what slacks do beside their rates.

        Parameters
        ----------
        constraints : Constraints
            The limits.
        motion : Motion
            Where the step begins.
        tried : Tried
            The step, and how far it went.

        Returns
        -------
        Motion or None
            None where it cannot be told.

        """
        size = max(tried.size, LEAST_BEND)
        moved = stepped(constraints.grid, constraints.points, motion, tried.step.motion, size)
        if not (moved.T > 0.0).all():
            return None
        aside = [(room - s - size * r) / size ** 2 for room, s, r in zip(
            self.room(constraints, moved, size), self.slacks, tried.rates)]
        push = [d / s * e for d, s, e in zip(self._duals, self.slacks, aside)]
        y, T = pulled(self.changes, [p[1] - p[0] for p in push])
        step = self._step(self._simple._replace(y=y, T=T))
        return None if step is None else step.motion

    def rates(self, constraints: Constraints, step: Step) -> list[Array]:
        """
        Return how slacks change along a step, to first order.

        Parameters
        ----------
        constraints : Constraints
            The limits.
        step : Step
            It takes all relief away.

        Returns
        -------
        list of ndarray
            As slacks.

        """
        rates = [rate_of(constraints, x, step.motion) for x in self.changes]
        return rates if self.reliefs is None else [r - h for r, h in zip(rates, self.reliefs)]

    def room(self, constraints: Constraints, moved: Motion, size: float) -> list[Array]:
        """
        Return the room to the limits after a part of a step.

        Parameters
        ----------
        constraints : Constraints
            The limits.
        moved : Motion
            What the part leads to.
        size : float
            The part.

        Returns
        -------
        list of ndarray
            As slacks, with what is left of relief.

        """
        slacks = constraints.slacks(moved)
        return slacks if self.reliefs is None else [
            s + (1.0 - size) * h for s, h in zip(slacks, self.reliefs)]


def best_step(constraints: Constraints, freedom: Freedom, motion: Motion, local: Local,
              barrier: float) -> Tried | None:
    """
    Return the first of the suggested steps that gets far, else the one that gets furthest.

    Parameters
    ----------
    constraints : Constraints
        The limits.
    freedom : Freedom
        What may change.
    motion : Motion
        Where it begins.
    local : Local
        The problem there.
    barrier : float
        The barrier's weight.

    Returns
    -------
    Tried or None
        None where there is no step.

    """
    tried: list[Tried] = []

    def attempt(step: Step, bend: Motion | None = None) -> Tried:
        rates = local.rates(constraints, step)
        return Tried(step, rates, *_line_search(
            constraints, freedom, motion, local, rates, step, bend, barrier))

    for step in local.steps():
        tried.append(attempt(step))
        if tried[-1].size <= SHORT:
            bend = local.bend(constraints, motion, tried[-1])
            if bend is not None:
                tried.append(attempt(step, bend))
        if tried[-1].size > SHORT:
            break
    return max(tried, key=lambda t: t.size, default=None)


def rate_of(constraints: Constraints, x: Change, step: Motion) -> Array:
    """
    Return how slacks change along a step, to first order.

    Parameters
    ----------
    constraints : Constraints
        The limits.
    x : Change
        How the limited quantity changes.
    step : Motion
        Change of every unknown.

    Returns
    -------
    ndarray, shape (2, N, p, K)
        Above and below.

    """
    nodes, v0, _ = constraints.grid.nodes(step)
    y = np.concatenate((v0[:, np.newaxis], nodes), axis=1)
    rate = x.by_y @ y if x.by_y.ndim == 3 else np.einsum('npijm,nmj->npi', x.by_y, y)
    rate = rate + x.by_T * step.T[:, np.newaxis, np.newaxis]
    return np.stack((-rate, rate))


def _line_search(constraints: Constraints, freedom: Freedom, motion: Motion, local: Local,
                 rates: list[Array], step: Step, bend: Motion | None,
                 barrier: float) -> tuple[float, tuple[Motion, list[Array]] | None]:
    """Return a step's size and what it leads to, feasible and of less objective + barrier."""
    slacks = local.slacks
    merit = freedom.cost(motion.T) - barrier * log_of(slacks)
    size = min(1.0, TO_BOUNDARY / max(float((-r / s).max()) for r, s in zip(rates, slacks)))
    if size <= 0.0:
        size = 1.0
    for _ in range(BACKTRACKS):
        towards = step.motion if bend is None else Motion(
            *(x + size * b for x, b in zip(step.motion, bend)))
        moved = stepped(constraints.grid, constraints.points, motion, towards, size)
        if not (moved.T > 0.0).all():
            size *= 0.5
            continue
        room = local.room(constraints, moved, size)
        kept = all((r >= LEAST_ROOM_KEPT * s).all() for r, s in zip(room, slacks))
        # relief is taken away whatever that costs
        if kept and (local.reliefs is not None or freedom.cost(moved.T) - barrier * log_of(room)
                     <= merit - SUFFICIENT_GAIN * size * step.gain):
            return size, (moved, room)
        size = 0.5 * size if kept else _shorter(size, slacks, rates, room)
    return 0.0, None


def _shorter(size: float, slacks: list[Array], rates: list[Array], moved: list[Array]) -> float:
    """Return where parabolas through what slacks do keep enough of them; at least half-way."""
    best = LONGEST_RETRY * size
    for s, rate, to in zip(slacks, rates, moved):
        if not np.isfinite(to).all():
            return 0.5 * size
        short = to < ROOM_AIMED_AT * s
        if not short.any():
            continue
        s, rate, to = s[short], rate[short], to[short]
        bend, fall = (to - s - size * rate) / size ** 2, (1.0 - ROOM_AIMED_AT) * s
        roots = 2.0 * fall / (np.sqrt(rate ** 2 - 4.0 * bend * fall) - rate)
        best = min(best, float(roots.min()))
    return max(best, 0.5 * size)


def log_of(slacks: list[Array]) -> float:
    """
    Return the barrier without its weight.

    Parameters
    ----------
    slacks : list of ndarray
        Room to the limits, positive.

    Returns
    -------
    float
        Sum of their logarithms.

    """
    return sum(float(np.log(s).sum()) for s in slacks)
