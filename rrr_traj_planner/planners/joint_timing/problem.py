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

"""The least-time problem of joint motions, and its solutions fitted to every limit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.read_only import ReadOnlyArrays
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.planners.joint_timing.constraints import JointConstraints
from rrr_traj_planner.planners.joint_timing.margins import Margins
from rrr_traj_planner.planners.joint_timing.within_limits import fitted
from rrr_traj_planner.planners.solver.interior_point import CentralPathPoint, minimise, Outcome
from rrr_traj_planner.planners.solver.limits import DurationConstraints
from rrr_traj_planner.planners.solver.ramps import Grid, Variables
from rrr_traj_planner.planners.solver.timing_problem import Workspace
from rrr_traj_planner.planners.tasks import JointTask

# Returns a motion strictly within constraints, to start from, or None.
InitialMotion = Callable[[JointTask, JointConstraints], Variables | None]


class Solved(NamedTuple):
    """A motion within every limit."""

    trajectory: PiecewiseTrajectory
    motion: Variables  # the solver's; the trajectory is this motion, slowed where necessary
    cost: float        # the trajectory's weighted sum of durations [s]
    gap: float         # bound on the cost that the optimum saves [s]


@dataclass(frozen=True, eq=False)
class JointProblem(ReadOnlyArrays):
    """
    Via points and limits, the family of motions, and the constraints on durations.

    Parameters
    ----------
    task : JointTask
        The via points, the arm and its limits.
    grid : Grid
        Discretisation: n ramps per segment.
    durations : DurationConstraints
        Which durations may change, and their weights.
    least_T : ndarray, shape (N,), optional
        Least durations of the segments [s].

    """

    task: JointTask
    grid: Grid
    durations: DurationConstraints
    least_T: Array | None = None
    _workspace: Workspace = field(default_factory=Workspace)

    def constraints(self, margins: Margins) -> JointConstraints:
        """
        Return the limits less margins.

        Parameters
        ----------
        margins : Margins
            By which limits are tightened at the points.

        Returns
        -------
        JointConstraints
            As the solver takes them.

        """
        task = self.task
        return JointConstraints(
            task.model, task.limits, self.grid, task.points, margins.positions,
            margins.velocities, margins.efforts, self.least_T, self._workspace)

    def minimised(self, constraints: JointConstraints, margins: Margins, start: CentralPathPoint,
                  least_barrier: float = 0.0) -> Outcome:
        """
        Return the fastest motion within constraints.

        Parameters
        ----------
        constraints : JointConstraints
            With these margins.
        margins : Margins
            For the joints that rest at a via point.
        start : CentralPathPoint
            Strictly within the constraints.
        least_barrier : float
            The barrier parameter at which the method ends.

        Returns
        -------
        Outcome
            See `interior_point.minimise`.

        """
        durations = self.durations._replace(fixed_velocities=margins.at_rest)
        return minimise(constraints.problem, start, durations, self.task.should_stop,
                        least_barrier)

    def fitting(self, outcome: Outcome, motion: Variables) -> Solved | None:
        """
        Return a motion slowed until it keeps every limit, between the points too.

        Parameters
        ----------
        outcome : Outcome
            The solver's result, for the gap.
        motion : Variables
            One of its motions.

        Returns
        -------
        Solved or None
            None where slowing does not help, or durations may not change.

        """
        durations = self.durations
        may_scale = bool((durations.free | (durations.proportions > 0.0)).all())
        trajectory = fitted(self.task, self.grid.trajectory(self.task.points, motion),
                            may_scale)
        if trajectory is None:
            return None
        cost = durations.cost(np.diff(trajectory.via_times))
        return Solved(trajectory, motion, cost,
                      outcome.gap + cost - durations.cost(outcome.motion.T))
