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
Solve under growing margins until the motion keeps its limits between the points too.

The solver bounds states at the points of the problem only. Where a dense check finds that a limit
is exceeded between them, margins at the points beside are enlarged and the problem is solved again
(an exchange method of semi-infinite programming: Hettich & Kortanek, SIAM Review 35, 1993),
starting from the last point near the central path that satisfies the new margins.
"""

from __future__ import annotations

from rrr_traj_planner.planners.joint_timing.constraints import JointConstraints
from rrr_traj_planner.planners.joint_timing.dense_check import DenseCheck
from rrr_traj_planner.planners.joint_timing.margins import Margins
from rrr_traj_planner.planners.joint_timing.problem import InitialMotion, JointProblem, Solved
from rrr_traj_planner.planners.solver.interior_point import Centre, Outcome
from rrr_traj_planner.planners.solver.ramps import Variables

# Without unit.
ROUNDS = 20              # of solving, at most
PARTS_OF_MARGINS = (1.0, 0.9, 0.7, 0.4, 0.1, 0.03)  # tried in turn where the whole is infeasible
APPROACHES = 5           # rounds towards margins that no centre satisfies, at most, each with a
HIGHER = 10.0            # barrier parameter larger by this factor
WORTH_IT = 1e-3          # part by which a motion is slowed rather than solved again,
PATIENCE = 4             # doubled in every round after so many
RESTARTED_SEGMENTS = 60  # number of restarts from rest, times segments, at most


def tightened(problem: JointProblem, initial_motion: InitialMotion) -> Solved | None:
    """
    Solve, and solve again with larger margins where the motion exceeds a limit between points.

    Parameters
    ----------
    problem : JointProblem
        Via points, limits and durations.
    initial_motion : callable
        Returns a motion to start from, strictly within the constraints, or None.

    Returns
    -------
    Solved or None
        The best motion found; None where there is none to start from.

    """
    task, grid, durations = problem.task, problem.grid, problem.durations
    margins = Margins.none(grid, len(durations.free))._replace(at_rest=durations.fixed_velocities)
    centres: list[Centre] = []
    slow: Variables | None = None
    approaches, restarts = 0, RESTARTED_SEGMENTS
    outcomes: list[tuple[Outcome, Variables]] = []  # each with its start
    for round_ in range(ROUNDS):
        task.should_stop()
        worth_it = WORTH_IT * 2.0 ** max(round_ - PATIENCE, 0)
        before, constraints = margins, problem.constraints(margins)
        start = _last_within(constraints, centres)
        if start is None and centres and approaches < APPROACHES:
            nearer = _nearer(problem, margins, centres, HIGHER ** approaches)
            if nearer:
                centres += nearer
                approaches += 1
                continue
        approaches = 0
        if start is None:
            started = _start_from_rest(problem, margins, initial_motion)
            if started is None:
                break
            margins, constraints, start = started
        slow = slow or start.motion
        outcome = problem.minimised(constraints, margins, start)
        task.should_stop()
        check = DenseCheck(task, grid, outcome.motion)
        if check.time_scale() <= 1.0 + worth_it and not check.beyond_range.any():
            task.should_stop()
            fits = problem.fitting(outcome, outcome.motion)
            if fits is not None and fits.cost <= (1.0 + worth_it) * durations.cost(
                    outcome.motion.T):
                return fits
        outcomes.append((outcome, start.motion))
        if task.should_stop():
            found = _best_that_fits(problem, outcomes)
            if found is not None:
                return found
        margins = margins.widened(task, grid, slow, check)
        # where a joint leaves its range the solution is not near the former one
        if check.beyond_range.any() and restarts >= len(durations.free):
            centres, restarts = [], restarts - len(durations.free)
        else:
            centres = centres + outcome.centres
        if not centres and margins.is_same(before):
            break  # the next round would repeat this one
    return _best_that_fits(problem, outcomes)


def _last_within(constraints: JointConstraints, centres: list[Centre]) -> Centre | None:
    return next((c for c in reversed(centres) if constraints.problem.is_within(c.motion)), None)


def _nearer(problem: JointProblem, margins: Margins, centres: list[Centre],
            higher: float) -> list[Centre]:
    """
    Return centres for a part of the margins, where no known one satisfies all of them.

    The larger the barrier parameter, the further they are from all limits.
    """
    for part in PARTS_OF_MARGINS[1:]:
        constraints = problem.constraints(margins.part(part))
        centre = _last_within(constraints, centres)
        if centre is not None:
            barrier = None if centre.barrier is None else higher * centre.barrier
            return problem.minimised(constraints, margins, Centre(centre.motion, barrier),
                                     barrier or 0.0).centres
    return []


def _start_from_rest(
        problem: JointProblem, margins: Margins,
        initial_motion: InitialMotion) -> tuple[Margins, JointConstraints, Centre] | None:
    """Return an initial motion, and as large a part of the margins as it satisfies."""
    for part in (*PARTS_OF_MARGINS, 0.0):
        reduced = margins.of_slow_motion().part(part)
        constraints = problem.constraints(reduced)
        motion = initial_motion(problem.task, constraints)
        if motion is None:
            return None
        if constraints.problem.is_within(motion):
            return reduced, constraints, Centre(motion, None)
    return None


def _best_that_fits(problem: JointProblem,
                    outcomes: list[tuple[Outcome, Variables]]) -> Solved | None:
    """Return the fastest of all outcomes, centres and starts, each slowed as limits require."""
    best: Solved | None = None
    durations = problem.durations
    for outcome, start in sorted(outcomes, key=lambda t: durations.cost(t[0].motion.T)):
        for motion in (outcome.motion, *(c.motion for c in reversed(outcome.centres)), start):
            cost = durations.cost(motion.T)
            if best is not None and best.cost <= cost:
                break
            problem.task.should_stop()
            fits = problem.fitting(outcome, motion)
            if fits is not None and (best is None or fits.cost < best.cost):
                best = fits
    return best
