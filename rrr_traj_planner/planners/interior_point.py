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
Least time of a chain of ramps: a primal-dual interior-point method of feasible iterates.

It begins at a motion strictly within all limits and never leaves them, so that whatever ends it,
what it has is a valid motion, and it knows how far the optimum can be.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.planners import compiled
from rrr_traj_planner.planners.convergence import CONVERGED
from rrr_traj_planner.planners.interior_step import (
    BACKTRACKS,
    best_step,
    Constraints,
    LEAST_BEND,
    LEAST_ROOM_KEPT,
    Local,
    log_of,
    LONGEST_RETRY,
    ROOM_AIMED_AT,
    SHORT,
    SUFFICIENT_GAIN,
    TO_BOUNDARY,
)
from rrr_traj_planner.planners.ramp_chain import Motion
from rrr_traj_planner.planners.ramp_newton import Freedom
from rrr_traj_planner.planners.relief import less, relief_in_tables, relief_of, SMALL

RELATIVE_GAP = 1e-3          # of the total time
BARRIER_REDUCTION = 0.1
CENTRED = 0.1                # gain left per constraint at which the barrier is lowered
PATIENCE = 6                 # steps in which it is lowered all the same, where they gain less
STALL = 3e-4                 # than this part of the total time
START = 0.3                  # the first barrier per constraint, over the start's total time
FAR_FROM_CENTRE = 1e5        # gain over barrier at the start at which the barrier is raised
RAISES = 6
ITERATIONS = 200
DUAL_CORRIDOR = 1e6          # how far multipliers may be from barrier / slack


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
    within: bool = True    # False where it did not get within the limits from former ones


def is_within(constraints: Constraints, m: Motion) -> bool:
    """
    Return whether a motion is strictly within its limits, as a start must be.

    Parameters
    ----------
    constraints : Constraints
        The limits.
    m : Motion
        Its unknowns.

    Returns
    -------
    bool
        False on a limit.

    """
    return min(float(s.min()) for s in constraints.slacks(m)) > 0.0


def minimise(constraints: Constraints, start: Centre, freedom: Freedom,
             should_stop: Callable[[], bool], least_barrier: float = 0.0,
             relative_gap: float = RELATIVE_GAP, former: Constraints | None = None) -> Outcome:
    """
    Return the fastest motion.

    Parameters
    ----------
    constraints : Constraints
        The limits.
    start : Centre
        Strictly within them, or within the former ones.
    freedom : Freedom
        What may change.
    should_stop : callable
        Asked before every iteration; True ends the method with what it has.
    least_barrier : float
        The method ends at its centre,
    relative_gap : float
        or where so much of the total time may be left to gain.
    former : Constraints, optional
        Limits that the start keeps where it does not keep these yet.

    Returns
    -------
    Outcome
        Never slower than a start that is within the limits.

    """
    if compiled.LIBRARY is not None:
        return _minimised_by_compiled(constraints, start, freedom, should_stop, least_barrier,
                                      relative_gap, former)
    motion, known = start
    slacks = constraints.slacks(motion)
    count = sum(s.size for s in slacks)
    barrier, reliefs = known or START * freedom.cost(motion.T) / count, None
    if former is None:
        barrier, duals = _first_barrier(constraints, motion, freedom, barrier)
    else:
        reliefs = relief_of(constraints, former, motion)
        duals = [barrier / (s + h) for s, h in zip(slacks, reliefs)]
    best, gap, centres = motion, np.inf, []
    merits: list[float] = []  # at this barrier
    for _ in range(ITERATIONS):
        if should_stop():
            break
        local, closing = Local(constraints, motion, duals, freedom, barrier, reliefs), reliefs
        tried = best_step(constraints, freedom, motion, local, barrier)
        if tried is None:
            break
        step, rates, size, moved = tried
        dual_steps = [barrier / s - d - d / s * r
                      for s, d, r in zip(local.slacks, duals, rates)]
        slacks = local.slacks
        if moved is not None:
            motion, slacks = moved
            if closing is not None:
                reliefs, slacks = less(closing, slacks, size)
                reliefs = reliefs if any(h.any() for h in reliefs) else None
            if reliefs is None and (closing is not None
                                    or freedom.cost(motion.T) < freedom.cost(best.T)):
                best = motion
        duals = _moved_duals(duals, dual_steps, slacks, barrier)
        if closing is not None:
            if moved is None:
                break
            continue
        merits.append(freedom.cost(motion.T) - barrier * log_of(slacks))
        # what is left to gain at this barrier, and below it
        gap = min(gap, step.gain * (1.0 - 0.5 * size) + count * barrier)
        stalled = moved is None or len(merits) > PATIENCE and (
            merits[-1 - PATIENCE] - merits[-1] < STALL * freedom.cost(motion.T))
        if stalled or step.gain < CENTRED * count * barrier:
            centres.append(Centre(motion, barrier))
            if barrier <= least_barrier or (
                    count * barrier < relative_gap * freedom.cost(motion.T)):
                break
            barrier, merits = barrier * BARRIER_REDUCTION, []
    return Outcome(best, gap, gap < CONVERGED * freedom.cost(best.T), centres,
                   reliefs is None)


def _minimised_by_compiled(constraints: Constraints, start: Centre, freedom: Freedom,
                           should_stop: Callable[[], bool], least_barrier: float,
                           relative_gap: float, former: Constraints | None) -> Outcome:
    settings = compiled.Settings(
        relative_gap, BARRIER_REDUCTION, CENTRED, STALL, START, FAR_FROM_CENTRE,
        DUAL_CORRIDOR, SUFFICIENT_GAIN, SHORT, LEAST_BEND, TO_BOUNDARY, LEAST_ROOM_KEPT,
        ROOM_AIMED_AT, LONGEST_RETRY, SMALL, PATIENCE, RAISES, ITERATIONS, BACKTRACKS)
    tables = constraints.tables()
    relief = None if former is None else relief_in_tables(tables, former.tables())
    found = compiled.Compiled(
        constraints.grid, constraints.points, tables, freedom, settings).minimised(
            *start, least_barrier, relief, should_stop)
    return Outcome(found.motion, found.gap,
                   found.gap < CONVERGED * freedom.cost(found.motion.T),
                   [Centre(*c) for c in found.centres], found.within)


def _first_barrier(constraints: Constraints, motion: Motion, freedom: Freedom,
                   barrier: float) -> tuple[float, list[Array]]:
    """Return a barrier high enough to lead away from limits that the start is close to."""
    duals = [barrier / s for s in constraints.slacks(motion)]
    for _ in range(RAISES):
        step = next(Local(constraints, motion, duals, freedom, barrier).steps(), None)
        if step is None or step.gain < FAR_FROM_CENTRE * barrier:
            break
        barrier /= BARRIER_REDUCTION
        duals = [barrier / s for s in constraints.slacks(motion)]
    return barrier, duals


def _moved_duals(duals: list[Array], steps: list[Array], slacks: list[Array],
                 barrier: float) -> list[Array]:
    """Return multipliers after a step that keeps them positive, in sight of barrier / slack."""
    worst = max(float((-step / d).max()) for step, d in zip(steps, duals))
    size = min(1.0, TO_BOUNDARY / worst) if worst > 0.0 else 1.0
    return [np.clip(d + size * step, barrier / s / DUAL_CORRIDOR, barrier / s * DUAL_CORRIDOR)
            for d, step, s in zip(duals, steps, slacks)]
