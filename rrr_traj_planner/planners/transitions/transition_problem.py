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

"""A task of transitions and cruises, and its solution at ever lower via velocities."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeVar

from rrr_traj_planner.core.arrays import BoolArray
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.transitions.via_problem import at_rest, slower_at, ViaProblem

Result = TypeVar('Result')


class TransitionProblem(NamedTuple):
    """The arm, its limits and the via points, and the bounds on velocities there."""

    task: JointTask
    via: ViaProblem

    def slower_at(self, segments: BoolArray) -> TransitionProblem:
        """
        Return the problem with tighter bounds on velocities at the ends of some segments.

        Parameters
        ----------
        segments : ndarray of bool, shape (n, 3)
            Which segments of which joints.

        Returns
        -------
        TransitionProblem
            With the bounds of the via velocities halved there.

        """
        return self._replace(via=slower_at(self.via, segments))

    def at_rest(self) -> TransitionProblem:
        """Return the problem with a stop at every via point."""
        return self._replace(via=at_rest(self.via))


def at_lower_velocities(
        problem: TransitionProblem, rounds: int,
        attempt: Callable[[TransitionProblem], tuple[Result | None, BoolArray | None]],
        ) -> Result | None:
    """
    Return the result of the first attempt that has one, each with lower via velocities, at last 0.

    Parameters
    ----------
    problem : TransitionProblem
        Of the first attempt.
    rounds : int
        Attempts, at most, before the one with a stop at every via point.
    attempt : callable
        Returns a result, or None and the segments, shape (n, 3), at whose ends velocities are
        to be lower; None for these where that does not help.

    Returns
    -------
    object or None
        None where no attempt has a result.

    """
    for round_ in range(rounds + 1):
        problem.task.should_stop()
        if round_ == rounds:
            problem = problem.at_rest()
        result, segments = attempt(problem)
        if result is not None or segments is None:
            return result
        problem = problem.slower_at(segments)
    return None
