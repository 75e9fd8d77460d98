"""
Least time of a chain of ramps: a primal-dual interior-point method of feasible iterates.

It begins at a motion strictly within all limits and never leaves them, so that whatever ends it,
what it has is a valid motion, and it knows how far the optimum can be.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple, Protocol

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.planners.ramp_chain import Grid, Motion
from rrr_traj_planner.planners.ramp_constraints import Change
from rrr_traj_planner.planners.ramp_newton import (
    Curvature,
    curvature,
    Freedom,
    newton_step,
    pulled,
    Step,
)

RELATIVE_GAP = 1e-3          # of the total time
BARRIER_REDUCTION = 0.1
CENTRED = 0.1                # gain left per constraint at which the barrier is lowered
PATIENCE = 6                 # steps in which it is lowered all the same, where they gain less
STALL = 3e-4                 # than this part of the total time
START = 0.3                  # the first barrier per constraint, over the start's total time
FAR_FROM_CENTRE = 1e5        # gain over barrier at the start at which the barrier is raised
RAISES = 6
CONVERGED = 5e-3             # relative gap that counts as convergence
ITERATIONS = 120
BACKTRACKS = 30
SUFFICIENT_GAIN = 1e-4
SHORT = 0.05                 # a step of less than this part of it is tried again, simpler
LEAST_BEND = 1e-3            # size of step at which it is found out how slacks leave their rates
TO_BOUNDARY = 0.995          # part of the way to the boundary that a step may go
LEAST_ROOM_KEPT = 0.005     # part of its room that a constraint keeps in a step
DUAL_CORRIDOR = 1e6          # how far multipliers may be from barrier / slack


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


class Centre(NamedTuple):
    """A motion strictly within its limits, and the barrier that keeps it there."""

    motion: Motion
    barrier: float | None  # None: not known


class Outcome(NamedTuple):
    """What the method ended with."""

    motion: Motion
    gap: float             # what a better motion could save at most, by duality [s]
    converged: bool
    centres: list[Centre]  # that it passed, slowest first


def minimise(constraints: Constraints, start: Centre, freedom: Freedom,
             should_stop: Callable[[], bool], least_barrier: float = 0.0) -> Outcome:
    """
    Return the fastest motion.

    Parameters
    ----------
    constraints : Constraints
        The limits.
    start : Centre
        Strictly within them.
    freedom : Freedom
        What may change.
    should_stop : callable
        Asked before every iteration; True ends the method with what it has.
    least_barrier : float
        The method ends at its centre.

    Returns
    -------
    Outcome
        Never slower than the start.

    """
    objective, (motion, known) = _Objective(freedom), start
    slacks = constraints.slacks(motion)
    count = sum(s.size for s in slacks)
    barrier, duals = _first_barrier(
        constraints, motion, freedom, known or START * objective(motion) / count)
    best, gap, centres = motion, np.inf, []
    merits: list[float] = []  # at this barrier
    for _ in range(ITERATIONS):
        if should_stop():
            break
        local = _Local(constraints, motion, duals, freedom, barrier)
        tried = _best_step(constraints, objective, motion, local, barrier)
        if tried is None:
            break
        step, rates, size, moved = tried
        dual_steps = [barrier / s - d - d / s * r
                      for s, d, r in zip(local.slacks, duals, rates)]
        slacks = local.slacks
        if moved is not None:
            motion, slacks = moved
            if objective(motion) < objective(best):
                best = motion
        duals = _moved_duals(duals, dual_steps, slacks, barrier)
        merits.append(objective(motion) - barrier * _log(slacks))
        # what is left to gain at this barrier, and below it
        gap = min(gap, step.gain * (1.0 - 0.5 * size) + count * barrier)
        stalled = moved is None or len(merits) > PATIENCE and (
            merits[-1 - PATIENCE] - merits[-1] < STALL * objective(motion))
        if stalled or step.gain < CENTRED * count * barrier:
            if count * barrier < RELATIVE_GAP * objective(motion):
                break
            centres.append(Centre(motion, barrier))
            if barrier <= least_barrier:
                break
            barrier, merits = barrier * BARRIER_REDUCTION, []
    return Outcome(best, gap, gap < CONVERGED * objective(best), centres)


def _first_barrier(constraints: Constraints, motion: Motion, freedom: Freedom,
                   barrier: float) -> tuple[float, list[Array]]:
    """Return a barrier high enough to lead away from limits that the start is close to."""
    for _ in range(RAISES):
        duals = [barrier / s for s in constraints.slacks(motion)]
        step = next(_Local(constraints, motion, duals, freedom, barrier).steps(), None)
        if step is None or step.gain < FAR_FROM_CENTRE * barrier:
            break
        barrier /= BARRIER_REDUCTION
    return barrier, duals


class _Tried(NamedTuple):
    """A step, how slacks change along it, how far it goes, and what it leads to."""

    step: Step
    rates: list[Array]
    size: float
    moved: tuple[Motion, list[Array]] | None


def _best_step(constraints: Constraints, objective: _Objective, motion: Motion, local: _Local,
               barrier: float) -> _Tried | None:
    """Return the first of the suggested steps that gets far, else the one that gets furthest."""
    tried: list[_Tried] = []

    def attempt(step: Step, bend: Motion | None = None) -> _Tried:
        rates = [_rate(constraints, x, step.motion) for x in local.changes]
        return _Tried(step, rates, *_line_search(
            constraints, objective, motion, local.slacks, rates, step, bend, barrier))

    for step in local.steps():
        tried.append(attempt(step))
        if tried[-1].size <= SHORT:
            bend = local.bend(constraints, motion, tried[-1])
            if bend is not None:
                tried.append(attempt(step, bend))
        if tried[-1].size > SHORT:
            break
    return max(tried, key=lambda t: t.size, default=None)


class _Objective:
    """The sum of free durations; where none is free, the stretch of the tied ones."""

    def __init__(self, freedom: Freedom) -> None:
        self.weights = freedom.weights

    def __call__(self, m: Motion) -> float:
        return float(self.weights @ m.T)


class _Local:
    """The problem near a motion, and the Newton steps that it suggests."""

    def __init__(self, constraints: Constraints, motion: Motion, duals: list[Array],
                 freedom: Freedom, barrier: float) -> None:
        self.slacks, self.changes, self._bent = constraints.linear(motion)
        self._hessian = constraints.hessian
        self._n, self._ends = constraints.grid.n, constraints.grid.end_changes(motion)
        self._duals, self._freedom = duals, freedom
        self._simple = curvature(self.slacks, self.changes, duals, barrier, freedom.weights)

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

    def bend(self, constraints: Constraints, motion: Motion, tried: _Tried) -> Motion | None:
        """Return the change, by size squared, that mends what slacks do beside their rates."""
        size = max(tried.size, LEAST_BEND)
        moved = constraints.grid.moved(constraints.points, motion, tried.step.motion, size)
        if not (moved.T > 0.0).all():
            return None
        aside = [(room - s - size * r) / size ** 2 for room, s, r in zip(
            constraints.slacks(moved), self.slacks, tried.rates)]
        push = [d / s * e for d, s, e in zip(self._duals, self.slacks, aside)]
        y, T = pulled(self.changes, [p[1] - p[0] for p in push])
        step = self._step(self._simple._replace(y=y, T=T))
        return None if step is None else step.motion


def _rate(constraints: Constraints, x: Change, step: Motion) -> Array:
    """Return how slacks change along a step, to first order, shape (2, N, p, 3)."""
    nodes, v0, _ = constraints.grid.nodes(step)
    y = np.concatenate((v0[:, np.newaxis], nodes), axis=1)
    rate = x.by_y @ y if x.by_y.ndim == 3 else np.einsum('npijm,nmj->npi', x.by_y, y)
    rate = rate + x.by_T * step.T[:, np.newaxis, np.newaxis]
    return np.stack((-rate, rate))


def _line_search(constraints: Constraints, objective: _Objective, motion: Motion,
                 slacks: list[Array], rates: list[Array], step: Step, bend: Motion | None,
                 barrier: float) -> tuple[float, tuple[Motion, list[Array]] | None]:
    """Return a step's size and what it leads to, feasible and of less objective + barrier."""
    merit = objective(motion) - barrier * _log(slacks)
    size = min(1.0, TO_BOUNDARY / max(float((-r / s).max()) for r, s in zip(rates, slacks)))
    if size <= 0.0:
        size = 1.0
    for _ in range(BACKTRACKS):
        towards = step.motion if bend is None else Motion(
            *(x + size * b for x, b in zip(step.motion, bend)))
        moved = constraints.grid.moved(constraints.points, motion, towards, size)
        if (moved.T > 0.0).all():
            room = constraints.slacks(moved)
            if all((r >= LEAST_ROOM_KEPT * s).all() for r, s in zip(room, slacks)) and (
                    objective(moved) - barrier * _log(room)
                    <= merit - SUFFICIENT_GAIN * size * step.gain):
                return size, (moved, room)
        size *= 0.5
    return 0.0, None


def _moved_duals(duals: list[Array], steps: list[Array], slacks: list[Array],
                 barrier: float) -> list[Array]:
    """Return multipliers after a step that keeps them positive, in sight of barrier / slack."""
    worst = max(float((-step / d).max()) for step, d in zip(steps, duals))
    size = min(1.0, TO_BOUNDARY / worst) if worst > 0.0 else 1.0
    return [np.clip(d + size * step, barrier / s / DUAL_CORRIDOR, barrier / s * DUAL_CORRIDOR)
            for d, step, s in zip(duals, steps, slacks)]


def _log(slacks: list[Array]) -> float:
    return sum(float(np.log(s).sum()) for s in slacks)
