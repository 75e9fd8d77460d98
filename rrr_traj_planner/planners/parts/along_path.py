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

"""Planning along a path of the tip, part by part, on one branch of the inverse kinematics."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.errors import (
    InvalidInputError,
    JointRangeError,
    LimitViolationError,
    RrrPlannerError,
    StartStateError,
)
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.joint_ranges import TURN
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.answers.answer_size import check_answer_size
from rrr_traj_planner.planners.answers.checked_plan import checked_plan
from rrr_traj_planner.planners.parts.joining import Part, Whole, whole_motion
from rrr_traj_planner.planners.parts.posture_choice import (
    first_possible,
    furthest,
    path_beginnings,
)
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
from rrr_traj_planner.planners.registration import CartesianPlanner
from rrr_traj_planner.planners.tasks import CartesianTask

# Difference of a joint from its given position up to which a path passes the via point. Chosen:
# the path passes its tip position to 1e-12 m, which near singular positions is more of a joint.
SAME_JOINTS = 1e-9  # rad

MOST_TURNS = 2  # whole turns either way of a joint that are tried; chosen


class _Path(NamedTuple):
    """What a motion along a path is made of."""

    method: CartesianPlanner
    problem: PlanningProblem
    tips: Array      # of all points, that of the start state included, (n, 3) [m]
    same: BoolArray  # which of them, from the second on, repeat the one before, (n - 1,)

    def number(self, point: int) -> int:
        """Return a point's number in the request, -1 for the start state."""
        return point - (self.problem.start is not None)

    def name(self, point: int) -> str:
        """Return a point's name."""
        return 'start state' if self.number(point) < 0 else f'via point {self.number(point)}'


def planned_path(method: CartesianPlanner, problem: PlanningProblem) -> Plan:
    """
    Return the plan along a path of the tip, on the first branch that can follow it.

    Parameters
    ----------
    method : callable
        The planner.
    problem : PlanningProblem
        The arm and the request.

    Returns
    -------
    Plan
        Checked.

    Raises
    ------
    InvalidInputError, StartStateError, UnreachableError, LimitViolationError
        If the request cannot be met.

    """
    request = problem.request
    if request.segment_durations is not None:
        raise InvalidInputError(
            f'planner {request.planner_id} takes no segment_durations: its time is the least')
    q = problem.joint_points(problem.asked)
    check_answer_size(problem.limits, request, q)
    tips = problem.tips
    if problem.start is not None:
        tips = np.vstack((forward_kinematics(problem.model, problem.start), tips))
    same = same_tips(tips)
    path = _Path(method, problem, without_repeats(tips, same), same)

    def attempt(first: Array) -> Plan:
        whole = _on_branch(path, q[0] if same.all() else first)
        _check_joints(path, whole)
        return checked_plan(problem, whole.trajectory, whole.via_index)

    return first_possible(
        [q[0]] if same.all() else path_beginnings(problem), attempt, furthest)


def _on_branch(path: _Path, first: Array) -> Whole:
    """Return the motion that begins in joint positions, up to whole turns if none are given."""
    problem = path.problem
    if problem.start is not None or len(problem.given_joints):
        return _beginning(path, first, first)
    try:
        return _beginning(path, first, None)
    except JointRangeError:
        if len(spans(problem.request)) == 1:
            raise
        # The first part has turns that do for itself.
        for turned in _turned(first, problem.limits):
            try:
                return _beginning(path, turned, turned)
            except JointRangeError:
                continue
        raise


def _beginning(path: _Path, first: Array, pinned: Array | None) -> Whole:
    """Return the motion that begins in joint positions; pinned, with their whole turns."""
    parts, here = [], first
    for span in spans(path.problem.request):
        part = _part(path, span, here, pinned)
        if part.motion is not None:
            here = pinned = part.motion(part.motion.duration)[0]
        parts.append(part)
    return whole_motion(path.problem.request, parts, first)


def _part(path: _Path, span: Span, first: Array, pinned: Array | None) -> Part:
    """Return the motion from one stop to the next."""
    same, problem = path.same[span.segments], path.problem
    points = span.first + np.flatnonzero(np.concatenate(([True], ~same)))
    if len(points) == 1:
        return Part(span, None, same)
    request, should_stop = problem.request, time_share(problem.request, span)
    should_stop()
    task = CartesianTask(
        problem.model, problem.limits, path.tips[points], first, pinned, request.max_deviation,
        request.max_tip_speed, request.steady_zones, spacing(request), should_stop)
    try:
        motion: Trajectory = path.method(task)
    except RrrPlannerError as error:
        raise _of_request(error, path, points.tolist()) from error
    return Part(span, motion, same)


def _of_request(error: RrrPlannerError, path: _Path, points: list[int]) -> RrrPlannerError:
    """Return an error with the points of a part numbered as in the request."""
    model, limits = path.problem.model, path.problem.limits
    if isinstance(error, StartStateError) and path.number(points[0]) >= 0:
        text = str(error).replace('start state', path.name(points[0]), 1)
        return LimitViolationError(text, model.joint_names[0], np.inf,
                                   float(limits.max_velocity[0]), path.number(points[0]))
    numbers = [path.number(point) for point in points]
    if isinstance(error, InvalidInputError) and error.via_point >= 0:
        error.args = (f'{error}; stop_at lets the tip stop there',)
    if error.via_point is not None and error.via_point >= 0:
        error.via_point = numbers[error.via_point]
    if numbers != list(range(len(numbers))):
        names = ', '.join('start' if n < 0 else str(n) for n in numbers)
        error.args = (f'{error} (points counted along the path, via points: {names})',)
    return error


def _turned(q: Array, limits: JointLimits) -> Iterator[Array]:
    """Yield joint positions with all whole turns within their ranges, those near 0 first."""
    with np.errstate(invalid='ignore'):
        least = np.ceil(np.maximum((limits.min_position - q) / TURN, -MOST_TURNS))
        most = np.floor(np.minimum((limits.max_position - q) / TURN, MOST_TURNS))
    choices = [np.arange(a, b + 1.0) for a, b in zip(least, most)]
    found = [q + TURN * np.array(turns) for turns in product(*choices)]
    yield from sorted(found, key=lambda turned: float(np.abs(turned).sum()))


def _check_joints(path: _Path, whole: Whole) -> None:
    """Raise if the arm is not at the joint positions that are given for a via point."""
    problem, given = path.problem, path.problem.given_joints
    if not len(given):
        return
    times = whole.trajectory.via_times[whole.via_index]
    reached = whole.trajectory(times)[0]
    missed = np.abs(reached - given).max(axis=1) > SAME_JOINTS
    if missed.any():
        k = int(missed.argmax())
        raise InvalidInputError(
            f'via point {k}: along a path of the tip, from the joint positions before it, planner '
            f'{problem.request.planner_id} comes to {_shown(reached[k])} rad, not to '
            f'{_shown(given[k])} rad with the same position of the tip; planners in joint space '
            'change the posture', k)


def _shown(q: Array) -> str:
    return '[' + ', '.join(f'{x:.6g}' for x in q) + ']'
