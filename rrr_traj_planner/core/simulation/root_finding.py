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
Time of an event within a step, by the Illinois variant of false position.

Dowell and Jarratt, A modified regula falsi method for computing the root of an equation, BIT 11,
1971.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

Outcome = TypeVar('Outcome')

# Tolerance of an event: largest distance past it [rad], [rad/s]; chosen: a thousandth of what
# counts as rounding of a position.
EVENT_TOLERANCE = 1e-12


CLEARANCE = 0.02  # of the interval, least distance of a trial from either end; chosen


def locate_event(trial: Callable[[float], Outcome], margin: Callable[[Outcome], float],
                 first: float, h: float, last: float) -> tuple[float, Outcome]:
    """
    Locate an event: return its time, and the outcome then.

    Parameters
    ----------
    trial : callable
        Outcome (state and more) after a time [s].
    margin : callable
        Distance of an outcome from the event; negative past it.
    first, last : float
        Margins at the beginning, not negative, and after h, negative.
    h : float
        End of the step [s].

    Returns
    -------
    time : float
        [s].
    outcome : object
        At that time, past the event by no more than `EVENT_TOLERANCE`.

    """
    low, high, at_low, at_high, now, outcome = 0.0, h, first, last, last, trial(h)
    for n in range(200):  # some ten are needed; every fourth is a bisection: so many suffice
        if now >= -EVENT_TOLERANCE:
            break
        fraction = min(max(at_low / (at_low - at_high), CLEARANCE), 1.0 - CLEARANCE)
        if n % 4 == 3:
            fraction = 0.5
        middle = low + fraction * (high - low)
        attempt = trial(middle)
        value = margin(attempt)
        if value < 0.0:  # Illinois rule: the value at the retained end is halved
            high, now, outcome, at_low, at_high = middle, value, attempt, 0.5 * at_low, value
        else:
            low, at_low, at_high = middle, value, 0.5 * at_high
    return high, outcome
