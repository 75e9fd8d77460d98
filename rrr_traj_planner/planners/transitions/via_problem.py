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

"""The via-point problem: displacements between via points, and the limits of the motion."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.motion_laws.cycloid_transitions import CYCLOID
from rrr_traj_planner.core.read_only import ReadOnlyArrays
from rrr_traj_planner.core.trajectory.pieces import TransitionFunction
from rrr_traj_planner.planners.sampling_jerk_limit import jerk_over_samples, SAMPLES_PER_TRANSITION
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.transitions.transition_law import SegmentLimits, TransitionLaw

LEAST_VELOCITY = 1e-9      # rad/s, bound of a via velocity that must be zero: rounding; chosen


@dataclass(frozen=True, eq=False)
class ViaProblem(ReadOnlyArrays):
    """
    The displacements between via points, and the limits of the motion.

    Parameters
    ----------
    displacements : ndarray, shape (n, 3)
        From point to point [rad].
    law : TransitionLaw
        Transitions' least durations.
    max_velocity : ndarray, shape (3,)
        [rad/s], finite.
    lowest, highest : ndarray, shape (n - 1, 3)
        Bounds of the velocities at the via points [rad/s], around 0.
    function : TransitionFunction
        The velocity function of transitions.

    """

    displacements: Array
    law: TransitionLaw
    max_velocity: Array
    lowest: Array
    highest: Array
    function: TransitionFunction = CYCLOID

    @property
    def segment_limits(self) -> SegmentLimits:
        """Return the limits of each segment's motion."""
        return SegmentLimits(self.law, self.max_velocity)

    def rest_to_rest_times(self) -> Array:
        """Return the least durations with a stop at every via point, shape (n,) [s]."""
        D = np.abs(self.displacements)
        slope, root = self.law.slope, self.law.root
        with np.errstate(divide='ignore', invalid='ignore'):
            by_jerk = np.where(root > 0.0, (D / root) ** (2.0 / 3.0), np.inf)
            # cruise u without a velocity limit: D = u t(u)
            u = np.minimum(np.minimum(np.sqrt(D / slope), by_jerk), self.max_velocity)
            total = np.where(D > 0.0, self.law.least_time(u) + D / u, 0.0)
        return np.asarray(total.max(axis=1))


def slower_at(problem: ViaProblem, segments: BoolArray) -> ViaProblem:
    """
    Return the problem with tighter bounds on velocities at the ends of some segments.

    Parameters
    ----------
    problem : ViaProblem
        The via points.
    segments : ndarray of bool, shape (n, 3)
        Which segments of which joints.

    Returns
    -------
    ViaProblem
        With the bounds of the via velocities halved there.

    """
    at_ends = segments[:-1] | segments[1:]
    factor = np.where(at_ends, 0.5, 1.0)
    return replace(problem, lowest=np.minimum(problem.lowest * factor, -LEAST_VELOCITY),
                   highest=np.maximum(problem.highest * factor, LEAST_VELOCITY))


def at_rest(problem: ViaProblem) -> ViaProblem:
    """
    Return the problem with a stop at every via point: its motions do not overshoot.

    Parameters
    ----------
    problem : ViaProblem
        The via points.

    Returns
    -------
    ViaProblem
        With via velocities bounded by LEAST_VELOCITY; see `rests_everywhere`.

    """
    still = np.full_like(problem.highest, LEAST_VELOCITY)
    return replace(problem, lowest=-still, highest=still)


def rests_everywhere(problem: ViaProblem) -> bool:
    """
    Return whether every via velocity is to be zero: its times then have a closed form.

    The barrier method would leave velocities below the bound, and in a long transition even those
    overshoot a range.

    Parameters
    ----------
    problem : ViaProblem
        The via points.

    Returns
    -------
    bool
        True also where there are no via points between the first and the last.

    """
    return bool((np.maximum(-problem.lowest, problem.highest) <= LEAST_VELOCITY).all())


def via_problem_of(task: JointTask, function: TransitionFunction = CYCLOID) -> ViaProblem:
    """
    Return the via-point problem of a task.

    A via velocity is bounded so that the joint can stop before the end of its range.

    Parameters
    ----------
    task : JointTask
        Via points, the arm and its limits.
    function : TransitionFunction
        The velocity function of transitions.

    Returns
    -------
    ViaProblem
        The problem.

    Raises
    ------
    InvalidInputError
        If a joint has no acceleration limit.

    """
    limits = task.limits
    if np.isinf(limits.max_acceleration).any():
        joint = task.model.joint_names[int(np.isinf(limits.max_acceleration).argmax())]
        raise InvalidInputError(
            f'a planner of {function.name} transitions needs acceleration limits, {joint} has '
            'none')
    jerk = np.minimum(limits.max_jerk, jerk_over_samples(
        function.peak_jerk / function.peak_acceleration, limits.max_acceleration,
        SAMPLES_PER_TRANSITION, task.sample_period))
    law = TransitionLaw(function.peak_acceleration / limits.max_acceleration,
                        np.sqrt(function.peak_jerk / jerk))
    D = np.diff(task.points, axis=0)
    fastest = np.sqrt(2.0 * np.abs(D).sum(axis=0) / law.slope) + 1.0  # above any motion's
    velocity = np.minimum(limits.max_velocity, fastest)
    inner = task.points[1:-1]
    distance = np.minimum(inner - limits.min_position, limits.max_position - inner)
    highest = np.clip(np.sqrt(2.0 * np.maximum(distance, 0.0) / law.slope), LEAST_VELOCITY,
                      velocity)
    return ViaProblem(D, law, velocity, -highest, highest, function)
