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
The line search of one iteration: Newton steps, shortened until they are acceptable.

The first step is computed with the second derivatives of the constraints, weighted by their
multipliers; it need not be a descent direction. The second is computed without them (Gauss-Newton)
and tried where the first makes little progress. The step size starts at the fraction to the
boundary (Nocedal & Wright, Numerical Optimization, eq. 19.9; Waechter & Biegler 2006, eq. 8) and
is reduced until every slack retains a part of itself and the merit decreases sufficiently
(Armijo). A step that stays short because constraints are curved is tried again with a second-order
correction (Nocedal & Wright 18.3; Waechter & Biegler 2.4), here along a parabola: step * size +
correction * size^2.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from rrr_traj_planner.planners.solver.library import KERNELS
from rrr_traj_planner.planners.solver.timing_problem import TimingProblem
from rrr_traj_planner.planners.solver.workspace import Step

# Chosen values, without unit; sizes are parts of the whole Newton step. SUFFICIENT_DECREASE and
# TO_BOUNDARY are usual (Nocedal & Wright 3.1, 19.2); half and twice of the others (LONGEST_RETRY:
# 0.5 and 0.99) change durations of 28 random tasks by 0.02 % in the mean, by 0.6 % at most.
SUFFICIENT_DECREASE = 1e-4   # part of the predicted decrease of the merit (Armijo)
SHORT = 0.05                 # size up to which a step is corrected, then replaced by the next
LEAST_CORRECTED = 1e-3       # least size at which constraints are evaluated for the correction
TO_BOUNDARY = 0.995          # fraction to the boundary
LEAST_SLACK_RETAINED = 0.004   # part of its slack that a constraint must retain after a step
TARGET_SLACK = 0.05          # part that a shorter step is to retain where one was too long
LONGEST_RETRY = 0.95         # of the size of a step that was too long


class LineSearchResult(NamedTuple):
    """A step, and the size taken; 0: it was not acceptable."""

    step: Step
    size: float


def best_step(problem: TimingProblem, steps: Iterator[tuple[Step, Step]], barrier: float,
              merit: float | None) -> LineSearchResult | None:
    """
    Return the first Newton step that is acceptable at more than SHORT size, else the longest.

    Parameters
    ----------
    problem : TimingProblem
        Linearised at the iterate.
    steps : iterator
        Its Newton steps, as of `newton_steps`.
    barrier : float
        The barrier parameter.
    merit : float or None
        Objective - barrier * sum of logarithms at the iterate; None where constraints are
        shifted: the merit may then increase.

    Returns
    -------
    LineSearchResult or None
        None where the Newton system is singular.

    """
    best: LineSearchResult | None = None
    for step, corrected in steps:
        found = _search(problem, step, barrier, merit)
        if best is None or found.size > best.size:
            best = found
        if found.size <= SHORT and KERNELS.timing_correct(
                problem.address, step.address, max(found.size, LEAST_CORRECTED),
                corrected.address):
            found = _search(problem, corrected, barrier, merit)
            if found.size > best.size:
                best = found
        if found.size > SHORT:
            break
    return best


def newton_steps(problem: TimingProblem) -> Iterator[tuple[Step, Step]]:
    """
    Yield the Newton steps, each computed when it is asked for.

    Parameters
    ----------
    problem : TimingProblem
        Linearised at the iterate.

    Yields
    ------
    tuple of Step and Step
        A step, and memory for its correction; none where the Newton system is singular.

    """
    exact, exact_corrected, plain, plain_corrected = problem.steps
    if not problem.limits.bounds_alone:
        solved = KERNELS.timing_newton(problem.address, 1, exact.address)
        if solved and exact.structure.predicted_decrease > 0.0:
            yield exact, exact_corrected
    if KERNELS.timing_newton(problem.address, 0, plain.address):
        yield plain, plain_corrected


def _search(problem: TimingProblem, step: Step, barrier: float,
            merit: float | None) -> LineSearchResult:
    """Backtrack along a step, by parabolas of the slacks where it violates a constraint."""
    address, found = problem.address, step.structure
    fastest_fall = found.max_relative_slack_decrease
    size = TO_BOUNDARY / fastest_fall if fastest_fall > TO_BOUNDARY else 1.0
    for _ in range(30):  # at most
        feasible = KERNELS.timing_trial(address, step.address, size, LEAST_SLACK_RETAINED,
                                        TARGET_SLACK)
        if feasible and (merit is None or found.cost - barrier * found.log
                         <= merit - SUFFICIENT_DECREASE * size * found.predicted_decrease):
            return LineSearchResult(step, size)
        size = 0.5 * size if feasible else max(
            min(found.suggested_size, LONGEST_RETRY * size), 0.5 * size)
    return LineSearchResult(step, 0.0)
