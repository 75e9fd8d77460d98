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
Steps of the interior-point method that each segment shortens for itself, for long motions.

A step of the whole motion is as short as the worst of its slacks asks; the longer the motion, the
worse is its worst place. Here the Hessian of such a segment alone is damped (Levenberg's and
Marquardt's method: Nocedal & Wright, Numerical Optimization, 10.3), which shortens the step there,
and the step is computed again around it, with the steps beside as they are: their influence decays
within a few segments. Segments that are centred rest while the others take more steps.
"""

from __future__ import annotations

import ctypes
from ctypes import c_double, c_int32, c_void_p
from typing import Any

import numpy as np
from rrr_traj_planner.core.kernels import declared, same_size_as
from rrr_traj_planner.planners.solver.limits import DurationConstraints, FAR
from rrr_traj_planner.planners.solver.line_search import SUFFICIENT_DECREASE
from rrr_traj_planner.planners.solver.timing_problem import TimingProblem

# Segments from which on they take steps of their own; chosen: with 20 (by torque: 50) planning
# takes as long either way, with 40 a third less (by torque, with 100: a quarter).
FEWEST, FEWEST_BY_TORQUE = 24, 48

# Chosen values, without unit, by planning times of random tasks with 100 via points: those of
# similar values differ by a tenth or two. Shorter steps than those of whole motions (TO_BOUNDARY,
# RETAINED) cost the other segments nothing, and keep a segment from places where it gets stuck.
TO_BOUNDARY = 0.9  # part by which a slack may fall, to first order
RETAINED = 0.05    # part that it must retain
TARGET = 0.15      # part that it is to retain after a step that is shorter
SHORTER = 0.7      # factor on the size of a shorter step, so that few are tried
RISE = 1.0         # over the predicted merit, as a part of the decrement squared: then damped
CENTRED = 0.05     # decrement squared / (constraints * barrier) up to which a segment rests
ROUNDS = 40        # of damping, at most

KERNELS = declared({
    'segments_log_sum': (c_double, [c_void_p] * 2),
    'segments_newton': (c_double, [c_void_p] * 4),
    'segments_step': (c_int32, [c_void_p] * 4),
})


@same_size_as('size_of_segment_rules')
class _Rules(ctypes.Structure):  # as in native/segment_steps.h
    _fields_ = [*((name, c_double) for name in (
        'to_boundary', 'retained', 'target', 'shorter', 'sufficient_decrease', 'bad', 'centred',
        'corridor', 'small_shift', 'barrier')), ('rounds', c_int32)]


@same_size_as('size_of_segments')
class _Segments(ctypes.Structure):  # as in native/segment_steps.h
    _fields_ = [*((name, c_void_p) for name in (
        'damping', 'decrease', 'decrement', 'fall', 'part', 'log', 'moved_log', 'change',
        'active', 'flipped', 'untried', 'changed', 'marked')),
        *((name, c_double) for name in (
            'predicted_decrease', 'damped_decrease', 'cost', 'total_log', 'newton_barrier'))]


def take_own_steps(problem: TimingProblem, durations: DurationConstraints) -> bool:
    """
    Return whether the segments of a problem take steps of their own.

    Parameters
    ----------
    problem : TimingProblem
        The limits.
    durations : DurationConstraints
        Which durations are free.

    Returns
    -------
    bool
        Of long motions in joint space whose durations are all free, without least ones. By torque
        alone, without limits on jerk, segments would get stuck.

    """
    limits, N = problem.limits, len(durations.free)
    if limits.table is not None or limits.least_T is not None or not durations.free.all():
        return False
    if limits.bounds_alone:
        return N >= FEWEST
    jerk = 3 * problem.points.shape[1]  # its first column
    return N >= FEWEST_BY_TORQUE and bool((limits.upper[0, 1, jerk:] < FAR).all())


class SegmentSteps:
    """
    The steps of a problem's segments.

    Parameters
    ----------
    problem : TimingProblem
        One to which `take_own_steps` applies.
    dual_corridor, small_shift : float
        See `interior_point`.

    Attributes
    ----------
    active : ndarray of uint8, shape (N,)
        1 for the segments that take the next step, else 0.
    structure : object
        What the last step has brought; see native/segment_steps.h.

    """

    def __init__(self, problem: TimingProblem, dual_corridor: float, small_shift: float) -> None:
        N = len(problem.points) - 1
        self._floats, self._flags = np.ones((8, N)), np.zeros((5, N), np.uint8)
        self.active = self._flags[0]
        self.activate_all()
        self.structure: Any = _Segments(
            *(row.ctypes.data for row in (*self._floats, *self._flags)))
        self._rules = _Rules(TO_BOUNDARY, RETAINED, TARGET, SHORTER, SUFFICIENT_DECREASE, RISE,
                             CENTRED, dual_corridor, small_shift, 0.0, ROUNDS)
        self._problem, self._addresses = problem, [
            problem.address, problem.steps[-1].address,
            *(ctypes.byref(f) for f in (self.structure, self._rules))]

    def activate_all(self) -> None:
        """Let all segments take the next step."""
        self.active[:] = 1

    def log_sum(self) -> float:
        """Return the sum of the logarithms of all slacks at the iterate."""
        return float(KERNELS.segments_log_sum(
            self._problem.address, ctypes.byref(self.structure)))

    def newton(self, barrier: float) -> float:
        """
        Compute the Newton step of the active segments, which `take` takes then.

        Parameters
        ----------
        barrier : float
            The barrier parameter.

        Returns
        -------
        float
            The decrease of the merit that it predicts; NaN where there is none.

        """
        self._rules.barrier = barrier
        return float(KERNELS.segments_newton(*self._addresses))

    def take(self, barrier: float) -> bool:
        """
        Take a step of the active segments, and choose those that take the next one.

        Parameters
        ----------
        barrier : float
            The barrier parameter.

        Returns
        -------
        bool
            False where none is acceptable; then nothing has changed.

        """
        self._rules.barrier = barrier
        return bool(KERNELS.segments_step(*self._addresses))
