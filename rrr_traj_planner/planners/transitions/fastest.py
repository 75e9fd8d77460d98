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
The fastest motion through consecutive segments of transitions and cruises (thesis 4.2.3).

Durations and via velocities are optimised together under the velocity, acceleration and jerk
limits; segments whose torque exceeds its limits are then lengthened, and the others optimised
again.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import ConvergenceError
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.transitions.motion import (
    motion_slowed_for_torque,
    motion_with_least_durations,
    quickest_motion,
    segment_time_scale,
    TimedMotion,
)
from rrr_traj_planner.planners.transitions.via_problem import at_rest, slower_at, ViaProblem

# Numbers of rounds, at most; chosen: half and twice of the second change none of 28 random plans.
STRAIGHTENING_ROUNDS = 5   # of reducing via velocities where gravity blocks the path
SLOWING_ROUNDS = 8         # of lengthening the segments that lack torque
OVERSHOOT_ROUNDS = 8       # of reducing via velocities where a joint overshoots its range
BACKWARD = 1.0, 0.5        # exponents tried for shortening a segment lengthened too much; chosen


def fastest(task: JointTask, problem: ViaProblem, least_T: Array | None) -> TimedMotion:
    """
    Return the motion of least total time, slowed as its torques require.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    problem : ViaProblem
        The via points.
    least_T : ndarray, shape (n,), optional
        Durations [s] that no segment may fall below.

    Returns
    -------
    TimedMotion
        Within all limits.

    Raises
    ------
    LimitViolationError
        If gravity alone exceeds an effort limit between the via points.

    """
    problem, motion, scaling = _statically_feasible_motion(task, problem, least_T)
    candidates = [(motion, scaling)]
    for backward in BACKWARD:
        candidates += _slowed(task, problem, least_T, motion, scaling, backward)
    totals = [m.durations.sum() * max(1.0, s.max()) for m, s in candidates]
    return motion_slowed_for_torque(task, candidates[int(np.argmin(totals))][0])


def fastest_with_stops(task: JointTask, problem: ViaProblem, least_T: Array) -> TimedMotion:
    """
    Return the motion of least total time with a stop at every via point.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    problem : ViaProblem
        The via points.
    least_T : ndarray, shape (n,)
        Durations [s] that no segment may fall below.

    Returns
    -------
    TimedMotion
        Within all limits.

    Raises
    ------
    LimitViolationError
        If gravity alone exceeds an effort limit between the via points.

    """
    stops = at_rest(problem)
    return motion_slowed_for_torque(task, _least_time_motion(task, stops, least_T))


def _slowed(task: JointTask, problem: ViaProblem, least_T: Array | None, motion: TimedMotion,
            scaling: Array, backward: float) -> Iterator[tuple[TimedMotion, Array]]:
    """
    Yield motions and their time scaling, each lengthened as the torques of the one before require.

    A segment that has been lengthened too much is shortened by a power of its time scaling.
    """
    lacking = np.zeros(len(scaling), dtype=bool)
    for _ in range(SLOWING_ROUNDS):
        lacking |= scaling > 1.0
        if not lacking.any() or np.isinf(scaling).any() or task.should_stop():
            return
        change = np.where(scaling > 1.0, scaling, scaling ** backward)
        slow = np.where(lacking, motion.durations * change, 0.0)
        slow = slow if least_T is None else np.maximum(slow, least_T)
        motion = _least_time_motion(task, problem, slow)
        scaling = segment_time_scale(task, motion)
        yield motion, scaling


def _statically_feasible_motion(task: JointTask, problem: ViaProblem,
                                least_T: Array | None) -> tuple[ViaProblem, TimedMotion, Array]:
    """
    Return the fastest motion whose path is statically feasible, and its segments' time scaling.

    Lower via velocities straighten the path; the time scaling is infinite where gravity exceeds a
    limit even between stops.
    """
    for _ in range(STRAIGHTENING_ROUNDS):
        task.should_stop()
        motion = _least_time_motion(task, problem, least_T)
        scaling = segment_time_scale(task, motion)
        blocked = np.isinf(scaling)
        if not blocked.any():
            return problem, motion, scaling
        problem = slower_at(problem, np.tile(blocked[:, np.newaxis], 3))
    motion = _least_time_motion(task, at_rest(problem), least_T)
    return at_rest(problem), motion, segment_time_scale(task, motion)


def _least_time_motion(task: JointTask, problem: ViaProblem, least_T: Array | None) -> TimedMotion:
    """Return the motion of least total time within the kinematic limits."""
    for round_ in range(OVERSHOOT_ROUNDS + 1):
        task.should_stop()
        if round_ == OVERSHOOT_ROUNDS:
            problem = at_rest(problem)
        motion, overshoot = (quickest_motion(task, problem) if least_T is None
                             else motion_with_least_durations(task, problem, least_T))
        if motion is not None:
            return motion
        problem = slower_at(problem, overshoot)
    raise ConvergenceError(
        f'{problem.function.name}: even stops at the via points overshoot a range')
