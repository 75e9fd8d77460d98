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
The barrier method of `solver.barrier_method` for long motions: steps only where they are needed.

A step of the whole motion is refused if it predicts one place badly, and centring takes as many
steps as its slowest place; the longer the motion, the worse is its worst place. Here such a place
alone is damped, and the step computed again around it, with the steps beside as they are: their
influence decays within a few segments. Segments that are centred rest while the others take more
steps; a last step of all of them together confirms that they all are.
"""

from __future__ import annotations

from collections.abc import Callable
import ctypes
from ctypes import c_double, c_void_p

import numpy as np
from rrr_traj_planner.core.kernels import declared, same_size_as
from rrr_traj_planner.planners.solver.barrier_method import (
    along_central_path,
    BARRIER_REDUCTION,
    LESS_DAMPING,
    MORE_DAMPING,
    ROUNDING,
    Solution,
    SUFFICIENT_DECREASE,
    TOLERATED_RISE,
)
from rrr_traj_planner.planners.solver.via_barrier import ViaBarrier

# Part of the Newton decrement squared that the segments without a step may have together; chosen:
# 0.02 and 0.25 take as long.
LEFT_OUT = 0.1
MOST_STEPS = 50  # before the weight is raised; chosen, twice as many as of whole steps

# Of 1 / weight, from one centre to the next; chosen: with that of `barrier_method`, twice as much,
# planning takes a tenth longer.
REDUCTION = 0.5 * BARRIER_REDUCTION

# Damping of a first step after the weight is raised: the tangent of the central path by 1 / weight
# is as much shorter than Newton's step as the barrier's weight has become less.
TANGENT = 1.0 / REDUCTION - 1.0

KERNELS = declared({'via_local_step': (c_double, [c_void_p, c_double, *[c_void_p] * 4])})


@same_size_as('size_of_local_rules')
class _LocalRules(ctypes.Structure):  # as in native/via_local.c
    _fields_ = [(name, c_double) for name in (
        'sufficient_decrease', 'tolerated_rise', 'more_damping', 'less_damping', 'left_out')]


RULES = _LocalRules(SUFFICIENT_DECREASE, TOLERATED_RISE, MORE_DAMPING, LESS_DAMPING, LEFT_OUT)


def minimise_locally(barrier: ViaBarrier, should_stop: Callable[[], bool],
                     is_futile: Callable[[Solution], bool] | None = None) -> Solution:
    """
    Return the minimiser of the total duration of a barrier problem, as `barrier_method.minimise`.

    Parameters
    ----------
    barrier : ViaBarrier
        The problem, durations free, at a strictly feasible point.
    should_stop : callable
        Cancellation callback, called before every step; True ends the method with the iterate.
    is_futile : callable, optional
        See `along_central_path`.

    Returns
    -------
    Solution
        Within RELATIVE_GAP of the optimum, where the problem is convex and it is not cancelled.

    """
    steps = LocalSteps(barrier)

    def centre(weight: float, decrement: float) -> bool:
        return steps.centre(weight, decrement, should_stop)

    return along_central_path(barrier, centre, REDUCTION, is_futile)


class LocalSteps:
    """
    Newton steps of the segments that need them.

    Parameters
    ----------
    barrier : ViaBarrier
        The problem, durations free.

    Attributes
    ----------
    active : ndarray, shape (n,)
        1 for the segments that take the next step, else 0.

    """

    def __init__(self, barrier: ViaBarrier) -> None:
        self.active, self._scratch = np.ones((2, len(barrier.durations)))
        self._barrier, self._left_out, self._weight = barrier, np.zeros(1), np.inf
        self._addresses = [x.ctypes.data for x in (self.active, self._scratch, self._left_out)]

    def centre(self, weight: float, decrement: float, should_stop: Callable[[], bool]) -> bool:
        """
        Minimise weight * objective + barrier up to a decrement, which the last step confirms.

        Parameters
        ----------
        weight : float
            Of the objective.
        decrement : float
            Newton decrement squared at which it ends.
        should_stop : callable
            As in `minimise_locally`.

        Returns
        -------
        bool
            Whether it was cancelled.

        """
        self._activate_all()
        if weight > self._weight:
            damping = self._barrier.arrays['damping']
            np.maximum(damping, TANGENT, out=damping)
        self._weight = weight
        for _ in range(MOST_STEPS):
            if should_stop():
                return True
            rounding = ROUNDING * weight * self._barrier.structure.objective
            whole = bool(self.active.all())
            squared = self.step(weight)
            centred = squared is None or squared < max(decrement, rounding)
            if centred and (whole or squared is None):
                break
            stale = squared is not None and self._left_out[0] > 0.5 * squared
            if centred or stale or self.active.mean() > 0.5:  # to leave few out saves nothing
                self._activate_all()
        return False

    def step(self, weight: float) -> float | None:
        """
        Take a Newton step of the active segments.

        Parameters
        ----------
        weight : float
            Of the objective.

        Returns
        -------
        float or None
            Its decrement squared, of all segments; None where rounding allows no decrease.

        """
        squared: float = KERNELS.via_local_step(
            self._barrier.address, weight, ctypes.addressof(RULES), *self._addresses)
        return squared if squared >= 0.0 else None

    def _activate_all(self) -> None:
        self.active[:], self._left_out[:] = 1.0, 0.0
