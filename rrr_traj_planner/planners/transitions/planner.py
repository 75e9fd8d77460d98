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

"""The planner of transition, cruise, transition in every segment (thesis 4.2.3)."""

from __future__ import annotations

from rrr_traj_planner.core.trajectory.pieces import TransitionFunction
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.registration import JointPlanner
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.transitions.fastest import fastest
from rrr_traj_planner.planners.transitions.prescribed import prescribed
from rrr_traj_planner.planners.transitions.transition_problem import TransitionProblem
from rrr_traj_planner.planners.transitions.via_problem import via_problem_of


def planner_with(function: TransitionFunction) -> JointPlanner:
    """
    Return the planner whose transitions have a given velocity function (thesis 4.2.3).

    Parameters
    ----------
    function : TransitionFunction
        The velocity function of transitions.

    Returns
    -------
    callable
        The planner, of free via velocities.

    """
    def plan(task: JointTask) -> Trajectory:
        """
        Return the fastest motion of this structure, or one of prescribed durations.

        Parameters
        ----------
        task : JointTask
            Via points, the arm and its limits.

        Returns
        -------
        Trajectory
            Within the limits.

        Raises
        ------
        InvalidInputError
            If a joint has no acceleration limit.
        TimingError
            If prescribed durations are too short; with feasible ones.
        LimitViolationError
            If gravity alone exceeds an effort limit between the via points.

        """
        problem = TransitionProblem(task, via_problem_of(task, function))
        if task.durations is None:
            return fastest(problem, None).trajectory
        return prescribed(problem, task.durations).trajectory

    return plan
