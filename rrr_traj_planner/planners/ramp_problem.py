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
from rrr_traj_planner.planners.interior_point import (
    Centre,
    is_within,
    minimise,
    Outcome,
)
from rrr_traj_planner.planners.ramp_chain import Grid, Motion
from rrr_traj_planner.planners.ramp_constraints import Constraints
from rrr_traj_planner.planners.ramp_fit import fitted, torque_fits
from rrr_traj_planner.planners.ramp_look import Look
from rrr_traj_planner.planners.ramp_moves import stretched
from rrr_traj_planner.planners.ramp_newton import Freedom
from rrr_traj_planner.planners.ramp_room import Room
from rrr_traj_planner.planners.ramp_start import rest_to_rest
from rrr_traj_planner.planners.request import JointTask

REPAIRS = 20             # rounds of mending what happens between the points that are looked at
PARTS_OF_ROOM = (1.0, 0.9, 0.7, 0.4, 0.1, 0.03)
APPROACHES = 5           # rounds of coming nearer to room that no centre has, each time with a
HIGHER = 10.0            # barrier so much higher
WORTH_IT = 1e-3          # a stretch longer than this is better mended by planning again,
PATIENCE = 4             # after so many rounds one of twice as much, and so on
BEGINNINGS = 60          # segments that are begun from rest again, in all
POOR = 1e-2              # relative gap of what is solved again
RESTARTS = 8             # from the best that was found, where it is not the optimum
SLOWER = (1e-6, 0.02)    # than it, first by just enough to be within its limits


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
        free = replace(task, limits=replace(task.limits, max_effort=np.full(3, np.inf)))
        found = mended(free, grid, freedom, rest_to_rest, floor)
        task.should_stop()
        if found is not None and torque_fits(task, found.trajectory):
            better = _bettered(free, grid, freedom, found, floor)
            return better if torque_fits(task, better.trajectory) else _bettered(
                task, grid, freedom, found, floor)
    found = mended(task, grid, freedom, rest_to_rest, floor)
    return None if found is None else _bettered(task, grid, freedom, found, floor)


def _bettered(task: JointTask, grid: Grid, freedom: Freedom, solved: Solved,
              floor: Array | None) -> Solved:
    """Return what is found by solving again from the best so far, until it is the optimum."""
    tries = list(SLOWER)
    for _ in range(RESTARTS):
        if not tries or solved.gap < POOR * solved.cost or task.should_stop():
            break
        again = _solved_from(task, grid, freedom, solved, floor, tries[0])
        if again is None or again.cost > (1.0 - WORTH_IT) * solved.cost:
            tries.pop(0)
        solved = min((s for s in (solved, again) if s is not None), key=lambda s: s.cost)
    return solved


def _solved_from(task: JointTask, grid: Grid, freedom: Freedom, solved: Solved,
                 floor: Array | None, slower: float) -> Solved | None:
    """
    Return what is found from a motion that keeps every limit on, run through a part slower.

    It may leave room where a motion with stops at the via points has none: at the ends of ranges,
    and between two points that are close together.
    """
    factor = (1.0 + slower) * solved.cost / freedom.cost(solved.motion.T)
    start = stretched(solved.motion, factor)
    return mended(task, grid, freedom, lambda planned, constraints: start, floor)


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
    approaches, beginnings = 0, BEGINNINGS
    tried: list[tuple[Outcome, Motion]] = []  # what was found, from which start
    for repair in range(REPAIRS):
        task.should_stop()
        worth_it = WORTH_IT * 2.0 ** max(repair - PATIENCE, 0)
        asked, constraints = room, room.constraints(task, grid, floor)
        start = _last_within(constraints, centres)
        if start is None and centres and approaches < APPROACHES:
            nearer = _nearer(task, grid, room, floor, centres, freedom, HIGHER ** approaches)
            if nearer:
                centres += nearer
                approaches += 1
                continue
        approaches = 0
        if start is None:
            begun = _begun(task, grid, room, floor, begin)
            if begun is None:
                break
            room, constraints, start = begun
        slow = slow or start.motion
        outcome = minimise(constraints, start, freedom._replace(still=room.still),
                           task.should_stop)
        task.should_stop()
        look = Look(task, grid, outcome.motion)
        if look.stretch() <= 1.0 + worth_it and not look.beyond_range.any():
            task.should_stop()
            fits = _fitting(task, grid, freedom, outcome, outcome.motion)
            if fits is not None and fits.cost <= (1.0 + worth_it) * freedom.cost(
                    outcome.motion.T):
                return fits
        tried.append((outcome, start.motion))
        if task.should_stop():
            found = _best_that_fits(task, grid, freedom, tried)
            if found is not None:
                return found
        room = room.grown(task, grid, slow, look)
        # where ranges are left it takes another course, not a nearby one
        if look.beyond_range.any() and beginnings >= len(freedom.free):
            centres, beginnings = [], beginnings - len(freedom.free)
        else:
            centres = centres + outcome.centres
        if not centres and room.is_same(asked):
            break  # the same again
    return _best_that_fits(task, grid, freedom, tried)


def _last_within(constraints: Constraints, centres: list[Centre]) -> Centre | None:
    return next((c for c in reversed(centres) if is_within(constraints, c.motion)), None)


def _nearer(task: JointTask, grid: Grid, room: Room, floor: Array | None,
            centres: list[Centre], freedom: Freedom, higher: float) -> list[Centre]:
    """
    Return centres nearer to the room where no other has all of it, but one has some.

    The higher their barrier, the further they are from all limits.
    """
    for part in PARTS_OF_ROOM[1:]:
        constraints = room.part(part).constraints(task, grid, floor)
        centre = _last_within(constraints, centres)
        if centre is not None:
            barrier = None if centre.barrier is None else higher * centre.barrier
            return minimise(constraints, Centre(centre.motion, barrier),
                            freedom._replace(still=room.still), task.should_stop,
                            barrier or 0.0).centres
    return []


def _begun(task: JointTask, grid: Grid, room: Room, floor: Array | None,
           begin: Begin) -> tuple[Room, Constraints, Centre] | None:
    """Return a motion to begin with, and as much of the room as it has."""
    for part in (*PARTS_OF_ROOM, 0.0):
        reduced = room.kept().part(part)
        constraints = reduced.constraints(task, grid, floor)
        motion = begin(task, constraints)
        if motion is None:
            return None
        if is_within(constraints, motion):
            return reduced, constraints, Centre(motion, None)
    return None


def _best_that_fits(task: JointTask, grid: Grid, freedom: Freedom,
                    tried: list[tuple[Outcome, Motion]]) -> Solved | None:
    """Return the fastest of outcomes and centres that keeps every limit, as it is or slowed."""
    best: Solved | None = None
    for outcome, start in sorted(tried, key=lambda t: freedom.cost(t[0].motion.T)):
        for motion in (outcome.motion, *(c.motion for c in reversed(outcome.centres)), start):
            cost = freedom.cost(motion.T)
            if best is not None and best.cost <= cost:
                break
            task.should_stop()
            fits = _fitting(task, grid, freedom, outcome, motion)
            if fits is not None and (best is None or fits.cost < best.cost):
                best = fits
    return best


def _fitting(task: JointTask, grid: Grid, freedom: Freedom, outcome: Outcome,
             motion: Motion) -> Solved | None:
    """Return a motion slowed until it keeps every limit, None where that cannot be."""
    may_stretch = bool((freedom.free | (freedom.tie > 0.0)).all())
    trajectory = fitted(task, grid.trajectory(task.points, motion), may_stretch)
    if trajectory is None:
        return None
    cost = freedom.cost(np.diff(trajectory.via_times))
    return Solved(trajectory, motion, cost,
                  outcome.gap + cost - freedom.cost(outcome.motion.T))
