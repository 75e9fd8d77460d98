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
`cycloid_approach_b`: blends around the via points, after Paul (thesis 4.2, b; figure 4.4).

Via points between the first and the last are missed: the arm cuts the corners of the lines between
them in joint space. Transitions are full-period cycloids, common to all joints, as short as the
limits allow: the shorter, the less they miss by.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.travel_time import ViaPointBehaviour
from rrr_traj_planner.core.motion_laws.cycloid_transitions import CYCLOID
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.blends.blend_motion import (
    BlendTimes,
    is_within_limits,
    shortest_transitions,
    trajectory,
)
from rrr_traj_planner.planners.blends.blend_timing import fastest
from rrr_traj_planner.planners.registration import register
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.torque_scaling import slowed_for_torque
from rrr_traj_planner.planners.transitions.prescribed_by_search import (
    feasible_motion,
    least_durations_except_dwells,
    within_torque,
)
from rrr_traj_planner.planners.transitions.transition_law import TransitionLaw
from rrr_traj_planner.planners.transitions.via_problem import via_problem_of, ViaProblem


@register('cycloid_approach_b', misses_via_points=True, passing=ViaPointBehaviour('blend'))
def plan(task: JointTask) -> Trajectory:
    """
    Return the fastest motion of approach (b), or one of prescribed durations.

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
    problem = via_problem_of(task, CYCLOID)
    if task.durations is None:
        return _fastest(task, problem)
    return feasible_motion(
        lambda durations: within_torque(
            task, problem.law, lambda law: _motion_in(task, problem, law, durations)),
        task.durations, lambda: least_durations_except_dwells(task, lambda points: plan(
            replace(task, points=points, durations=None))))


def _fastest(task: JointTask, problem: ViaProblem) -> Trajectory:
    """Return the fastest motion."""
    timing = fastest(problem, None, task.should_stop)
    return slowed_for_torque(task, trajectory(task.points, timing, CYCLOID))


def _motion_in(task: JointTask, problem: ViaProblem, law: TransitionLaw,
               durations: Array) -> PiecewiseTrajectory | None:
    """Return the motion of given durations, None if it exceeds a limit other than torque's."""
    lines = _lines(law, problem.displacements, durations)
    if lines is None:
        return None
    timing = BlendTimes(lines, shortest_transitions(law, problem.displacements, lines))
    return trajectory(task.points, timing, CYCLOID) if is_within_limits(problem, timing) else None


def _lines(law: TransitionLaw, D: Array, durations: Array) -> Array | None:
    """
    Return the times of the lines, None where the first or the last transition does not fit.

    The first duration is that of half the first transition and the first line, the last one
    likewise: T + share t(D / T) = duration. The left side is convex: Newton's method from above
    converges to the greater solution.
    """
    share = np.zeros(len(D))
    share[0] += 0.5
    share[-1] += 0.5
    T, held = durations.copy(), (share * np.abs(D).max(axis=1)) > 0.0
    for k in np.flatnonzero(held):
        for _ in range(60):  # convergence is quadratic, slower near a double root
            each = law.least_time(D[k] / T[k])
            j = int(each.argmax())
            rate = law.slope[j] * abs(D[k, j]) / T[k]  # t by the acceleration limit
            power = 1.0 if rate >= each[j] else 0.5
            above = T[k] + share[k] * each[j] - durations[k]
            fall = 1.0 - share[k] * power * each[j] / T[k]
            if fall <= 0.0:
                return None
            step = above / fall
            T[k] -= step
            if T[k] <= 0.0:
                return None
            if step <= 1e-15 * T[k]:  # a few units in the last place (2^-52): converged
                break
    return T
