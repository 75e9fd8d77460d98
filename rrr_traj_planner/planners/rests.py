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

"""Stops at via points, and how long the arm rests there."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray, number_array, truth_array
from rrr_traj_planner.core.errors import counted, InvalidInputError
from rrr_traj_planner.core.read_only import make_read_only

LEAST_DWELL = 1e-6  # s; chosen: times in messages are whole nanoseconds


class Rests(NamedTuple):
    """Where and how long the arm rests, for each of n via points."""

    at: BoolArray  # whether it rests there, (n,)
    dwell: Array   # for how long [s], (n,)


def rests_at_via_points(stop_at: Any, dwell: Any, number: int, started: bool) -> Rests:
    """
    Return where and how long the arm rests.

    It rests where it is to stop, at the last via point, and at the first if the motion starts
    there.

    Parameters
    ----------
    stop_at : array_like of bool, shape (n,), optional
        Whether the arm stops at each via point; the motion ends at the last one. None: only there.
    dwell : array_like, shape (n,), optional
        Rest at each via point [s]; None: none.
    number : int
        Number of via points.
    started : bool
        Whether a start state comes before the first via point.

    Returns
    -------
    Rests
        For each via point.

    Raises
    ------
    InvalidInputError
        If there is not one value for each via point, the arm is not to stop at the last, or a
        dwell is negative, not finite, or at a via point at which the arm does not stop; with that
        via point.

    """
    at = np.zeros(number, dtype=bool)
    if stop_at is not None:
        _check_length('stop_at', stop_at, number)
        at = truth_array('stop_at', stop_at, (number,)).copy()
        if number and not at[-1]:
            raise InvalidInputError(
                f'stop_at[{number - 1}] is false, must be true: the motion ends at the last via '
                'point, at rest', number - 1)
    at[-1:] = True
    if not started:
        at[:1] = True
    seconds = np.zeros(number)
    if dwell is not None:
        _check_length('dwell', dwell, number)
        seconds = number_array('dwell', dwell, (number,))
        _check_dwell(seconds, at)
    make_read_only((at, seconds))
    return Rests(at, seconds)


def _check_length(name: str, values: Any, number: int) -> None:
    """Refuse another number of values than of via points."""
    if hasattr(values, '__len__') and len(values) != number:
        raise InvalidInputError(
            f'{name} has {counted(len(values), "value")} for {counted(number, "via point")}, must '
            'have one for each, or none')


def _check_dwell(seconds: Array, at: BoolArray) -> None:
    """Refuse times that are no rest, and rests where the arm does not stop."""
    wrong = ~(seconds >= LEAST_DWELL) & (seconds != 0.0) | np.isinf(seconds)
    if wrong.any():
        k = int(wrong.argmax())
        raise InvalidInputError(
            f'dwell[{k}] is {seconds[k]} s, must be 0, or finite and at least {LEAST_DWELL} s', k)
    moving = (seconds > 0.0) & ~at
    if moving.any():
        k = int(moving.argmax())
        raise InvalidInputError(
            f'dwell[{k}] is {seconds[k]:g} s, but the arm does not stop at via point {k}: stop_at '
            'must be true there', k)
