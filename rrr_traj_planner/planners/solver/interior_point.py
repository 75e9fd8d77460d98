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
The least time of a motion: a feasible primal-dual interior-point method.

Nocedal & Wright, Numerical Optimization, chapter 19, and Waechter & Biegler, On the implementation
of an interior-point filter line-search algorithm, Mathematical Programming 106 (2006): the barrier
parameter is lowered monotonically (section 2.1 there), multipliers are confined to a corridor
around barrier / slack (eq. 16). Unlike there, every iterate is strictly feasible: whenever the
method ends it has a valid motion, and the merit function is objective + barrier alone. The gap to
the optimum is bounded by duality, as on the central path (Boyd & Vandenberghe, Convex
Optimization, 11.2.2), plus the decrease that the Newton step predicts; where torque makes the
problem nonconvex it is an estimate.

When limits are tightened so that the last iterate violates them, the constraints are first shifted
out to the previous limits, and the steps reduce the shifts to zero (shifted barriers: Freund,
Mathematical Programming 51, 1991).
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

# Without unit. RELATIVE_GAP decides accuracy, the others the number of iterations.
RELATIVE_GAP = 1e-3          # of the objective, at which the method ends
BARRIER_REDUCTION = 0.1      # factor on the barrier parameter
CENTRED = 0.1                # predicted decrease / (constraints * barrier) at which it is lowered
PATIENCE = 6                 # iterations after which it is lowered too, where they have gained
STALL = 3e-4                 # less than this part of the objective
START = 0.3                  # first barrier * constraints / objective
FAR_FROM_CENTRE = 1e5        # predicted decrease / barrier at which the first barrier is raised,
RAISES = 6                   # at most so many times
ITERATIONS = 200             # at most
DUAL_CORRIDOR = 1e6          # largest ratio of a multiplier to barrier / slack, and its inverse
SMALL_SHIFT = 0.5            # part of its slack below which a shift is removed at once


class Centre(NamedTuple):
    """A point near the central path: a strictly feasible motion and its barrier parameter."""

    motion: Variables
    barrier: float | None  # None: not known


class Outcome(NamedTuple):
    """The result of the method."""

    motion: Variables
    gap: float             # bound on the time that the optimum saves, by duality [s]
    converged: bool
    centres: list[Centre]  # points near the central path on the way, slowest first
    within: bool = True    # False where shifts remain: the new limits were not reached


def minimise(problem: TimingProblem, start: Centre, durations: DurationConstraints,
             should_stop: Callable[[], bool], least_barrier: float = 0.0,
             relative_gap: float = RELATIVE_GAP, previous: TimingProblem | None = None) -> Outcome:
    """
    Return the motion whose weighted sum of durations is least.

    Parameters
    ----------
    problem : TimingProblem
        The limits.
    start : Centre
        Strictly within them, or within the previous ones.
    durations : DurationConstraints
        Which durations are free, and their weights in the objective.
    should_stop : callable
        Cancellation callback, called before every iteration; True ends the method with the best
        motion so far.
    least_barrier : float
        The method ends when it has converged for this barrier parameter,
    relative_gap : float
        or when the gap is this part of the objective.
    previous : TimingProblem, optional
        Wider limits, which the start keeps; None: it keeps those of the problem.

    Returns
    -------
    Outcome
        Never slower than a start that is within the limits.

    """
    problem.begin(start.motion, durations)
    at, count = problem.at, KERNELS.timing_constraint_count(problem.at)
    iterate, slack = (problem.arrays.addresses[name] for name in ('variables', 'slack'))
    cost = best_cost = KERNELS.timing_cost(at, iterate)
    best, gap, centres = problem.arrays['variables'].copy(), math.inf, []
    barrier = start.barrier or START * cost / count
    if previous is None:
        barrier = _first_barrier(problem, barrier)
    else:
        problem.shift(previous.limits)
        _central(problem, barrier)
    merits: list[float] = []  # at this barrier
    log = math.nan            # the sum of the iterate's slacks' logarithms; not known yet
    for _ in range(ITERATIONS):
        if should_stop():
            break
        KERNELS.timing_linearise(at, barrier)
        closing = problem.shifted
        if math.isnan(log) and not closing:
            log = KERNELS.timing_log_sum(at, slack)
        found = best_step(problem, barrier, None if closing else cost - barrier * log)
        if found is None:
            break
        size, step = found.size, found.step
        moved = size > 0.0
        if closing and moved:
            KERNELS.timing_reduce_shifts(at, step.at, size, SMALL_SHIFT)
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
        # predicted decrease at this barrier, plus the duality gap of its centre
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
    """Set every multiplier to its value on the central path: barrier / slack."""
    addresses = problem.arrays.addresses
    KERNELS.timing_slacks(problem.at, addresses['variables'], addresses['slack'])
    KERNELS.timing_central_duals(problem.at, barrier)


def _first_barrier(problem: TimingProblem, barrier: float) -> float:
    """Return a barrier parameter large enough to move a start that is close to a limit off it."""
    _central(problem, barrier)
    for _ in range(RAISES):
        KERNELS.timing_linearise(problem.at, barrier)
        gain = promised_gain(problem)
        if gain is None or gain < FAR_FROM_CENTRE * barrier:
            break
        barrier /= BARRIER_REDUCTION
        KERNELS.timing_central_duals(problem.at, barrier)
    return barrier
