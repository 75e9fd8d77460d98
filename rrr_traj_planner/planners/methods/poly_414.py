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
`poly_414`: lines in joint space, blended by quartics around the via points (6.1-6.8, after Paul).

The thesis's [42], in a list of references that we do not have. The quartic transition is in Paul,
Robot Manipulators, MIT Press 1981, chapter 5.

Every transition lasts 2 t_acc, centred on the time at which two lines meet in their via point,
which is missed. Lines have the least durations that the limits and the transitions allow, none
less than 2 t_acc. Where torque exceeds its limits, the whole motion is slowed, t_acc with it. Jerk
steps where a quartic begins or ends.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.motion_laws.quartic import QUARTIC
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.blends.blend_motion import BlendTimes, is_within_limits, trajectory
from rrr_traj_planner.planners.blends.blend_timing import fastest, total_time
from rrr_traj_planner.planners.registration import register
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.tolerances import TORQUE_TOLERANCE
from rrr_traj_planner.planners.torque_scaling import (
    cannot_hold,
    slowed_for_torque,
    torque_time_scale,
)
from rrr_traj_planner.planners.transitions.prescribed_by_search import (
    feasible_motion,
    least_durations_except_dwells,
)
from rrr_traj_planner.planners.transitions.via_problem import via_problem_of, ViaProblem


@register('poly_414', misses_via_points=True)
def plan(task: JointTask) -> Trajectory:
    """
    Return the fastest 4-1-4 motion, or one of prescribed durations.

    Parameters
    ----------
    task : JointTask
        Via points, the arm and its limits.

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
        If gravity alone exceeds an effort limit along the path.

    """
    return planned(task, task.half_transition)


def planned(task: JointTask, t_acc: float) -> Trajectory:
    """
    Return the motion for a given t_acc.

    At a via point beside a segment whose least time from rest to rest is below 2 t_acc, the
    transition lasts that time instead, if the motion is then faster. With prescribed durations a
    transition is shorter where they are too short for it.

    Parameters
    ----------
    task : JointTask
        Via points, the arm and its limits.
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
        return feasible_motion(
            lambda durations: _motion_in(task, problem, t_acc, durations), task.durations,
            lambda: least_durations_except_dwells(task, lambda points: planned(
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
    """Return transitions no longer than the bounds of the segments before and after each."""
    inner = np.minimum(np.append(bounds, np.inf), np.append(np.inf, bounds))
    return np.asarray(np.minimum(transitions, inner))


def _motion_in(task: JointTask, problem: ViaProblem, t_acc: float,
               durations: Array) -> PiecewiseTrajectory | None:
    """
    Return the motion of given durations, None if it exceeds a limit.

    A segment contains half of both its transitions, the first and the last segment all of the
    motion's first and last transition.
    """
    longest = durations.copy()
    if len(longest) == 1:
        longest *= 0.5
    else:
        longest[[0, -1]] /= 1.5
    transitions = _beside(np.full(len(longest) + 1, 2.0 * t_acc), longest)
    lines = durations.copy()
    lines[0] -= 0.5 * transitions[0]
    lines[-1] -= 0.5 * transitions[-1]
    timing = BlendTimes(lines, transitions)
    if not is_within_limits(problem, timing):
        return None
    motion = trajectory(task.points, timing, QUARTIC)
    scaling = torque_time_scale(task, motion)
    if np.isinf(scaling):
        raise cannot_hold(task, motion)
    return motion if scaling <= 1.0 + TORQUE_TOLERANCE else None
