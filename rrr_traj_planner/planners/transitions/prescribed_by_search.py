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

"""Feasible scaling of prescribed durations, by search."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import TimingError
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.short_durations import durations_too_short, whole_microseconds
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.tolerances import DURATION_MARGIN, TORQUE_TOLERANCE
from rrr_traj_planner.planners.torque_scaling import cannot_hold, torque_time_scale
from rrr_traj_planner.planners.transitions.transition_law import TransitionLaw

# Chosen values, without unit; the scaling is refined by bisection.
SCALING_STEP = 1.3       # factor between the scalings of durations that are tried in turn
LARGEST_SCALING = 1e4    # of durations, up to which feasible ones are sought


def within_torque(task: JointTask, law: TransitionLaw,
                  motion_by: Callable[[TransitionLaw], PiecewiseTrajectory | None],
                  ) -> PiecewiseTrajectory | None:
    """
    Return a motion within all limits, with accelerations lowered as torque requires.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    law : TransitionLaw
        By the limits on acceleration and jerk.
    motion_by : callable
        Returns the motion with the transitions of a law, or None where there is none.

    Returns
    -------
    PiecewiseTrajectory or None
        None where none is found.

    Raises
    ------
    LimitViolationError
        If gravity alone exceeds an effort limit along the path.

    """
    scale, too_fast, too_slow = 1.0, None, None  # of the acceleration
    for _ in range(12):  # of lower accelerations, at most; chosen
        task.should_stop()
        motion = motion_by(TransitionLaw(law.slope / scale, law.root / scale ** 0.75))
        if motion is None:
            if too_fast is None:
                return None
            too_slow = scale
        else:
            scaling = torque_time_scale(task, motion)
            if np.isinf(scaling):
                raise cannot_hold(task, motion)
            if scaling <= 1.0 + TORQUE_TOLERANCE:
                return motion
            too_fast, scale = scale, scale / scaling ** 2
        if too_slow is not None and too_fast is not None:
            scale = max(float(np.sqrt(too_fast * too_slow)), scale if motion else 0.0)
    return None


def feasible_motion(motion_in: Callable[[Array], PiecewiseTrajectory | None], durations: Array,
                    fastest: Callable[[], Array] | None = None) -> PiecewiseTrajectory:
    """
    Return the motion of given durations, or raise an error with longer feasible ones.

    Parameters
    ----------
    motion_in : callable
        Returns the motion of given durations, or None where there is none.
    durations : ndarray, shape (n,)
        [s].
    fastest : callable, optional
        Returns the durations of the fastest motion [s]: the feasible ones are at least a multiple
        of these, and at least those given. None: they are a multiple of those given.

    Returns
    -------
    PiecewiseTrajectory
        The motion.

    Raises
    ------
    TimingError
        If there is none; with feasible durations, none shorter than those given.

    """
    motion = motion_in(durations)
    if motion is not None:
        return motion
    if fastest is None:
        proportions, least_T = durations, 0.0 * durations
        which = 'the least feasible in their proportion are'
    else:
        proportions, least_T, which = fastest(), durations, 'feasible are'
    scaling = _least_scaling(motion_in, proportions, least_T)
    if scaling is None:
        raise TimingError(
            f'segment_durations {durations.tolist()} s are too short, and no multiple of '
            'them is feasible')
    feasible = whole_microseconds(scaling * proportions * (1.0 + DURATION_MARGIN))
    raise durations_too_short(durations, np.maximum(feasible, least_T), which=which)


def least_durations_except_dwells(task: JointTask,
                                  fastest: Callable[[Array], Trajectory]) -> Array:
    """
    Return the durations of the fastest motion; those of segments without displacement as given.

    Parameters
    ----------
    task : JointTask
        With durations.
    fastest : callable
        Returns the fastest motion through points (m + 1, 3), none of which repeats.

    Returns
    -------
    ndarray, shape (n,)
        [s].

    """
    assert task.durations is not None
    stays = (np.diff(task.points, axis=0) == 0.0).all(axis=1)
    found = task.durations.copy()
    if not stays.all():
        found[~stays] = np.diff(fastest(task.points[np.append(True, ~stays)]).via_times)
    return found


def _least_scaling(motion_in: Callable[[Array], PiecewiseTrajectory | None], proportions: Array,
                   least_T: Array) -> float | None:
    """Return the least factor >= 1 on durations, with lower bounds, that makes them feasible."""
    def has_motion(factor: float) -> bool:
        return motion_in(np.maximum(factor * proportions, least_T)) is not None

    low, high = 1.0, 1.0
    while not has_motion(high):
        low, high = high, SCALING_STEP * high
        if high > LARGEST_SCALING:
            return None
    for _ in range(20):  # to 1.3^(2^-20)
        middle = float(np.sqrt(low * high))
        low, high = (low, middle) if has_motion(middle) else (middle, high)
    return high
