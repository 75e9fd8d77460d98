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

"""Splines whose durations, all or some, are prescribed."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.errors import TimingError
from rrr_traj_planner.planners.joint_timing.constraints import JointConstraints
from rrr_traj_planner.planners.joint_timing.least_time import fastest
from rrr_traj_planner.planners.joint_timing.meshing import meshed
from rrr_traj_planner.planners.joint_timing.problem import (
    brought_within,
    JointProblem,
    Solved,
)
from rrr_traj_planner.planners.joint_timing.start import rest_to_rest, with_durations
from rrr_traj_planner.planners.joint_timing.tightening import tightened
from rrr_traj_planner.planners.joint_timing.within_limits import fitted, torque_fits
from rrr_traj_planner.planners.short_durations import durations_too_short, least_feasible
from rrr_traj_planner.planners.solver.limits import DurationConstraints, fixed_ends
from rrr_traj_planner.planners.solver.splines import Mesh, time_scaled, Variables
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.tolerances import DURATION_TOLERANCE

# Chosen values, without unit: half and twice of LEAST_SCALING, and of LEAST_REDUCTION's excess
# over 1, change peak accelerations of 11 random tasks by 0.01 % in the mean, by 0.1 % at most.
LEAST_SCALING = 0.2     # of prescribed durations, down to which the problem is solved
SLOWER = 1e-5           # part by which the fastest motion is slowed to start from
FREE_WEIGHT = 1e-3      # of free durations while the scaling of the prescribed is minimised
LEAST_REDUCTION = 1.02  # factor on peak acceleration that justifies another round


class PrescribedProblem(NamedTuple):
    """Via points and limits, the family of motions, and prescribed durations."""

    task: JointTask
    mesh: Mesh
    durations: Array  # [s], NaN where free

    @property
    def free(self) -> BoolArray:
        """Return which durations are free."""
        return np.isnan(self.durations)

    def problem(self, proportions: Array, weights: Array,
                least_T: Array | None = None) -> JointProblem:
        """
        Return the problem of least weighted durations.

        Parameters
        ----------
        proportions : ndarray, shape (N,)
            Durations with a common factor [s], 0 where fixed or free.
        weights : ndarray, shape (N,)
            Of the durations in the sum that is minimised.
        least_T : ndarray, shape (N,), optional
            Least durations of the segments [s].

        Returns
        -------
        JointProblem
            Of motions that need not stop at any via point.

        """
        return JointProblem(self.task, self.mesh, DurationConstraints(
            self.free, proportions, weights, fixed_ends(len(self.durations), 3)), least_T)

    def scaling(self, solved: Solved) -> float:
        """
        Return the largest ratio of a motion's durations to the prescribed ones.

        Parameters
        ----------
        solved : Solved
            The motion.

        Returns
        -------
        float
            Without unit.

        """
        return float(np.nanmax(np.diff(solved.trajectory.via_times) / self.durations))

    def is_met_by(self, solved: Solved | None) -> bool:
        """
        Return whether a motion is as fast as prescribed.

        Parameters
        ----------
        solved : Solved or None
            The motion, if there is one.

        Returns
        -------
        bool
            Whether there is one, and its scaling is at most 1.

        """
        return solved is not None and self.scaling(solved) <= 1.0 + DURATION_TOLERANCE


def prescribed(task: JointTask, mesh: Mesh, durations: Array) -> Solved | None:
    """
    Return a motion of prescribed durations.

    If all durations are prescribed, the motion of least peak acceleration, relative to the limits;
    if some are free, the fastest.

    Parameters
    ----------
    task : JointTask
        The via points, the arm and its limits.
    mesh : Mesh
        Its n intervals in each segment.
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
    ConvergenceError
        If they are too short, and no feasible ones are found.

    """
    problem = PrescribedProblem(task, mesh, durations)
    solved = _least_scaled(problem)
    if solved is None:
        return None
    if not problem.is_met_by(solved):
        own = fastest(task, mesh)
        solved = None if own is None else _from_own(problem, own)
        if solved is None or not problem.is_met_by(solved):
            raise _too_short(problem, own)
    if problem.free.any():
        return _fastest_of_free(problem, solved)
    return _least_peak_acceleration(problem, solved)


def _least_scaled(problem: PrescribedProblem) -> Solved | None:
    """Return the motion with the least common factor on the prescribed durations."""
    durations, free = problem.durations, problem.free

    def initial_motion(planned: JointTask, constraints: JointConstraints) -> Variables | None:
        m = rest_to_rest(planned, constraints)
        if m is None:
            return None
        scaling = float((m.T / durations)[~free].max())
        return with_durations(m, np.where(free, m.T, scaling * durations))

    refined, start = meshed(_scaled(problem), initial_motion)
    return tightened(refined, start, initial_motion)


def _scaled(problem: PrescribedProblem) -> JointProblem:
    """Return the problem of the least common factor on the prescribed durations."""
    durations, free = problem.durations, problem.free
    proportions = np.where(free, 0.0, durations)
    weights = np.where(free, FREE_WEIGHT, 1.0 / np.where(free, 1.0, durations) / (~free).sum())
    return problem.problem(proportions, weights, LEAST_SCALING * proportions)


def _from_own(problem: PrescribedProblem, own: Solved) -> Solved | None:
    """
    Return the motion with the least common factor that is found from the fastest motion, slowed.

    Slow motions with stops may not lead there: near the ends of ranges, and between via points
    that are close together. None where the fastest motion's durations are longer.
    """
    durations, free = problem.durations, problem.free
    if (np.abs(np.diff(own.trajectory.via_times) / durations - 1.0) <= DURATION_TOLERANCE)[
            ~free].all():
        return own  # such as durations that are those of a plan
    ratios = (own.motion.T / durations)[~free]
    least = float(ratios.max()) * (1.0 + SLOWER)
    if not least <= 1.0:
        return None
    slower = time_scaled(own.motion, float(np.median(least / ratios)))
    start = own.mesh.restored(problem.task.points, slower._replace(
        T=np.where(free, slower.T, least * durations)))
    scaled = _scaled(problem._replace(mesh=own.mesh))
    found = tightened(scaled, lambda planned, constraints: brought_within(
        constraints, start, scaled.durations, planned.should_stop))
    slowed = fitted(problem.task, own.mesh.trajectory(problem.task.points, start), True)
    if slowed is None:
        return found
    cost = scaled.durations.cost(np.diff(slowed.via_times))
    kept = Solved(slowed, start, own.mesh, cost, own.gap)
    return kept if found is None or cost < found.cost else found


def _in_time(problem: PrescribedProblem, found: list[Solved]) -> Solved | None:
    """
    Return the first of several motions that keeps its limits when slowed to the exact durations.

    A motion may pass fast through a pose that the motors cannot hold, but not more slowly. If all
    do, the motion that stops at every via point is returned: its path is statically feasible.
    """
    for solved in found:
        slower = solved.trajectory.time_scaled(1.0 / problem.scaling(solved))
        if torque_fits(problem.task, slower):
            return solved._replace(trajectory=slower)
    return _stopping(problem)


def _stopping(problem: PrescribedProblem) -> Solved | None:
    """Return the motion that stops at every via point; None where none is found."""
    task, mesh, durations = problem
    segments = len(durations)
    stops = JointProblem(task, mesh, DurationConstraints.all_free(segments, 3))
    motion = rest_to_rest(task, stops.without_margins)
    if motion is None:
        return None
    T = np.where(problem.free, motion.T, durations)
    if (motion.T > T).any():
        raise durations_too_short(durations, np.maximum(T, motion.T))
    return Solved(mesh.trajectory(task.points, with_durations(motion, T)), motion,
                  mesh, float(T.sum()), np.inf)


def _least_peak_acceleration(problem: PrescribedProblem, solved: Solved) -> Solved | None:
    """
    Return the motion of least peak acceleration over its limit.

    A motion that is faster than prescribed, slowed to its durations, satisfies lower acceleration
    limits; the problem is solved again under those until the durations are just met.
    """
    task = problem.task
    limit = np.minimum(task.limits.max_acceleration, solved.trajectory.peaks().acceleration.max())
    found = [solved]  # of least acceleration first
    for _ in range(12):  # at most; chosen
        task.should_stop()
        z = problem.scaling(found[0])
        if z ** 2 > 1.0 / LEAST_REDUCTION:
            break
        limit = limit * z ** 2
        again = _least_scaled(problem._replace(task=replace(
            task, limits=replace(task.limits, max_acceleration=limit))))
        if again is None or not problem.is_met_by(again):
            break
        found.insert(0, again)
    return _in_time(problem, found)


def _fastest_of_free(problem: PrescribedProblem, solved: Solved) -> Solved | None:
    """Return the motion with the least sum of free durations, the others as prescribed."""
    free, durations = problem.free, problem.durations
    problem, m = problem._replace(mesh=solved.mesh), solved.motion
    m = time_scaled(m, float(1.0 / np.nanmax(m.T / durations)))
    start = problem.mesh.restored(
        problem.task.points, m._replace(T=np.where(free, m.T, durations)))
    fastest_of = problem.problem(np.zeros(len(free)), free.astype(float))
    given = fastest_of.mesh
    found = tightened(*meshed(fastest_of, lambda _, within: (
        start if within.mesh is given else None)))
    return found if problem.is_met_by(found) else _in_time(problem, [solved])


def _too_short(problem: PrescribedProblem, own: Solved | None) -> TimingError:
    """Return the error of prescribed durations that are too short, with feasible ones."""
    durations, least_T = problem.durations, np.nan_to_num(problem.durations)
    found = fastest(problem.task, problem.mesh, least_T)
    least = np.maximum(np.diff(found.trajectory.via_times), least_T) if found else least_T

    def is_feasible(T: Array) -> bool:
        longer = problem._replace(durations=T)
        return longer.is_met_by(_least_scaled(longer)) or (
            own is not None and longer.is_met_by(_from_own(longer, own)))

    return durations_too_short(
        durations, least_feasible(durations, [least], is_feasible))
