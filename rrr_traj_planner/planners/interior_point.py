"""
Least time of a chain of ramps: a primal-dual interior-point method of feasible iterates.

It begins at a motion strictly within all limits and never leaves them, so that whatever ends it,
what it has is a valid motion, and it knows how far the optimum can be.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.planners.ramp_chain import Motion
from rrr_traj_planner.planners.ramp_constraints import Change, Constraints, torque_hessian
from rrr_traj_planner.planners.ramp_newton import curvature, Freedom, newton_step, Step

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
TO_BOUNDARY = 0.995          # part of the way to the boundary that a step may go
LEAST_ROOM_KEPT = 0.005      # part of its room that a constraint keeps in a step
DUAL_CORRIDOR = 1e6          # how far multipliers may be from barrier / slack


class Outcome(NamedTuple):
    """What the method ended with."""

    motion: Motion
    gap: float        # what a better motion could save at most, by duality [s]
    converged: bool


def minimise(constraints: Constraints, motion: Motion, freedom: Freedom,
             should_stop: Callable[[], bool], nearness: float = 1.0) -> Outcome:
    """
    Return the fastest motion.

    Parameters
    ----------
    constraints : Constraints
        The limits.
    motion : Motion
        Strictly within them.
    freedom : Freedom
        What may change.
    should_stop : callable
        Asked before every iteration; True ends the method with what it has.
    nearness : float
        About how far the start is from the optimum, relative; less is faster.

    Returns
    -------
    Outcome
        Never slower than the start.

    """
    objective = _Objective(freedom)
    slacks = constraints.slacks(motion)
    count = sum(s.size for s in slacks)
    barrier = START * nearness * objective(motion) / count
    barrier, duals = _first_barrier(constraints, motion, freedom, barrier)
    best, gap = motion, np.inf
    merits: list[float] = []  # at this barrier
    for _ in range(ITERATIONS):
        if should_stop():
            break
        local = _Local(constraints, motion, duals, freedom, barrier)
        step, rates, size, moved = _best_step(constraints, objective, motion, local, barrier)
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
            barrier, merits = barrier * BARRIER_REDUCTION, []
    return Outcome(best, gap, gap < CONVERGED * objective(best))


def _first_barrier(constraints: Constraints, motion: Motion, freedom: Freedom,
                   barrier: float) -> tuple[float, list[Array]]:
    """Return a barrier high enough to lead away from limits that the start is close to."""
    for _ in range(RAISES):
        duals = [barrier / s for s in constraints.slacks(motion)]
        step = next(_Local(constraints, motion, duals, freedom, barrier).steps())
        if step.gain < FAR_FROM_CENTRE * barrier:
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
               barrier: float) -> _Tried:
    """Return the first of the suggested steps that gets far, else the one that gets furthest."""
    tried: list[_Tried] = []
    for step in local.steps():
        rates = [_rate(constraints, x, step.motion) for x in local.changes]
        tried.append(_Tried(step, rates, *_line_search(
            constraints, objective, motion, local.slacks, rates, step, barrier)))
        if tried[-1].size > SHORT:
            break
    return max(tried, key=lambda t: t.size)


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
        self.slacks, self.changes, self._torque = constraints.linear(motion)
        self._n, self._ends = constraints.grid.n, constraints.grid.end_changes(motion)
        self._duals, self._freedom = duals, freedom
        self._simple = curvature(self.slacks, self.changes, duals, barrier, freedom.weights)

    def steps(self) -> Iterator[Step]:
        """Give the step with torque's own curvature, which may lead astray, then one without."""
        c = self._simple
        if self._torque is not None:
            yy, yT, TT = torque_hessian(self._torque, self._duals[-1])
            full = c._replace(yy=c.yy + yy, yT=c.yT + yT, TT=c.TT + TT)
            step = newton_step(self._n, self._ends, full, self._freedom)
            if step.gain > 0.0:
                yield step
        yield newton_step(self._n, self._ends, c, self._freedom)


def _rate(constraints: Constraints, x: Change, step: Motion) -> Array:
    """Return how slacks change along a step, to first order, shape (2, N, p, 3)."""
    nodes, v0, _ = constraints.grid.nodes(step)
    y = np.concatenate((v0[:, np.newaxis], nodes), axis=1)
    rate = x.by_y @ y if x.by_y.ndim == 3 else np.einsum('npijm,nmj->npi', x.by_y, y)
    rate = rate + x.by_T * step.T[:, np.newaxis, np.newaxis]
    return np.stack((-rate, rate))


def _line_search(constraints: Constraints, objective: _Objective, motion: Motion,
                 slacks: list[Array], rates: list[Array], step: Step,
                 barrier: float) -> tuple[float, tuple[Motion, list[Array]] | None]:
    """Return a step's size and what it leads to, feasible and of less objective + barrier."""
    merit = objective(motion) - barrier * _log(slacks)
    size = min(1.0, TO_BOUNDARY / max(float((-r / s).max()) for r, s in zip(rates, slacks)))
    if size <= 0.0:
        size = 1.0
    for _ in range(BACKTRACKS):
        moved = constraints.grid.moved(constraints.points, motion, step.motion, size)
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
