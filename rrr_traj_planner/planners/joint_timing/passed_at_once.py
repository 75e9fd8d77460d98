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

"""Via points that a moving arm passes at once, whatever it does: the solver is spared them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.rounding import JOINT_ROUNDING
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.planners.tasks import JointTask


def times_of_points_passed_at_once(task: JointTask) -> Array:
    """
    Return when a moving arm passes the first via points, where no jerk can change that.

    Up to rounding, the arm moves with its first acceleration for as long as the largest jerk
    takes to move a joint by half of `JOINT_ROUNDING`.

    Parameters
    ----------
    task : JointTask
        The arm, its limits, the via points and how the joints move at the start.

    Returns
    -------
    ndarray, shape (k,)
        [s], increasing; of the first k via points but the last, at which the arm rests.

    """
    (v, a), found = task.rates_at_start, [0.0]
    longest = float(np.cbrt(3.0 * JOINT_ROUNDING / task.limits.max_jerk.max()))
    for point in task.points[1:-1]:
        way, t = point - task.points[0], 0.0
        for _ in range(2):  # the second time with the mean velocity until then
            pace = float((v + 0.5 * t * a) @ v)
            along = float(way @ v)
            if not 0.0 < along <= longest * pace:
                return np.array(found[1:])
            t = along / pace
        beside = np.abs(t * (v + 0.5 * t * a) - way).max()
        if t <= found[-1] or beside > 0.5 * JOINT_ROUNDING:
            break
        found.append(t)
    return np.array(found[1:])


def without_first_points(task: JointTask, number: int) -> JointTask:
    """
    Return a task without its first via points.

    Parameters
    ----------
    task : JointTask
        It starts moving.
    number : int
        Of the points.

    Returns
    -------
    JointTask
        From the same state.

    """
    own = task.segment_numbers
    return replace(task, points=np.delete(task.points, np.s_[1:number + 1], axis=0),
                   segment_numbers=np.arange(number, len(task.points) - 1) if own is None
                   else own[number:])


def passing(motion: PiecewiseTrajectory, times: Array) -> PiecewiseTrajectory:
    """
    Return the same motion with further via points after its start.

    Parameters
    ----------
    motion : PiecewiseTrajectory
        The motion.
    times : ndarray, shape (k,)
        When it passes them [s].

    Returns
    -------
    PiecewiseTrajectory
        With k more via times.

    """
    if not len(times):
        return motion
    return PiecewiseTrajectory(motion.profiles, np.insert(motion.via_times, 1, times),
                               motion.note, motion.jerk_step_times)
