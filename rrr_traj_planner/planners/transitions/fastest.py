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
The fastest motion through consecutive segments.

Durations and via velocities are optimised together under the velocity, acceleration and jerk
limits; where the torque of the motion is too much, the segments that ask for it are given more
time.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import ConvergenceError
from rrr_traj_planner.planners.request import JointTask
from rrr_traj_planner.planners.transitions.motion import (
    motion_with_floor,
    quickest_motion,
    segment_stretch,
    stretched_for_torque,
    TimedMotion,
)
from rrr_traj_planner.planners.transitions.via_problem import at_rest, slower_at, ViaProblem

STRAIGHTENING_ROUNDS = 5   # of lowering via velocities of a path that gravity blocks
SLOWING_ROUNDS = 8         # of giving more time to the segments that lack torque
BACKWARD = 1.0, 0.5        # powers, each tried, of what it asks of segments that last too long
OVERSHOOT_ROUNDS = 8       # of lowering via velocities that overshoot a joint's range


def fastest(task: JointTask, problem: ViaProblem, floor: Array | None) -> TimedMotion:
    """
    Return the motion of least total time, slowed where torque asks for it.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    problem : ViaProblem
        The via points.
    floor : ndarray, shape (n,), optional
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
    problem, motion, stretch = _holdable_motion(task, problem, floor)
    candidates = [(motion, stretch)]
    for backward in BACKWARD:
        candidates += _slowed(task, problem, floor, motion, stretch, backward)
    totals = [m.durations.sum() * max(1.0, s.max()) for m, s in candidates]
    return stretched_for_torque(task, candidates[int(np.argmin(totals))][0])


def fastest_with_stops(task: JointTask, problem: ViaProblem, floor: Array) -> TimedMotion:
    """
    Return the motion of least total time with a stop at every via point.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    problem : ViaProblem
        The via points.
    floor : ndarray, shape (n,)
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
    return stretched_for_torque(task, _least_time_motion(task, stops, floor))


def _slowed(task: JointTask, problem: ViaProblem, floor: Array | None, motion: TimedMotion,
            stretch: Array, backward: float) -> Iterator[tuple[TimedMotion, Array]]:
    """
    Give motions, and their stretch, whose segments last as long as torque asks of the one before.

    Where it asks for less than before, durations go back by a power of it.
    """
    lacking = np.zeros(len(stretch), dtype=bool)
    for _ in range(SLOWING_ROUNDS):
        lacking |= stretch > 1.0
        if not lacking.any() or np.isinf(stretch).any() or task.should_stop():
            return
        change = np.where(stretch > 1.0, stretch, stretch ** backward)
        slow = np.where(lacking, motion.durations * change, 0.0)
        slow = slow if floor is None else np.maximum(slow, floor)
        motion = _least_time_motion(task, problem, slow)
        stretch = segment_stretch(task, motion)
        yield motion, stretch


def _holdable_motion(task: JointTask, problem: ViaProblem,
                     floor: Array | None) -> tuple[ViaProblem, TimedMotion, Array]:
    """
    Return the motion of least time whose path can be held against gravity, and torque's stretch.

    Lower via velocities straighten the path; if gravity is too much even from rest to rest, the
    stretch says so by being infinite.
    """
    for _ in range(STRAIGHTENING_ROUNDS):
        task.should_stop()
        motion = _least_time_motion(task, problem, floor)
        stretch = segment_stretch(task, motion)
        blocked = np.isinf(stretch)
        if not blocked.any():
            return problem, motion, stretch
        problem = slower_at(problem, np.tile(blocked[:, np.newaxis], 3))
    motion = _least_time_motion(task, at_rest(problem), floor)
    return at_rest(problem), motion, segment_stretch(task, motion)


def _least_time_motion(task: JointTask, problem: ViaProblem, floor: Array | None) -> TimedMotion:
    """Return the motion of least total time within the kinematic limits."""
    for round_ in range(OVERSHOOT_ROUNDS + 1):
        task.should_stop()
        if round_ == OVERSHOOT_ROUNDS:
            problem = at_rest(problem)
        motion, overshoot = (quickest_motion(task, problem) if floor is None
                             else motion_with_floor(task, problem, floor))
        if motion is not None:
            return motion
        problem = slower_at(problem, overshoot)
    raise ConvergenceError(
        f'{problem.function.name}: even stops at the via points overshoot a range')
