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
Velocities at the via points and durations of the segments that take least total time.

For one joint, the least time of a segment as a function of its end velocities is bounded by a
second-order cone: this constraint on durations is convex. Its opposite is not: a joint that could
be faster must still take as long as the others. A Newton step solves a banded system: its cost is
linear in the number of via points. Method: `solver.barrier_method`; for long motions
`local_steps`.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.cancellation import never
from rrr_traj_planner.planners.solver.barrier_method import minimise, Solution
from rrr_traj_planner.planners.solver.via_barrier import ViaBarrier
from rrr_traj_planner.planners.transitions.local_steps import minimise_locally
from rrr_traj_planner.planners.transitions.via_problem import ViaProblem

# Of the start's durations; chosen: 1.1 and 2 give the same motions on 27 of 28 random tasks.
START_MARGIN = 1.3   # over the least ones from rest to rest: all limits are then inactive

# Segments up to which every step is of the whole motion; chosen: there `local_steps` would save a
# tenth at most, of 1,000 they save more than half.
FEW = 100


def least_time(problem: ViaProblem, least_T: Array | None = None,
               should_stop: Callable[[], bool] = never,
               is_futile: Callable[[Solution], bool] | None = None) -> Solution:
    """
    Return the via velocities and durations of least total time.

    Parameters
    ----------
    problem : ViaProblem
        The via points; no displacement zero in all joints.
    least_T : ndarray, shape (n,), optional
        Durations [s] that no segment may fall below.
    should_stop : callable
        Cancellation callback, called before every step; True ends the method with its iterate.
    is_futile : callable, optional
        Of long motions, called with a nearly converged solution; True ends the method with that.

    Returns
    -------
    Solution
        Within a relative 2e-7 of the least total time, where the problem is convex and it is not
        cancelled.

    """
    n = len(problem.displacements)
    T = problem.rest_to_rest_times()
    if least_T is not None:
        T = np.maximum(T, least_T)
    barrier = ViaBarrier(problem, np.zeros((n - 1, 3)), START_MARGIN * T, least_T)
    if n <= FEW:
        return minimise(barrier, should_stop)
    return minimise_locally(barrier, should_stop, is_futile)


def least_time_scale(problem: ViaProblem, durations: Array) -> tuple[float, Solution]:
    """
    Return the least factor with which prescribed durations are feasible.

    Parameters
    ----------
    problem : ViaProblem
        The via points.
    durations : ndarray, shape (n,)
        Prescribed durations [s], positive.

    Returns
    -------
    tuple of float and Solution
        The factor, below 1 where the durations are longer than necessary, and the motion of the
        scaled durations.

    """
    n = len(problem.displacements)
    least = float((problem.rest_to_rest_times() / durations).max())
    # Durations are positive where nothing moves, too: at least a millionth of those given; chosen.
    factor = START_MARGIN * max(least, 1e-6)
    solution = minimise(ViaBarrier(problem, np.zeros((n - 1, 3)), factor * durations,
                                   proportions=durations), never)
    return float(solution.durations[0] / durations[0]), solution
