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
Limits that hold at all times, by a solver that bounds states at points: an exchange method.

Where a dense check finds that a limit is exceeded between the points, margins at the points beside
are enlarged, and the problem is solved again (an exchange method of semi-infinite programming:
Hettich & Kortanek, SIAM Review 35, 1993).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, Protocol

from rrr_traj_planner.planners.solver.interior_point import Outcome


class Schedule(NamedTuple):
    """How often a problem is solved, and the excess over limits that ends it."""

    rounds: int       # of solving, at most
    tolerance: float  # part by which a motion is slowed rather than solved again,
    patience: int     # after so many rounds multiplied in each round
    growth: float     # by this factor


class TightenedProblem(Protocol):
    """A least-time problem with margins to its limits."""

    def solve(self) -> Outcome | None:
        """Return the solution; None where no start is known that satisfies the margins."""

    def relax(self) -> bool:
        """Relax the margins for another start; return False where none is left to try."""

    def accept(self, outcome: Outcome, tolerance: float) -> bool:
        """
        Store a solution; return whether it satisfies the tolerance.

        Parameters
        ----------
        outcome : Outcome
            Of `solve`.
        tolerance : float
            Part by which a motion may have to be slowed to keep its limits at all times.

        Returns
        -------
        bool
            True also where planning is to stop and a motion is known.

        """

    def tighten(self) -> bool:
        """Enlarge margins where the last solution exceeds limits; return whether that helps."""


def tighten(problem: TightenedProblem, schedule: Schedule,
            should_stop: Callable[[], bool]) -> None:
    """
    Solve a problem with growing margins, until its solution keeps the limits at all times.

    Parameters
    ----------
    problem : TightenedProblem
        Stores its solutions.
    schedule : Schedule
        Round limit and tolerance schedule.
    should_stop : callable
        Called now and then for the exceptions that it may raise.

    """
    for round_ in range(schedule.rounds):
        should_stop()
        outcome = problem.solve()
        if outcome is None:
            if problem.relax():
                continue
            return
        should_stop()
        tolerance = schedule.tolerance * schedule.growth ** max(round_ - schedule.patience, 0)
        if problem.accept(outcome, tolerance) or not problem.tighten():
            return
