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

from dataclasses import replace

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.cancellation import step
from rrr_traj_planner.core.errors import (
    ConvergenceError,
    InvalidInputError,
    RrrPlannerError,
    TimingError,
)
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.postures import Posture
from rrr_traj_planner.core.motion_laws import cycloid
from rrr_traj_planner.core.rounding import JOINT_ROUNDING, TIP_ROUNDING
from rrr_traj_planner.core.scalars import kind_of
from rrr_traj_planner.core.trajectory.limit_check import violations
from rrr_traj_planner.core.trajectory.piecewise import JointProfile, PiecewiseTrajectory
from rrr_traj_planner.core.trajectory.torque import peak_torque
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.answer_points import answer_points
from rrr_traj_planner.planners.answer_size import check_answer_size
from rrr_traj_planner.planners.missed_via_points import miss_note, via_point_errors
from rrr_traj_planner.planners.plan import Plan
from rrr_traj_planner.planners.planning_problem import planning_problem, PlanningProblem
from rrr_traj_planner.planners.posture_choice import (
    first_possible,
    furthest,
    joint_postures,
    path_beginnings,
)
from rrr_traj_planner.planners.registration import CartesianPlanner, Registered
from rrr_traj_planner.planners.registry import planner
from rrr_traj_planner.planners.request import PlanningRequest
from rrr_traj_planner.planners.tasks import CartesianTask, JointTask

# Joint positions within this that give the same tip position are one point: near the workspace
# boundary 1e-9 m correspond to 7e-5 rad.
SAME_POSTURE = 1e-4  # rad

# Displacements up to this are set to zero: ratios of 1e-310 rad to 1 rad would overflow.
# Chosen: rounding of an angle of some tens of rad.
ZERO_DISPLACEMENT = 1e-14  # rad

# Motions are planned for sample periods up to this, so that a longer sample_period does not slow
# them: the answer has additional points where its quintics need them. The default sample_period;
# half and twice of it change none of 28 random plans by `cycloid`.
LONGEST_SPACING = 0.01  # s


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
            answer = _planned_path(method.plan_path, problem)
        else:
            answer = _planned_joints(method, problem)
    return answer if problem.start is None else _with_exact_start(
        problem.start, answer, request)


def _with_exact_start(start: Array, answer: Plan, request: PlanningRequest) -> Plan:
    """Return a plan with the start state as its first point, to the last bit."""
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


def _planned_joints(method: Registered, problem: PlanningProblem) -> Plan:
    """Return the plan in joint space, in the first feasible posture."""
    durations = problem.request.segment_durations
    if durations is not None and np.isnan(durations).any() and not method.some_durations:
        raise InvalidInputError(
            f'segment_durations[{int(np.isnan(durations).argmax())}] is nan: planner '
            f'{problem.request.planner_id} takes every duration or none')
    tried: dict[bytes, RrrPlannerError] = {}  # by joint positions

    def attempt(posture: Posture) -> Plan:
        q = problem.joint_points(posture, method.passing)
        if q.tobytes() in tried:
            raise tried[q.tobytes()]
        try:
            return _plan_through(method, problem, q)
        except RrrPlannerError as error:
            tried[q.tobytes()] = error
            raise

    postures = joint_postures(problem, method.passing)
    # What stands against the widest choice stands against every part of it.
    widest = postures.index(problem.asked)
    return first_possible(postures, attempt, lambda failures: failures[widest])


def _plan_through(method: Registered, problem: PlanningProblem, q: Array) -> Plan:
    """Return the plan through joint positions."""
    model, limits, request = problem.model, problem.limits, problem.request
    check_answer_size(limits, request, q)
    q = _with_exact_zeros(q)
    same, durations = _repeated(model, q), request.segment_durations
    if durations is not None:  # where a stay is prescribed, a point counts twice
        same &= np.isnan(durations)
        durations = None if np.isnan(durations[~same]).all() else durations[~same]
    rates = request.start_rates
    if rates is not None and same.all():  # it comes back
        same[-1] = False
    distinct = q[np.concatenate(([True], ~same))]
    if len(distinct) == 1:
        return _rest(problem, q)
    assert method.plan is not None
    trajectory = method.plan(JointTask(
        model, limits, distinct, durations, _spacing(request), np.flatnonzero(~same),
        request.should_stop, request.half_transition, request.least_jerk_rise, rates))
    answer = _checked(problem, trajectory, _via_times(request, trajectory, same))
    return _with_miss_note(model, answer, q) if method.misses_via_points else answer


def _spacing(request: PlanningRequest) -> float:
    """Return the sample period for which a motion is planned [s]."""
    return min(request.sample_period, LONGEST_SPACING)


def _with_miss_note(model: RobotModel, answer: Plan, q: Array) -> Plan:
    """Return a plan with the distances by which it misses its via points in the note."""
    found = via_point_errors(
        model, answer.trajectory, answer.via_times, q[len(q) - len(answer.via_times):])
    return replace(answer, note='; '.join(filter(None, (answer.note, miss_note(found)))))


def _planned_path(method: CartesianPlanner, problem: PlanningProblem) -> Plan:
    """Return the plan along a path of the tip, on the first branch that can follow it."""
    if problem.request.segment_durations is not None:
        raise InvalidInputError(
            f'planner {problem.request.planner_id} takes no segment_durations: its time is the '
            'least')
    request, start = problem.request, problem.start
    tips = request.via_points
    if start is not None:
        tips = np.vstack((forward_kinematics(problem.model, start), tips))
    same = _same_tips(tips)
    distinct = tips[np.concatenate(([True], ~same))]
    q = problem.joint_points(problem.asked)
    check_answer_size(problem.limits, request, q)
    if len(distinct) == 1:
        return _rest(problem, q)

    def attempt(first: Array) -> Plan:
        trajectory = method(CartesianTask(
            problem.model, problem.limits, distinct, first, start, request.max_deviation,
            request.max_tip_speed, request.steady_zones, _spacing(request), request.should_stop))
        return _checked(problem, trajectory, _via_times(request, trajectory, same))

    beginnings = path_beginnings(problem)
    try:
        return first_possible(beginnings, attempt, furthest)
    except RrrPlannerError as error:
        raise _renumbered(error, same, start is not None) from error


def _renumbered(error: RrrPlannerError, same: BoolArray, started: bool) -> RrrPlannerError:
    """Return an error with via points numbered as in the request."""
    numbers = np.concatenate(([0], np.flatnonzero(~same) + 1)) - started
    if error.via_point is not None and error.via_point >= 0:
        error.via_point = int(numbers[error.via_point])
    if (numbers != np.arange(len(numbers))).any():
        names = ', '.join('start' if n < 0 else str(n) for n in numbers)
        error.args = (f'{error} (points counted along the path, via points: {names})',)
    return error


def _via_times(request: PlanningRequest, trajectory: Trajectory, same: BoolArray) -> Array:
    """Return when each of the request's via points is passed, repeated ones too."""
    index = np.cumsum(np.concatenate(([0], ~same)))
    return np.asarray(trajectory.via_times[index][len(index) - len(request.via_points):])


def _with_exact_zeros(q: Array) -> Array:
    """Return points in which displacements of at most ZERO_DISPLACEMENT are exactly zero."""
    q = q.copy()
    for before, point in zip(q, q[1:]):
        still = np.abs(point - before) <= ZERO_DISPLACEMENT
        point[still] = before[still]
    return q


def _repeated(model: RobotModel, q: Array) -> BoolArray:
    """Return which via points repeat the one before, in the same posture, shape (n - 1,)."""
    ways = np.abs(np.diff(q, axis=0)).max(axis=1)
    same_tips = _same_tips(forward_kinematics(model, q)) & (ways <= SAME_POSTURE)
    return np.asarray((ways <= JOINT_ROUNDING) | same_tips)


def _same_tips(tips: Array) -> BoolArray:
    """Return at which via points the tip is where it was at the one before, shape (n - 1,)."""
    return np.asarray(np.linalg.norm(np.diff(tips, axis=0), axis=1) <= TIP_ROUNDING)


def _rest(problem: PlanningProblem, q: Array) -> Plan:
    """Return the plan for identical via points: rest there for a sample period."""
    period = problem.request.sample_period
    profiles = [JointProfile(cycloid.cruise(np.array([period]), np.array([position]),
                                            np.zeros(1))) for position in q[0]]
    via_times = np.zeros(len(problem.request.via_points))
    return _checked(problem, PiecewiseTrajectory(profiles, via_times), via_times)


def _checked(problem: PlanningProblem, trajectory: Trajectory, via_times: Array) -> Plan:
    """Return the plan of a trajectory, after checks that are independent of the planner."""
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
    return Plan(trajectory, found.points, via_times * found.time_scale, peaks, effort, model,
                '; '.join(filter(None, (problem.note, trajectory.note, found.note))))
