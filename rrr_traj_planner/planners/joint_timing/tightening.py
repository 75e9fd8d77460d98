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
Joint motions that keep their limits between the points too: margins, starts, the best so far.

Each round continues from the last point near the central path, although it may exceed the new
margins; where that fails, from the last point that satisfies them, or anew (an exchange
method: Hettich & Kortanek, SIAM Review 35, 1993).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from rrr_traj_planner.planners.joint_timing.constraints import JointConstraints
from rrr_traj_planner.planners.joint_timing.dense_check import JointCheck
from rrr_traj_planner.planners.joint_timing.local_repairs import LocalRepairs
from rrr_traj_planner.planners.joint_timing.margins import Margins
from rrr_traj_planner.planners.joint_timing.problem import InitialMotion, JointProblem, Solved
from rrr_traj_planner.planners.joint_timing.slowed_after_start import slowed_after_start
from rrr_traj_planner.planners.joint_timing.start import rest_to_rest_shapes, with_durations
from rrr_traj_planner.planners.joint_timing.within_limits import beyond_range
from rrr_traj_planner.planners.solver.interior_point import CentralPathPoint, Outcome
from rrr_traj_planner.planners.solver.limits import Limits
from rrr_traj_planner.planners.solver.segment_steps import take_own_steps
from rrr_traj_planner.planners.solver.splines import Variables, with_stops
from rrr_traj_planner.planners.solver.tightening import Schedule, tighten
from rrr_traj_planner.planners.solver.timing_problem import TimingProblem

# Chosen values, without unit.
SCHEDULE = Schedule(rounds=20, tolerance=1e-3, patience=4, growth=2.0)
EXCEEDED = 30.0  # slacks by which a centre may exceed tighter limits: more take many steps;
EXCEEDED_BY_SEGMENTS = 300.0  # more where only the segments that do so take them
FROM_MOTION = 0.2  # of the schedule's tolerance where motions are slowed after the start
PARTS_OF_SLOW = (0.0, 1e-3, 1e-2, 3e-2, 0.1, 0.3)  # tried in turn where a range is left slightly
PARTS_OF_MARGINS = (1.0, 0.9, 0.7, 0.4, 0.1, 0.03)  # tried in turn where the whole is infeasible


def tightened(problem: JointProblem, initial_motion: InitialMotion,
              slow_motion: InitialMotion | None = None) -> Solved | None:
    """
    Solve, and solve again with larger margins where the motion exceeds a limit between points.

    Parameters
    ----------
    problem : JointProblem
        Via points, limits and durations.
    initial_motion : callable
        Returns a motion to start from, strictly within the constraints, or None.
    slow_motion : callable, optional
        Returns a motion far from the ends of ranges, which bounds margins; by default, the first
        start. Where the arm starts moving, a straight motion that starts at rest bounds them.

    Returns
    -------
    Solved or None
        The best motion found; None where there is none to start from.

    """
    rounds = _Rounds(problem, initial_motion, slow_motion)
    if rounds.start_anew():
        tighten(rounds, SCHEDULE, problem.task.should_stop)
    return rounds.best or rounds.best_that_fits()


class _Rounds:
    """The rounds of one problem; see `solver.tightening.TightenedProblem`."""

    def __init__(self, problem: JointProblem, initial_motion: InitialMotion,
                 slow_motion: InitialMotion | None) -> None:
        self._problem, self._initial_motion = problem, initial_motion
        self._slow_motion = slow_motion
        durations = problem.durations
        self._margins = Margins.none(problem.mesh, len(durations.free))
        self._constraints = problem.without_margins
        self._wider: Limits | None = None  # which the start keeps, if not these
        self._start: CentralPathPoint | None = None
        self._slow: Variables | None = None
        self._centres: list[CentralPathPoint] = []
        self._outcomes: list[tuple[Outcome, Variables]] = []  # each with its start
        self._check: JointCheck | None = None  # of the last outcome
        self.best: Solved | None = None

    def start_anew(self) -> bool:
        """Start from the initial motion; return whether there is one."""
        started = _start_anew(self._problem, self._margins, self._initial_motion)
        if started is not None:
            self._margins, self._constraints, self._start = started
        return started is not None

    def solve(self) -> Outcome | None:
        start, wider = self._start, self._wider
        self._start = self._wider = None
        if start is None:
            return None
        if self._slow_motion is None and self._problem.durations.from_rest:
            self._slow = self._slow or start.motion
        outcome = self._problem.minimised(
            self._constraints, start, wider=wider)
        if not outcome.within:
            return None
        self._outcomes.append((outcome, start.motion))
        return outcome

    def relax(self) -> bool:
        self._start = next((c for c in reversed(self._centres)
                            if self._constraints.is_within(c.motion)), None)
        return self._start is not None or self.start_anew()

    def accept(self, outcome: Outcome, tolerance: float) -> bool:
        task, durations = self._problem.task, self._problem.durations
        if task.should_stop():
            return True  # `best_that_fits` has the last word
        if self._may_mend(outcome):
            self.best = self._mended(outcome)
            if self.best is not None:
                return True
        self._check = check = JointCheck(task, self._problem.mesh, outcome.motion)
        # `fitting` is exact. Where torque is limited it takes much longer than this check, which
        # is a little stricter, and is not tried where that fails.
        if np.isinf(task.limits.max_effort).all() or not durations.may_scale or (
                check.time_scale() <= 1.0 + tolerance and not check.beyond_range.any()):
            task.should_stop()
            # in short motions a further round is as fast as slowing after the start
            fitting = self._fitting if self._by_segments() else self._problem.fitting
            fits = fitting(outcome, outcome.motion)
            tolerance *= 1.0 if durations.from_rest else FROM_MOTION
            if fits is not None and fits.cost <= (1.0 + tolerance) * durations.cost(
                    outcome.motion.T):
                self.best = fits
                return True
        return task.should_stop()

    def _by_segments(self) -> bool:
        return take_own_steps(self._constraints.problem, self._problem.durations)

    def _may_mend(self, outcome: Outcome) -> bool:
        return self._by_segments() and self._problem.durations.may_scale and bool(outcome.centres)

    def _mended(self, outcome: Outcome) -> Solved | None:
        """Return an outcome mended where it exceeds limits; None where that fails."""
        self._find_slow_motion()
        repairs = LocalRepairs(self._problem, self._margins, self._slow, outcome)
        if repairs.mend():
            return self._problem.fitting(outcome, repairs.motion)
        if self._problem.task.should_stop():  # with part of the repairs it is worth a try too
            self._outcomes[-1][0].centres.append(CentralPathPoint(repairs.motion, None))
        return None

    def _find_slow_motion(self) -> None:
        problem = self._problem
        if self._slow is not None:
            return
        if not problem.durations.from_rest:
            # Without a bound, a margin just before a via point at the end of a range makes motions
            # several times slower.
            jerks = rest_to_rest_shapes(problem.mesh, problem.task.points)
            self._slow = with_stops(jerks, np.ones(len(jerks)))
        elif self._slow_motion is not None:
            self._slow = self._slow_motion(problem.task, problem.without_margins)

    def tighten(self) -> bool:
        problem, before = self._problem, self._margins
        self._find_slow_motion()
        assert self._check is not None
        former = self._constraints
        self._margins = before.widened(problem.task, problem.mesh, self._slow, self._check)
        self._constraints = problem.constraints(self._margins)
        centres = self._outcomes[-1][0].centres
        if np.array_equal(self._margins.stays, before.stays):
            self._centres = self._centres + centres
            self._start = _near(centres, former.problem, self._constraints.problem,
                                EXCEEDED_BY_SEGMENTS if self._by_segments() else EXCEEDED)
            self._wider = former.problem.limits
        else:  # the solution is not near the former one
            self._centres = []
        return bool(self._centres) or not self._margins.is_same(before)

    def best_that_fits(self) -> Solved | None:
        """
        Return the fastest of all outcomes, centres and starts, slowed as limits require.

        Where none keeps its joints in their ranges: one with a part of a slow motion.
        """
        best: Solved | None = None
        durations = self._problem.durations
        motions = {durations.cost(m.T): (outcome, m) for outcome, start in self._outcomes
                   for m in (start, *(c.motion for c in outcome.centres), outcome.motion)}
        for cost in sorted(motions):
            if best is not None and best.cost <= cost:
                break
            self._problem.task.should_stop()
            fits = self._fitting(*motions[cost])
            if fits is not None and (best is None or fits.cost < best.cost):
                best = fits
        return best or (self._partly_slow(list(motions.values())) if motions else None)

    def _fitting(self, outcome: Outcome, motion: Variables) -> Solved | None:
        """Return a motion slowed until it keeps every limit, after the start if that moves."""
        fits = self._problem.fitting(outcome, motion)
        if fits is not None or self._problem.durations.from_rest:
            return fits
        slower = slowed_after_start(self._problem, motion)
        return None if slower is None else self._problem.fitting(outcome, slower)

    def _partly_slow(self, motions: Sequence[tuple[Outcome, Variables]]) -> Solved | None:
        """Return the motion that is least out of range, mixed with as much of a slow one."""
        self._find_slow_motion()
        if (self._slow is None or self._slow_motion is None
                or not self._problem.durations.from_rest):
            return None
        task, mesh = self._problem.task, self._problem.mesh
        outcome, motion = min(
            ((outcome, self._problem.inwards(m)) for outcome, m in motions),
            key=lambda m: beyond_range(task, mesh.trajectory(task.points, m[1])).max())
        slow = with_durations(self._slow, motion.T).flat()
        for part in PARTS_OF_SLOW:
            task.should_stop()
            mixed = motion.with_values((1.0 - part) * motion.flat() + part * slow)
            fits = self._problem.fitting(outcome, mixed)
            if fits is not None:
                return fits
        return self._problem.fitting(outcome, self._slow)


def _near(centres: list[CentralPathPoint], former: TimingProblem,
          tighter: TimingProblem, most: float) -> CentralPathPoint | None:
    """Return the last centre that exceeds tighter limits by at most so many former slacks."""
    for centre in reversed(centres):
        slacks, before = (problem.slacks(centre.motion) for problem in (tighter, former))
        if (slacks >= -most * before).all():
            return centre
    return centres[0] if centres else None


def _start_anew(problem: JointProblem, margins: Margins, initial_motion: InitialMotion,
                ) -> tuple[Margins, JointConstraints, CentralPathPoint] | None:
    """Return an initial motion, and as large a part of the margins as it satisfies."""
    for part in (*PARTS_OF_MARGINS, 0.0):
        reduced = margins.of_slow_motion().part(part)
        constraints = problem.constraints(reduced)
        motion = initial_motion(problem.task, constraints)
        if motion is None:
            return None
        if constraints.is_within(motion):
            return reduced, constraints, CentralPathPoint(motion, None)
    return None
