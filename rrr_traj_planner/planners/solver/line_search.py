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
The step of one iteration: Newton steps that the problem suggests, each followed as far as it pays.

The first to be tried has the curvature of the constraints, weighted by their multipliers, which
may lead astray, the next one has not. A step begins at the fraction to the boundary (Nocedal &
Wright, Numerical Optimization, eq. 19.9; Waechter & Biegler 2006, eq. 8) and is shortened until
every slack keeps a part of itself and the merit falls enough (Armijo). One that gets nowhere since
constraints curve away from it is tried again with a second-order correction (Nocedal & Wright
18.3; Waechter & Biegler 2.4), here of the whole path: step * size + correction * size^2.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from rrr_traj_planner.planners.solver.library import KERNELS
from rrr_traj_planner.planners.solver.limits import BOUNDS_ALONE
from rrr_traj_planner.planners.solver.timing_problem import Step, TimingProblem

BACKTRACKS = 30
SUFFICIENT_GAIN = 1e-4       # part of the promised gain
SHORT = 0.05                 # a step of which no more is taken is corrected, or replaced
LEAST_CORRECTED = 1e-3       # size of step at which curvature is found out
TO_BOUNDARY = 0.995          # part of the way to the boundary that a step may go
LEAST_SLACK_KEPT = 0.004     # part of its slack that a constraint keeps in a step
SLACK_AIMED_AT = 0.05        # part that it is to keep where a step was too long for it
LONGEST_RETRY = 0.95         # of a step that was too long


class Searched(NamedTuple):
    """A step, and the part of it that is taken; 0: none."""

    step: Step
    size: float


def best_step(problem: TimingProblem, barrier: float, merit: float | None) -> Searched | None:
    """
    Return the first of the suggested steps that gets far, else the one that gets furthest.

    Parameters
    ----------
    problem : TimingProblem
        Linearised at the iterate.
    barrier : float
        The barrier parameter.
    merit : float or None
        Objective - barrier * sum of logarithms at the iterate; None where constraints are
        shifted: shifts are taken away whatever that costs.

    Returns
    -------
    Searched or None
        None where there is no step.

    """
    best: Searched | None = None
    for step, corrected in _suggested(problem):
        found = _search(problem, step, barrier, merit)
        if best is None or found.size > best.size:
            best = found
        if found.size <= SHORT and KERNELS.timing_correct(
                problem.at, step.at, max(found.size, LEAST_CORRECTED), corrected.at):
            found = _search(problem, corrected, barrier, merit)
            if found.size > best.size:
                best = found
        if found.size > SHORT:
            break
    return best


def promised_gain(problem: TimingProblem) -> float | None:
    """
    Return the gain that the first suggested step promises.

    Parameters
    ----------
    problem : TimingProblem
        Linearised at the iterate.

    Returns
    -------
    float or None
        None where there is no step.

    """
    return next((float(step.found.gain) for step, _ in _suggested(problem)), None)


def _suggested(problem: TimingProblem) -> Iterator[tuple[Step, Step]]:
    """Give Newton steps, each with room for its correction."""
    exact, exact_corrected, plain, plain_corrected = problem.steps
    if problem.limits.kind != BOUNDS_ALONE:
        if KERNELS.timing_newton(problem.at, 1, exact.at) and exact.found.gain > 0.0:
            yield exact, exact_corrected
    if KERNELS.timing_newton(problem.at, 0, plain.at):
        yield plain, plain_corrected


def _search(problem: TimingProblem, step: Step, barrier: float,
            merit: float | None) -> Searched:
    """Return how far a step goes: backtracking, by parabolas where it breaks a constraint."""
    at, found = problem.at, step.found
    gain, steepest = found.gain, found.steepest
    size = TO_BOUNDARY / steepest if steepest > TO_BOUNDARY else 1.0
    for _ in range(BACKTRACKS):
        kept = KERNELS.timing_trial(at, step.at, size, LEAST_SLACK_KEPT, SLACK_AIMED_AT)
        if kept and (merit is None or found.cost - barrier * found.log
                     <= merit - SUFFICIENT_GAIN * size * gain):
            return Searched(step, size)
        size = 0.5 * size if kept else max(min(found.shorter, LONGEST_RETRY * size), 0.5 * size)
    return Searched(step, 0.0)
