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
Solving under margins that grow until the motion keeps its limits between its points too.

The solver bounds states at the points of a motion alone. What a dense check finds to be exceeded
between them becomes a margin at the points beside, and the problem is solved again from the last
centre of the barrier method that keeps the new margins.
"""

from __future__ import annotations

from rrr_traj_planner.planners.joint_timing.constraints import JointConstraints
from rrr_traj_planner.planners.joint_timing.dense_check import DenseCheck
from rrr_traj_planner.planners.joint_timing.margins import Margins
from rrr_traj_planner.planners.joint_timing.problem import Begin, JointProblem, Solved
from rrr_traj_planner.planners.solver.interior_point import Centre, Outcome
from rrr_traj_planner.planners.solver.ramps import Variables

ROUNDS = 20
PARTS_OF_MARGINS = (1.0, 0.9, 0.7, 0.4, 0.1, 0.03)
APPROACHES = 5           # rounds of coming nearer to margins that no centre keeps, each with a
HIGHER = 10.0            # barrier so much higher
WORTH_IT = 1e-3          # a motion is slowed, rather than planned again, where that is no more,
PATIENCE = 4             # after so many rounds twice as much, and so on
BEGINNINGS = 60          # segments that are begun from rest again, in all


def tightened(problem: JointProblem, begin: Begin) -> Solved | None:
    """
    Solve, and solve again with larger margins where the motion breaks a limit between points.

    Parameters
    ----------
    problem : JointProblem
        Via points, limits and durations.
    begin : callable
        Gives a motion to start from, strictly within the constraints, or None.

    Returns
    -------
    Solved or None
        The best that was found; None where there is nothing to start from.

    """
    task, grid, durations = problem.task, problem.grid, problem.durations
    margins = Margins.none(grid, len(durations.free))._replace(at_rest=durations.fixed_velocities)
    centres: list[Centre] = []
    slow: Variables | None = None
    approaches, beginnings = 0, BEGINNINGS
    tried: list[tuple[Outcome, Variables]] = []  # what was found, from which start
    for round_ in range(ROUNDS):
        task.should_stop()
        worth_it = WORTH_IT * 2.0 ** max(round_ - PATIENCE, 0)
        wanted, constraints = margins, problem.constraints(margins)
        start = _last_within(constraints, centres)
        if start is None and centres and approaches < APPROACHES:
            nearer = _nearer(problem, margins, centres, HIGHER ** approaches)
            if nearer:
                centres += nearer
                approaches += 1
                continue
        approaches = 0
        if start is None:
            begun = _begun(problem, margins, begin)
            if begun is None:
                break
            margins, constraints, start = begun
        slow = slow or start.motion
        outcome = problem.minimised(constraints, margins, start)
        task.should_stop()
        check = DenseCheck(task, grid, outcome.motion)
        if check.stretch() <= 1.0 + worth_it and not check.beyond_range.any():
            task.should_stop()
            fits = problem.fitting(outcome, outcome.motion)
            if fits is not None and fits.cost <= (1.0 + worth_it) * durations.cost(
                    outcome.motion.T):
                return fits
        tried.append((outcome, start.motion))
        if task.should_stop():
            found = _best_that_fits(problem, tried)
            if found is not None:
                return found
        margins = margins.widened(task, grid, slow, check)
        # where ranges are left it takes another course, not a nearby one
        if check.beyond_range.any() and beginnings >= len(durations.free):
            centres, beginnings = [], beginnings - len(durations.free)
        else:
            centres = centres + outcome.centres
        if not centres and margins.is_same(wanted):
            break  # the same again
    return _best_that_fits(problem, tried)


def _last_within(constraints: JointConstraints, centres: list[Centre]) -> Centre | None:
    return next((c for c in reversed(centres) if constraints.problem.is_within(c.motion)), None)


def _nearer(problem: JointProblem, margins: Margins, centres: list[Centre],
            higher: float) -> list[Centre]:
    """
    Return centres nearer to the margins where no other keeps all of them, but one keeps a part.

    The higher their barrier, the further they are from all limits.
    """
    for part in PARTS_OF_MARGINS[1:]:
        constraints = problem.constraints(margins.part(part))
        centre = _last_within(constraints, centres)
        if centre is not None:
            barrier = None if centre.barrier is None else higher * centre.barrier
            return problem.minimised(constraints, margins, Centre(centre.motion, barrier),
                                     barrier or 0.0).centres
    return []


def _begun(problem: JointProblem, margins: Margins,
           begin: Begin) -> tuple[Margins, JointConstraints, Centre] | None:
    """Return a motion to begin with, and as large a part of the margins as it keeps."""
    for part in (*PARTS_OF_MARGINS, 0.0):
        reduced = margins.of_slow_motion().part(part)
        constraints = problem.constraints(reduced)
        motion = begin(problem.task, constraints)
        if motion is None:
            return None
        if constraints.problem.is_within(motion):
            return reduced, constraints, Centre(motion, None)
    return None


def _best_that_fits(problem: JointProblem,
                    tried: list[tuple[Outcome, Variables]]) -> Solved | None:
    """Return the fastest of outcomes and centres that keeps every limit, as it is or slowed."""
    best: Solved | None = None
    durations = problem.durations
    for outcome, start in sorted(tried, key=lambda t: durations.cost(t[0].motion.T)):
        for motion in (outcome.motion, *(c.motion for c in reversed(outcome.centres)), start):
            cost = durations.cost(motion.T)
            if best is not None and best.cost <= cost:
                break
            problem.task.should_stop()
            fits = problem.fitting(outcome, motion)
            if fits is not None and (best is None or fits.cost < best.cost):
                best = fits
    return best
