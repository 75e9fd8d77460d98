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

"""What the planners of Cartesian paths share: path, check, timing, and what there is to say."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.cancellation import ShouldStop, step
from rrr_traj_planner.core.errors import LimitViolationError, UnreachableError
from rrr_traj_planner.core.path.axis_planes import zone_sides
from rrr_traj_planner.core.path.cartesian_path import CartesianPath
from rrr_traj_planner.core.path.largest_radii import paths_within
from rrr_traj_planner.core.path.path_trajectory import ArmPath, PathTrajectory
from rrr_traj_planner.core.path.workspace_check import check_workspace
from rrr_traj_planner.planners.deadline import part_of
from rrr_traj_planner.planners.path_timing.least_time import (
    kept,
    nearly_fastest_along,
    PathTask,
    Timed,
)
from rrr_traj_planner.planners.request import CartesianTask
from rrr_traj_planner.planners.sampling_jerk_limit import followable
from rrr_traj_planner.planners.solver.convergence import unconverged_note

Family = Callable[[Array, ArrayLike, ShouldStop, ArrayLike], CartesianPath]
Design = Callable[[Array, ArrayLike], CartesianPath]  # of points and radii

DESIGN = 0.3     # of the time, for the first path: the motion takes the rest
AGAIN = 0.4      # of the time, after which no other path is begun

LEAST_PART = 1e-3  # of the largest radii: so small that a path is as good as the polyline
HALVED = 0.5       # radii where the arm cannot follow larger ones

SMALLER = 0.7    # radii, than those before
WORTH_IT = 1e-3  # of the time, that smaller radii must gain
STEP = 1e-3  # rad/s^2: joint accelerations that step by more are told of


def along(task: CartesianTask, family: Family) -> PathTrajectory:
    """
    Return the fastest motion of the tip along a path of a family.

    Parameters
    ----------
    task : CartesianTask
        What is asked.
    family : callable
        `line_arc` or `line_polynomial` of `core.path.design`.

    Returns
    -------
    PathTrajectory
        On the path whose radii are the largest that the deviation allows, or part of them where
        the arm cannot follow larger ones or the motion is faster then.

    Raises
    ------
    InvalidInputError
        If no path passes the points without a stop.
    UnreachableError, LimitViolationError
        If the arm cannot follow the path; with the place.

    """
    early = part_of(task.should_stop, DESIGN)
    side = zone_sides(task.tips, task.start is not None)

    def design(points: Array, radii: ArrayLike) -> CartesianPath:
        return family(points, radii, early, side)

    with step(f'the design of a path through {len(task.tips)} points'):
        *others, largest = paths_within(design, task.tips, task.max_deviation, early)
    with step(f'the timing along a path through {len(task.tips)} points'):
        paths = [path for path in others if (path.radii > largest.radii).any()] + [largest]
        return _fastest(task, design, paths, early)


def _fastest(task: CartesianTask, design: Design, paths: list[CartesianPath],
             early: ShouldStop) -> PathTrajectory:
    """Return the fastest motion along one of some paths, or along one of smaller radii."""
    late = part_of(task.should_stop, AGAIN)
    cut_short = len(paths[0].radii) > 0 and early()
    asked = _followed(task, design, paths[0], early)
    best = _Motion(asked, nearly_fastest_along(asked))
    for path in paths[1:]:
        if not late():
            best = min(best, _motion(task, path) or best, key=_Motion.duration)
    while len(best.path.radii):
        if late():
            cut_short = True
            break
        # smaller ones bend more, but their way is another one: now and then the faster
        path = design(task.tips, SMALLER * best.path.radii)
        if (path.deviation > task.max_deviation).any():
            break
        smaller = _motion(task, path)
        if smaller is None or smaller.duration() >= (1.0 - WORTH_IT) * best.duration():
            break
        best = smaller
    timed = kept(best.asked, best.timed)
    return timed.trajectory.noted(_note(task, timed, cut_short))


class _Motion(NamedTuple):
    """A motion along a path."""

    asked: PathTask
    timed: Timed

    @property
    def path(self) -> CartesianPath:
        """Return the path."""
        return self.asked.arm_path.path

    def duration(self) -> float:
        """Return how long it takes [s]."""
        return self.timed.trajectory.duration


def _motion(task: CartesianTask, path: CartesianPath) -> _Motion | None:
    """Return the fastest motion along a path; None where the arm cannot follow it."""
    try:
        asked = _timing(task, path)
        return _Motion(asked, nearly_fastest_along(asked))
    except (UnreachableError, LimitViolationError):
        return None


def _followed(task: CartesianTask, design: Design, path: CartesianPath,
              early: ShouldStop) -> PathTask:
    """
    Return what is asked of the timing along a path, or along one of smaller radii.

    Where the arm cannot follow a path though it could follow the polyline, the radii around the
    place are halved, again and again.
    """
    try:
        return _timing(task, path)
    except (UnreachableError, LimitViolationError) as error:
        if not len(path.radii):
            raise
        refusal = error
    radii, least = path.radii, LEAST_PART * path.radii
    try:
        nearest = _timing(task, design(task.tips, least))
    except (UnreachableError, LimitViolationError):
        raise refusal from None
    smaller = _around(refusal, radii)
    while not early():
        if not (smaller & (radii > least)).any():
            smaller = radii > least
        radii = np.maximum(np.where(smaller, HALVED, 1.0) * radii, least)
        path = design(task.tips, radii)
        smaller = path.deviation > task.max_deviation
        if smaller.any():
            continue
        try:
            return _timing(task, path)
        except (UnreachableError, LimitViolationError) as error:
            smaller = _around(error, radii)
    return nearest


def _around(refusal: UnreachableError | LimitViolationError, radii: Array) -> BoolArray:
    """Return which zones are at the via point nearest to where a path is refused, or beside it."""
    return np.asarray(np.abs(np.arange(1, len(radii) + 1) - refusal.via_point) <= 1)


def _timing(task: CartesianTask, path: CartesianPath) -> PathTask:
    """Return what is asked of the timing, after a check that the arm can follow the path."""
    with step('the check that the arm can follow the path'):
        joints = check_workspace(
            task.model, task.limits, path, task.posture, task.start, task.should_stop)
    arm_path = ArmPath(task.model, task.limits, path, task.posture, joints.start)
    limits, cruise = followable(
        task.model, task.limits, arm_path(path.via_s).q, task.sample_period)
    return PathTask(
        arm_path, limits, cruise, task.max_tip_speed, task.steady_zones, task.should_stop)


def _note(task: CartesianTask, timed: Timed, cut_short: bool) -> str:
    """Return the note of a motion; no bound on its gain if not every path was tried."""
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
