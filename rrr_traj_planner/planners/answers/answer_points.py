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
Sampling of the trajectory so that the controller's quintic spline satisfies the limits.

Where the spline exceeds a limit, points are inserted, not closer than a tenth of the sample
period; where that is not enough, the motion is slowed. A motion that cannot be slowed, and one
whose spline leaves a joint's range, get points down to CLOSEST. Excess of the jerk limit is
reduced by inserted points and otherwise reported in the note.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arrays import Array, IntArray
from rrr_traj_planner.core.errors import ConvergenceError, TimingError
from rrr_traj_planner.core.trajectory.controller_spline import (
    checked_intervals,
    checked_where_divided,
    RANGE_TOLERANCE,
    SplineExcess,
)
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through, spline_where_divided
from rrr_traj_planner.core.trajectory.sampling import (
    LEAST_GAP,
    NANOSECOND,
    points_at,
    sample_times,
    SampleTimes,
    STEP_FRACTION,
    with_states_at,
)
from rrr_traj_planner.core.trajectory.torque import time_scale_for_torque
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.planners.planning_problem import PlanningProblem

# Chosen values.
LARGEST_SCALING = 1.5  # of time, in a round: 1.1 or 3 change none of 28 random plans
CLOSEST = 1e-4         # s, least spacing for a motion that cannot be slowed, or leaves a range: a
#                        tenth of a controller's period of 1 ms

# Ratios above which the plan's note tells of them; chosen: what a user would notice.
REPORTED_JERK = 1.1       # of the quintics' jerk to its limit
REPORTED_SCALING = 1.001  # of the slowed motion's duration to the planned one's


class AnswerPoints(NamedTuple):
    """Points whose quintic spline satisfies the limits, and the motion that they sample."""

    trajectory: Trajectory    # slowed where necessary
    points: TrajectoryPoints
    effort: Array             # largest torque of the quintics, (3,) [N m]
    time_scale: float            # the factor by which the motion has been slowed
    note: str                 # on slowing and jerk; usually empty


def answer_points(problem: PlanningProblem, trajectory: Trajectory) -> AnswerPoints:
    """
    Return the points of a motion, and the motion, slowed as its points require.

    Parameters
    ----------
    problem : PlanningProblem
        The arm, its limits, the sample period, the durations and the largest number of points.
    trajectory : Trajectory
        Within the limits.

    Returns
    -------
    AnswerPoints
        Velocity, acceleration and torque of the quintics are within their limits to 0.1 %,
        positions within their ranges to 1e-6 rad.

    Raises
    ------
    InvalidInputError
        If there would be too many points.
    TimingError
        If quintics through the points of a motion of prescribed durations exceed limits.
    ConvergenceError
        If no points are found, which is a bug.

    """
    request = problem.request
    time_scale, min_spacing = 1.0, LEAST_GAP * request.sample_period
    closest = min(min_spacing, CLOSEST)
    for _ in range(40):  # at most: 20 or 80 change none of 28 random plans
        points, excess = _best_refined(problem, trajectory, min_spacing)
        factor = excess.slowing
        if factor <= 1.0:
            return AnswerPoints(trajectory, points, excess.effort, time_scale, _note(
                problem, excess.jerk.max(axis=0), time_scale))
        given = request.segment_durations is not None or request.start_rates is not None
        cannot_be_slower = given or np.isinf(
            time_scale_for_torque(problem.model, problem.limits, trajectory).value).any()
        if cannot_be_slower or np.isinf(factor):
            if min_spacing == closest:
                break
            min_spacing = closest
            continue
        factor = min(factor, LARGEST_SCALING)
        trajectory, time_scale = trajectory.time_scaled(factor), time_scale * factor
    if request.segment_durations is not None:
        raise TimingError(
            f'sample_period {request.sample_period} s is too long for segment_durations '
            f'{list(request.segment_durations)} s: between the points the motion would '
            'exceed its limits')
    raise ConvergenceError(
        f'planner {request.planner_id}: the quintics between the points need a time '
        f'scale of {factor:.6g}, limit 1, and leave a range by '
        f'{excess.outside.max(initial=0.0):.3g} rad, limit {RANGE_TOLERANCE:g} rad')


def _best_refined(problem: PlanningProblem, trajectory: Trajectory,
                  min_spacing: float) -> tuple[TrajectoryPoints, SplineExcess]:
    """
    Return points as close as necessary, and by how much quintics through them exceed limits.

    Where a limit is exceeded on one side of a step of acceleration, points are placed so that the
    quintic overshoots on the other side. If that exceeds it too, all overshoot before the step:
    planners whose motions have steps leave a margin for that (`PathTable.overshoot`).
    """
    found = _refined(problem, trajectory, min_spacing, False)
    if len(trajectory.step_times) and found[1].slowing > 1.0:
        other = _refined(problem, trajectory, min_spacing, True)
        found = min(found, other, key=lambda f: f[1].slowing)
    return found


def _refined(problem: PlanningProblem, trajectory: Trajectory, min_spacing: float,
             overshoot_before: bool) -> tuple[TrajectoryPoints, SplineExcess]:
    """
    Return points with intervals divided until the quintics keep limits or none can be divided.

    At steps of acceleration the quintic overshoots on the side with a margin, or before all steps.
    """
    request, model, limits = problem.request, problem.model, problem.limits
    times = sample_times(trajectory, request.sample_period, request.max_points)
    points = points_at(trajectory, times, from_rest=request.start_rates is None)
    request.should_stop()
    spline = spline_through(points)
    found = checked_intervals(model, limits, spline, request.should_stop)
    while True:
        excess = found.excess(limits)
        index, cuts = _divisions(
            limits, times, excess, trajectory.step_times, min_spacing, overshoot_before)
        if not len(index) or len(times.stamps) + len(index) > request.max_points:
            return points, excess
        times, further = times.divided(index, cuts)
        request.should_stop()
        points = with_states_at(points, trajectory, further, index + 1)
        request.should_stop()
        spline = spline_where_divided(spline, points, index)
        found = checked_where_divided(model, limits, spline, found, index, request.should_stop)


def _divisions(limits: JointLimits, times: SampleTimes, excess: SplineExcess, steps: Array,
               min_spacing: float, overshoot_before: bool) -> tuple[IntArray, Array]:
    """Return which intervals that exceed limits to divide, and when, at least a spacing apart."""
    begin, width = times.stamps[:-1] * NANOSECOND, np.diff(times.stamps) * NANOSECOND
    cut = begin + 0.5 * width
    outside = excess.outside > 0.0
    exceeds_jerk = np.asarray((excess.jerk > REPORTED_JERK * limits.max_jerk).any(axis=1))
    if len(steps):
        index = np.searchsorted(begin, steps, side='right') - 1
        share = (steps - begin[index]) / width[index]
        after = np.where(outside[index], share < 0.5,  # both intervals are shorter in any case
                         (excess.place[index] > share) | overshoot_before)
        # Not at the step itself: beside it, so that the step is at STEP_FRACTION of an interval.
        beside = STEP_FRACTION / (1.0 - STEP_FRACTION) * width[index]
        cut[index] = np.where(after, steps + beside * share, steps - beside * (1.0 - share))
        exceeds_jerk[index] = False  # a shorter interval would make the step's jerk larger
    least = np.where(outside, min(min_spacing, CLOSEST), min_spacing) - NANOSECOND
    far = np.minimum(cut - begin, begin + width - cut) >= least
    index = np.flatnonzero(far & (exceeds_jerk | (excess.time_scale > 1.0) | outside))
    return index, cut[index]


def _note(problem: PlanningProblem, jerk: Array, time_scale: float) -> str:
    """Return the note on slowing and on jerk; usually empty."""
    limit, texts = problem.limits.max_jerk, []
    if time_scale > REPORTED_SCALING:
        period, slower = problem.request.sample_period, 100.0 * (time_scale - 1.0)
        texts.append(f'sample_period {period:g} s makes the motion {slower:.2g} '
                     '% slower: a controller would else exceed limits between points')
    joint = int((jerk / limit).argmax())
    if jerk[joint] > REPORTED_JERK * limit[joint]:
        name = problem.model.joint_names[joint]
        texts.append(
            f'between points a controller makes {name} reach a jerk of '
            f'{jerk[joint]:.3g} rad/s^3, limit {limit[joint]:g} rad/s^3')
    return '; '.join(texts)
