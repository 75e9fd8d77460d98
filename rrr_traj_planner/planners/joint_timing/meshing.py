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

"""Least-time problems of joint motions on a mesh that suits the motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.travel_time import ramp_time
from rrr_traj_planner.planners.joint_timing.constraints import JointConstraints
from rrr_traj_planner.planners.joint_timing.problem import (
    brought_within,
    InitialMotion,
    JointProblem,
)
from rrr_traj_planner.planners.solver.interior_point import CentralPathPoint, Outcome
from rrr_traj_planner.planners.solver.refinement import moved, refined
from rrr_traj_planner.planners.solver.segment_steps import take_own_steps
from rrr_traj_planner.planners.solver.splines import Mesh, time_scaled, Variables
from rrr_traj_planner.planners.tasks import JointTask

# Chosen values. A second refinement makes motions 0.2 % faster in the mean, a third 0.03 %, and
# jerk varies less. With rough gaps of 0.03 and less motions are slower.
ROUGH_GAP = 0.1  # of the solutions before them, as a part of the objective
# How near to the central path those are. 0.1 twice takes a seventh more Newton steps; after 2
# twice the meshes of 1 motion in 100 are worse: its jerk varies a tenth more.
ROUGHLY_CENTRED = (2.0, 0.5)
# Where LONGER times the duration of a ramp to the velocity limit is a SHORT part of a segment, it
# begins and ends with the part RAMPS of its intervals in that time: with uniform first meshes
# motions at 0.05 rad/s were 2 % slower. Motions by torque alone, whose ramps are longer than
# estimated, were planned more slowly at SHORT = 0.25.
SHORT, RAMPS, LONGER = 0.05, 0.25, 1.2
KEPT = 0.03      # of the segments, at most, that keep their mesh for they would exceed limits
FARTHER = 3.0    # first barrier parameter on a new mesh, over the last before, of long motions
SLOWER = (1.003, 1.01, 1.02, 1.04, 1.08, 1.16, 1.3, 1.6)  # factors on all durations, tried in turn


def least_times(task: JointTask, acceleration: Array) -> Array:
    """
    Return the least times of the segments from rest to rest, by velocity and acceleration alone.

    Parameters
    ----------
    task : JointTask
        The via points, and the limits on velocity.
    acceleration : ndarray, shape (3,)
        The largest of each joint [rad/s^2].

    Returns
    -------
    ndarray, shape (N,)
        [s]; of the two limits the one that allows less.

    """
    D = np.abs(np.diff(task.points, axis=0))
    return np.asarray(np.maximum(2.0 * np.sqrt(D / acceleration),
                                 D / task.limits.max_velocity).max(axis=1))


def first_mesh(task: JointTask, acceleration: Array, n: int) -> Mesh:
    """
    Return a mesh to begin with: uniform, but for segments that cruise for long.

    Those have short intervals at their ends. They keep them, for in rough solutions their ramps
    are far longer than in the fastest motion.

    Parameters
    ----------
    task : JointTask
        With limits on jerk.
    acceleration : ndarray, shape (3,)
        The largest of each joint [rad/s^2].
    n : int
        Number of intervals in a segment.

    Returns
    -------
    Mesh
        The mesh.

    """
    limits, T = task.limits, least_times(task, acceleration)
    ramp = ramp_time(limits.max_velocity, acceleration, limits.max_jerk).max()
    begins = min(int(RAMPS * n), n // 2 - 1)  # intervals at each end
    zone, cruises = np.full(len(T), begins / n), LONGER * ramp < SHORT * T
    zone[cruises] = LONGER * ramp / T[cruises]
    parts = np.repeat(((1.0 - 2.0 * zone) / (n - 2 * begins))[:, np.newaxis], n, axis=1)
    parts[:, :begins] = parts[:, n - begins:] = (zone / begins)[:, np.newaxis]
    return Mesh(parts, cruises if cruises.any() else None)


def meshed(problem: JointProblem,
           initial_motion: InitialMotion) -> tuple[JointProblem, InitialMotion]:
    """
    Return the problem on a refined mesh, and a motion on it to start from.

    Parameters
    ----------
    problem : JointProblem
        On any mesh.
    initial_motion : callable
        Returns a motion to start from on any mesh, or None.

    Returns
    -------
    problem : JointProblem
        The same, on another mesh.
    initial_motion : callable
        Returns a motion near the fastest where that is within the constraints, else as given;
        None where that gives none.

    """
    task, barrier = problem.task, None
    first = initial_motion(task, problem.without_margins)
    if first is None:
        return problem, lambda planned, within: None
    for centred in ROUGHLY_CENTRED:
        if task.should_stop():
            break
        outcome = problem.minimised(
            problem.without_margins, CentralPathPoint(first, barrier), ROUGH_GAP, centred)
        found = _remeshed(problem, outcome)
        if found is None:
            break
        problem, first = found
        if outcome.centres and take_own_steps(problem.without_margins.problem, problem.durations):
            barrier = FARTHER * (outcome.centres[-1].barrier or 0.0) or None

    def near_the_fastest(planned: JointTask, within: JointConstraints) -> Variables | None:
        return first if within.is_within(first) else initial_motion(planned, within)

    return problem, near_the_fastest


def _remeshed(problem: JointProblem, outcome: Outcome) -> tuple[JointProblem, Variables] | None:
    """Return the problem on a refined mesh, and a motion within its limits near a solution."""
    task, durations = problem.task, problem.durations
    mesh, motion = refined(problem.mesh, task.points, outcome.motion, task.limits.max_jerk,
                           task.least_jerk_rise)
    found = slower_on(problem, outcome.motion, mesh, motion) if durations.may_scale else None
    if found is not None:
        return found
    remeshed = replace(problem, mesh=mesh)
    constraints = remeshed.without_margins
    farther = (moved(problem.mesh, mesh, task.points, c.motion)
               for c in reversed(outcome.centres))  # from limits
    first = (next(filter(constraints.is_within, farther), None)
             or brought_within(constraints, motion, durations, task.should_stop))
    return None if first is None else (remeshed, first)


def slower_on(problem: JointProblem, before: Variables, mesh: Mesh,
              motion: Variables) -> tuple[JointProblem, Variables] | None:
    """
    Return the problem on another mesh, and a motion slowed until it is within the limits.

    Parameters
    ----------
    problem : JointProblem
        With durations that may be scaled.
    before : Variables
        A motion within its limits.
    mesh : Mesh
        The other one, of which a few segments, KEPT, may keep theirs and the motion before.
    motion : Variables
        The same on that, which may exceed limits.

    Returns
    -------
    tuple of JointProblem and Variables, or None
        None where no slower motion is within the limits.

    """
    N = len(problem.durations.free)
    whole = replace(problem, mesh=mesh)
    for factor in SLOWER:
        slower = time_scaled(motion, factor)
        if whole.without_margins.is_within(slower):
            return whole, slower
        if KEPT * N < 1.0:
            continue
        by_segment = whole.without_margins.problem.slacks(slower)[:-2 * N].reshape(N, -1)
        kept = by_segment.min(axis=1, initial=np.inf) <= 0.0
        if np.count_nonzero(kept) > KEPT * N:
            continue
        parts = np.where(kept[:, np.newaxis], problem.mesh.parts, mesh.parts)
        inner = np.where(kept[:, np.newaxis, np.newaxis], time_scaled(before, factor).inner,
                         slower.inner)
        partly = replace(problem, mesh=Mesh(parts, mesh.suits))
        slower = slower._replace(inner=inner)
        if partly.without_margins.is_within(slower):
            return partly, slower
    return None
