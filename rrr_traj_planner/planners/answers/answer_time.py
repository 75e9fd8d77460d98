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

"""Time that is kept for points and checks of an answer that will have many points."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.travel_time import travel_time, ViaPointBehaviour
from rrr_traj_planner.core.trajectory.controller_spline import BLOCK, checked_intervals
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.planners.deadline import Deadline
from rrr_traj_planner.planners.planning_problem import PlanningProblem

# Chosen values.
MANY = 20_000  # points from which on their time is estimated: fewer take 0.05 s
WHOLE = 1.8    # time of an answer over that of the checks that are measured: 1.6 to 2.5
BESIDES = 30   # points that take as long as the last checks of a segment's motion
TRIES = 2      # of the measurement: the least counts


def with_time_for_answer(problem: PlanningProblem, q: Array,
                         passing: ViaPointBehaviour) -> PlanningProblem:
    """
    Return the same problem, with time kept for the answer if it will have MANY points.

    Parameters
    ----------
    problem : PlanningProblem
        The arm and the request.
    q : ndarray, shape (n, 3)
        Joint positions in the order in which they are passed [rad].
    passing : ViaPointBehaviour
        How the motion passes via points.

    Returns
    -------
    PlanningProblem
        See `Deadline.keeping`.

    """
    request, should_stop = problem.request, problem.request.should_stop
    durations = np.zeros(0) if request.segment_durations is None else request.segment_durations
    duration = max(travel_time(problem.limits, q, passing), float(np.nansum(durations)))
    number = (duration + float(request.rests.dwell.sum())) / request.sample_period
    number += BESIDES * len(q)
    if number < MANY or not isinstance(should_stop, Deadline):
        return problem
    kept = should_stop.keeping(number * _seconds_per_point(problem, q[0], should_stop))
    return replace(problem, request=replace(request, should_stop=kept))


def _seconds_per_point(problem: PlanningProblem, q: Array, deadline: Deadline) -> float:
    """Return the time of a point of the answer [s], by that of checks of a rest."""
    still = np.zeros((BLOCK + 1, 3))
    rest = spline_through(TrajectoryPoints(
        problem.request.sample_period * np.arange(float(BLOCK + 1)), still + q, still, still))
    return WHOLE / BLOCK * min(deadline.duration_of(partial(
        checked_intervals, problem.model, problem.limits, rest)) for _ in range(TRIES))
