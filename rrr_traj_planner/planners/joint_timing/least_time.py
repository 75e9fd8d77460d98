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

"""The fastest motion of all joints, solved again from the best so far until it has converged."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.cancellation import until_found
from rrr_traj_planner.core.errors import StartStateError
from rrr_traj_planner.planners.joint_timing.from_motion import (
    after_a_stop,
    as_with_a_stop,
    from_motion,
)
from rrr_traj_planner.planners.joint_timing.meshing import meshed
from rrr_traj_planner.planners.joint_timing.pose_ahead import through_a_pose_ahead
from rrr_traj_planner.planners.joint_timing.problem import (
    InitialMotion,
    JointProblem,
    Solved,
)
from rrr_traj_planner.planners.joint_timing.start import rest_to_rest
from rrr_traj_planner.planners.joint_timing.tightening import SCHEDULE, tightened
from rrr_traj_planner.planners.joint_timing.within_limits import torque_fits
from rrr_traj_planner.planners.solver.limits import DurationConstraints
from rrr_traj_planner.planners.solver.refinement import halved, moved
from rrr_traj_planner.planners.solver.splines import Mesh, time_scaled, uniform_mesh
from rrr_traj_planner.planners.tasks import JointTask

# Restarts from the best motion so far. On 28 random tasks half and twice of each value change no
# duration: they matter on rarer tasks (see `_solved_from`).
POOR = 1e-2            # gap, as a part of the time, above which it is solved again
SLOWER = (1e-6, 0.02)  # part by which a restart is slower: first just strictly feasible; chosen


def fastest(task: JointTask, mesh: Mesh, least_T: Array | None = None) -> Solved | None:
    """
    Return the fastest motion.

    Where every joint has an acceleration limit the problem is first solved without torque limits,
    so that the joints are coupled through the durations only; often the result keeps them too.

    Parameters
    ----------
    task : JointTask
        The via points, the arm and its limits.
    mesh : Mesh
        Its n intervals in each segment.
    least_T : ndarray, shape (N,), optional
        Least durations of the segments [s].

    Returns
    -------
    Solved or None
        None where no path is found along which the motors can hold the arm.

    """
    if task.start_rates is None:
        return _fastest(JointProblem(task, mesh, DurationConstraints.all_free(
            len(task.points) - 1, 3), least_T), rest_to_rest)
    for own in (mesh, halved(mesh)):
        found = _straight_on(task, own, least_T)
        if found is not None:
            return found
        if ended_early := task.should_stop():
            break
    try:
        stops = after_a_stop(task, lambda from_rest: fastest(from_rest, mesh, least_T))
        if stops is None or task.should_stop():
            return stops
        found = _straight_on(task, mesh, least_T, partial(as_with_a_stop, stops.trajectory))
        return found if found is not None and found.cost < stops.cost else stops
    except StartStateError:
        patient = replace(task, should_stop=until_found(task.should_stop))
        tries = (task, patient) if ended_early else ()  # the first motion, or an optimised one
        again = filter(None, (_straight_on(t, mesh, least_T) for t in tries))
        found = next(again, None) or through_a_pose_ahead(task, lambda ahead: _straight_on(
            ahead, uniform_mesh(len(ahead.points) - 1, mesh.n)))
        if found is None:
            raise
        return found


def _straight_on(
        task: JointTask, mesh: Mesh, least_T: Array | None = None,
        start: Callable[[DurationConstraints], InitialMotion] = from_motion) -> Solved | None:
    """Return the fastest motion from a moving start that the first iterates lead to."""
    durations = DurationConstraints.all_free(len(task.points) - 1, 3).from_motion()
    return _fastest(JointProblem(task, mesh, durations, least_T), start(durations))


def _fastest(whole: JointProblem, start: InitialMotion) -> Solved | None:
    task = whole.task
    if np.isfinite(task.limits.max_acceleration).all():
        without_torque, first = meshed(_without_torque(whole), start)
        whole = replace(whole, mesh=without_torque.mesh)
        found = tightened(without_torque, first, start)
        task.should_stop()
        if found is None and np.isinf(task.limits.max_effort).all():
            return None
        if found is not None and torque_fits(task, found.trajectory):
            better = _refined(without_torque, found)
            return better if torque_fits(task, better.trajectory) else _refined(whole, found)
    whole, first = meshed(whole, start)
    found = tightened(whole, first, start)
    return None if found is None else _refined(whole, found)


def _without_torque(problem: JointProblem) -> JointProblem:
    limits = problem.task.limits
    if np.isinf(limits.max_effort).all():
        return problem
    unlimited = replace(limits, max_effort=np.full(3, np.inf))
    return replace(problem, task=replace(problem.task, limits=unlimited))


def _refined(problem: JointProblem, solved: Solved) -> Solved:
    """Return the best motion of repeated solutions, each from the best so far, until converged."""
    if not problem.durations.may_scale:
        return solved
    tries = [(slower, False) for slower in SLOWER] + [(SLOWER[0], True)]
    for _ in range(8):  # restarts, at most
        if not tries or solved.gap < POOR * solved.cost or problem.task.should_stop():
            break
        again = _solved_from(problem, solved, *tries[0])
        if again is None or again.cost > (1.0 - SCHEDULE.tolerance) * solved.cost:
            tries.pop(0)
        solved = min((s for s in (solved, again) if s is not None), key=lambda s: s.cost)
    return solved


def _solved_from(problem: JointProblem, solved: Solved, slower: float,
                 finer: bool) -> Solved | None:
    """
    Return the solution that starts from a motion within every limit, slowed by a part.

    Such a start can satisfy margins that a start with stops at the via points cannot: near the
    ends of ranges, and between via points that are close together. On a finer mesh, of twice as
    many intervals, less can be exceeded between the points.
    """
    mesh = halved(solved.mesh) if finer else solved.mesh
    problem = replace(problem, mesh=mesh)
    factor = (1.0 + slower) * solved.cost / problem.durations.cost(solved.motion.T)
    start = time_scaled(solved.motion, factor)
    if finer:
        start = moved(solved.mesh, mesh, problem.task.points, start)
    return tightened(problem, lambda planned, constraints: start)
