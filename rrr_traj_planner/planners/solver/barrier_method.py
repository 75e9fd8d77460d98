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
The barrier method over via velocities and durations; every iterate is strictly feasible.

Boyd & Vandenberghe, Convex Optimization, algorithm 11.1: minimise weight * objective + barrier by
damped Newton steps for an increasing sequence of weights, until the gap, the number of constraints
over the weight (11.2.2), is small. Instead of a line search along one step, damping (Levenberg and
Marquardt; Nocedal & Wright, Numerical Optimization, 10.3) scales up the Hessian of those terms of
the barrier that a step predicted badly: the barrier has kinks where a transition passes from the
jerk limit to the acceleration limit, and the other segments still take full steps.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.planners.solver.library import KERNELS
from rrr_traj_planner.planners.solver.via_barrier import ViaBarrier

# Chosen values, without unit. RELATIVE_GAP and POLISHED decide accuracy, the others the number of
# steps: half and twice of each (TOLERATED_RISE: 0.6 and 1) change at most one of 28 random plans,
# by 0.4 %.
RELATIVE_GAP = 2e-7        # of the objective, at which the method ends
ROUGH_GAP = 1e-5           # at which it may turn out that a solution is of no use
CENTRED = 0.5              # Newton decrement squared at which the weight is raised,
POLISHED = 1e-7            # and at the end: the answer then varies smoothly with the task
BARRIER_REDUCTION = 0.12   # of 1 / weight, from one centre to the next
SUFFICIENT_DECREASE = 0.1  # of the decrement squared (Armijo)
TOLERATED_RISE = 0.75      # of s'Hs: a term may increase by so much beyond g's on a step s; 1/2 is
#                            the prediction of the quadratic model
MORE_DAMPING = 4.0         # factor for the terms that a trial predicted badly
LESS_DAMPING = 0.25        # factor for all terms after an accepted step
ROUNDING = 1e-15           # of weight * objective, below which a decrease is rounding


class Solution(NamedTuple):
    """Velocities at the via points and durations, strictly feasible."""

    velocities: Array  # shape (n - 1, 3) [rad/s]
    durations: Array   # shape (n,) [s]
    gap: float         # upper bound on objective - optimum, where the problem is convex


def minimise(barrier: ViaBarrier, should_stop: Callable[[], bool]) -> Solution:
    """
    Return the minimiser of the objective of a barrier problem.

    Parameters
    ----------
    barrier : ViaBarrier
        The problem, at a strictly feasible point.
    should_stop : callable
        Cancellation callback, called before every step; True ends the method with the iterate.

    Returns
    -------
    Solution
        Within RELATIVE_GAP of the optimum, where the problem is convex and it is not cancelled.

    """
    def centre(weight: float, decrement: float) -> bool:
        return _centre(barrier, weight, decrement, should_stop)

    return along_central_path(barrier, centre)


def along_central_path(barrier: ViaBarrier, centre: Callable[[float, float], bool],
                       reduction: float = BARRIER_REDUCTION,
                       is_futile: Callable[[Solution], bool] | None = None) -> Solution:
    """
    Return the minimiser of the objective, by centring with larger and larger weights.

    Parameters
    ----------
    barrier : ViaBarrier
        The problem, at a strictly feasible point.
    centre : callable
        Minimises weight * objective + barrier up to a Newton decrement squared, given the weight
        and the decrement; returns whether it was cancelled.
    reduction : float
        Of 1 / weight, from one centre to the next.
    is_futile : callable, optional
        Called once, with the first solution within ROUGH_GAP; True ends the method with that.

    Returns
    -------
    Solution
        As of `minimise`.

    """
    count, found = barrier.constraints, barrier.structure
    weight = count / found.objective
    stopped = centre(weight, CENTRED)
    while not stopped and count / weight >= RELATIVE_GAP * found.objective:
        if is_futile is not None and count / weight < ROUGH_GAP * found.objective:
            rough = Solution(barrier.velocities, barrier.durations, count / weight)
            if is_futile(rough):
                return rough
            is_futile = None
        weight /= reduction
        stopped = centre(weight, CENTRED)
    if not stopped:
        centre(weight, POLISHED)
    return Solution(barrier.velocities, barrier.durations, count / weight)


def _centre(barrier: ViaBarrier, weight: float, decrement: float,
            should_stop: Callable[[], bool]) -> bool:
    """Minimise weight * objective + barrier up to a decrement; return whether it was cancelled."""
    for _ in range(25):  # at most, before the weight is raised
        if should_stop():
            return True
        rounding = ROUNDING * weight * barrier.structure.objective
        squared = _step(barrier, weight)
        if squared is None or squared < decrement or squared < rounding:
            break
    return False


def _step(barrier: ViaBarrier, weight: float) -> float | None:
    """Take a Newton step; return its decrement squared, None where rounding allows no decrease."""
    address, found = barrier.address, barrier.structure
    for _ in range(30):  # of damping, at most
        change = KERNELS.via_attempt(address, weight)
        squared: float = found.decrement
        if not squared >= 0.0:
            return None
        if change <= -SUFFICIENT_DECREASE * squared:
            KERNELS.via_accept(address, LESS_DAMPING)
            return squared
        KERNELS.via_damp(address, TOLERATED_RISE, MORE_DAMPING)
    return None
