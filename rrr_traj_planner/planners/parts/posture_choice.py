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

"""The branches of the inverse kinematics in which a motion is planned, in order."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import (
    LimitViolationError,
    RrrPlannerError,
    StartStateError,
    UnreachableError,
)
from rrr_traj_planner.core.kinematics.axis_frame import axis_frame
from rrr_traj_planner.core.kinematics.inverse import reachable
from rrr_traj_planner.core.kinematics.joint_ranges import out_of_range, TURN, whole_turns
from rrr_traj_planner.core.kinematics.joint_sequence import joint_sequence
from rrr_traj_planner.core.kinematics.postures import (
    ALL_POSTURES,
    in_posture,
    Posture,
    posture_of,
    postures_near,
)
from rrr_traj_planner.core.kinematics.travel_time import THROUGH, travel_time, ViaPointBehaviour
from rrr_traj_planner.core.rounding import JOINT_ROUNDING, TIP_ROUNDING
from rrr_traj_planner.planners.planning_problem import PlanningProblem

# A start this close to where postures meet counts as in all of them: noise must not decide.
# Chosen, a hundred times the 1e-4 rad of a coarse encoder.
MEETING = 0.01

Branch = TypeVar('Branch')
Answer = TypeVar('Answer')


def joint_postures(problem: PlanningProblem, passing: ViaPointBehaviour) -> list[Posture]:
    """
    Return what is asked of the posture of a motion in joint space through via points, in order.

    Parameters
    ----------
    problem : PlanningProblem
        Via points, the start and the requested posture; limits for the estimate of time, where the
        start has several postures.
    passing : ViaPointBehaviour
        How the motion passes via points.

    Returns
    -------
    list of Posture
        The start's; then any that is requested, which may change from point to point; then each
        alone.

    """
    asked = problem.asked
    own: list[Posture] = []
    if problem.start is not None:
        own = [p for p in postures_near(problem.model, problem.start, MEETING)
               if asked.includes(p)]
        if len(own) > 1:
            own.sort(key=lambda posture: _time(problem, posture, passing))
    return list(dict.fromkeys((*own, asked, *filter(asked.includes, ALL_POSTURES))))


def path_beginnings(problem: PlanningProblem) -> list[Array]:
    """
    Return joint positions in which a path of the tip may begin, in order.

    Parameters
    ----------
    problem : PlanningProblem
        Via points, the requested posture, and the start: along a path of the tip its branch is
        kept.

    Returns
    -------
    list of ndarray, shape (3,)
        The start; or else the joint positions given for the first via point; or else its solutions
        up to whole turns, those first in whose posture the estimated time through the via points
        is least [rad], without those out of range, unless all are.

    Raises
    ------
    StartStateError
        If the start is in another posture than requested.
    UnreachableError
        If there is none.

    """
    model, start, asked = problem.model, problem.start, problem.asked
    if start is not None:
        own = postures_near(model, start, JOINT_ROUNDING)
        if own and not any(map(asked.includes, own)):
            raise StartStateError(
                f'the start state has {posture_of(model, start)}: along a path of the tip the arm '
                f'cannot change to {asked}')
        return [start]
    if len(problem.given_joints):
        return [problem.given_joints[0]]
    first = problem.tips[0]
    found = _away_from_axis(problem, reachable(model, first))
    asked_for = found[in_posture(model, found, asked)]
    if not len(asked_for):
        raise UnreachableError(f'via point 0 is out of reach with {asked}', 0.0, 0)
    outside = out_of_range(asked_for + [
        whole_turns(q[np.newaxis], problem.limits) for q in asked_for], problem.limits).any(axis=1)
    asked_for = asked_for if outside.all() else asked_for[~outside]
    postures = [posture_of(model, q) for q in asked_for]
    times = {p: np.inf if p is None else _time(problem, p, THROUGH) for p in set(postures)}
    return [asked_for[k] for k in np.argsort([times[p] for p in postures], kind='stable')]


def _away_from_axis(problem: PlanningProblem, found: Array) -> Array:
    """Return solutions, on joint axis 1 with joint 1 towards the path and half a turn from it."""
    frame = axis_frame(problem.model)
    points = frame.coordinates(problem.tips)
    distance = np.hypot(*points[:, :2].T)
    if distance[0] > TIP_ROUNDING:
        return found
    away = np.flatnonzero(distance > TIP_ROUNDING)
    azimuth = float(np.arctan2(*points[away[0], 1::-1])) if len(away) else float(
        np.clip(0.0, problem.limits.min_position[0], problem.limits.max_position[0]))
    turned = [found.copy(), found.copy()]
    for q, angle in zip(turned, (azimuth, azimuth + 0.5 * TURN)):
        q[:, 0] = angle
    return np.concatenate(turned)


def first_possible(branches: Sequence[Branch], attempt: Callable[[Branch], Answer],
                   told: Callable[[list[RrrPlannerError]], RrrPlannerError]) -> Answer:
    """
    Return the answer on the first branch that has one.

    Parameters
    ----------
    branches : sequence
        In the order in which they are tried.
    attempt : callable
        Returns the answer on a branch, or raises why there is none.
    told : callable
        Returns which of the branches' errors is raised, where there is no answer.

    Returns
    -------
    object
        The answer.

    Raises
    ------
    UnreachableError, LimitViolationError, StartStateError
        If there is none.

    """
    failures: list[RrrPlannerError] = []
    for branch in branches:
        try:
            return attempt(branch)
        except (UnreachableError, LimitViolationError, StartStateError) as error:
            failures.append(error)
    raise told(failures)


def furthest(failures: list[RrrPlannerError]) -> RrrPlannerError:
    """
    Return the error of the branch on which a path can be followed furthest.

    Parameters
    ----------
    failures : list of RrrPlannerError
        With the nearest via points.

    Returns
    -------
    RrrPlannerError
        The first of several.

    """
    return max(failures, key=lambda error: -1 if error.via_point is None else error.via_point)


def _time(problem: PlanningProblem, posture: Posture, passing: ViaPointBehaviour) -> float:
    """Return the estimated time through via points, infinite where a joint leaves its range."""
    model, limits, start = problem.model, problem.limits, problem.start
    try:
        q = joint_sequence(model, limits, problem.tips, posture, start, passing)
    except UnreachableError:
        return np.inf
    if out_of_range(q, limits).any():
        return np.inf
    return travel_time(limits, q if start is None else np.vstack((start, q)), passing)
