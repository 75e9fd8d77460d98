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

"""Planning along Cartesian paths: design of the path, workspace check, timing and notes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.cancellation import ShouldStop, step
from rrr_traj_planner.core.errors import LimitViolationError, UnreachableError
from rrr_traj_planner.core.path.axis_planes import zone_sides
from rrr_traj_planner.core.path.cartesian_path import CartesianPath
from rrr_traj_planner.core.path.largest_radii import paths_within
from rrr_traj_planner.core.path.path_trajectory import PathTrajectory
from rrr_traj_planner.core.path.workspace_check import check_workspace
from rrr_traj_planner.planners.deadline import part_of
from rrr_traj_planner.planners.path_timing.least_time import RoughMotion, Timed
from rrr_traj_planner.planners.path_timing.task import PathTask
from rrr_traj_planner.planners.sampling_jerk_limit import acceleration_scale, limits_for_sampling
from rrr_traj_planner.planners.solver.convergence import unconverged_note
from rrr_traj_planner.planners.tasks import CartesianTask
from rrr_traj_planner.planners.via_points import holding_failure

Family = Callable[[Array, ArrayLike, ShouldStop, ArrayLike], CartesianPath]
Design = Callable[[Array, ArrayLike], CartesianPath]  # of points and radii

# Parts of the planning time; chosen:
DESIGN = 0.3  # for the first path; its timing has the rest
AGAIN = 0.4   # after which no other path is timed

# Radii of zones, and what smaller ones must gain; chosen: SMALLER of 0.5 or 0.85, and half and
# twice of WORTH_IT, give the same motions on 12 random paths:
LEAST_PART = 1e-3  # of the largest radii: the path is then practically the polyline
SMALLER = 0.7      # factor from one path to the next that is tried
WORTH_IT = 1e-3    # part of the motion's duration

# Steps of joint acceleration above which the note tells of them [rad/s^2]; chosen: far above
# rounding, far below any limit.
STEP = 1e-3


def along(task: CartesianTask, family: Family) -> PathTrajectory:
    """
    Return the fastest motion of the tip along a path of a family.

    Parameters
    ----------
    task : CartesianTask
        Points of the tip, the arm and its limits.
    family : callable
        `line_arc` or `line_polynomial` of `core.path.design`.

    Returns
    -------
    PathTrajectory
        On the path with the largest radii that the deviation allows, or with smaller ones where
        the arm cannot follow that or where the motion is faster.

    Raises
    ------
    InvalidInputError
        If no path passes the points without a stop.
    UnreachableError, LimitViolationError
        If the arm cannot follow the path; with the position.

    """
    early = part_of(task.should_stop, DESIGN)
    side = zone_sides(task.model, task.tips, task.start is not None)

    def design(points: Array, radii: ArrayLike) -> CartesianPath:
        return family(points, radii, early, side)

    with step(f'the design of a path through {len(task.tips)} points'):
        *others, largest = paths_within(design, task.tips, task.max_deviation, early)
    with step(f'the timing along a path through {len(task.tips)} points'):
        paths = [path for path in others if (path.radii > largest.radii).any()] + [largest]
        return _fastest(task, design, paths, early)


def _fastest(task: CartesianTask, design: Design, paths: list[CartesianPath],
             early: ShouldStop) -> PathTrajectory:
    """Return the fastest motion along one of several paths, or along one of smaller radii."""
    late = part_of(task.should_stop, AGAIN)
    cut_short = len(paths[0].radii) > 0 and early()
    best = RoughMotion(_feasible_path_task(task, design, paths[0], early))
    for path in paths[1:]:
        if not late():
            best = min(best, _rough_motion(task, path) or best, key=lambda m: m.duration)
    while len(best_radii := best.task.arm_path.path.radii):
        if late():
            cut_short = True
            break
        # smaller radii have larger curvature on shorter zones: sometimes that is faster
        path = design(task.tips, SMALLER * best_radii)
        if (path.deviation > task.max_deviation).any():
            break
        smaller = _rough_motion(task, path)
        if smaller is None or smaller.duration >= (1.0 - WORTH_IT) * best.duration:
            break
        best = smaller
    timed = best.finished()
    return timed.trajectory.noted(_note(task, timed, cut_short))


def _rough_motion(task: CartesianTask, path: CartesianPath) -> RoughMotion | None:
    """Return the fastest motion along a path, roughly; None where the arm cannot follow it."""
    try:
        return RoughMotion(_path_task(task, path))
    except (UnreachableError, LimitViolationError):
        return None


def _feasible_path_task(task: CartesianTask, design: Design, path: CartesianPath,
                        early: ShouldStop) -> PathTask:
    """
    Return the timing task along a path, or along one of smaller radii that the arm can follow.

    Where the arm cannot follow a path but can follow the polyline, the radii next to the position
    of the failure are halved repeatedly.
    """
    try:
        return _path_task(task, path)
    except (UnreachableError, LimitViolationError) as error:
        if not len(path.radii):
            raise
        refusal = error
    radii, least = path.radii, LEAST_PART * path.radii
    try:
        nearest = _path_task(task, design(task.tips, least))
    except (UnreachableError, LimitViolationError):
        raise refusal from None
    smaller = _around(refusal, radii)
    while not early():
        if not (smaller & (radii > least)).any():
            smaller = radii > least
        radii = np.maximum(np.where(smaller, 0.5, 1.0) * radii, least)
        path = design(task.tips, radii)
        smaller = path.deviation > task.max_deviation
        if smaller.any():
            continue
        try:
            return _path_task(task, path)
        except (UnreachableError, LimitViolationError) as error:
            smaller = _around(error, radii)
    return nearest


def _around(refusal: UnreachableError | LimitViolationError, radii: Array) -> BoolArray:
    """Return the zones at the via point nearest to a failure, and beside it."""
    return np.asarray(np.abs(np.arange(1, len(radii) + 1) - refusal.via_point) <= 1)


def _path_task(task: CartesianTask, path: CartesianPath) -> PathTask:
    """Return the timing task along a path, after a check that the arm can follow it."""
    with step('the check that the arm can follow the path'):
        arm_path = check_workspace(
            task.model, task.limits, path, task.first, task.start, task.should_stop)
    failure = holding_failure(task.model, task.limits, arm_path(path.via_s).q)
    if failure is not None:
        raise failure
    scale = acceleration_scale(task.model, task.limits, arm_path(path.via_s).q)
    limits = limits_for_sampling(task.limits, scale, task.sample_period)
    return PathTask(arm_path, limits, task.max_tip_speed, task.steady_zones, task.should_stop)


def _note(task: CartesianTask, timed: Timed, cut_short: bool) -> str:
    """
    Return the note: acceleration steps, and how much faster a motion may be.

    The latter has no bound if not every path was tried.
    """
    notes = []
    most = timed.trajectory.acceleration_steps().max(axis=0, initial=0.0)
    if most.max() > STEP:
        largest = ', '.join(f'{name} {value:.3g}' for name, value in zip(
            task.model.joint_names, most))
        notes.append(f'joint accelerations step where arcs begin and end, at most by {largest} '
                     'rad/s^2')
    gap = np.inf if cut_short else timed.gap
    notes.append(unconverged_note(gap, timed.trajectory.duration))
    return '; '.join(filter(None, notes))
