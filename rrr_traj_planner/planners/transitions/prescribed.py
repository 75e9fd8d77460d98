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
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import ConvergenceError, TimingError
from rrr_traj_planner.core.trajectory.sampling import NANOSECOND
from rrr_traj_planner.planners.short_durations import durations_too_short, whole_microseconds
from rrr_traj_planner.planners.tasks import JointTask
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
from rrr_traj_planner.planners.transitions.via_problem import at_rest, slower_at, ViaProblem

# Tried in turn on top of the least durations until they can be prescribed, as parts of them;
# chosen.
MARGINS = (0.0, 1e-6, 1e-5, 1e-4, 1e-3)


def prescribed(task: JointTask, problem: ViaProblem, durations: Array) -> TimedMotion:
    """
    Return a motion of given durations.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    problem : ViaProblem
        The via points.
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
    motion = _within_limits(task, problem, durations) or _slowed_fastest(task, problem, durations)
    if motion is None:
        raise _too_short(task, problem, durations)
    return motion


def _within_limits(task: JointTask, problem: ViaProblem, durations: Array) -> TimedMotion | None:
    """
    Return a motion of given durations within all limits; None if none is found.

    Where the motion of low accelerations exceeds torque limits, the fastest one of the same
    proportions, slowed to these durations, may keep them; else lower via velocities are tried.
    """
    for round_ in range(STRAIGHTENING_ROUNDS + 1):
        task.should_stop()
        if round_ == STRAIGHTENING_ROUNDS:
            problem = at_rest(problem)
        for low_acceleration in (True, False):
            motion = _with_durations(task, problem, durations, low_acceleration)
            if motion is None:
                return None
            scaling = segment_time_scale(task, motion)
            if torque_time_scale(task, motion.trajectory) <= 1.0 + TORQUE_TOLERANCE:
                return motion
        lacking = scaling > 1.0
        problem = slower_at(problem, np.tile(lacking[:, np.newaxis], 3))
    return None


def _slowed_fastest(task: JointTask, problem: ViaProblem, durations: Array) -> TimedMotion | None:
    """Return the fastest motion, slowed, if that has the given durations; else None."""
    if (problem.displacements == 0.0).all(axis=1).any():
        return None  # the fastest motion has no segment without displacement
    quickest = fastest(task, problem, None)
    slower = float(np.mean(durations / quickest.durations))
    if slower < 1.0 - SCALING_TOLERANCE or (
            np.abs(durations - slower * quickest.durations).max() > NANOSECOND):
        return None
    return TimedMotion(quickest.trajectory.time_scaled(slower), durations)


def _with_durations(task: JointTask, problem: ViaProblem, durations: Array,
                    low_acceleration: bool) -> TimedMotion | None:
    """Return a motion of given durations within the kinematic limits; None if there is none."""
    for round_ in range(OVERSHOOT_ROUNDS + 1):
        task.should_stop()
        if round_ == OVERSHOOT_ROUNDS:
            problem = at_rest(problem)
        motion, overshoot = timed_motion(task, problem, durations, low_acceleration)
        if motion is not None or not overshoot.any():
            return motion
        problem = slower_at(problem, overshoot)
    return None


def _too_short(task: JointTask, problem: ViaProblem, durations: Array) -> TimingError:
    """Return the error of prescribed durations that are too short, with feasible ones."""
    feasible = _least_feasible(task, problem, durations)
    # Feasible durations are rounded to microseconds: two of these are no difference.
    short = np.flatnonzero(
        durations * (1.0 + 2.0 * DURATION_MARGIN) < feasible - 2e-6).tolist()
    return durations_too_short(durations, feasible, short)


def _least_feasible(task: JointTask, problem: ViaProblem, durations: Array) -> Array:
    """Return feasible durations in whole microseconds, none shorter than the given ones."""
    for candidate in (fastest(task, problem, durations), fastest_with_stops(
            task, problem, durations)):
        for margin in MARGINS:
            feasible = whole_microseconds(candidate.durations * (1.0 + margin))
            if _within_limits(task, problem, feasible) is not None:
                return feasible
    raise ConvergenceError(
        f'no feasible durations found for segment_durations {durations.tolist()} s')
