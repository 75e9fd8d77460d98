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

"""The postures in which a motion is planned, in order: the start's own first."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np
from rrr_traj_planner.core.errors import (
    JointRangeError,
    LimitViolationError,
    RrrPlannerError,
    StartStateError,
    UnreachableError,
)
from rrr_traj_planner.core.kinematics.joint_ranges import out_of_range
from rrr_traj_planner.core.kinematics.joint_sequence import joint_sequence
from rrr_traj_planner.core.kinematics.postures import (
    ELBOWS,
    Posture,
    posture_of,
    postures_of,
    Shoulder,
    SHOULDERS,
)
from rrr_traj_planner.core.kinematics.travel_time import travel_time, ViaPointBehaviour
from rrr_traj_planner.core.path.axis_planes import passes_axis
from rrr_traj_planner.core.rounding import JOINT_ROUNDING
from rrr_traj_planner.planners.planning_problem import PlanningProblem

# A start this close to where postures meet counts as in all of them: noise must not decide.
# Chosen, a hundred times the 1e-4 rad of a coarse encoder.
MEETING = 0.01  # rad

Answer = TypeVar('Answer')


def joint_postures(problem: PlanningProblem, passing: ViaPointBehaviour) -> list[Posture]:
    """
    Return the postures for a motion in joint space through via points, in order.

    Parameters
    ----------
    problem : PlanningProblem
        Via points, the start and the requested branch; limits for the estimate of time, where the
        start has several postures.
    passing : ViaPointBehaviour
        How the motion passes via points.

    Returns
    -------
    list of Posture
        The start's first; then the other elbow, then the shoulder's front. Without a start: the
        shoulder's front, with the elbow up before down.

    """
    elbow = problem.request.elbow
    if problem.start is None:
        return [Posture(e) for e in ELBOWS if elbow in (None, e)]
    own = postures_of(problem.model, problem.start, MEETING)
    if len(own) > 1:
        own.sort(key=lambda posture: _time(problem, posture, passing))
    shoulders: tuple[Shoulder, Shoulder] = own[0].shoulder, 'front'
    others = [Posture(e, s) for s in shoulders for e in ELBOWS]
    return [p for p in dict.fromkeys((*own, *others)) if elbow in (None, p.elbow)]


def path_postures(problem: PlanningProblem) -> list[Posture]:
    """
    Return the postures for a path of the tip, in order.

    Parameters
    ----------
    problem : PlanningProblem
        Via points, the requested branch, and the start: along a path of the tip its posture is
        kept.

    Returns
    -------
    list of Posture
        At least one, in which the path begins: without a start the shoulder's front, or the back
        too where the path changes from one to the other.

    Raises
    ------
    StartStateError
        If the start is on another elbow branch than requested.

    """
    model, start, elbow = problem.model, problem.start, problem.request.elbow
    if start is None:
        shoulders = SHOULDERS if passes_axis(problem.request.via_points) else SHOULDERS[:1]
        return [Posture(e, s) for s in shoulders for e in ELBOWS if elbow in (None, e)]
    own = [p for p in postures_of(model, start, JOINT_ROUNDING) if elbow in (None, p.elbow)]
    if not own:
        raise StartStateError(
            f'the start state is on elbow branch {posture_of(model, start).elbow} '
            f'({model.joint_names[2]} at {start[2]:.6g} rad): along a path of the tip the arm '
            f'cannot change to elbow {elbow!r}')
    return own


def first_possible(postures: Sequence[Posture], attempt: Callable[[Posture], Answer]) -> Answer:
    """
    Return the answer in the first posture that has one.

    Parameters
    ----------
    postures : sequence of Posture
        In the order in which they are tried.
    attempt : callable
        Returns the answer in a posture, or raises why there is none.

    Returns
    -------
    object
        The answer.

    Raises
    ------
    UnreachableError, LimitViolationError, StartStateError
        If there is none: of the first posture that keeps the joints' ranges, else of the first.

    """
    failures: list[RrrPlannerError] = []
    for posture in postures:
        try:
            return attempt(posture)
        except (UnreachableError, LimitViolationError, StartStateError) as error:
            failures.append(error)
    raise next((e for e in failures if not isinstance(e, JointRangeError)), failures[0])


def _time(problem: PlanningProblem, posture: Posture, passing: ViaPointBehaviour) -> float:
    """Return the estimated time through via points, infinite where a joint leaves its range."""
    model, limits, start = problem.model, problem.limits, problem.start
    assert start is not None
    q = joint_sequence(model, limits, problem.request.via_points, posture, start, passing)
    if out_of_range(q, limits).any():
        return np.inf
    return travel_time(limits, np.vstack((start, q)), passing)
