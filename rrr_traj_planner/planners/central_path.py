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
The central path of a log barrier, to the least time or stretch: always feasible.

Where a Newton step is too long for some part of the barrier, which has kinks, that part alone is
damped: the others need not wait for it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, Protocol

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.planners import compiled
from rrr_traj_planner.planners.barrier import (
    damped,
    Derivatives,
    derivatives,
    local,
    misjudged,
    Parts,
    values,
)
from rrr_traj_planner.planners.chain import Chain
from rrr_traj_planner.planners.compiled_segments import followed, VelocitySettings

# The barrier's gap, relative to the total time: what a better answer could save at most.
RELATIVE_GAP = 2e-7
BARRIER_REDUCTION = 0.12
CENTRED = 0.5            # Newton decrement squared below which the barrier is lowered
POLISHED = 1e-7          # the same at the end: the answer then varies smoothly with the task
STEPS_TO_CENTRE = 25     # and after so many steps it is lowered all the same
SUFFICIENT_DECREASE = 0.1
TRIES = 30               # of a step
MORE_DAMPING = 4.0       # of the parts of the barrier that a step misjudged, before the next try
LESS_DAMPING = 0.25      # of all, before the next step
ROUNDING = 1e-15         # of what is minimised, below which no gain is seen


class Solution(NamedTuple):
    """Velocities at the via points and durations, strictly feasible."""

    velocities: Array  # shape (n - 1, 3) [rad/s]
    durations: Array   # shape (n,) [s]
    gap: float         # what a better answer could save at most, of what is minimised


class Problem(Protocol):
    """What is minimised along the central path."""

    @property
    def chain(self) -> Chain:
        """Return the via points."""

    @property
    def floor(self) -> Array | None:
        """Least durations, if there are any [s]."""

    @property
    def proportions(self) -> Array | None:
        """Durations whose common stretch is sought; None: each is free [s]."""

    def objective(self, T: Array) -> float:
        """
        Return what is minimised.

        Parameters
        ----------
        T : ndarray, shape (n,)
            Durations [s].

        Returns
        -------
        float
            Seconds, or a factor.

        """

    def newton_step(self, b: Derivatives, weight: float) -> tuple[Array, Array, float]:
        """
        Return the Newton step of weight * objective + barrier.

        Parameters
        ----------
        b : Derivatives
            The barrier's.
        weight : float
            The objective's.

        Returns
        -------
        tuple
            Changes of via velocities (n - 1, 3) and durations (n,), the decrement squared.

        """


def follow(problem: Problem, v: Array, T: Array, should_stop: Callable[[], bool]) -> Solution:
    """
    Lower the barrier from a strictly feasible point until the gap is closed.

    Parameters
    ----------
    problem : Problem
        What is minimised.
    v : ndarray, shape (n - 1, 3)
        Via velocities to begin with [rad/s].
    T : ndarray, shape (n,)
        Durations [s].
    should_stop : callable
        Asked before every step; True ends the search with what it has.

    Returns
    -------
    Solution
        The least, where the problem is convex and nothing stops the search.

    """
    if compiled.LIBRARY is not None:
        return Solution(*followed(
            problem.chain, problem.floor, problem.proportions, v, T, VelocitySettings(
                RELATIVE_GAP, BARRIER_REDUCTION, CENTRED, POLISHED, SUFFICIENT_DECREASE,
                MORE_DAMPING, LESS_DAMPING, ROUNDING, STEPS_TO_CENTRE, TRIES), should_stop))
    constraints = 12 * len(T) + 6 * len(v)
    weight = constraints / problem.objective(T)
    damping = Parts(np.zeros((len(T), 3)), np.zeros_like(v), np.zeros_like(T))
    while True:
        v, T, damping, stopped = _centre(problem, v, T, weight, CENTRED, damping, should_stop)
        closed = constraints / weight < RELATIVE_GAP * problem.objective(T)
        if stopped or closed:
            break
        weight /= BARRIER_REDUCTION
    if closed:
        v, T, damping, _ = _centre(problem, v, T, weight, POLISHED, damping, should_stop)
    return Solution(v, T, constraints / weight)


def _centre(problem: Problem, v: Array, T: Array, weight: float, centred: float, damping: Parts,
            should_stop: Callable[[], bool]) -> tuple[Array, Array, Parts, bool]:
    """Return a point near the minimum of weight * objective + barrier, and whether to stop."""
    chain, floor = problem.chain, problem.floor
    before = values(chain, floor, v, T)
    for _ in range(STEPS_TO_CENTRE):
        if should_stop():
            return v, T, damping, True
        at = local(chain, floor, v, T)
        cost = weight * problem.objective(T)
        for _ in range(TRIES):
            stiff = damped(at, damping)
            try:
                dv, dT, decrement = problem.newton_step(derivatives(stiff), weight)
            except np.linalg.LinAlgError:
                return v, T, damping, False  # rounding leaves no step to be found
            after = values(chain, floor, v + dv, T + dT)
            change = Parts(*(a - b for a, b in zip(after, before)))
            if weight * problem.objective(T + dT) - cost + sum(
                    float(c.sum()) for c in change) <= -SUFFICIENT_DECREASE * decrement:
                break
            wrong = misjudged(stiff, dv, dT, change)
            damping = Parts(*(np.where(w, d * MORE_DAMPING + 1.0, d)
                              for w, d in zip(wrong, damping)))
        else:
            return v, T, damping, False  # nor a lower point
        v, T, before = v + dv, T + dT, after
        damping = Parts(*(d * LESS_DAMPING for d in damping))
        if decrement < max(centred, ROUNDING * cost):
            break
    return v, T, damping, False
