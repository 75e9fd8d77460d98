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

"""Planning in joint space: through joint positions, part by part."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.errors import InvalidInputError, RrrPlannerError, TimingError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.postures import Posture
from rrr_traj_planner.core.kinematics.travel_time import ViaPointBehaviour
from rrr_traj_planner.core.rounding import JOINT_ROUNDING
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.answers.answer_size import check_answer_size
from rrr_traj_planner.planners.answers.answer_time import with_time_for_answer
from rrr_traj_planner.planners.answers.checked_plan import checked_plan
from rrr_traj_planner.planners.answers.missed_via_points import with_miss_note
from rrr_traj_planner.planners.parts.joining import Part, whole_motion
from rrr_traj_planner.planners.parts.posture_choice import first_possible, joint_postures
from rrr_traj_planner.planners.parts.spans import (
    same_tips,
    spacing,
    Span,
    spans,
    time_share,
    without_repeats,
)
from rrr_traj_planner.planners.plan import Plan
from rrr_traj_planner.planners.planning_problem import PlanningProblem
from rrr_traj_planner.planners.registration import Registered
from rrr_traj_planner.planners.tasks import JointTask

# Joint positions within this that give the same tip position are one point: near the workspace
# boundary 1e-9 m correspond to 7e-5 rad.
SAME_POSTURE = 1e-4  # rad

# Displacements up to this are set to zero: ratios of 1e-310 rad to 1 rad would overflow.
# Chosen: rounding of an angle of some tens of rad.
ZERO_DISPLACEMENT = 1e-14  # rad


class _Chain(NamedTuple):
    """Joint positions of all points, that of the start state included."""

    q: Array         # [rad], (n, 3)
    same: BoolArray  # which of them, from the second on, repeat the one before, (n - 1,)


def planned_joints(method: Registered, problem: PlanningProblem) -> Plan:
    """
    Return the plan in joint space, in the first feasible posture of the whole motion.

    Parameters
    ----------
    method : Registered
        The planner.
    problem : PlanningProblem
        The arm and the request.

    Returns
    -------
    Plan
        Checked.

    Raises
    ------
    InvalidInputError, StartStateError, UnreachableError, LimitViolationError, TimingError
        If the request cannot be met.

    """
    durations = problem.request.segment_durations
    if durations is not None and np.isnan(durations).any() and not method.some_durations:
        raise InvalidInputError(
            f'segment_durations[{int(np.isnan(durations).argmax())}] is nan: planner '
            f'{problem.request.planner_id} takes every duration or none')
    passing = _passing(method, problem)
    tried: dict[bytes, RrrPlannerError] = {}  # by joint positions

    def attempt(posture: Posture) -> Plan:
        q = problem.joint_points(posture, passing)
        if q.tobytes() in tried:
            raise tried[q.tobytes()]
        try:
            return _plan_through(method, problem, q)
        except RrrPlannerError as error:
            tried[q.tobytes()] = error
            raise

    if problem.request.via_points is None:
        return attempt(problem.asked)
    postures = joint_postures(problem, passing)
    # What stands against the widest choice stands against every part of it.
    widest = postures.index(problem.asked)
    return first_possible(postures, attempt, lambda failures: failures[widest])


def _passing(method: Registered, problem: PlanningProblem) -> ViaPointBehaviour:
    """Return how the motion passes via points, for the choice of postures and whole turns."""
    stops_everywhere = len(problem.request.rest_points) == problem.request.segments + 1
    return method.passing._replace(via='stop') if stops_everywhere else method.passing


def _plan_through(method: Registered, problem: PlanningProblem, q: Array) -> Plan:
    """Return the plan through joint positions."""
    check_answer_size(problem.limits, problem.request, q)
    problem = with_time_for_answer(problem, q, _passing(method, problem))
    request = problem.request
    # A planner that stops at every via point plans them at once.
    divided = [Span(0, request.segments)] if method.passing.via == 'stop' else spans(request)
    chain = _chain(problem, q, divided[0])
    parts = [_part(method, problem, chain, span) for span in divided]
    whole = whole_motion(request, parts, chain.q[0])
    answer = checked_plan(problem, whole.trajectory, whole.via_index)
    return (with_miss_note(problem.model, answer, q[-request.number:])
            if method.misses_via_points else answer)


def _chain(problem: PlanningProblem, q: Array, first: Span) -> _Chain:
    """Return the points with repeated ones exactly equal; first: the first part of the motion."""
    request = problem.request
    q = _with_exact_zeros(q)
    same = _repeated(problem.model, q)
    if request.segment_durations is not None:  # a stay is prescribed: the point counts twice
        same &= np.isnan(request.segment_durations)
    if request.start_rates is not None and same[first.segments].all():  # it comes back
        same[first.last - 1] = False
    return _Chain(without_repeats(q, same), same)


def _part(method: Registered, problem: PlanningProblem, chain: _Chain, span: Span) -> Part:
    """Return the motion from one stop to the next."""
    request, same = problem.request, chain.same[span.segments]
    distinct = chain.q[span.points][np.concatenate(([True], ~same))]
    if len(distinct) == 1:
        return Part(span, None, same)
    should_stop = time_share(request, span)
    should_stop()
    durations, begins = request.segment_durations, span.first == 0
    if durations is not None:
        durations = durations[span.segments][~same]
        durations = None if np.isnan(durations).all() else durations
    task = JointTask(
        problem.model, problem.limits if begins else problem.from_rest, distinct, durations,
        spacing(request), span.first + np.flatnonzero(~same), should_stop,
        request.half_transition, request.least_jerk_rise,
        request.start_rates if begins else None)
    return Part(span, _planned(method, problem, task, span), same)


def _planned(method: Registered, problem: PlanningProblem, task: JointTask,
             span: Span) -> Trajectory:
    """Return the motion of a task, or raise what stands against it in terms of the request."""
    assert method.plan is not None
    try:
        return method.plan(task)
    except TimingError as error:
        own = task.segment_numbers
        is_whole = span.last - span.first == problem.request.segments
        if own is None or is_whole or len(error.least_durations) != len(own):
            raise
        numbers = ', '.join(map(str, own))
        least = np.array(problem.request.segment_durations)
        least[own] = error.least_durations
        raise TimingError(f'{error} (of segments {numbers} alone)', tuple(least.tolist()),
                          error.via_point) from error


def _with_exact_zeros(q: Array) -> Array:
    """Return points in which displacements of at most ZERO_DISPLACEMENT are exactly zero."""
    q = q.copy()
    for before, point in zip(q, q[1:]):
        still = np.abs(point - before) <= ZERO_DISPLACEMENT
        point[still] = before[still]
    return q


def _repeated(model: RobotModel, q: Array) -> BoolArray:
    """Return which points repeat the one before, in the same posture, shape (n - 1,)."""
    ways = np.abs(np.diff(q, axis=0)).max(axis=1)
    same = same_tips(forward_kinematics(model, q)) & (ways <= SAME_POSTURE)
    return np.asarray((ways <= JOINT_ROUNDING) | same)
