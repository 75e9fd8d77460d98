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

"""Least-time problems on chains of ramps, solved and mended until nothing breaks a limit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.piecewise import PiecewiseTrajectory
from rrr_traj_planner.planners.interior_point import Centre, is_within, minimise, Outcome
from rrr_traj_planner.planners.ramp_chain import Grid, Motion
from rrr_traj_planner.planners.ramp_constraints import Constraints
from rrr_traj_planner.planners.ramp_fit import beyond_range, fitted, torque_fits
from rrr_traj_planner.planners.ramp_newton import Freedom
from rrr_traj_planner.planners.ramp_room import Room
from rrr_traj_planner.planners.ramp_start import rest_to_rest
from rrr_traj_planner.planners.request import JointTask

REPAIRS = 20             # rounds of mending what happens between the points that are looked at
PARTS_OF_ROOM = (1.0, 0.9, 0.7, 0.4, 0.1, 0.03)
WORTH_IT = 1e-3          # a stretch longer than this is better mended by planning again


Begin = Callable[[JointTask, Constraints], Motion | None]


class Solved(NamedTuple):
    """A motion that keeps every limit."""

    trajectory: PiecewiseTrajectory
    motion: Motion    # of which the trajectory is a little slower, where it had to be
    cost: float       # its weighted durations [s]
    gap: float        # what a better motion could save of them at most


def fastest(task: JointTask, grid: Grid, floor: Array | None = None) -> Solved | None:
    """
    Return the fastest motion.

    Where joints have acceleration limits they are first planned without regard to torque, each
    for itself but for time; torque then often has nothing to say.

    Parameters
    ----------
    task : JointTask
        The via points, the arm and its limits.
    grid : Grid
        The family of motions.
    floor : ndarray, shape (N,), optional
        Least durations of the segments [s].

    Returns
    -------
    Solved or None
        None where no way is found along which the motors can hold the arm.

    """
    segments = len(task.points) - 1
    freedom = Freedom(np.ones(segments, bool), np.zeros(segments), np.ones(segments),
                      np.zeros((segments - 1, 3), bool))
    if np.isfinite(task.limits.max_acceleration).all():
        free = replace(task.limits, max_effort=np.full(3, np.inf))
        found = mended(replace(task, limits=free), grid, freedom, rest_to_rest, floor)
        if found is not None and torque_fits(task, found.trajectory):
            return found
    return mended(task, grid, freedom, rest_to_rest, floor)


def mended(task: JointTask, grid: Grid, freedom: Freedom, begin: Begin,
           floor: Array | None = None) -> Solved | None:
    """
    Solve, and solve again with more room where the motion breaks a limit between points.

    Parameters
    ----------
    task : JointTask
        The via points, the arm and its limits.
    grid : Grid
        The family of motions.
    freedom : Freedom
        Which durations may change.
    begin : callable
        Gives a motion to start from, strictly within the constraints, or None.
    floor : ndarray, shape (N,), optional
        Least durations of the segments [s].

    Returns
    -------
    Solved or None
        The best that was found; None where there is nothing to start from.

    """
    room = Room.none(grid, len(freedom.free))._replace(still=freedom.still)
    centres: list[Centre] = []
    slow: Motion | None = None
    found: list[Solved] = []
    for _ in range(REPAIRS):
        nearer = _nearer(task, grid, room, floor, centres, freedom)
        if nearer is not None and nearer.centres:
            centres += nearer.centres
            continue
        begun = _begun(task, grid, room, floor, centres, begin)
        if begun is None:
            break
        room, constraints, start = begun
        slow = slow or start.motion
        outcome = minimise(constraints, start, freedom._replace(still=room.still),
                           task.should_stop)
        found += _those_that_fit(task, grid, freedom, start, outcome)
        if found and found[-1].motion is outcome.motion and (
                found[-1].cost <= (1.0 + WORTH_IT) * freedom.cost(outcome.motion.T)):
            break
        if found and task.should_stop():
            break
        trajectory = grid.trajectory(task.points, outcome.motion)
        room = room.grown(task, grid, slow, outcome.motion, trajectory)
        # where ranges are left it takes another course, not a nearby one
        centres = [] if beyond_range(task, trajectory).any() else centres + outcome.centres
    return min(found, default=None, key=lambda s: s.cost)


def _nearer(task: JointTask, grid: Grid, room: Room, floor: Array | None,
            centres: list[Centre], freedom: Freedom) -> Outcome | None:
    """Return a centre nearer to the room where no other has all of it, but one has some."""
    for part in PARTS_OF_ROOM:
        constraints = room.part(part).constraints(task, grid, floor)
        for centre in reversed(centres):
            if is_within(constraints, centre.motion):
                return None if part == 1.0 else minimise(
                    constraints, centre, freedom._replace(still=room.still), task.should_stop,
                    centre.barrier or 0.0)
    return None


def _begun(task: JointTask, grid: Grid, room: Room, floor: Array | None,
           centres: list[Centre], begin: Begin) -> tuple[Room, Constraints, Centre] | None:
    """Return the last centre that has room, else a motion from rest and as much as it has."""
    constraints = room.constraints(task, grid, floor)
    for centre in reversed(centres):
        if is_within(constraints, centre.motion):
            return room, constraints, centre
    for part in (*PARTS_OF_ROOM, 0.0):
        reduced = room.kept().part(part)
        constraints = reduced.constraints(task, grid, floor)
        motion = begin(task, constraints)
        if motion is None:
            return None
        if is_within(constraints, motion):
            return reduced, constraints, Centre(motion, None)
    return None


def _those_that_fit(task: JointTask, grid: Grid, freedom: Freedom, start: Centre,
                    outcome: Outcome) -> list[Solved]:
    """Return what keeps every limit: a centre that does as it is, the outcome perhaps slowed."""
    may_stretch = bool((freedom.free | (freedom.tie > 0.0)).all())
    least, found = freedom.cost(outcome.motion.T), []
    for motion in (outcome.motion, *(c.motion for c in reversed(outcome.centres)), start.motion):
        trajectory = fitted(task, grid.trajectory(task.points, motion), may_stretch)
        if trajectory is None:
            continue
        cost = freedom.cost(np.diff(trajectory.via_times))
        found.append(Solved(trajectory, motion, cost, outcome.gap + cost - least))
        if cost <= (1.0 + WORTH_IT) * freedom.cost(motion.T):
            break
    return found[::-1]
