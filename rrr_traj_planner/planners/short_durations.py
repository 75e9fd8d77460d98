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

"""The error of prescribed durations that are too short, with feasible ones."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import ConvergenceError, TimingError

# By what parts of themselves about least durations are lengthened until they are feasible: from
# rounding on to where the margins of a planner's own search can no longer be the reason. Chosen.
MARGINS = (0.0, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1)


def whole_microseconds(durations: Array) -> Array:
    """
    Return durations rounded up, so that they can be read from an error and prescribed.

    Parameters
    ----------
    durations : ndarray
        [s].

    Returns
    -------
    ndarray
        Multiples of 1e-6 s.

    """
    return np.asarray(np.ceil(durations * 1e6) / 1e6)


def least_feasible(durations: Array, candidates: Sequence[Array],
                   is_feasible: Callable[[Array], bool]) -> Array:
    """
    Return the first feasible durations: candidates in turn, each lengthened by MARGINS in turn.

    Parameters
    ----------
    durations : ndarray, shape (n,)
        As prescribed [s], for the message.
    candidates : sequence of ndarray, shape (n,)
        About the least feasible ones [s].
    is_feasible : callable
        Returns whether given durations are.

    Returns
    -------
    ndarray, shape (n,)
        In whole microseconds [s].

    Raises
    ------
    ConvergenceError
        If none is feasible.

    """
    for candidate in candidates:
        for margin in MARGINS:
            feasible = whole_microseconds(candidate * (1.0 + margin))
            if is_feasible(feasible):
                return feasible
    raise ConvergenceError(
        f'no feasible durations found for segment_durations {durations.tolist()} s')


def durations_too_short(durations: Array, feasible: Array, segments: Sequence[int] = (),
                        which: str = 'the least feasible are') -> TimingError:
    """
    Return the error of prescribed durations that are too short.

    Parameters
    ----------
    durations : ndarray, shape (n,)
        As prescribed [s].
    feasible : ndarray, shape (n,)
        Feasible ones [s].
    segments : sequence of int, optional
        The numbers of the segments that are too short; empty: not named in the message.
    which : str
        What the feasible ones are, for the message.

    Returns
    -------
    TimingError
        With the feasible durations.

    """
    # To nanoseconds, as in messages.
    given, offered = ([round(float(d), 9) for d in v] for v in (durations, feasible))
    where = (f' for segment{"s" * (len(segments) > 1)} {", ".join(map(str, segments))}'
             if len(segments) else '')
    return TimingError(f'segment_durations {given} s are too short{where}: {which} {offered} s',
                       tuple(offered))
