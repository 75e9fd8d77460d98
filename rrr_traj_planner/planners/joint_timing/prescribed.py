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

"""Motions of ramps whose durations, all or some, are prescribed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.errors import TimingError
from rrr_traj_planner.planners.joint_timing.constraints import JointConstraints
from rrr_traj_planner.planners.joint_timing.least_time import fastest
from rrr_traj_planner.planners.joint_timing.margins import Margins
from rrr_traj_planner.planners.joint_timing.problem import JointProblem, Solved
from rrr_traj_planner.planners.joint_timing.start import rest_to_rest
from rrr_traj_planner.planners.joint_timing.tightening import tightened
from rrr_traj_planner.planners.joint_timing.within_limits import torque_fits
from rrr_traj_planner.planners.short_durations import durations_too_short, whole_microseconds
from rrr_traj_planner.planners.solver.limits import DurationConstraints
from rrr_traj_planner.planners.solver.ramps import Grid, Variables, with_durations
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.tolerances import DURATION_TOLERANCE

# Chosen values, without unit: half and twice of LEAST_SCALING, and of LEAST_REDUCTION's excess
# over 1, change peak accelerations of 11 random tasks by 0.01 % in the mean, by 0.1 % at most.
LEAST_SCALING = 0.2     # of prescribed durations, down to which the problem is solved
FREE_WEIGHT = 1e-3      # of free durations while the scaling of the prescribed is minimised
LEAST_REDUCTION = 1.02  # factor on peak acceleration that justifies another round
# Tried in turn on top of the least durations until they can be prescribed.
OFFER_MARGINS = (0.0, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1)


def prescribed(task: JointTask, grid: Grid, durations: Array) -> Solved | None:
    """
    Return a motion of prescribed durations.

    If all durations are prescribed, the motion of least peak acceleration, relative to the limits;
    if some are free, the fastest.

    Parameters
    ----------
    task : JointTask
        The via points, the arm and its limits.
    grid : Grid
        Discretisation: n ramps per segment.
    durations : ndarray, shape (N,)
        [s], NaN where free.

    Returns
    -------
    Solved or None
        None where no path is found along which the motors can hold the arm.

    Raises
    ------
    TimingError
        If the durations are too short; with feasible ones.

    """
    solved = _least_scaled(task, grid, durations)
    if solved is None:
        return None
    if _scaling(solved, durations) > 1.0 + DURATION_TOLERANCE:
        raise _too_short(task, grid, durations)
    if np.isnan(durations).any():
        return _fastest_of_free(task, grid, durations, solved)
    return _least_peak_acceleration(task, grid, durations, solved)


def _least_scaled(task: JointTask, grid: Grid, durations: Array) -> Solved | None:
    """Return the motion with the least common factor on the prescribed durations."""
    free = np.isnan(durations)
    proportions = np.where(free, 0.0, durations)
    weights = np.where(free, FREE_WEIGHT, 1.0 / np.where(free, 1.0, durations) / (~free).sum())

    def initial_motion(planned: JointTask, constraints: JointConstraints) -> Variables | None:
        m = rest_to_rest(planned, constraints)
        if m is None:
            return None
        scaling = float((m.T / durations)[~free].max())
        return with_durations(m, np.where(free, m.T, scaling * proportions))

    constraints = DurationConstraints(free, proportions, weights, _no_stops(durations))
    return tightened(JointProblem(task, grid, constraints, LEAST_SCALING * proportions),
                     initial_motion)


def _scaling(solved: Solved, durations: Array) -> float:
    """Return the largest ratio of a motion's durations to the prescribed ones."""
    return float(np.nanmax(np.diff(solved.trajectory.via_times) / durations))


def _in_time(task: JointTask, grid: Grid, durations: Array, found: list[Solved]) -> Solved | None:
    """
    Return the first of several motions that keeps its limits when slowed to the exact durations.

    A motion may pass fast through a pose that the motors cannot hold, but not more slowly. If all
    do, the motion that stops at every via point is returned: its path is statically feasible.
    """
    for solved in found:
        slower = solved.trajectory.time_scaled(1.0 / _scaling(solved, durations))
        if torque_fits(task, slower):
            return solved._replace(trajectory=slower)
    segments = len(durations)
    problem = JointProblem(task, grid, DurationConstraints.all_free(segments, 3))
    motion = rest_to_rest(task, problem.constraints(Margins.none(grid, segments)))
    if motion is None:
        return None
    T = np.where(np.isnan(durations), motion.T, durations)
    if (motion.T > T).any():
        raise durations_too_short(durations, np.maximum(T, motion.T))
    return Solved(grid.trajectory(task.points, with_durations(motion, T)), motion,
                  float(T.sum()), np.inf)


def _least_peak_acceleration(task: JointTask, grid: Grid, durations: Array,
                             solved: Solved) -> Solved | None:
    """
    Return the motion of least peak acceleration over its limit.

    A motion that is faster than prescribed, slowed to its durations, satisfies lower acceleration
    limits; the problem is solved again under those until the durations are just met.
    """
    limit = np.minimum(task.limits.max_acceleration, solved.trajectory.peaks().acceleration.max())
    found = [solved]  # of least acceleration first
    for _ in range(12):  # at most; chosen
        task.should_stop()
        z = _scaling(solved, durations)
        if z ** 2 > 1.0 / LEAST_REDUCTION:
            break
        limit = limit * z ** 2
        lower = replace(task, limits=replace(task.limits, max_acceleration=limit))
        again = _least_scaled(lower, grid, durations)
        if again is None or _scaling(again, durations) > 1.0 + DURATION_TOLERANCE:
            break
        solved = again
        found.insert(0, solved)
    return _in_time(task, grid, durations, found)


def _fastest_of_free(task: JointTask, grid: Grid, durations: Array,
                     solved: Solved) -> Solved | None:
    """Return the motion with the least sum of free durations, the others as prescribed."""
    free, z = np.isnan(durations), _scaling(solved, durations)
    m = solved.motion
    z = float(np.nanmax(m.T / durations))
    start = grid.restored(task.points, Variables(
        m.inner * z ** 2, m.v * z, m.a * z ** 2, np.where(free, m.T / z, durations)))
    constraints = DurationConstraints(free, np.zeros(len(free)), free.astype(float),
                                      _no_stops(durations))
    found = tightened(JointProblem(task, grid, constraints), lambda planned, _: start)
    if found is None or _scaling(found, durations) > 1.0 + DURATION_TOLERANCE:
        return _in_time(task, grid, durations, [solved])
    return found


def _no_stops(durations: Array) -> BoolArray:
    return np.zeros((len(durations) - 1, 3), dtype=bool)


def _too_short(task: JointTask, grid: Grid, durations: Array) -> TimingError:
    """Return the error of prescribed durations that are too short, with feasible ones."""
    least_T = np.nan_to_num(durations)
    found = fastest(task, grid, least_T)
    least = np.maximum(np.diff(found.trajectory.via_times), least_T) if found else least_T
    for margin in OFFER_MARGINS:
        feasible = whole_microseconds(least * (1.0 + margin))
        solved = _least_scaled(task, grid, feasible)
        if solved is not None and _scaling(solved, feasible) <= 1.0 + DURATION_TOLERANCE:
            break
    return durations_too_short(durations, feasible)
