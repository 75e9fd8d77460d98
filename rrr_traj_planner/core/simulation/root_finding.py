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

"""Finding when something happens during a step, by false position."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

Outcome = TypeVar('Outcome')

# An event is found when the arm is past it by no more than this [rad], [rad/s].
PAST = 1e-12

# About ten trials are needed. Every fourth halves the interval, so that all together suffice.
MOST_TRIALS = 200

# No trial is nearer to an end of the interval than this part of it.
MARGIN = 0.02


def event(trial: Callable[[float], Outcome], room: Callable[[Outcome], float], first: float,
          h: float, last: float) -> tuple[float, Outcome]:
    """
    Return when an event happens, and the state of things then.

    Parameters
    ----------
    trial : callable
        The state of things after a time [s].
    room : callable
        How far a state is from the event; negative past it.
    first, last : float
        Room at the beginning and after h; not negative, and negative.
    h : float
        When it has happened at the latest [s].

    Returns
    -------
    time : float
        [s].
    outcome : object
        The state then, past the event by no more than `PAST`.

    """
    low, high, at_low, at_high, now, outcome = 0.0, h, first, last, last, trial(h)
    for n in range(MOST_TRIALS):
        if now >= -PAST:
            break
        share = min(max(at_low / (at_low - at_high), MARGIN), 1.0 - MARGIN)
        if n % 4 == 3:
            share = 0.5
        middle = low + share * (high - low)
        attempt = trial(middle)
        value = room(attempt)
        if value < 0.0:  # Illinois's rule: the end that stays counts half
            high, now, outcome, at_low, at_high = middle, value, attempt, 0.5 * at_low, value
        else:
            low, at_low, at_high = middle, value, 0.5 * at_high
    return high, outcome
