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
`poly_414`: lines in joint space, quartics around the via points (6.1-6.8, after Paul).

Every transition lasts 2 t_acc, half of it before and half of it after the time at which two lines
meet in their via point, which is missed. Lines take the least times that the limits and the
transitions allow, none less than 2 t_acc. Where that asks for more torque than there is, the whole
motion is slowed, t_acc with it. Jerk steps where a quartic begins or ends.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.motion_laws.quartic import QUARTIC
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.blends.blend_motion import is_kept, Straddling, trajectory
from rrr_traj_planner.planners.blends.blend_timing import fastest, total_time
from rrr_traj_planner.planners.prescribed_by_search import (
    fastest_beside_stays,
    kept_or_refused,
    TORQUE_TOLERANCE,
)
from rrr_traj_planner.planners.registry import register
from rrr_traj_planner.planners.request import JointTask
from rrr_traj_planner.planners.transitions.motion_law import (
    cannot_hold,
    slowed_for_torque,
    torque_stretch,
    via_problem_of,
)
from rrr_traj_planner.planners.transitions.via_problem import ViaProblem


@register('poly_414', misses_via_points=True)
def plan(task: JointTask) -> Trajectory:
    """
    Return the fastest 4-1-4 motion, or one of prescribed durations.

    Parameters
    ----------
    task : JointTask
        What is asked.

    Returns
    -------
    Trajectory
        Within the limits; via times are the middles of the transitions.

    Raises
    ------
    InvalidInputError
        If a joint has no acceleration limit.
    TimingError
        If prescribed durations are too short; with feasible ones.
    LimitViolationError
        If gravity alone exceeds an effort limit on the way.

    """
    return planned(task, task.half_transition)


def planned(task: JointTask, t_acc: float) -> Trajectory:
    """
    Return the motion for a given t_acc.

    It is shorter at a via point beside a segment that could be gone from rest to rest within
    2 t_acc: half that time, if the motion is then faster. With prescribed durations it is shorter
    where they leave no room for it.

    Parameters
    ----------
    task : JointTask
        What is asked.
    t_acc : float
        Half the length of a transition [s].

    Returns
    -------
    Trajectory
        Within the limits.

    Raises
    ------
    InvalidInputError, TimingError, LimitViolationError
        As in `plan`.

    """
    problem = via_problem_of(task, QUARTIC)
    if task.durations is not None:
        return kept_or_refused(
            lambda durations: _motion_in(task, problem, t_acc, durations), task.durations,
            lambda: fastest_beside_stays(task, lambda points: planned(
                replace(task, points=points, durations=None), t_acc)))
    return _fastest(task, problem, t_acc)


def _fastest(task: JointTask, problem: ViaProblem, t_acc: float) -> Trajectory:
    """Return the fastest motion."""
    full = np.full(len(task.points), 2.0 * t_acc)
    short = _beside(full, problem.rest_to_rest_times())
    timings = [fastest(problem, transitions, task.should_stop)
               for transitions in ([full] if (short == full).all() else [full, short])]
    return slowed_for_torque(
        task, trajectory(task.points, min(timings, key=total_time), QUARTIC))


def _beside(transitions: Array, bounds: Array) -> Array:
    """Return transitions that are no longer than the bound of either segment beside them."""
    inner = np.minimum(np.append(bounds, np.inf), np.append(np.inf, bounds))
    return np.asarray(np.minimum(transitions, inner))


def _motion_in(task: JointTask, problem: ViaProblem, t_acc: float,
               durations: Array) -> PiecewiseTrajectory | None:
    """
    Return the motion of given durations, None if it breaks a limit.

    A segment holds half of both its transitions, the first and the last segment all of the
    motion's first and last transition.
    """
    room = durations.copy()
    if len(room) == 1:
        room *= 0.5
    else:
        room[[0, -1]] /= 1.5
    transitions = _beside(np.full(len(room) + 1, 2.0 * t_acc), room)
    lines = durations.copy()
    lines[0] -= 0.5 * transitions[0]
    lines[-1] -= 0.5 * transitions[-1]
    timing = Straddling(lines, transitions)
    if not is_kept(problem, timing):
        return None
    motion = trajectory(task.points, timing, QUARTIC)
    stretch = torque_stretch(task, motion)
    if np.isinf(stretch):
        raise cannot_hold(task, motion)
    return motion if stretch <= 1.0 + TORQUE_TOLERANCE else None
