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
Motions that stop at every via point: approach (c) of thesis section 4.2.

The segments are independent of each other: each takes its own least time, is slowed by itself as
its torques require, and may be prescribed any longer duration. Planners differ in the motion of a
segment.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.errors import TimingError
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.planners.short_durations import durations_too_short, whole_microseconds
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.tolerances import DURATION_MARGIN, DURATION_TOLERANCE
from rrr_traj_planner.planners.torque_scaling import (
    cannot_hold,
    squared_time_scale_by_segment,
    torque_time_scale,
)

# Time scaling by sampled torques above which a segment's torque peaks are located exactly; chosen:
# 0.4 and 0.95 change none of 10 random plans.
SPEED_CHECKED = 0.8

# Returns the motion of consecutive segments in given durations.
SegmentMotion = Callable[[slice, Array], PiecewiseTrajectory]


def kinematic_durations(task: JointTask, least: Array) -> Array:
    """
    Return positive durations of segments from their least ones, torque not considered.

    Parameters
    ----------
    task : JointTask
        For its sample period.
    least : ndarray, shape (n,)
        Least durations by velocity, acceleration and jerk limits [s], 0 where nothing moves.

    Returns
    -------
    ndarray, shape (n,)
        [s], with DURATION_MARGIN; a millionth of the sample period where nothing moves.

    """
    return np.maximum(least * (1.0 + DURATION_MARGIN), task.sample_period * DURATION_MARGIN)


def stopping_motion(task: JointTask, quick: Array, motion: SegmentMotion) -> PiecewiseTrajectory:
    """
    Return the fastest motion that stops at every via point, or one of prescribed durations.

    Parameters
    ----------
    task : JointTask
        Via points, the arm and its limits; durations that are NaN are free.
    quick : ndarray, shape (n,)
        Durations within all limits but torque's [s].
    motion : callable
        Returns the motion of a slice of the segments in given durations, none shorter than these;
        in other durations the same motion, faster or slower.

    Returns
    -------
    PiecewiseTrajectory
        Within the limits.

    Raises
    ------
    TimingError
        If prescribed durations are too short; with feasible ones.
    LimitViolationError
        If gravity alone exceeds an effort limit between the via points.

    """
    everywhere = slice(0, len(quick))
    scalings = np.ones(len(quick))
    for k in np.flatnonzero(may_exceed_torque(task, motion(everywhere, quick))).tolist():
        task.should_stop()
        scalings[k] = max(1.0, torque_time_scale(task, motion(slice(k, k + 1), quick[k:k + 1])))
    if np.isinf(scalings).any():
        raise cannot_hold(task, motion(everywhere, quick))
    least = quick * scalings
    durations = least if task.durations is None else np.where(
        np.isnan(task.durations), least, task.durations)
    short = durations < least * (1.0 - DURATION_TOLERANCE)
    if short.any():
        raise _too_short(task, durations, least, np.flatnonzero(short).tolist())
    return motion(everywhere, durations)


def may_exceed_torque(task: JointTask, motion: PiecewiseTrajectory) -> BoolArray:
    """
    Return which segments may exceed torque limits, by samples: the others are well within.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    motion : PiecewiseTrajectory
        Through all via points.

    Returns
    -------
    ndarray of bool, shape (n,)
        Segments whose sampled torque requires a time scaling of more than SPEED_CHECKED.

    """
    worst = squared_time_scale_by_segment(task, motion, ['right', 'left'])
    return np.asarray(~(worst < SPEED_CHECKED ** 2))


def _too_short(task: JointTask, durations: Array, least: Array, short: list[int]) -> TimingError:
    """Return the error of prescribed durations that are too short, with the least feasible."""
    return durations_too_short(durations, np.maximum(durations, whole_microseconds(least)),
                               [task.segment_number(k) for k in short])
