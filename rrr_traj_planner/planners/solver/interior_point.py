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
out to wider limits, and the steps reduce the shifts to zero (shifted barriers: Freund,
Linear Algebra and its Applications 152, 1991).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import chain
import math
from typing import NamedTuple

from rrr_traj_planner.planners.solver.convergence import CONVERGED
from rrr_traj_planner.planners.solver.library import KERNELS
from rrr_traj_planner.planners.solver.limits import DurationConstraints, Limits
from rrr_traj_planner.planners.solver.line_search import (
    best_step,
    newton_steps,
    TO_BOUNDARY,
)
from rrr_traj_planner.planners.solver.segment_steps import SegmentSteps, take_own_steps
from rrr_traj_planner.planners.solver.splines import Variables
from rrr_traj_planner.planners.solver.timing_problem import TimingProblem
from rrr_traj_planner.planners.solver.workspace import Step

# Chosen values, without unit. RELATIVE_GAP decides accuracy, the others the number of iterations:
# half and twice of each (SMALL_SHIFT: 0.25 and 0.9; DUAL_CORRIDOR: 1e4 and 1e8) change durations
# of 28 random tasks by less than 0.01 % in the mean, by 0.2 % at most.
RELATIVE_GAP = 1e-3          # of the objective, at which the method ends
BARRIER_REDUCTION = 0.1      # factor on the barrier parameter
CENTRED = 0.1                # by default
PATIENCE = 6                 # iterations after which it is lowered too, where they have gained
STALL = 3e-4                 # less than this part of the objective
START = 0.3                  # first barrier * constraints / objective
FAR_FROM_CENTRE = 1e5        # predicted decrease / barrier at which the first barrier is raised
DUAL_CORRIDOR = 1e6          # largest ratio of a multiplier to barrier / slack, and its inverse
SMALL_SHIFT = 0.5            # part of its slack below which a shift is removed at once
MOST_ITERATIONS = 200        # by default


class CentralPathPoint(NamedTuple):
    """A point near the central path: a strictly feasible motion and its barrier parameter."""

    motion: Variables
    barrier: float | None  # None: not known


class Outcome(NamedTuple):
    """The result of the method."""

    motion: Variables
    gap: float             # bound on what the optimum saves of the objective, by duality [s]
    converged: bool
    centres: list[CentralPathPoint]  # points near the central path on the way, slowest first
    within: bool = True    # False where shifts remain: the new limits were not reached


def minimise(problem: TimingProblem, start: CentralPathPoint, durations: DurationConstraints,
             should_stop: Callable[[], bool], least_barrier: float = 0.0,
             relative_gap: float = RELATIVE_GAP, centred: float = CENTRED,
             wider: Limits | None = None,
             most_iterations: int = MOST_ITERATIONS) -> Outcome:
    """
    Return the motion whose weighted sum of durations, and of squared jerks, is least.

    Parameters
    ----------
    problem : TimingProblem
        The limits.
    start : CentralPathPoint
        Strictly within them, or within the wider ones.
    durations : DurationConstraints
        Which durations are free, and the objective.
    should_stop : callable
        Cancellation callback, called before every iteration; True ends the method with the best
        motion so far.
    least_barrier : float
        The method ends when it has converged for this barrier parameter,
    relative_gap : float
        or when the gap is this part of the objective.
    centred : float
        Predicted decrease of the merit, as a part of the gap, at which the barrier parameter is
        lowered: how near to the central path.
    wider : Limits, optional
        Wider limits on the same quantities; None: the start is within those of the problem.
    most_iterations : int
        The method ends after as many.

    Returns
    -------
    Outcome
        Never slower than a start that is within the limits.

    """
    # Steps of the whole may return from wider limits where segments are stuck: in 1 of 10 motions
    # of 24 to 30 segments that start moving.
    for by_segments in (True, False) if take_own_steps(problem, durations) else (False,):
        problem.begin(start.motion, durations)
        run = _Run(problem, start.barrier, wider, by_segments)
        for _ in range(most_iterations):
            if should_stop():
                return run.outcome()
            run.iterate()
            if run.ended or run.converged(least_barrier, relative_gap, centred):
                break
        if not problem.shifted:
            break
    return run.outcome()


class _Run:
    """The iterates of one problem, and the best motion so far."""

    def __init__(self, problem: TimingProblem, barrier: float | None, wider: Limits | None,
                 by_segments: bool) -> None:
        self._problem, self._address = problem, problem.address
        self._count = KERNELS.timing_constraint_count(problem.address)
        self._cost = self._best_cost = KERNELS.timing_cost(
            problem.address, problem.arrays.addresses['variables'])
        self._best, self._gap = problem.arrays['variables'].copy(), math.inf
        self._centres: list[CentralPathPoint] = []
        self._barrier = barrier or START * self._cost / self._count
        self._steps: Iterator[tuple[Step, Step]] | None = None  # from the iterate, if computed
        self._segments = SegmentSteps(
            problem, DUAL_CORRIDOR, SMALL_SHIFT) if by_segments else None
        if wider is not None:
            problem.shift(wider)
        _central(problem, self._barrier)
        if wider is None:
            self._move_off_limits()
        self._merits: list[float] = []  # at this barrier
        self._log = math.nan            # of the iterate's slacks, summed; not known yet
        self._predicted_decrease = math.inf  # of the merit function, by the last step
        self._moved = True
        self._knows_logs = False        # whether the segments know theirs
        self.ended = False

    def _move_off_limits(self) -> None:
        """Raise the barrier parameter until it moves a start that is close to a limit off it."""
        for _ in range(6):  # at most
            decrease = self._newton_decrease()
            if not decrease >= FAR_FROM_CENTRE * self._barrier:
                return
            self._steps = None
            self._barrier /= BARRIER_REDUCTION
            _central(self._problem, self._barrier)

    def _newton_decrease(self) -> float:
        """Return the decrease that the first Newton step predicts; NaN where there is none."""
        if self._segments is not None:
            return self._segments.newton(self._barrier)
        KERNELS.timing_linearise(self._address, self._barrier)
        steps = newton_steps(self._problem)
        first = next(steps, None)
        if first is None:
            return math.nan
        self._steps = chain([first], steps)
        return float(first[0].structure.predicted_decrease)

    def iterate(self) -> None:
        """Take one Newton step, as far as slacks and merit allow; `ended` if there is none."""
        if self._segments is None or not self._step_segments(self._segments):
            self._step_whole()
            self._knows_logs = False

    def _step_segments(self, segments: SegmentSteps) -> bool:
        """Take a step that each segment shortens for itself; return whether there is one."""
        shifted = self._problem.shifted
        self._steps = None
        if not self._knows_logs:
            segments.log_sum()
            self._knows_logs = True
        if not segments.take(self._barrier):
            segments.activate_all()
            self._log = math.nan
            return False
        found = segments.structure
        self._cost, self._log, self._moved = found.cost, found.total_log, True
        self._predicted_decrease = found.predicted_decrease
        self._keep_if_best(shifted)
        if not shifted:
            self._note_merit(found.damped_decrease)
        return True

    def _step_whole(self) -> None:
        problem, address = self._problem, self._address
        steps, self._steps = self._steps, None
        if steps is None:
            KERNELS.timing_linearise(address, self._barrier)
            steps = newton_steps(problem)
        reducing_shifts = problem.shifted
        if math.isnan(self._log) and not reducing_shifts:
            self._log = KERNELS.timing_log_sum(address, problem.arrays.addresses['slack'])
        found = best_step(problem, steps, self._barrier,
                          None if reducing_shifts else self._merit())
        if found is None:
            self.ended = True
            return
        size, step = found.size, found.step
        self._moved = size > 0.0
        if reducing_shifts and self._moved:
            KERNELS.timing_reduce_shifts(address, step.address, size, SMALL_SHIFT)
        KERNELS.timing_accept(address, step.address, self._moved, self._barrier, TO_BOUNDARY,
                              DUAL_CORRIDOR)
        if self._moved:
            self._cost = step.structure.cost
            self._log = math.nan if reducing_shifts else step.structure.log
            self._keep_if_best(reducing_shifts)
        self._predicted_decrease = step.structure.predicted_decrease
        if reducing_shifts:
            self.ended = not self._moved
            return
        self._note_merit(size * self._predicted_decrease)

    def _keep_if_best(self, shifted_before: bool) -> None:
        if not self._problem.shifted and (shifted_before or self._cost < self._best_cost):
            self._best, self._best_cost = self._problem.arrays['variables'].copy(), self._cost

    def _note_merit(self, decrease: float) -> None:
        """Note the merit after a step that decreases it, to first order."""
        self._merits.append(self._merit())
        # predicted decrease at this barrier, plus the duality gap of its centre
        self._gap = min(self._gap, self._predicted_decrease - 0.5 * decrease
                        + self._count * self._barrier)

    def converged(self, least_barrier: float, relative_gap: float, centred: float) -> bool:
        """Lower the barrier parameter at a centre; return whether the method has converged."""
        if not self._merits:
            return False
        complementarity = self._count * self._barrier
        stalled = not self._moved or len(self._merits) > PATIENCE and (
            self._merits[-1 - PATIENCE] - self._merits[-1] < STALL * self._cost)
        if not stalled and self._predicted_decrease >= centred * complementarity:
            return False
        self._centres.append(CentralPathPoint(
            self._problem.motion(self._problem.arrays['variables'].copy()), self._barrier))
        if self._barrier <= least_barrier or complementarity < relative_gap * self._cost:
            return True
        self._barrier, self._merits = self._barrier * BARRIER_REDUCTION, []
        if self._segments is not None:
            self._segments.activate_all()
        return False

    def outcome(self) -> Outcome:
        """Return the best motion so far."""
        return Outcome(self._problem.motion(self._best), self._gap,
                       self._gap < CONVERGED * self._best_cost, self._centres,
                       not self._problem.shifted)

    def _merit(self) -> float:
        return float(self._cost - self._barrier * self._log)


def _central(problem: TimingProblem, barrier: float) -> None:
    """Set every multiplier to its value on the central path: barrier / slack."""
    addresses = problem.arrays.addresses
    KERNELS.timing_slacks(problem.address, addresses['variables'], addresses['slack'])
    KERNELS.timing_central_duals(problem.address, barrier)
