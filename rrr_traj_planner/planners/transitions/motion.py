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
Motions through consecutive segments of given or least durations, slowed as torque requires.

All joints take the time of the slowest (thesis 4.2.3).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.rounding import JOINT_ROUNDING
from rrr_traj_planner.core.trajectory.joint_profile import JointProfile
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.planners.solver.barrier_method import Solution
from rrr_traj_planner.planners.solver.convergence import unconverged_note
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.tolerances import DURATION_MARGIN, TORQUE_TOLERANCE
from rrr_traj_planner.planners.torque_scaling import (
    feasible_time_scale,
    squared_time_scale_by_segment,
)
from rrr_traj_planner.planners.transitions import segment_motion
from rrr_traj_planner.planners.transitions.transition_problem import TransitionProblem
from rrr_traj_planner.planners.transitions.via_problem import rests_everywhere
from rrr_traj_planner.planners.transitions.via_velocities import least_time, least_time_scale

# Without unit: parts of a duration.
SCALING_TOLERANCE = 3e-7   # by which prescribed durations may fall short: jerk is then within 1e-6


class TimedMotion(NamedTuple):
    """A motion within the kinematic limits, and the durations of its segments."""

    trajectory: PiecewiseTrajectory
    durations: Array


def timed_motion(problem: TransitionProblem, durations: Array,
                 low_acceleration: bool = True) -> tuple[TimedMotion | None, BoolArray]:
    """
    Return a motion of given durations, and which segments overshoot a joint's range.

    If the durations are longer than necessary, the motion has lower accelerations, or is the
    fastest one of the same proportions, slowed.

    Parameters
    ----------
    problem : TransitionProblem
        The via points, the arm and its limits.
    durations : ndarray, shape (n,)
        [s].
    low_acceleration : bool
        Whether to choose low accelerations.

    Returns
    -------
    tuple of TimedMotion and ndarray of bool, shape (n, 3)
        The motion is None where a segment overshoots, or none satisfies the kinematic limits.

    """
    via = problem.via
    if rests_everywhere(via):
        factor = float((via.rest_to_rest_times() / durations).max())
        v, T = np.zeros_like(via.highest), durations * factor
    else:
        factor, solution = least_time_scale(via, durations)
        v, T = solution.velocities, solution.durations
    if factor > 1.0 + SCALING_TOLERANCE:
        return None, np.zeros_like(via.displacements, dtype=bool)
    if factor <= 1.0 and low_acceleration:
        v, T, factor = v * factor, durations, 1.0
    motion, overshoot = _motion_of(problem, v, T, durations)
    if motion is not None and factor != 1.0:
        motion = motion._replace(trajectory=motion.trajectory.time_scaled(1.0 / factor))
    return motion, overshoot


def quickest_motion(problem: TransitionProblem) -> tuple[TimedMotion | None, BoolArray]:
    """
    Return the motion of least total time, and which segments overshoot a joint's range.

    Parameters
    ----------
    problem : TransitionProblem
        As in `timed_motion`.

    Returns
    -------
    tuple of TimedMotion and ndarray of bool, shape (n, 3)
        The motion is None where a segment overshoots. Its note tells if planning was stopped
        before it converged.

    """
    via = problem.via
    stops = via.rest_to_rest_times()
    v, T, gap = np.zeros_like(via.highest), stops, 0.0
    slower = 1.0 + DURATION_MARGIN
    futile: list[BoolArray] = []

    def is_futile(rough: Solution) -> bool:
        futile.append(_overshoot(problem, *_parts(
            problem, rough.velocities / slower, rough.durations * slower)))
        return bool(futile[0].any())

    if not rests_everywhere(via):
        found = least_time(via, None, problem.task.should_stop, is_futile)
        if futile and futile[0].any():
            return None, futile[0]
        gap = found.gap - float(max(found.durations.sum() - stops.sum(), 0.0))
        if found.durations.sum() <= stops.sum():  # it was not stopped early
            v, T = found.velocities, found.durations
    motion, overshoot = _motion_of(problem, v / slower, T * slower, T * slower)
    if motion is not None:
        motion.trajectory.note = unconverged_note(gap, motion.trajectory.duration)
    return motion, overshoot


def motion_with_least_durations(problem: TransitionProblem, least_T: Array,
                                ) -> tuple[TimedMotion | None, BoolArray]:
    """
    Return the motion of least total time with lower bounds on durations, and what overshoots.

    Its via velocities are those for which these durations could be scaled down most.

    Parameters
    ----------
    problem : TransitionProblem
        As in `timed_motion`.
    least_T : ndarray, shape (n,)
        Durations [s] that no segment may fall below.

    Returns
    -------
    tuple of TimedMotion and ndarray of bool, shape (n, 3)
        As of `timed_motion`.

    """
    task, via = problem
    durations = (np.maximum(via.rest_to_rest_times(), least_T) if rests_everywhere(via)
                 else least_time(via, least_T, task.should_stop).durations)
    return timed_motion(problem, durations * (1.0 + DURATION_MARGIN))


def segment_time_scale(task: JointTask, motion: TimedMotion) -> Array:
    """
    Return the least factor on each segment's times with which torque limits hold.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    motion : TimedMotion
        The motion.

    Returns
    -------
    ndarray, shape (n,)
        Below 1 where torque is below its limits, infinite where gravity alone exceeds one.

    """
    if np.isinf(task.limits.max_effort).all():
        return np.zeros(len(motion.durations))
    return np.sqrt(squared_time_scale_by_segment(task, motion.trajectory, ['right']))


def motion_slowed_for_torque(task: JointTask, motion: TimedMotion) -> TimedMotion:
    """
    Return the motion slowed as a whole until its torques are within their limits.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    motion : TimedMotion
        The motion.

    Returns
    -------
    TimedMotion
        Within the effort limits.

    Raises
    ------
    LimitViolationError
        If gravity alone exceeds an effort limit along the path.

    """
    factor = feasible_time_scale(task, motion.trajectory)
    if factor <= 1.0 + TORQUE_TOLERANCE:
        return motion
    return TimedMotion(motion.trajectory.time_scaled(factor), motion.durations * factor)


def _motion_of(problem: TransitionProblem, v: Array, T: Array,
               durations: Array) -> tuple[TimedMotion | None, BoolArray]:
    """Return the motion of given velocities and durations; none where it overshoots a range."""
    task, via = problem
    v0, v1, parts = _parts(problem, v, T)
    overshoot = _overshoot(problem, v0, v1, parts)
    if overshoot.any():
        return None, overshoot
    trajectory = segment_motion.trajectory(
        task.points, v0, v1, T[:, np.newaxis], parts, via.function)
    return TimedMotion(trajectory, durations), overshoot


def _parts(problem: TransitionProblem, v: Array,
           T: Array) -> tuple[Array, Array, segment_motion.Parts]:
    """Return velocities at the segments' starts and ends, and the parts of the motion between."""
    rest = np.zeros((1, 3))
    v0, v1 = np.concatenate((rest, v)), np.concatenate((v, rest))
    return v0, v1, segment_motion.low_acceleration_parts(
        problem.via.segment_limits, segment_motion.Segments(
            v0, v1, T[:, np.newaxis], problem.via.displacements))


def _overshoot(problem: TransitionProblem, v0: Array, v1: Array,
               parts: segment_motion.Parts) -> BoolArray:
    """
    Return which joints leave their range in which segments, shape (n, 3).

    Via points are within it, and between them position has an extreme only where velocity changes
    sign in a transition, at a distance below velocity times duration.
    """
    (task, via), cruise = problem, parts.cruise
    limits = task.limits
    least, most = limits.min_position, limits.max_position
    out = np.zeros(v0.shape, dtype=bool)
    for point, duration, velocity, way in (
            (task.points[:-1], parts.first, v0, 1.0), (task.points[1:], parts.last, v1, -1.0)):
        furthest = point + way * velocity * duration
        doubtful = (velocity * cruise < 0.0) & (duration > 0.0) & (
            (furthest < least) | (furthest > most))
        if doubtful.any():  # a last transition is a first one, backwards
            row, joint = np.nonzero(doubtful)
            at = row, joint
            ranges = JointProfile(via.function.transition(
                duration[at], point[at], way * velocity[at], way * cruise[at])).piece_ranges
            out[at] |= (ranges[0] < least[joint] - JOINT_ROUNDING) | (
                ranges[1] > most[joint] + JOINT_ROUNDING)
    return out
