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

"""What a request asks of an arm: its scaled limits and the checked start state."""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import format_distinct, InvalidInputError, StartStateError
from rrr_traj_planner.core.kinematics.branch_factors import has_named_postures
from rrr_traj_planner.core.kinematics.postures import ANY_POSTURE, Posture
from rrr_traj_planner.planners.effort_limits import (
    check_friction,
    torque_note,
)
from rrr_traj_planner.planners.joint_timing.moving_start import limits_of_moving_start
from rrr_traj_planner.planners.planning_problem import PlanningProblem
from rrr_traj_planner.planners.registry import planner, planner_ids
from rrr_traj_planner.planners.request import PlanningRequest
from rrr_traj_planner.planners.tasks import StartRates
from rrr_traj_planner.planners.via_points import check_start


def planning_problem(model: RobotModel, limits: JointLimits,
                     request: PlanningRequest) -> PlanningProblem:
    """
    Return the problem that a request poses an arm.

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
    PlanningProblem
        With scaled limits.

    Raises
    ------
    InvalidInputError
        If it names a posture, and the arm's have no names.
    StartStateError
        If the start state is out of its range or cannot be held, or the arm cannot go on from it.
    LimitViolationError
        If Coulomb friction reaches an effort limit: it leaves no torque for motion.

    """
    asked = Posture(request.elbow, request.shoulder)
    if asked != ANY_POSTURE and not has_named_postures(model):
        raise InvalidInputError(
            f'{asked} is asked for, but the postures of this arm have no names')
    note = torque_note(model, limits)
    scaled = limits.scaled(request.velocity_scaling, request.acceleration_scaling)
    check_friction(model, scaled)
    limits, rates, start = scaled, request.start_rates, None
    if request.start is not None:
        start = check_start(model, scaled, request.start, request.start_state_tolerance,
                            rests=rates is None)
        if rates is not None:
            _check_planner(model, request, rates)
            limits = limits_of_moving_start(model, scaled, start, rates)
    return PlanningProblem(model, limits, request, start, scaled, note)


def _check_planner(model: RobotModel, request: PlanningRequest, rates: StartRates) -> None:
    """Raise if the planner takes no motion that starts moving, or not as it is asked for."""
    if not planner(request.planner_id).starts_moving:
        able = ', '.join(i for i in planner_ids() if planner(i).starts_moving)
        tolerance = request.start_state_tolerance
        moving = np.abs(rates.velocity) > tolerance
        values, how, unit, j = (
            (rates.velocity, 'moves at', 'rad/s', int(moving.argmax())) if moving.any() else
            (rates.acceleration, 'accelerates with', 'rad/s^2',
             int(np.abs(rates.acceleration).argmax())))
        _, most, shown = format_distinct(abs(float(values[j])), tolerance, float(values[j]))
        raise StartStateError(
            f'start state: {model.joint_names[j]} {how} {shown} {unit}, must be at rest (no '
            f'faster than start_state_tolerance, {most} rad/s) for planner {request.planner_id}; '
            f'from any state: {able}')
    if request.segment_durations is not None:
        raise InvalidInputError('segment_durations are given, and the start state moves: '
                                'durations can be prescribed from rest only')
