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
The fastest motion along a given path (Bobrow, Dubowsky & Gibson 1985; Shin & McKay 1985).

The method is that of `time_optimal`, direct transcription and an interior-point method, with one
coordinate, the path length s, instead of the joints: its acceleration is a sequence of ramps, the
pieces of the path are its segments, and the joints' limits are functions of s, sd, sdd and sddd.
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
    least_time_scale,
)
from rrr_traj_planner.planners.path_timing.initial_speeds import initial_speeds_of
from rrr_traj_planner.planners.path_timing.start import motion_with_speeds, uniform_along
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

# Without unit.
MOST_RAMPS, FEWEST_RAMPS = 16, 8  # in a piece of the path: the most for up to
PIECES, RAMP_EXPONENT = 11, 2.0   # so many pieces, beyond fewer by this power of their number
DURATION_MARGIN = 1.02  # durations of the start / least durations: it is strictly feasible
HOLDING_MARGIN = 1e-6   # part of the effort limits that gravity must leave along the path
ROUNDS = 8              # of solving with larger margins, at most
WORTH_IT = 2e-3         # part by which a motion is slowed rather than solved again,
PATIENCE = 1            # after so many rounds multiplied in each round by
WORTH_IT_GROWTH = 1.7
ROUGH_GAP = 0.3         # part of the total time: the gap to which the first round converges
CENTRES_BACK = 3        # which of the last centres a round with larger margins starts from


class PathTask(NamedTuple):
    """A path and the limits of the motion along it."""

    arm_path: ArmPath
    limits: JointLimits
    cruise: float                      # part of a ramp during which the change of sdd is constant
    max_tip_speed: float               # [m/s], infinite: none
    steady_zones: bool                 # whether the tip keeps its speed on curved zones (5.58)
    should_stop: Callable[[], bool]


class Timed(NamedTuple):
    """A motion along a path, and its gap to the optimum."""

    trajectory: PathTrajectory
    gap: float  # bound on the time that the fastest motion saves [s]


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
        Within every limit, between the problem's points too.

    Raises
    ------
    LimitViolationError
        If the motors cannot hold the arm somewhere on the path; with the position.

    """
    return fitted(task, nearly_fastest_along(task))


def nearly_fastest_along(task: PathTask) -> Timed:
    """
    Return the fastest motion along a path, by the path's table.

    Parameters
    ----------
    task : PathTask
        Path and limits.

    Returns
    -------
    Timed
        Within the limits but for the table's interpolation error.

    Raises
    ------
    LimitViolationError
        If the motors cannot hold the arm somewhere on the path; with the position.

    """
    task.should_stop()
    table = PathTable(task.arm_path)
    task.should_stop()
    N = len(table.ends) - 1
    grid = grid_of(_ramps(N), task.cruise)
    bounds = all_bounds(task.limits, task.max_tip_speed)
    _check_held(task, table)
    durations = DurationConstraints.all_free(N, 1)
    steady = _in_zones(task, table) if task.steady_zones else np.zeros(N, bool)

    workspace = Workspace()

    def limits(margins: Array) -> PathConstraints:
        return PathConstraints(
            table, task.limits, task.max_tip_speed, grid, margins, steady, workspace)

    task.should_stop()
    constraints, previous = limits(np.zeros((N, 2 * grid.n + 1, QUANTITIES))), None
    start = Centre(_slow_start(task, table, constraints, steady), None)
    found = [(float(start.motion.T.sum()), start.motion, -np.inf)]  # no motion takes less than
    task.should_stop()
    for round_ in range(ROUNDS if constraints.problem.is_within(start.motion) else 0):
        outcome = minimise(constraints.problem, start, durations, task.should_stop,
                           previous=previous.problem if previous else None,
                           relative_gap=RELATIVE_GAP if previous else ROUGH_GAP)
        if previous and not outcome.within:  # margins were enlarged too much at once
            constraints = limits(0.5 * (previous.margins + constraints.margins))
            continue
        task.should_stop()
        outcome, check = _last_forward(outcome, start, constraints.problem, bounds)
        found.append(_slowed(outcome, check.time_scale))
        worth_it = WORTH_IT * WORTH_IT_GROWTH ** max(round_ - PATIENCE, 0)
        fits = previous and check.time_scale <= 1.0 + worth_it
        if fits or task.should_stop() or not outcome.centres:
            break
        start = outcome.centres[-CENTRES_BACK if previous else -1:][0]
        previous, constraints = constraints, limits(constraints.margins + check.excess)
    task.should_stop()
    T, motion, _ = min(found, key=lambda f: f[0])
    least = max(least for *_, least in found)
    return Timed(_trajectory(task, table, grid, motion), max(T - least, 0.0))


def _ramps(pieces: int) -> int:
    """Return the number of ramps in a piece."""
    return max(int(MOST_RAMPS * min(PIECES / pieces, 1.0) ** RAMP_EXPONENT), FEWEST_RAMPS)


def fitted(task: PathTask, timed: Timed) -> Timed:
    """
    Return a motion slowed until it keeps its limits exactly, by its own peaks, not the table's.

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
    factor = _exact_time_scale(task, timed.trajectory)
    return timed if factor <= 1.0 else timed._replace(
        trajectory=timed.trajectory.time_scaled(factor))


def _in_zones(task: PathTask, table: PathTable) -> BoolArray:
    """Return which pieces are in curved zones; not the first and the last, which touch rest."""
    middle = 0.5 * (table.ends[1:] + table.ends[:-1])[:, np.newaxis]
    begin, end = task.arm_path.path.zone_ends.T
    inside = ((middle > begin) & (middle < end)).any(axis=1)
    inside[[0, -1]] = False
    return np.asarray(inside)


def _last_forward(outcome: Outcome, start: Centre, problem: TimingProblem,
                  bounds: Array) -> tuple[Outcome, DenseCheck]:
    """Return the last motion on which the tip never moves backward, as when cancelled it may."""
    passed = (outcome.motion, *(c.motion for c in reversed(outcome.centres)), start.motion)
    for motion in passed:
        check = dense_check(problem, motion, bounds)
        if check.is_forward:
            break
    lost = float(motion.T.sum() - outcome.motion.T.sum())
    return outcome._replace(motion=motion, gap=outcome.gap + lost), check


def _slowed(outcome: Outcome, time_scale: float) -> tuple[float, Variables, float]:
    """Return the duration of a motion slowed to its limits, the motion, and a lower bound."""
    T, factor = float(outcome.motion.T.sum()), max(time_scale, 1.0)
    return factor * T, time_scaled(outcome.motion, factor), T - outcome.gap


def _check_held(task: PathTask, table: PathTable) -> None:
    """Raise an error if gravity's torque exceeds an effort limit along the path."""
    share = np.abs(table.values.g) / task.limits.max_effort
    piece, place, joint = map(int, np.unravel_index(int(share.argmax()), share.shape))
    if share.max() < 1.0 - HOLDING_MARGIN:
        return
    needed, limit = (float(f) for f in (
        abs(table.values.g[piece, place, joint]), task.limits.max_effort[joint]))
    where, nearest = place_on_path(task.arm_path.path, float(table.places[piece, place]))
    name = task.arm_path.model.joint_names[joint]
    raise holding_error(f'{where}:', name, needed, limit, nearest)


def _slow_start(task: PathTask, table: PathTable, constraints: PathConstraints,
                steady: BoolArray) -> Variables:
    """Return a feasible motion to start from, of constant speed if any piece is to have it."""
    grid, bounds = constraints.grid, all_bounds(task.limits, task.max_tip_speed)
    if steady.any():
        m = uniform_along(grid, table.ends)
    else:
        m = motion_with_speeds(grid, table.ends, initial_speeds_of(table, bounds))
    at = progress_at(grid, constraints.points, m)
    return time_scaled(m, DURATION_MARGIN * least_time_scale(
        constraints.terms(at.s), at, bounds - constraints.margins))


def _exact_time_scale(task: PathTask, trajectory: PathTrajectory) -> float:
    """Return the least factor on all times with which limits hold, by the motion's own peaks."""
    limits = task.limits
    peaks, speed = trajectory.peaks(), trajectory.peak_speed
    task.should_stop()
    torque = time_scale_for_torque(task.arm_path.model, limits, trajectory).value
    task.should_stop()
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
