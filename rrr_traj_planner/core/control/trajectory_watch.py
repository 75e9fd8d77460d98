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

"""Whether the trajectory that is followed is a goal's, and when it is reached or given up."""

from __future__ import annotations

from collections.abc import Sequence

from rrr_traj_planner.core.control.goal_end import end_of, GoalEnd
from rrr_traj_planner.core.control.tolerances import Tolerances, Verdict
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.core.states import Desired, State


class TrajectoryWatch:
    """
    Checks a trajectory's tolerances, by joint_trajectory_controller's rules.

    A goal is pursued until it ends; a trajectory that replaces its own meanwhile goes on as the
    goal's. Tolerances are not checked while the arm holds its position.

    Attributes
    ----------
    goal : Tolerances or None
        Those of the goal that is pursued; None: there is no goal.
    goal_end : GoalEnd or None
        How the last goal ended; None while it goes on.
    is_on : bool
        Whether a trajectory is followed.

    """

    def __init__(self) -> None:
        self.goal: Tolerances | None = None
        self.goal_end: GoalEnd | None = None
        self.is_on = self._is_first = False

    def pursue(self, tolerances: Tolerances) -> None:
        """
        Begin a goal.

        Parameters
        ----------
        tolerances : Tolerances
            Of this goal.

        """
        self.goal, self.goal_end = tolerances, None

    def follow(self) -> None:
        """Watch a new trajectory."""
        self.is_on = self._is_first = True

    def leave(self, end: GoalEnd) -> None:
        """
        Watch no trajectory any more.

        Parameters
        ----------
        end : GoalEnd
            How that ends a goal, if there is one.

        """
        self.is_on = self._is_first = False
        if self.goal is not None:
            self.goal, self.goal_end = None, end

    def time_to_check(self, defaults: Tolerances, until_end: int) -> int | None:
        """
        Return when there is something to check.

        Parameters
        ----------
        defaults : Tolerances
            For trajectories that are no goal's.
        until_end : int
            Time until the trajectory's end [ns].

        Returns
        -------
        int or None
            Time until then [ns], at least 0; None: never.

        """
        if not self.is_on:
            return None
        tolerances = self.goal or defaults
        if tolerances.apply_on_the_way:
            return 0
        return max(until_end, 0) if self.goal or tolerances.apply_after_the_end else None

    def check(self, defaults: Tolerances, measured: State, desired: Desired, since_end: int
              ) -> Verdict | None:
        """
        Check the tolerances now.

        Parameters
        ----------
        defaults : Tolerances
            For trajectories that are no goal's.
        measured : tuple of 6 floats
            Measured positions [rad] and velocities [rad/s].
        desired : tuple of 9 floats
            The reference.
        since_end : int
            Time since the trajectory's end [ns]; negative before it.

        Returns
        -------
        Verdict or None
            None: the trajectory goes on.

        """
        verdict = (self.goal or defaults).verdict(
            measured, desired, since_end / SECOND, self._is_first, self.goal is not None)
        self._is_first = False
        return verdict

    def apply(self, verdict: Verdict, joint_names: Sequence[str]) -> tuple[str, ...]:
        """
        End the trajectory, and the goal if there is one.

        Parameters
        ----------
        verdict : Verdict
            From `check`.
        joint_names : sequence of str
            The arm's joints.

        Returns
        -------
        tuple of str
            What is to be logged: the exceeded tolerances, and the consequence unless `goal_end`
            has it.

        """
        consequence = () if self.goal else (verdict.outcome.value,)
        self.leave(end_of(verdict, joint_names))
        return (*verdict.lines, *consequence)
