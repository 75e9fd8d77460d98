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
The least time of a motion: a primal-dual interior-point method whose iterates are all feasible.

Nocedal & Wright, Numerical Optimization, chapter 19, and Waechter & Biegler, On the implementation
of an interior-point filter line-search algorithm, Mathematical Programming 106 (2006): the barrier
parameter is lowered monotonically (section 2.1 there), multipliers are kept in sight of
barrier / slack (eq. 16). Unlike there, no iterate leaves the constraints: whatever ends the
method, it has a valid motion, and the merit is objective + barrier alone. The gap to the optimum
is bounded by duality, as on a central path (Boyd & Vandenberghe, Convex Optimization, 11.2.2),
with what a Newton step still promises added; where torque makes the problem nonconvex it is an
estimate.

Limits may come closer to an iterate that is already there, even beyond it: then the constraints
are shifted out to where they were, and steps take the shifts away as they go (shifted barriers:
Freund, Mathematical Programming 51, 1991).
"""

from __future__ import annotations

from collections.abc import Callable
import math
from typing import NamedTuple

from rrr_traj_planner.planners.solver.convergence import CONVERGED
from rrr_traj_planner.planners.solver.library import KERNELS
from rrr_traj_planner.planners.solver.limits import DurationConstraints
from rrr_traj_planner.planners.solver.line_search import best_step, promised_gain, TO_BOUNDARY
from rrr_traj_planner.planners.solver.ramps import Variables
from rrr_traj_planner.planners.solver.timing_problem import TimingProblem

RELATIVE_GAP = 1e-3          # of the objective, at which the method ends
BARRIER_REDUCTION = 0.1
CENTRED = 0.1                # gain left per constraint at which the barrier is lowered
PATIENCE = 6                 # steps after which it is lowered all the same, where they gain less
STALL = 3e-4                 # than this part of the objective
START = 0.3                  # the first barrier per constraint, over the start's objective
FAR_FROM_CENTRE = 1e5        # gain over barrier at the start at which the barrier is raised
RAISES = 6
ITERATIONS = 200
DUAL_CORRIDOR = 1e6          # how far multipliers may be from barrier / slack
SMALL_SHIFT = 0.5            # part of its slack: a smaller shift is taken away at once


class Centre(NamedTuple):
    """A motion strictly within its limits, and the barrier that keeps it there."""

    motion: Variables
    barrier: float | None  # None: not known


class Outcome(NamedTuple):
    """What the method ended with."""

    motion: Variables
    gap: float             # what a better motion could save at most, by duality [s]
    converged: bool
    centres: list[Centre]  # that it passed, slowest first
    within: bool = True    # False where it did not get within the limits from former ones


def minimise(problem: TimingProblem, start: Centre, durations: DurationConstraints,
             should_stop: Callable[[], bool], least_barrier: float = 0.0,
             relative_gap: float = RELATIVE_GAP, former: TimingProblem | None = None) -> Outcome:
    """
    Return the motion of least weighted durations.

    Parameters
    ----------
    problem : TimingProblem
        The limits.
    start : Centre
        Strictly within them, or within the former ones.
    durations : DurationConstraints
        What may change, and the weights.
    should_stop : callable
        The cancellation callback, called before every iteration; True ends the method with what
        it has.
    least_barrier : float
        The method ends at its centre,
    relative_gap : float
        or where so much of the objective may be left to gain.
    former : TimingProblem, optional
        Limits that the start keeps where it does not keep these yet.

    Returns
    -------
    Outcome
        Never slower than a start that is within the limits.

    """
    problem.begin(start.motion, durations)
    at, count = problem.at, KERNELS.timing_count(problem.at)
    iterate, slack = (problem.arrays.addresses[name] for name in ('variables', 'slack'))
    cost = best_cost = KERNELS.timing_cost(at, iterate)
    best, gap, centres = problem.arrays['variables'].copy(), math.inf, []
    barrier = start.barrier or START * cost / count
    if former is None:
        barrier = _first_barrier(problem, barrier)
    else:
        problem.shift(former.limits)
        _central(problem, barrier)
    merits: list[float] = []  # at this barrier
    log = math.nan            # the sum of the iterate's slacks' logarithms; not known yet
    for _ in range(ITERATIONS):
        if should_stop():
            break
        KERNELS.timing_linearise(at, barrier)
        closing = problem.shifted
        if math.isnan(log) and not closing:
            log = KERNELS.timing_log(at, slack)
        found = best_step(problem, barrier, None if closing else cost - barrier * log)
        if found is None:
            break
        size, step = found.size, found.step
        moved = size > 0.0
        if closing and moved:
            KERNELS.timing_close(at, step.at, size, SMALL_SHIFT)
        KERNELS.timing_accept(at, step.at, moved, barrier, TO_BOUNDARY, DUAL_CORRIDOR)
        if moved:
            cost, log = step.found.cost, math.nan if closing else step.found.log
            if not problem.shifted and (closing or cost < best_cost):
                best, best_cost = problem.arrays['variables'].copy(), cost
        if closing:
            if not moved:
                break
            continue
        merits.append(cost - barrier * log)
        # what is left to gain at this barrier, and below it
        gap = min(gap, step.found.gain * (1.0 - 0.5 * size) + count * barrier)
        stalled = not moved or len(merits) > PATIENCE and (
            merits[-1 - PATIENCE] - merits[-1] < STALL * cost)
        if stalled or step.found.gain < CENTRED * count * barrier:
            centres.append(Centre(
                problem.motion(problem.arrays['variables'].copy()), barrier))
            if barrier <= least_barrier or count * barrier < relative_gap * cost:
                break
            barrier, merits = barrier * BARRIER_REDUCTION, []
    return Outcome(problem.motion(best), gap, gap < CONVERGED * best_cost, centres,
                   not problem.shifted)


def _central(problem: TimingProblem, barrier: float) -> None:
    """Give every multiplier its value on the central path: barrier / slack."""
    addresses = problem.arrays.addresses
    KERNELS.timing_slacks(problem.at, addresses['variables'], addresses['slack'])
    KERNELS.timing_central_duals(problem.at, barrier)


def _first_barrier(problem: TimingProblem, barrier: float) -> float:
    """Return a barrier high enough to lead away from limits that the start is close to."""
    _central(problem, barrier)
    for _ in range(RAISES):
        KERNELS.timing_linearise(problem.at, barrier)
        gain = promised_gain(problem)
        if gain is None or gain < FAR_FROM_CENTRE * barrier:
            break
        barrier /= BARRIER_REDUCTION
        KERNELS.timing_central_duals(problem.at, barrier)
    return barrier
