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
from functools import cached_property
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.cancellation import ShouldStop
from rrr_traj_planner.core.read_only import ReadOnlyArrays
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.planners.joint_timing.constraints import JointConstraints
from rrr_traj_planner.planners.joint_timing.margins import Margins
from rrr_traj_planner.planners.joint_timing.within_limits import fitted
from rrr_traj_planner.planners.solver.interior_point import (
    CentralPathPoint,
    CENTRED,
    minimise,
    MOST_ITERATIONS,
    Outcome,
    RELATIVE_GAP,
)
from rrr_traj_planner.planners.solver.limits import DurationConstraints, Limits
from rrr_traj_planner.planners.solver.splines import Mesh, Variables
from rrr_traj_planner.planners.solver.timing_problem import TimingProblem
from rrr_traj_planner.planners.solver.workspace import Workspace
from rrr_traj_planner.planners.tasks import JointTask

# Chosen values.
AT_END = 1e-6        # rad, distance of a via point from the end of a range, at which joints stop
INWARDS = 0.1        # least acceleration away from it, of displacement / duration^2
WIDER = (0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0)  # parts by which limits are first exceeded, tried
FIRST_GAP = 0.3      # as a part of the objective, to which a motion is brought within them
MOST_TO_RETURN = 40  # iterations from beyond the limits, which usually take two to five

# Returns a motion strictly within constraints, to start from, or None.
InitialMotion = Callable[[JointTask, JointConstraints], Variables | None]


class Solved(NamedTuple):
    """A motion within every limit."""

    trajectory: PiecewiseTrajectory
    motion: Variables  # the solver's; the trajectory is this motion, slowed where necessary
    mesh: Mesh         # the motion's
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
    mesh : Mesh
        Its n intervals in each segment.
    durations : DurationConstraints
        Which durations may change, and their weights.
    least_T : ndarray, shape (N,), optional
        Least durations of the segments [s].

    """

    task: JointTask
    mesh: Mesh
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
        return self._constraints(margins) if margins.tighten else self.without_margins

    @cached_property
    def without_margins(self) -> JointConstraints:
        """Return the limits themselves, as the solver takes them."""
        none = Margins.none(self.mesh, len(self.durations.free))
        return self._constraints(none._replace(  # alike in all segments
            positions=none.positions[:, :1], velocities=none.velocities[:1],
            accelerations=none.accelerations[:1]))

    def _constraints(self, margins: Margins) -> JointConstraints:
        task = self.task
        return JointConstraints(
            task.model, task.limits, self.mesh, task.points, margins.positions,
            margins.velocities, margins.accelerations, margins.efforts, self.least_T,
            self._workspace, margins.stays | self._stays, not self.durations.from_rest)

    @property
    def _stays(self) -> BoolArray:
        """Return where via velocities must be zero, for the joint is at an end of its range."""
        found = np.zeros((len(self.durations.free) - 1, 3, 3), bool)
        upper, lower = self._at_ends
        found[:, 0] = upper | lower
        return found

    @property
    def _at_ends(self) -> tuple[BoolArray, BoolArray]:
        """Return which joints are at the upper, and at the lower end at via points, (N - 1, 3)."""
        limits, via = self.task.limits, self.task.points[1:-1]
        return limits.max_position - via <= AT_END, via - limits.min_position <= AT_END

    def inwards(self, motion: Variables) -> Variables:
        """
        Return a motion whose joints accelerate away from ends of ranges at via points there.

        Parameters
        ----------
        motion : Variables
            In which they may leave their ranges slightly beside these via points.

        Returns
        -------
        Variables
            Nearly the same.

        """
        upper, lower = self._at_ends
        pace = INWARDS * np.abs(np.diff(self.task.points, axis=0)) / motion.T[:, np.newaxis] ** 2
        a = motion.a.copy()
        inwards = np.maximum(np.abs(a[1:-1]), np.minimum(pace[:-1], pace[1:]))
        a[1:-1] = np.where(upper, -inwards, np.where(lower, inwards, a[1:-1]))
        return self.mesh.restored(self.task.points, motion._replace(a=a))

    def minimised(self, constraints: JointConstraints, start: CentralPathPoint,
                  relative_gap: float = RELATIVE_GAP, centred: float = CENTRED,
                  wider: Limits | None = None) -> Outcome:
        """
        Return the fastest motion within constraints.

        Parameters
        ----------
        constraints : JointConstraints
            Of this problem.
        start : CentralPathPoint
            Strictly within the constraints, or within the wider limits.
        relative_gap : float
            The gap at which the method ends, as a part of the objective.
        centred : float
            See `interior_point.minimise`.
        wider : Limits, optional
            See `interior_point.minimise`.

        Returns
        -------
        Outcome
            See `interior_point.minimise`.

        """
        return minimise(constraints.problem, start, constraints.fixing(self.durations),
                        self.task.should_stop, relative_gap=relative_gap, centred=centred,
                        wider=wider,
                        most_iterations=MOST_TO_RETURN if wider else MOST_ITERATIONS)

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
        trajectory = fitted(self.task, self.mesh.trajectory(self.task.points, motion),
                            durations.may_scale)
        if trajectory is None:
            return None
        cost = durations.cost(np.diff(trajectory.via_times))
        return Solved(trajectory, motion, self.mesh, cost,
                      outcome.gap + cost - durations.cost(outcome.motion.T))


def brought_within(constraints: JointConstraints, motion: Variables,
                   durations: DurationConstraints, should_stop: ShouldStop) -> Variables | None:
    """
    Return a motion strictly within constraints, near one that may exceed them.

    Parameters
    ----------
    constraints : JointConstraints
        The constraints.
    motion : Variables
        On their mesh.
    durations : DurationConstraints
        Which durations and values at via points may change.
    should_stop : callable
        Cancellation callback.

    Returns
    -------
    Variables or None
        None where none is found.

    """
    if constraints.is_within(motion):
        return motion
    motion, problem = constraints.staying(motion), constraints.problem
    for part in WIDER:
        wider = problem.limits.widened(part)
        if TimingProblem(problem.mesh, problem.points, wider).is_within(motion):
            outcome = minimise(problem, CentralPathPoint(motion, None),
                               constraints.fixing(durations), should_stop,
                               relative_gap=FIRST_GAP, wider=wider)
            if outcome.within and outcome.centres:
                return outcome.centres[0].motion
            break
    return None
