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

"""Planning of a task by several planners: their plans, or why they refuse it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from time import perf_counter

from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import RrrPlannerError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.rounding import TIME_ROUNDING
from rrr_traj_planner.planners.plan import Plan
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.registry import planner
from rrr_traj_planner.planners.request import PlanningRequest

TIME_LIMIT = 10.0  # s, after which a planner stops with the best motion so far


@dataclass(frozen=True, eq=False)
class Task:
    """
    An arm and a planning request.

    Parameters
    ----------
    name : str
        Name for the page.
    model : RobotModel
        The arm.
    limits : JointLimits
        Its limits.
    request : PlanningRequest
        The request; its planner id is replaced.

    """

    name: str
    model: RobotModel
    limits: JointLimits
    request: PlanningRequest

    @cached_property
    def via_points(self) -> Array:
        """Tip positions [m], shape (n, 3)."""
        if self.request.via_points is not None:
            return self.request.via_points
        assert self.request.joint_via_points is not None  # one of the two is given
        return forward_kinematics(self.model, self.request.joint_via_points)


@dataclass(frozen=True, eq=False)
class Attempt:
    """
    The result of one planner for a task.

    Parameters
    ----------
    task : Task
        The task.
    planner_id : str
        The planner.
    plan : Plan, optional
        Its plan; None if it refused the task.
    refusal : str
        The reason of a refusal, else empty.
    planning_time : float
        Planning time [s].

    """

    task: Task
    planner_id: str
    plan: Plan | None
    refusal: str
    planning_time: float


@dataclass(frozen=True, eq=False)
class Planned:
    """
    A plan with its task and planner.

    Parameters
    ----------
    task : Task
        The task.
    planner_id : str
        The planner.
    plan : Plan
        Its plan.

    """

    task: Task
    planner_id: str
    plan: Plan

    @property
    def moving_knots(self) -> Array:
        """Knots until the last via point is reached; then the arm holds, if it is to dwell [s]."""
        knots = self.plan.trajectory.knots
        return knots[knots <= self.plan.via_times[-1] + TIME_ROUNDING * max(1.0, knots[-1])]


def attempts(task: Task, planner_ids: Sequence[str], repeats: int = 1) -> list[Attempt]:
    """
    Plan a task by several planners.

    Parameters
    ----------
    task : Task
        The task.
    planner_ids : sequence of str
        The planners.
    repeats : int
        Number of times that each planner plans; the result has the shortest planning time.

    Returns
    -------
    list of Attempt
        One for each planner, in the same order.

    Raises
    ------
    InvalidInputError
        If an id is unknown.

    """
    for planner_id in planner_ids:
        planner(planner_id)
    return [min((_attempt(task, planner_id) for _ in range(repeats)),
                key=lambda found: found.planning_time) for planner_id in planner_ids]


def planned(found: Sequence[Attempt]) -> list[Planned]:
    """
    Return the plans among attempts.

    Parameters
    ----------
    found : sequence of Attempt
        Attempts.

    Returns
    -------
    list of Planned
        The attempts that were not refused.

    """
    return [Planned(a.task, a.planner_id, a.plan) for a in found if a.plan is not None]


def _attempt(task: Task, planner_id: str) -> Attempt:
    started = perf_counter()
    request = replace(task.request, planner_id=planner_id,
                      should_stop=lambda: perf_counter() - started > TIME_LIMIT)
    try:
        answer, refusal = plan(task.model, task.limits, request), ''
    except RrrPlannerError as error:
        answer, refusal = None, str(error)
    return Attempt(task, planner_id, answer, refusal, perf_counter() - started)
