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

"""A motion through consecutive segments (thesis 4.2.3) whose durations are prescribed."""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.errors import TimingError
from rrr_traj_planner.core.trajectory.sampling import NANOSECOND
from rrr_traj_planner.planners.short_durations import durations_too_short, least_feasible
from rrr_traj_planner.planners.tolerances import DURATION_MARGIN, TORQUE_TOLERANCE
from rrr_traj_planner.planners.torque_scaling import torque_time_scale
from rrr_traj_planner.planners.transitions.fastest import (
    fastest,
    fastest_with_stops,
    OVERSHOOT_ROUNDS,
    STRAIGHTENING_ROUNDS,
)
from rrr_traj_planner.planners.transitions.motion import (
    SCALING_TOLERANCE,
    segment_time_scale,
    timed_motion,
    TimedMotion,
)
from rrr_traj_planner.planners.transitions.transition_problem import (
    at_lower_velocities,
    TransitionProblem,
)


def prescribed(problem: TransitionProblem, durations: Array) -> TimedMotion:
    """
    Return a motion of given durations.

    Parameters
    ----------
    problem : TransitionProblem
        The via points, the arm and its limits.
    durations : ndarray, shape (n,)
        [s].

    Returns
    -------
    TimedMotion
        Within all limits; with lower accelerations where durations are longer than necessary.

    Raises
    ------
    TimingError
        If the durations are too short; with feasible ones.
    LimitViolationError
        If gravity alone exceeds an effort limit between the via points.

    """
    motion = _within_limits(problem, durations) or _slowed_fastest(problem, durations)
    if motion is None:
        raise _too_short(problem, durations)
    return motion


def _within_limits(problem: TransitionProblem, durations: Array) -> TimedMotion | None:
    """
    Return a motion of given durations within all limits; None if none is found.

    Where the motion of low accelerations exceeds torque limits, the fastest one of the same
    proportions, slowed to these durations, may keep them; else lower via velocities are tried.
    """
    task = problem.task

    def attempt(slower: TransitionProblem) -> tuple[TimedMotion | None, BoolArray | None]:
        for low_acceleration in (True, False):
            motion = _with_durations(slower, durations, low_acceleration)
            if motion is None:
                return None, None
            if torque_time_scale(task, motion.trajectory) <= 1.0 + TORQUE_TOLERANCE:
                return motion, None
            lacking = segment_time_scale(task, motion) > 1.0
        return None, np.tile(lacking[:, np.newaxis], 3)

    return at_lower_velocities(problem, STRAIGHTENING_ROUNDS, attempt)


def _slowed_fastest(problem: TransitionProblem, durations: Array) -> TimedMotion | None:
    """Return the fastest motion, slowed, if that has the given durations; else None."""
    if (problem.via.displacements == 0.0).all(axis=1).any():
        return None  # the fastest motion has no segment without displacement
    quickest = fastest(problem, None)
    slower = float(np.mean(durations / quickest.durations))
    if slower < 1.0 - SCALING_TOLERANCE or (
            np.abs(durations - slower * quickest.durations).max() > NANOSECOND):
        return None
    return TimedMotion(quickest.trajectory.time_scaled(slower), durations)


def _with_durations(problem: TransitionProblem, durations: Array,
                    low_acceleration: bool) -> TimedMotion | None:
    """Return a motion of given durations within the kinematic limits; None if there is none."""
    def attempt(slower: TransitionProblem) -> tuple[TimedMotion | None, BoolArray | None]:
        motion, overshoot = timed_motion(slower, durations, low_acceleration)
        return motion, overshoot if overshoot.any() else None

    return at_lower_velocities(problem, OVERSHOOT_ROUNDS, attempt)


def _too_short(problem: TransitionProblem, durations: Array) -> TimingError:
    """Return the error of prescribed durations that are too short, with feasible ones."""
    feasible = _least_feasible(problem, durations)
    # Feasible durations are rounded to microseconds: two of these are no difference.
    short = np.flatnonzero(
        durations * (1.0 + 2.0 * DURATION_MARGIN) < feasible - 2e-6).tolist()
    return durations_too_short(durations, feasible, short)


def _least_feasible(problem: TransitionProblem, durations: Array) -> Array:
    """Return feasible durations in whole microseconds, none shorter than the given ones."""
    return least_feasible(
        durations, [motion.durations for motion in (
            fastest(problem, durations), fastest_with_stops(problem, durations))],
        lambda T: _within_limits(problem, T) is not None)
