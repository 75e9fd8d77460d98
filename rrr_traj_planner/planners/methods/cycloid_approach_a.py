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
`cycloid_approach_a`: in every segment a transition, then a cruise (thesis 4.2, approach a).

Each via point is left at the cruise velocity of the segment before it; a last transition brings
the arm to rest. The durations determine the velocities one after the other; they are chosen by
beam search (Bisiani, in Encyclopedia of Artificial Intelligence, 1987) and refined by coordinate
descent (Nocedal & Wright, Numerical Optimization, 9.3).
"""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arrays import Array, IntArray
from rrr_traj_planner.core.cancellation import ShouldStop
from rrr_traj_planner.core.errors import ConvergenceError, TimingError
from rrr_traj_planner.core.rounding import JOINT_ROUNDING
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.registration import register
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.torque_scaling import slowed_for_torque
from rrr_traj_planner.planners.transitions.prescribed_by_search import (
    feasible_motion,
    within_torque,
)
from rrr_traj_planner.planners.transitions.segment_motion import (
    Parts,
    quick_parts,
    Segments,
    trajectory,
)
from rrr_traj_planner.planners.transitions.transition_cruise import (
    bisected,
    cruise_velocity,
    stopping_bracket,
    stopping_time,
)
from rrr_traj_planner.planners.transitions.transition_law import SegmentLimits, TransitionLaw
from rrr_traj_planner.planners.transitions.via_problem import via_problem_of, ViaProblem

# Chosen values, without unit. On 12 random tasks half and twice of BEAM change nothing; with a
# grid half as fine one motion is 13 % faster and one 4 % slower, with one twice as fine one is 3 %
# faster: the search finds a local optimum.
BEAM = 24                  # partial solutions that are retained
# Durations tried, over the least one from rest to rest: finely spaced near it, up to very slow.
GRID = np.concatenate((np.geomspace(0.4, 2.5, 36), np.geomspace(2.8, 60.0, 12)))
REFINED_SEGMENTS = 12      # at most: beyond, the beam search's result is not refined
PASSES = 0.08 * 0.5 ** np.arange(16.0)  # of coordinate descent: largest steps, parts of a duration
REFINING_STEPS = np.array([-1.0, -0.5, -0.25, -0.1, 0.1, 0.25, 0.5, 1.0])  # over the largest
SHORTEST = 1e-6            # duration in place of a least one of 0 [s]


@register('cycloid_approach_a')
def plan(task: JointTask) -> Trajectory:
    """
    Return the fastest motion of approach (a) that the search finds, or one of given durations.

    Parameters
    ----------
    task : JointTask
        Via points, the arm and its limits.

    Returns
    -------
    Trajectory
        Within the limits.

    Raises
    ------
    InvalidInputError
        If a joint has no acceleration limit.
    TimingError
        If prescribed durations are too short; with feasible ones.
    LimitViolationError
        If gravity alone exceeds an effort limit between the via points.

    """
    problem = via_problem_of(task)
    if task.durations is not None:
        return feasible_motion(lambda durations: within_torque(
            task, problem.law, lambda law: _motion(task, problem, law, durations)), task.durations)
    motion = _motion(task, problem, problem.law, _fastest(task, problem))
    if motion is None:
        raise ConvergenceError('approach (a): the durations that were found are not feasible')
    return slowed_for_torque(task, motion)


def _fastest(task: JointTask, problem: ViaProblem) -> Array:
    """Return the durations of least total time that the search finds, shape (n,)."""
    durations = _beam_search(problem, task.should_stop)
    if len(durations) <= REFINED_SEGMENTS:
        durations = _refined(problem, durations, task.should_stop)
    for factor in np.geomspace(1.0, 30.0, 40):  # slower until feasible; chosen
        task.should_stop()
        if _motion(task, problem, problem.law, factor * durations) is not None:
            return np.asarray(factor * durations)
    raise TimingError(
        'approach (a) leaves every via point at the cruise velocity of the segment before it: no '
        'durations are found at which every joint then stays in its range')


def _beam_search(problem: ViaProblem, should_stop: ShouldStop) -> Array:
    """Return durations by beam search; the longest of the grid where no beam is left."""
    D, limits = problem.displacements, problem.segment_limits
    grids = np.maximum(problem.rest_to_rest_times(), SHORTEST)[:, np.newaxis] * GRID
    v, elapsed, chosen = np.zeros((1, 3)), np.zeros(1), np.zeros((1, 0))
    for k in range(len(D) - 1):
        should_stop()
        T = grids[k]
        next_v = cruise_velocity(limits, v[:, np.newaxis], T[:, np.newaxis], D[k])
        total = elapsed[:, np.newaxis] + T
        bound = (next_v >= problem.lowest[k]) & (next_v <= problem.highest[k])
        beam, step = np.nonzero(bound.all(axis=-1))
        if not len(beam):
            return np.asarray(grids[:, -1])
        v, elapsed = next_v[beam, step], total[beam, step]
        chosen = np.column_stack((chosen[beam], T[step]))
        best = _best(limits, v, elapsed, D[k + 1], grids[k + 1])
        v, elapsed, chosen = v[best], elapsed[best], chosen[best]
    last = stopping_time(limits, v, D[-1], grids[-1])
    best_one = int((elapsed + last).argmin())
    return np.append(chosen[best_one], min(last[best_one], grids[-1, -1]))


def _best(limits: SegmentLimits, v: Array, elapsed: Array, D: Array, grid: Array) -> IntArray:
    """Return the beams that can come to rest earliest at the end of the next segment."""
    low, high = stopping_bracket(limits, v, D, grid)
    near = np.arange(len(v))
    if len(v) > BEAM:  # others than these cannot be among them
        near = np.flatnonzero(elapsed + low <= np.partition(elapsed + high, BEAM - 1)[BEAM - 1])
    rest = bisected(limits, v[near], D, low[near], high[near])
    return near[np.argsort(elapsed[near] + rest, kind='stable')[:BEAM]]


def _refined(problem: ViaProblem, durations: Array, should_stop: ShouldStop) -> Array:
    """Return durations improved by coordinate descent with decreasing steps."""
    best = _total(problem, durations[np.newaxis])[0]
    for step in PASSES:
        if should_stop():
            break
        for k in range(len(durations) - 1):
            trials = np.tile(durations, (len(REFINING_STEPS), 1))
            trials[:, k] *= 1.0 + step * REFINING_STEPS
            totals = _total(problem, trials)
            if totals.min() < best:
                best, durations = totals.min(), trials[totals.argmin()]
    last = best - durations[:-1].sum()
    return np.append(durations[:-1], last) if np.isfinite(best) else durations


def _total(problem: ViaProblem, durations: Array) -> Array:
    """Return total times of rows of durations, the last one replaced by the least."""
    v, allowed = np.zeros((len(durations), 3)), np.ones(len(durations), dtype=bool)
    for k in range(durations.shape[1] - 1):
        v = cruise_velocity(
            problem.segment_limits, v, durations[:, k:k + 1], problem.displacements[k])
        allowed &= ((v >= problem.lowest[k]) & (v <= problem.highest[k])).all(axis=-1)
        v = np.nan_to_num(v)
    grid = np.maximum(problem.rest_to_rest_times()[-1], SHORTEST) * GRID
    last = stopping_time(problem.segment_limits, v, problem.displacements[-1], grid)
    return np.where(allowed, durations[:, :-1].sum(axis=1) + last, np.inf)


def _motion(task: JointTask, problem: ViaProblem, law: TransitionLaw,
            durations: Array) -> PiecewiseTrajectory | None:
    """Return the motion of given durations, None if it exceeds a limit other than torque's."""
    D, T = problem.displacements, durations[:, np.newaxis]
    limits = SegmentLimits(law, problem.max_velocity)
    v = np.zeros((len(D) + 1, 3))
    for k in range(len(D) - 1):
        v[k + 1] = cruise_velocity(limits, v[k], T[k], D[k])
        if np.isnan(v[k + 1]).any():
            return None
    if not np.isfinite(stopping_time(limits, v[-2:-1], D[-1], T[-1]))[0]:
        return None
    first = np.minimum(law.least_time(np.diff(v, axis=0)), T)
    parts = Parts(first, v[1:].copy(), np.zeros_like(first))
    to_rest = quick_parts(law, Segments(v[-2:-1], v[-1:], T[-1:], D[-1:]))
    for part, last in zip(parts, to_rest):
        part[-1:] = last
    motion = trajectory(task.points, v[:-1], v[1:], T, parts)
    peaks, ranges = motion.peaks(), task.limits
    in_range = (peaks.min_position >= ranges.min_position - JOINT_ROUNDING).all() and (
        peaks.max_position <= ranges.max_position + JOINT_ROUNDING).all()
    return motion if in_range else None
