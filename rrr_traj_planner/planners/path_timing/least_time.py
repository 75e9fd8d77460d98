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

"""
The fastest motion along a given path: its progress is a sequence of ramps.

One coordinate, the length behind the tip, takes the place of the joints in the method of
`time_optimal`: pieces of the path are its segments, and what the joints may do bounds it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.path.path_trajectory import ArmPath, PathTrajectory
from rrr_traj_planner.core.path.workspace_check import place_on_path
from rrr_traj_planner.core.trajectory.torque import time_scale_for_torque
from rrr_traj_planner.planners.path_timing.constraints import (
    all_bounds,
    PathConstraints,
    progress_at,
    QUANTITIES,
)
from rrr_traj_planner.planners.path_timing.dense_check import (
    dense_check,
    DenseCheck,
    least_stretch,
)
from rrr_traj_planner.planners.path_timing.initial_speeds import paces
from rrr_traj_planner.planners.path_timing.start import paced_along, uniform_along
from rrr_traj_planner.planners.path_timing.table import PathTable
from rrr_traj_planner.planners.solver.interior_point import (
    Centre,
    minimise,
    Outcome,
    RELATIVE_GAP,
)
from rrr_traj_planner.planners.solver.limits import DurationConstraints
from rrr_traj_planner.planners.solver.ramps import Grid, grid_of, time_scaled, Variables
from rrr_traj_planner.planners.solver.timing_problem import TimingProblem, Workspace
from rrr_traj_planner.planners.via_points import holding_error

MOST_RAMPS, FEWEST_RAMPS = 16, 8  # in a piece of the path: the most up to so many pieces,
PIECES, SPARING = 11, 2.0         # and for more fewer, by this power of their number
ROOM = 1.02        # durations of the start over the least that fit
HOLDING_ROOM = 1e-6
REPAIRS = 8
WORTH_IT = 2e-3    # a longer stretch than this is better mended by planning again
PATIENCE = 1       # times after which it is worth less, again each time:
LESS_WORTH = 1.7   # so many times a longer stretch is left as it is
ROUGH_GAP = 0.3    # of the total time, at which what the first motion exceeds is looked at
NEARER = 3         # centres before the last, from which limits are approached that are closer


class PathTask(NamedTuple):
    """A path and the limits on the way along it."""

    arm_path: ArmPath
    limits: JointLimits
    cruise: float                      # part of a ramp during which the change of sdd is constant
    max_tip_speed: float               # [m/s], infinite: none
    steady_zones: bool                 # whether the tip keeps its speed on curved zones (5.58)
    should_stop: Callable[[], bool]


class Timed(NamedTuple):
    """A motion along a path, and how far it may be from the fastest."""

    trajectory: PathTrajectory
    gap: float  # [s]


def fastest_along(task: PathTask) -> Timed:
    """
    Return the fastest motion along a path, from rest to rest.

    Parameters
    ----------
    task : PathTask
        Path and limits.

    Returns
    -------
    Timed
        Within every limit, between the points that are looked at too.

    Raises
    ------
    LimitViolationError
        If the motors cannot hold the arm somewhere on the path; with the place.

    """
    return kept(task, nearly_fastest_along(task))


def nearly_fastest_along(task: PathTask) -> Timed:
    """
    Return the fastest motion along a path as a table of the path has it.

    Parameters
    ----------
    task : PathTask
        Path and limits.

    Returns
    -------
    Timed
        Within limits but for what the table's interpolation leaves.

    Raises
    ------
    LimitViolationError
        If the motors cannot hold the arm somewhere on the path; with the place.

    """
    task.should_stop()
    table = PathTable(task.arm_path)
    task.should_stop()
    N = len(table.ends) - 1
    grid = grid_of(_ramps(N), task.cruise)
    bounds = all_bounds(task.limits, task.max_tip_speed)
    _refuse_heavy(task, table)
    durations = DurationConstraints.all_free(N, 1)
    steady = _in_zones(task, table) if task.steady_zones else np.zeros(N, bool)

    workspace = Workspace()

    def limits(margins: Array) -> PathConstraints:
        return PathConstraints(
            table, task.limits, task.max_tip_speed, grid, margins, steady, workspace)

    task.should_stop()
    constraints, former = limits(np.zeros((N, 2 * grid.n + 1, QUANTITIES))), None
    start = Centre(_slow_start(task, table, constraints, steady), None)
    found = [(float(start.motion.T.sum()), start.motion, -np.inf)]  # no motion takes less than
    task.should_stop()
    for repair in range(REPAIRS if constraints.problem.is_within(start.motion) else 0):
        outcome = minimise(constraints.problem, start, durations, task.should_stop,
                           previous=former.problem if former else None,
                           relative_gap=RELATIVE_GAP if former else ROUGH_GAP)
        if former and not outcome.within:  # it was too much at once
            constraints = limits(0.5 * (former.margins + constraints.margins))
            continue
        task.should_stop()
        outcome, seen = _onward(outcome, start, constraints.problem, bounds)
        found.append(_slowed(outcome, seen.stretch))
        worth_it = WORTH_IT * LESS_WORTH ** max(repair - PATIENCE, 0)
        if former and seen.stretch <= 1.0 + worth_it or task.should_stop() or not outcome.centres:
            break
        start = outcome.centres[-NEARER if former else -1:][0]
        former, constraints = constraints, limits(constraints.margins + seen.excess)
    task.should_stop()
    T, motion, _ = min(found, key=lambda f: f[0])
    least = max(least for *_, least in found)
    return Timed(_trajectory(task, table, grid, motion), max(T - least, 0.0))


def _ramps(pieces: int) -> int:
    """Return in how many ramps a piece is run through."""
    return max(int(MOST_RAMPS * min(PIECES / pieces, 1.0) ** SPARING), FEWEST_RAMPS)


def kept(task: PathTask, timed: Timed) -> Timed:
    """
    Return a motion slowed by what the table's interpolation leaves, measured exactly.

    Parameters
    ----------
    task : PathTask
        Path and limits.
    timed : Timed
        As of `nearly_fastest_along`.

    Returns
    -------
    Timed
        Within every limit.

    """
    task.should_stop()
    factor = _exact_stretch(task, timed.trajectory)
    return timed if factor <= 1.0 else timed._replace(
        trajectory=timed.trajectory.time_scaled(factor))


def _in_zones(task: PathTask, table: PathTable) -> BoolArray:
    """Return which pieces are in curved zones; not the first and the last, which have rest."""
    middle = 0.5 * (table.ends[1:] + table.ends[:-1])[:, np.newaxis]
    begin, end = task.arm_path.path.zone_ends.T
    inside = ((middle > begin) & (middle < end)).any(axis=1)
    inside[[0, -1]] = False
    return np.asarray(inside)


def _onward(outcome: Outcome, start: Centre, problem: TimingProblem,
            bounds: Array) -> tuple[Outcome, DenseCheck]:
    """Return the last motion on which the tip never goes back: one cut short may."""
    passed = (outcome.motion, *(c.motion for c in reversed(outcome.centres)), start.motion)
    for motion in passed:
        seen = dense_check(problem, motion, bounds)
        if seen.goes_on:
            break
    lost = float(motion.T.sum() - outcome.motion.T.sum())
    return outcome._replace(motion=motion, gap=outcome.gap + lost), seen


def _slowed(outcome: Outcome, stretch: float) -> tuple[float, Variables, float]:
    """Return a motion slowed to keep its limits, its duration and the least of any motion."""
    T, factor = float(outcome.motion.T.sum()), max(stretch, 1.0)
    return factor * T, time_scaled(outcome.motion, factor), T - outcome.gap


def _refuse_heavy(task: PathTask, table: PathTable) -> None:
    """Refuse a path on which gravity takes more than a motor has."""
    share = np.abs(table.values.g) / task.limits.max_effort
    piece, place, joint = map(int, np.unravel_index(int(share.argmax()), share.shape))
    if share.max() < 1.0 - HOLDING_ROOM:
        return
    needed, limit = (float(f) for f in (
        abs(table.values.g[piece, place, joint]), task.limits.max_effort[joint]))
    where, nearest = place_on_path(task.arm_path.path, float(table.places[piece, place]))
    name = task.arm_path.model.joint_names[joint]
    raise holding_error(f'{where}:', name, needed, limit, nearest)


def _slow_start(task: PathTask, table: PathTable, constraints: PathConstraints,
                steady: BoolArray) -> Variables:
    """Return a motion as slow as the limits ask for, of constant speed where pieces ask for it."""
    grid, bounds = constraints.grid, all_bounds(task.limits, task.max_tip_speed)
    if steady.any():
        m = uniform_along(grid, table.ends)
    else:
        m = paced_along(grid, table.ends, paces(table, bounds))
    at = progress_at(grid, constraints.points, m)
    return time_scaled(m, ROOM * least_stretch(
        constraints.demand(at.s), at, bounds - constraints.margins))


def _exact_stretch(task: PathTask, trajectory: PathTrajectory) -> float:
    """Return by how much a motion must be slowed, by its own values."""
    limits = task.limits
    peaks, speed = trajectory.peaks(), trajectory.peak_speed
    torque = time_scale_for_torque(task.arm_path.model, limits, trajectory).value
    return float(max((peaks.velocity / limits.max_velocity).max(), speed / task.max_tip_speed,
                     np.sqrt((peaks.acceleration / limits.max_acceleration).max()),
                     np.cbrt((peaks.jerk / limits.max_jerk).max()), torque.max()))


def _trajectory(task: PathTask, table: PathTable, grid: Grid, m: Variables) -> PathTrajectory:
    times = np.concatenate(([0.0], np.cumsum(m.T)))
    joins = np.searchsorted(table.ends, task.arm_path.path.joins)
    progress, = grid.profiles(table.ends[:, np.newaxis], m)
    via_times = np.concatenate((
        [0.0], progress.passed(task.arm_path.path.via_s[1:-1]), [progress.duration]))
    return PathTrajectory(task.arm_path, progress, via_times, times[joins])
