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

"""The plan of a trajectory, after checks that are independent of the planner."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from rrr_traj_planner.core.arrays import Array, IntArray
from rrr_traj_planner.core.cancellation import step
from rrr_traj_planner.core.errors import ConvergenceError, InvalidInputError, TimingError
from rrr_traj_planner.core.rounding import JOINT_ROUNDING
from rrr_traj_planner.core.trajectory.limit_check import violations
from rrr_traj_planner.core.trajectory.torque import peak_torque
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.answers.answer_points import answer_points
from rrr_traj_planner.planners.plan import Plan
from rrr_traj_planner.planners.planning_problem import PlanningProblem
from rrr_traj_planner.planners.request import PlanningRequest


def checked_plan(problem: PlanningProblem, trajectory: Trajectory, via_index: IntArray) -> Plan:
    """
    Return the plan of a trajectory, sampled and checked.

    Parameters
    ----------
    problem : PlanningProblem
        The arm, its limits, and the request.
    trajectory : Trajectory
        The motion.
    via_index : ndarray of int, shape (n,)
        The index of each via point's time in the trajectory's `via_times`.

    Returns
    -------
    Plan
        Within every limit; slower than the trajectory, if its points require that.

    Raises
    ------
    InvalidInputError
        If it has too many points.
    TimingError
        If it has too many points because planning ended early, or a motion of prescribed
        durations cannot be sampled.
    ConvergenceError
        If it breaks a limit, which is a bug.

    """
    model, limits, request = problem.model, problem.limits, problem.request
    with step('sampling of the trajectory'):
        try:
            found = answer_points(problem, trajectory)
        except InvalidInputError as error:
            if not request.should_stop():
                raise
            raise TimingError(f'planning ended early, with a slow motion: {error}') from error
    trajectory = found.trajectory
    with step('the final checks'):
        request.should_stop()
        peaks = trajectory.peaks()
        request.should_stop()
        effort = peak_torque(model, trajectory, limits).value
        request.should_stop()
    broken = violations(limits, peaks, effort)
    if broken:
        raise ConvergenceError(
            f'planner {request.planner_id} broke a limit: {broken[0].text(model.joint_names)}')
    # The points keep limits to a tolerance: within it their torque counts as at the limit.
    effort = np.maximum(effort, np.minimum(found.effort, limits.max_effort))
    return Plan(trajectory, found.points, trajectory.via_times[via_index], peaks, effort, model,
                '; '.join(filter(None, (problem.note, trajectory.note, found.note))))


def with_exact_start(start: Array, answer: Plan, request: PlanningRequest) -> Plan:
    """
    Return a plan with the start state as its first point, to the last bit.

    Parameters
    ----------
    start : ndarray, shape (3,)
        Joint positions [rad].
    answer : Plan
        The plan.
    request : PlanningRequest
        Has the start's velocity and acceleration.

    Returns
    -------
    Plan
        Otherwise the same.

    Raises
    ------
    ConvergenceError
        If the plan begins elsewhere, which is a bug.

    """
    points, planner_id = answer.points, request.planner_id
    positions, velocities, accelerations = (
        f.copy() for f in (points.positions, points.velocities, points.accelerations))
    if np.abs(positions[0] - start).max() > JOINT_ROUNDING:
        raise ConvergenceError(
            f'planner {planner_id} began at {positions[0].tolist()} rad, not at the start state '
            f'{start.tolist()} rad')
    positions[0] = start
    if request.start_rates is not None:
        velocities[0], accelerations[0] = request.start_rates
    return replace(answer, points=replace(points, positions=positions, velocities=velocities,
                                          accelerations=accelerations))
