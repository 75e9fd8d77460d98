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

"""`plan`: from a request to a checked plan."""

from __future__ import annotations

from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.cancellation import step
from rrr_traj_planner.core.scalars import kind_of
from rrr_traj_planner.planners.answers.checked_plan import with_exact_start
from rrr_traj_planner.planners.parts.along_path import planned_path
from rrr_traj_planner.planners.parts.through_joints import planned_joints
from rrr_traj_planner.planners.plan import Plan
from rrr_traj_planner.planners.posed_problem import planning_problem
from rrr_traj_planner.planners.registry import planner
from rrr_traj_planner.planners.request import PlanningRequest


def plan(model: RobotModel, limits: JointLimits, request: PlanningRequest) -> Plan:
    """
    Plan a motion through via points.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Its limits, before the request's scaling.
    request : PlanningRequest
        Via points and how to pass them.

    Returns
    -------
    Plan
        A motion within every limit, with its exact peaks.

    Raises
    ------
    InvalidInputError, StartStateError, UnreachableError, LimitViolationError, TimingError
        If the request cannot be met; each says why.
    ConvergenceError
        If the planner's motion breaks a limit, which is a bug.

    """
    for name, value, kind in (('model', model, RobotModel), ('limits', limits, JointLimits),
                              ('request', request, PlanningRequest)):
        kind_of(name, value, kind)
    method = planner(request.planner_id)
    problem = planning_problem(model, limits, request)
    with step(f'planning by {request.planner_id}'):
        if method.plan_path is not None:
            answer = planned_path(method.plan_path, problem)
        else:
            answer = planned_joints(method, problem)
    return answer if problem.start is None else with_exact_start(problem.start, answer, request)
