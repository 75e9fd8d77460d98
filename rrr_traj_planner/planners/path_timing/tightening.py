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
Motions along a path that keep their limits between the points too.

The first round is rough, under the limits themselves: it serves to compare paths. Each later one
starts from a point near the central path of the one before, and its constraints are shifted from
those limits to its own (an exchange method: Hettich & Kortanek, SIAM Review 35, 1993).
"""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.planners.path_timing.constraints import (
    limited_quantities,
    PathConstraints,
    QUANTITIES,
    time_scale_any_slower,
)
from rrr_traj_planner.planners.path_timing.dense_check import dense_check, PathCheck
from rrr_traj_planner.planners.path_timing.initial_speeds import initial_speeds_of
from rrr_traj_planner.planners.path_timing.problem import PathProblem
from rrr_traj_planner.planners.path_timing.start import motion_with_speeds, uniform_along
from rrr_traj_planner.planners.solver.interior_point import (
    CentralPathPoint,
    minimise,
    Outcome,
    RELATIVE_GAP,
)
from rrr_traj_planner.planners.solver.limits import DurationConstraints
from rrr_traj_planner.planners.solver.splines import time_scaled, Variables
from rrr_traj_planner.planners.solver.tightening import Schedule, tighten
from rrr_traj_planner.planners.solver.timing_problem import TimingProblem
from rrr_traj_planner.planners.tolerances import START_SCALING

# Chosen values, without unit: half of ROUGH_GAP and CENTRES_BACK of 1 or 5 change durations of 48
# random paths by less than 0.02 % in the mean, by 0.3 % at most; twice of ROUGH_GAP makes them
# 0.4 % slower in the mean, as slower paths are then chosen.
FIRST = Schedule(rounds=1, tolerance=2e-3, patience=0, growth=1.7)
OTHERS = FIRST._replace(rounds=7)
ROUGH_GAP = 0.3         # part of the total time: the gap to which the first round converges
CENTRES_BACK = 3        # which of the last centres a round with larger margins starts from


class RoughTiming:
    """
    The fastest motion along a path after the first round, and after all of them.

    Parameters
    ----------
    problem : PathProblem
        Path and limits.

    """

    def __init__(self, problem: PathProblem) -> None:
        self._rounds, self._should_stop = _Rounds(problem), problem.task.should_stop
        if self._rounds.may_begin():
            tighten(self._rounds, FIRST, self._should_stop)

    @property
    def duration(self) -> float:
        """Return the duration of the first round's motion, which may exceed limits slightly."""
        return float(self._rounds.fastest.T.sum())

    def finished(self) -> tuple[Variables, float]:
        """
        Return the fastest motion, and a bound on the time that the optimum saves.

        Returns
        -------
        motion : Variables
            Within the limits, by the table.
        gap : float
            [s].

        """
        if self._rounds.have_margins:
            tighten(self._rounds, OTHERS, self._should_stop)
        T, motion, _ = min(self._rounds.found, key=lambda f: f[0])
        return motion, max(T - max(least for *_, least in self._rounds.found), 0.0)


class _Rounds:
    """The rounds of one path; see `solver.tightening.TightenedProblem`."""

    def __init__(self, problem: PathProblem) -> None:
        self._problem, N = problem, len(problem.steady)
        self._durations = DurationConstraints.all_free(N, 1)
        self._previous: PathConstraints | None = None
        self._last: tuple[Outcome, PathCheck] | None = None
        self._constraints = problem.constraints(
            np.zeros((N, 2 * problem.mesh.n + 1, QUANTITIES)))
        self._start = CentralPathPoint(_slow_start(problem, self._constraints), None)
        # each with its duration and a lower bound of all durations [s]
        self.found = [(float(self._start.motion.T.sum()), self._start.motion, -np.inf)]

    @property
    def fastest(self) -> Variables:
        """Return the last solution, or the start where there is none."""
        return self._last[0].motion if self._last else self._start.motion

    @property
    def have_margins(self) -> bool:
        """Return whether the limits were tightened after a first solution."""
        return self._previous is not None

    def may_begin(self) -> bool:
        """Return whether the start is within the limits."""
        self._problem.task.should_stop()
        return self._constraints.problem.is_within(self._start.motion)

    def solve(self) -> Outcome | None:
        previous = self._previous
        outcome = minimise(self._constraints.problem, self._start, self._durations,
                           self._problem.task.should_stop,
                           wider=previous.problem.limits if previous else None,
                           relative_gap=RELATIVE_GAP if previous else ROUGH_GAP)
        return None if previous and not outcome.within else outcome

    def relax(self) -> bool:
        """Take back half of margins that were enlarged too much at once."""
        assert self._previous is not None
        self._constraints = self._problem.constraints(
            0.5 * (self._previous.margins + self._constraints.margins))
        return True

    def accept(self, outcome: Outcome, tolerance: float) -> bool:
        self._last = outcome, check = _last_forward(
            outcome, self._start, self._constraints.problem, self._problem)
        self.found.append(_slowed(outcome, check.time_scale))
        fits = self._previous is not None and check.time_scale <= 1.0 + tolerance
        return fits or self._problem.task.should_stop()

    def tighten(self) -> bool:
        assert self._last is not None
        (outcome, check), constraints = self._last, self._constraints
        if not outcome.centres:
            return False
        self._start = outcome.centres[-CENTRES_BACK if self._previous else -1:][0]
        self._previous, self._constraints = constraints, self._problem.constraints(
            constraints.margins + check.excess)
        return True


def _last_forward(outcome: Outcome, start: CentralPathPoint, timing: TimingProblem,
                  problem: PathProblem) -> tuple[Outcome, PathCheck]:
    """Return the last motion on which the tip never moves backward, as when cancelled it may."""
    passed = (outcome.motion, *(c.motion for c in reversed(outcome.centres)), start.motion)
    for motion in passed:
        check = dense_check(timing, motion, problem.bounds, problem.reserve)
        if check.is_forward:
            break
    lost = float(motion.T.sum() - outcome.motion.T.sum())
    return outcome._replace(motion=motion, gap=outcome.gap + lost), check


def _slowed(outcome: Outcome, time_scale: float) -> tuple[float, Variables, float]:
    """Return the duration of a motion slowed to its limits, the motion, and a lower bound."""
    T, factor = float(outcome.motion.T.sum()), max(time_scale, 1.0)
    return factor * T, time_scaled(outcome.motion, factor), T - outcome.gap


def _slow_start(problem: PathProblem, constraints: PathConstraints) -> Variables:
    """Return a feasible motion to start from, of constant speed if any piece is to have it."""
    table, mesh, bounds = problem.table, problem.mesh, problem.bounds
    if problem.steady.any():
        m = uniform_along(mesh, table.ends)
    else:
        m = motion_with_speeds(mesh, table.ends, initial_speeds_of(table, bounds))
    z = np.concatenate(mesh.states(constraints.points, m), axis=-1)
    x, gravity = limited_quantities(constraints.problem, z, at_points=True)
    return time_scaled(m, START_SCALING * time_scale_any_slower(
        x, gravity, table.friction.viscous, bounds - constraints.margins - problem.reserve))
