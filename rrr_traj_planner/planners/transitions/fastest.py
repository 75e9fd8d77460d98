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
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.errors import ConvergenceError
from rrr_traj_planner.planners.transitions.motion import (
    motion_slowed_for_torque,
    motion_with_least_durations,
    quickest_motion,
    segment_time_scale,
    TimedMotion,
)
from rrr_traj_planner.planners.transitions.transition_problem import (
    at_lower_velocities,
    TransitionProblem,
)
from rrr_traj_planner.planners.transitions.via_problem import rests_everywhere

# Numbers of rounds, at most; chosen: half and twice of the second change none of 28 random plans.
STRAIGHTENING_ROUNDS = 5   # of reducing via velocities where gravity blocks the path
SLOWING_ROUNDS = 8         # of lengthening the segments that lack torque
OVERSHOOT_ROUNDS = 8       # of reducing via velocities where a joint overshoots its range
BACKWARD = 1.0, 0.5        # exponents tried for shortening a segment lengthened too much; chosen


def fastest(problem: TransitionProblem, least_T: Array | None) -> TimedMotion:
    """
    Return the motion of least total time, slowed as its torques require.

    Parameters
    ----------
    problem : TransitionProblem
        The via points, the arm and its limits.
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
    problem, motion, scaling = _statically_feasible_motion(problem, least_T)
    candidates = [(motion, scaling)]
    for backward in BACKWARD:
        candidates += _slowed(problem, least_T, motion, scaling, backward)
    totals = [m.durations.sum() * max(1.0, s.max()) for m, s in candidates]
    return motion_slowed_for_torque(problem.task, candidates[int(np.argmin(totals))][0])


def fastest_with_stops(problem: TransitionProblem, least_T: Array) -> TimedMotion:
    """
    Return the motion of least total time with a stop at every via point.

    Parameters
    ----------
    problem : TransitionProblem
        The via points, the arm and its limits.
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
    return motion_slowed_for_torque(problem.task, _least_time_motion(problem.at_rest(), least_T))


def _slowed(problem: TransitionProblem, least_T: Array | None, motion: TimedMotion,
            scaling: Array, backward: float) -> Iterator[tuple[TimedMotion, Array]]:
    """
    Yield motions and their time scaling, each lengthened as the torques of the one before require.

    A segment that has been lengthened too much is shortened by a power of its time scaling.
    """
    lacking = np.zeros(len(scaling), dtype=bool)
    for _ in range(SLOWING_ROUNDS):
        lacking |= scaling > 1.0
        if not lacking.any() or np.isinf(scaling).any() or problem.task.should_stop():
            return
        change = np.where(scaling > 1.0, scaling, scaling ** backward)
        slow = np.where(lacking, motion.durations * change, 0.0)
        slow = slow if least_T is None else np.maximum(slow, least_T)
        motion = _least_time_motion(problem, slow)
        scaling = segment_time_scale(problem.task, motion)
        yield motion, scaling


def _statically_feasible_motion(problem: TransitionProblem, least_T: Array | None,
                                ) -> tuple[TransitionProblem, TimedMotion, Array]:
    """
    Return the fastest motion whose path is statically feasible, and its segments' time scaling.

    Lower via velocities straighten the path; the time scaling is infinite where gravity exceeds a
    limit even between stops.
    """
    def attempt(slower: TransitionProblem) -> tuple[
            tuple[TransitionProblem, TimedMotion, Array] | None, BoolArray | None]:
        motion = _least_time_motion(slower, least_T)
        scaling = segment_time_scale(slower.task, motion)
        blocked = np.isinf(scaling)
        if not blocked.any() or rests_everywhere(slower.via):
            return (slower, motion, scaling), None
        return None, np.tile(blocked[:, np.newaxis], 3)

    found = at_lower_velocities(problem, STRAIGHTENING_ROUNDS, attempt)
    assert found is not None  # at rest there is one
    return found


def _least_time_motion(problem: TransitionProblem, least_T: Array | None) -> TimedMotion:
    """Return the motion of least total time within the kinematic limits."""
    motion = at_lower_velocities(problem, OVERSHOOT_ROUNDS, lambda slower: (
        quickest_motion(slower) if least_T is None
        else motion_with_least_durations(slower, least_T)))
    if motion is None:
        raise ConvergenceError(f'{problem.via.function.name}: even stops at the via points '
                               'overshoot a range')
    return motion
