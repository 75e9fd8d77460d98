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
Long motions are mended where they exceed limits between the points of the problem, and only there.

The segments around such a place are a problem of their own, which begins and ends in the states
that the motion has there: the influence of a change decays within a few segments. In a motion of
1,000 segments some 150 exceed a limit, and a few of them take round after round; rounds of the
whole motion would take longer than everything else together.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import BoolArray
from rrr_traj_planner.planners.joint_timing.dense_check import JointCheck
from rrr_traj_planner.planners.joint_timing.margins import Margins
from rrr_traj_planner.planners.joint_timing.problem import brought_within, JointProblem
from rrr_traj_planner.planners.solver.interior_point import CentralPathPoint, Outcome
from rrr_traj_planner.planners.solver.limits import DurationConstraints
from rrr_traj_planner.planners.solver.splines import Mesh, Variables
from rrr_traj_planner.planners.tolerances import LIMIT_ROUNDING

# Chosen values, by planning times and durations of random tasks with 100 via points.
TOLERANCE = 1e-4  # part by which a segment may exceed limits: the whole motion is slowed by it
#                   (with torque limits rounding alone: gravity may need more of a slower motion)
BESIDE = 1        # segments on either side that change with those that exceed limits,
MOST = 3          # of which so many are mended together, at most
MORE_BESIDE = 3   # tries after which one more changes,
MOST_BESIDE = 4   # but no more than so many
TRIES = 30        # of a segment, at most
BLOCK = 50        # segments that are checked at once at first: their samples stay in the cache
BETWEEN = 1e-5    # part of efforts left for peaks between the samples that are checked
WIDER = 3e-4      # part by which former limits are widened, so that slacks are not too small


class Span(NamedTuple):
    """A few segments in a row, of which both ends stay as they are."""

    begin: int
    end: int

    @property
    def segments(self) -> slice:
        """Return their indices."""
        return slice(self.begin, self.end)

    def problem(self, whole: JointProblem) -> JointProblem:
        """
        Return their part of a problem.

        Parameters
        ----------
        whole : JointProblem
            With free durations.

        Returns
        -------
        JointProblem
            Velocities, accelerations and jerks at its ends are fixed.

        """
        free = DurationConstraints.all_free(self.end - self.begin, 3)
        return replace(
            whole, mesh=Mesh(whole.mesh.parts[self.segments]),
            task=replace(whole.task, points=whole.task.points[self.begin:self.end + 1]),
            durations=free._replace(weights=whole.durations.weights[self.segments]))

    def motion(self, whole: Variables) -> Variables:
        """
        Return their part of a motion.

        Parameters
        ----------
        whole : Variables
            The motion.

        Returns
        -------
        Variables
            Views.

        """
        via = slice(self.begin, self.end + 1)
        return Variables(whole.inner[self.segments], whole.v[via], whole.a[via], whole.j[via],
                         whole.T[self.segments])

    def margins(self, whole: Margins) -> Margins:
        """
        Return their part of margins.

        Parameters
        ----------
        whole : Margins
            The margins.

        Returns
        -------
        Margins
            Views.

        """
        at = self.segments
        return Margins(whole.positions[:, at], whole.velocities[at], whole.accelerations[at],
                       whole.efforts[at], whole.gravity_margins[at],
                       whole.stays[self.begin:self.end - 1])


class LocalRepairs:
    """
    The repairs of a motion whose durations are free, without torque limits.

    Parameters
    ----------
    problem : JointProblem
        Of the whole motion.
    margins : Margins
        Of its limits.
    slow : Variables, optional
        A motion far from the ends of ranges, which bounds margins.
    outcome : Outcome
        The whole motion's.

    Attributes
    ----------
    motion : Variables
        The motion, as far as it has been mended.

    """

    def __init__(self, problem: JointProblem, margins: Margins, slow: Variables | None,
                 outcome: Outcome) -> None:
        self._problem, self._slow = problem, slow
        self._margins = margins.copy()
        with_torque = np.isfinite(problem.task.limits.max_effort).any()
        self._tolerance = LIMIT_ROUNDING if with_torque else TOLERANCE
        self._barrier = outcome.centres[-1].barrier
        self.motion = outcome.motion.with_values(outcome.motion.flat())

    def mend(self) -> bool:
        """
        Mend the motion; return whether that has succeeded.

        Returns
        -------
        bool
            False also where planning is to stop.

        """
        N = len(self.motion.T)
        exceeding, tries = np.zeros(N, bool), np.zeros(N, int)
        for begin in range(0, N, BLOCK):
            at = Span(begin, min(begin + BLOCK, N))
            exceeding[at.segments] = _check(
                at.problem(self._problem), at.motion(self.motion)).exceeding(self._tolerance)
        while exceeding.any():
            begin = int(exceeding.argmax())
            end = begin + int(np.append(exceeding[begin:begin + MOST], False).argmin())
            tries[begin:end] += 1
            tried = int(tries[begin:end].max())
            if tried > TRIES or self._problem.task.should_stop():
                return False
            beside = min(BESIDE + tried // MORE_BESIDE, MOST_BESIDE)
            at = Span(max(begin - beside, 0), min(end + beside, N))
            exceeding[at.segments] = self._mend(at)
        return True

    def _mend(self, at: Span) -> BoolArray:
        """Solve a span of segments with larger margins; return which still exceed limits."""
        problem, motion = at.problem(self._problem), at.motion(self.motion)
        former = at.margins(self._margins)
        margins = former.widened(
            problem.task, problem.mesh, None if self._slow is None else at.motion(self._slow),
            _check(problem, motion))
        found = self._solved(problem, former, margins, motion)
        if found is not None:
            for before, after in zip((*motion, *former), (*found, *margins)):
                before[:] = after
        return _check(problem, motion).exceeding(self._tolerance)

    def _solved(self, problem: JointProblem, former: Margins, margins: Margins,
                motion: Variables) -> Variables | None:
        """Return the fastest motion within larger margins; None where none is found."""
        constraints = problem.constraints(margins)
        if np.array_equal(margins.stays, former.stays):
            outcome = problem.minimised(
                constraints, CentralPathPoint(motion, self._barrier),
                wider=problem.constraints(former).problem.limits.widened(WIDER))
            if outcome.within:
                return outcome.motion
        start = brought_within(constraints, motion, problem.durations, problem.task.should_stop)
        return None if start is None else problem.minimised(
            constraints, CentralPathPoint(start, None)).motion


def _check(problem: JointProblem, motion: Variables) -> JointCheck:
    limits = problem.task.limits
    task = replace(problem.task, limits=replace(
        limits, max_effort=(1.0 - BETWEEN) * np.asarray(limits.max_effort)))
    return JointCheck(task, problem.mesh, motion)
