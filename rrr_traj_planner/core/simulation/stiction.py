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
Stiction: whether friction and stops hold joints at rest, and the accelerations if they do not.

Each joint's reaction lies in a range: [-c, c] for Coulomb friction at rest, one-sided and
unbounded for a stop. A joint stays at rest with a reaction inside its range, or accelerates
against the reaction at the end of the range. These are the optimality conditions of a strictly
convex problem (Gauss's principle of least constraint with dry friction), which has exactly one
solution; for two coupled joints it is found among nine cases.
"""

from __future__ import annotations

from math import isinf

from rrr_traj_planner.core.dynamics.equations import Terms
from rrr_traj_planner.core.states import Triple

# Least and largest reaction [N m], not above and not below 0; (0, 0) for a joint that moves.
Range = tuple[float, float]

NO_REACTION: Range = (0.0, 0.0)


def resting_accelerations(t: Terms, x: Triple, ranges: tuple[Range, Range, Range]) -> Triple:
    """
    Return the accelerations of an arm with joints that may stay at rest.

    Finds a with r = M (a - x) such that a_i = 0 and r_i in its range, or a_i > 0 and r_i at the
    lower end, or a_i < 0 and r_i at the upper one.

    Parameters
    ----------
    t : Terms
        The equations' terms at the pose.
    x : tuple of 3 floats
        Accelerations without reactions [rad/s^2].
    ranges : tuple of 3 pairs of floats
        Least and largest reaction of each joint [N m]; may be infinite.

    Returns
    -------
    tuple of 3 floats
        Accelerations [rad/s^2]; exactly 0.0 for a joint that stays at rest.

    """
    (x1, x2, x3), (range_1, range_2, range_3) = x, ranges
    a1 = _single(t.M11, x1, range_1)
    if range_2 == range_3 == NO_REACTION:
        return a1, x2, x3
    return a1, *_pair((t.M22, t.M23, t.M33), (x2, x3), range_2, range_3)


def _single(inertia: float, x: float, limits: Range) -> float:
    """Return the acceleration of an inertially uncoupled joint."""
    low, high = limits
    reaction = -inertia * x
    if reaction < low:
        return x + low / inertia
    return x + high / inertia if reaction > high else 0.0


def _pair(M: Triple, x: tuple[float, float], range_2: Range,
          range_3: Range) -> tuple[float, float]:
    """Return the accelerations of two coupled joints."""
    (M22, M23, M33), (x2, x3) = M, x
    if _within(-M22 * x2 - M23 * x3, range_2) and _within(-M23 * x2 - M33 * x3, range_3):
        return 0.0, 0.0
    if range_2 != NO_REACTION:
        a3 = _single(M33, x3 + M23 / M33 * x2, range_3)
        if _within(M23 * (a3 - x3) - M22 * x2, range_2):
            return 0.0, a3
    if range_3 != NO_REACTION:
        a2 = _single(M22, x2 + M23 / M22 * x3, range_2)
        if _within(M23 * (a2 - x2) - M33 * x3, range_3):
            return a2, 0.0
    return _both_moving(M, x, range_2, range_3)


def _both_moving(M: Triple, x: tuple[float, float], range_2: Range,
                 range_3: Range) -> tuple[float, float]:
    """Return the case with consistent directions; up to rounding, the most consistent one."""
    M22, M23, M33 = M
    det = M22 * M33 - M23 * M23
    best, least = (0.0, 0.0), float('inf')
    for sign_2, r2 in zip((1.0, -1.0), range_2):
        for sign_3, r3 in zip((1.0, -1.0), range_3):
            if isinf(r2) or isinf(r3):
                continue
            a = (x[0] + (M33 * r2 - M23 * r3) / det, x[1] + (M22 * r3 - M23 * r2) / det)
            wrong = max(-sign_2 * a[0] if range_2 != NO_REACTION else 0.0,
                        -sign_3 * a[1] if range_3 != NO_REACTION else 0.0)
            if wrong < least:
                best, least = a, wrong
    return best


def _within(value: float, limits: Range) -> bool:
    return limits[0] <= value <= limits[1]
